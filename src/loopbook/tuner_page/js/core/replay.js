// A process driven by a recorded input, each sample held until the next, exact with any dead time.

import { held } from "./sampled.js";
import { trimmed } from "./polynomials.js";
import { polesOf, realised } from "./state.js";

// y at the times of the record, as a deviation from rest; u as a deviation too.
export function replay(process, times, u) {
    const den = trimmed(process.den), form = realised(den, polesOf(process)), plant = { ...form, ...form.row(trimmed(process.num)) };
    const { n, C, d } = plant, kept = new Map(), y = new Float64Array(times.length);
    const over = (duration) => {
        const key = duration.toPrecision(10);
        if (!kept.has(key)) kept.set(key, held(plant, duration));
        return kept.get(key);
    };
    let x = new Float64Array(n), now = times[0], next = 0, v = 0;
    const advance = (until) => {
        if (until - now <= 1e-12 * Math.max(1, Math.abs(until))) return;
        const { step, input } = over(until - now), after = new Float64Array(n);
        for (let i = 0; i < n; i += 1) {
            let total = input[i] * v;
            for (let j = 0; j < n; j += 1) total += step[i * n + j] * x[j];
            after[i] = total;
        }
        x = after;
        now = until;
    };
    times.forEach((t, k) => {
        while (next < times.length && times[next] + process.delay <= t) {
            advance(times[next] + process.delay);
            v = u[next];
            next += 1;
        }
        advance(t);
        let value = d * v;
        for (let i = 0; i < n; i += 1) value += C[i] * x[i];
        y[k] = value;
    });
    return y;
}

// How much of the output's movement the model explains, in per cent.
export function fitOf(y, model) {
    const mean = y.reduce((a, b) => a + b, 0) / y.length;
    let missed = 0, moved = 0;
    y.forEach((value, i) => { missed += (value - model[i]) ** 2; moved += (value - mean) ** 2; });
    return 100 * (1 - Math.sqrt(missed / moved));
}
