// A process behind a zero-order hold, sampled exactly, dead time of any fraction of a sample included: a port of
// loopbook.process.sampled. With the dead time (whole + part) h,
//
//     x(k+1) = Phi x(k) + newer u(k - whole) + older u(k - whole - 1)

import { exp, scale } from "./complex.js";
import { expm, times } from "./linear.js";
import { convolve, fromRoots, trimmed } from "./polynomials.js";
import { polesOf, realised } from "./state.js";

// {step: exp(A d), input: the integral of exp(A s) b over d}.
export function held({ A, b, n }, duration) {
    const all = n + 1, M = new Float64Array(all * all);
    for (let i = 0; i < n; i += 1) {
        for (let j = 0; j < n; j += 1) M[i * all + j] = A[i * n + j] * duration;
        M[i * all + n] = b[i] * duration;
    }
    const E = expm(M, all), step = new Float64Array(n * n), input = new Float64Array(n);
    for (let i = 0; i < n; i += 1) {
        for (let j = 0; j < n; j += 1) step[i * n + j] = E[i * all + j];
        input[i] = E[i * all + n];
    }
    return { step, input };
}

export function sample(process, h) {
    const num = trimmed(process.num), den = trimmed(process.den), form = realised(den, polesOf(process)), { n } = form;
    const plant = { ...form, ...form.row(num) }, ratio = process.delay / h, near = Math.round(ratio);
    const exact = Math.abs(ratio - near) < 1e-12 * Math.max(ratio, 1);
    const whole = exact ? near : Math.floor(ratio), tau = exact ? 0 : process.delay - whole * h;
    const late = held(plant, h - tau), early = held(plant, tau);
    const Phi = times(late.step, early.step, n, n, n), newer = late.input;
    return { plant, whole, tau, h, Phi, newer, older: times(late.step, early.input, n, n, 1), poles: form.poles };
}

// [B, A] in ascending powers of z^-1, A starting with 1, and the z of A's roots.
export function pulseTransfer({ plant, whole, tau, h, Phi, newer, older, poles }) {
    const { n, C, d } = plant, modes = poles.map((p) => exp(scale(p, h))), A = fromRoots(modes);
    const markov = [newer, older].map((gamma) => {
        const row = new Array(n + 1).fill(0);
        let state = gamma;
        for (let i = 1; i <= n; i += 1) {
            row[i] = C.reduce((total, c, k) => total + c * state[k], 0);
            state = times(Phi, state, n, n, 1);
        }
        return row;
    });
    markov[tau ? 1 : 0][0] = d;
    const B = new Array(n + 2).fill(0);
    convolve(A, markov[0]).slice(0, n + 1).forEach((c, i) => { B[i] += c; });
    convolve(A, markov[1]).slice(0, n + 1).forEach((c, i) => { B[i + 1] += c; });
    return { B: [...new Array(whole).fill(0), ...(tau ? B : B.slice(0, n + 1))], A, modes };
}
