// A program against the exact continuous process: what runs on the plant, sample by sample, within its limits.

import { held } from "./sampled.js";

// The gains of the discrete PID as polynomials in z^-1, R u = T r - S y, from the state of an emitted controller.
//     u = p1 r - p2 y + p5 z^-1/(1 - z^-1) (r - y) + p4 z^-1/(1 - p3 z^-1) (y - c r)
export function pidPolynomials({ p1, p2, p3, p4, p5, s }) {
    const filter = [1, -p3], integrates = p5 !== 0;
    if (!integrates) {
        return { R: filter, S: [p2, -p2 * p3 - p4], T: [p1, -p1 * p3 - s.c * p4] };
    }
    const row = (direct, derivative) => [
        direct,
        -direct * (1 + p3) + p5 - derivative,
        direct * p3 - p5 * p3 + derivative,
    ];
    return { R: [1, -1 - p3, p3], S: row(p2, p4), T: row(p1, s.c * p4) };
}

// u(k) of an RST regulator within limits, its observer polynomial against windup:
//     A_o v = T r - S y + (A_o - R) u,    u = v limited
export function rstController({ R, S, T, observer }, low, high) {
    const past = { r: [], y: [], u: [], v: [] };
    const tail = (p, values) => p.slice(1).reduce((total, c, i) => total + c * (values[i] ?? 0), 0);
    return {
        step(r, y) {
            let v = T[0] * r + tail(T, past.r) - S[0] * y - tail(S, past.y) - tail(R, past.u);
            v += tail(observer, past.u) - tail(observer, past.v);
            const u = Math.min(Math.max(v, low), high);
            for (const [name, value] of [["r", r], ["y", y], ["u", u], ["v", v]]) {
                past[name].unshift(value);
                past[name].length = Math.min(past[name].length, 12);
            }
            return u;
        },
    };
}

// Runs controller.step(r, y, k) on a process from `sample` for some samples. reference(t), load(t), noise(t): courses, the
// last one of the measurement alone. points: how many per sample are given of y. Returns {t, y, instants, u, seen}: u holds
// from each instant on, seen is what was measured there.
export function simulate(sampled, controller, steps, { reference, load, noise = () => 0, points = 1 }) {
    const { plant, whole, tau, h } = sampled, { n, C, d } = plant;
    const cuts = [], grid = [];
    for (let j = 0; j < points; j += 1) grid.push(j * h / points);
    const marks = [...new Set([...grid, ...(tau ? [tau] : []), h])].sort((a, b) => a - b);
    for (let i = 1; i < marks.length; i += 1) {
        cuts.push({ from: marks[i - 1], late: marks[i - 1] >= tau, ...held(plant, marks[i] - marks[i - 1]), given: grid.includes(marks[i - 1]) });
    }
    const history = [], t = [], y = [], instants = [], u = [], seen = [];
    const entered = (k) => (k >= 0 ? history[k] : 0);
    let x = new Float64Array(n), other = new Float64Array(n);
    for (let k = 0; k <= steps; k += 1) {
        const now = k * h, acting = entered(tau ? k - whole - 1 : k - whole);
        let measured = tau || whole ? d * acting : 0;
        for (let i = 0; i < n; i += 1) measured += C[i] * x[i];
        seen.push(measured + noise(now));
        const output = controller.step(reference(now), seen[k], k);
        instants.push(now);
        u.push(output);
        history.push(output + load(now));
        for (const cut of cuts) {
            const v = entered(cut.late ? k - whole : k - whole - 1);
            if (cut.given) {
                let value = d * v;
                for (let i = 0; i < n; i += 1) value += C[i] * x[i];
                t.push(now + cut.from);
                y.push(cut.from === 0 ? measured : value);
            }
            for (let i = 0; i < n; i += 1) {
                let total = cut.input[i] * v;
                for (let j = 0; j < n; j += 1) total += cut.step[i * n + j] * x[j];
                other[i] = total;
            }
            [x, other] = [other, x];
        }
    }
    return { t, y, instants, u, seen };
}
