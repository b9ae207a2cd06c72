// Pole placement for a sampled process: R and S of A R + B S = P A_o, as loopbook.pole_placement.numeric has it.

import { solveInPlace } from "./linear.js";
import { convolve } from "./polynomials.js";

const NEAR = 1e-8;

export class PlacementError extends Error {}

const at = (p, i) => (i >= 0 && i < p.length ? p[i] : 0);

const total = (p) => p.reduce((a, b) => a + b, 0);

// {R, S, T, observer}: coefficients of z^0, z^-1, ...; P, observer: wanted polynomials starting with 1.
export function place(B, A, P, observer, integrators) {
    if (B[0] !== 0 || !B.some((c) => c)) throw new PlacementError("the sampled process has no delay");
    let fixed = [1];
    for (let i = 0; i < integrators; i += 1) fixed = convolve(fixed, [1, -1]);
    const below = convolve(A, fixed), wanted = convolve(P, observer), last = lastNonzeroIndex(B);
    const n_s = below.length - 2, n_r = Math.max(last - 1, wanted.length - below.length), size = n_r + n_s + 1;
    const M = new Float64Array(size * size), right = new Float64Array(size);
    for (let i = 0; i < size; i += 1) {
        for (let j = 0; j < n_r; j += 1) M[i * size + j] = at(below, i - j);
        for (let j = 0; j <= n_s; j += 1) M[i * size + n_r + j] = at(B, i + 1 - j);
        right[i] = at(wanted, i + 1) - at(below, i + 1);
    }
    const sizes = [];
    for (let j = 0; j < size; j += 1) {
        let norm = 0;
        for (let i = 0; i < size; i += 1) norm = Math.hypot(norm, M[i * size + j]);
        sizes.push(norm);
        for (let i = 0; i < size; i += 1) M[i * size + j] /= norm;
    }
    const solution = Array.from(solveInPlace(M, size, right, 1), (x, j) => x / sizes[j]);
    if (!solution.every(Number.isFinite)) throw new PlacementError("process and integrator share a factor");
    if (Math.abs(total(B)) <= NEAR * total(B.map(Math.abs))) throw new PlacementError("the process has no static gain");
    const gain = total(P) / total(B);
    return {
        R: convolve([1, ...solution.slice(0, n_r)], fixed),
        S: solution.slice(n_r),
        T: observer.map((c) => gain * c),
        observer,
    };
}

function lastNonzeroIndex(p) {
    let i = p.length - 1;
    while (i > 0 && p[i] === 0) i -= 1;
    return i;
}
