// One cell of a linear differential equation with a delayed input, as a matrix: Radau collocation.
//
//     x'(t)  = A x(t) + b v(t) + e_s       x(0) = x0_s        one e and x0 for each source s
//     o_i(t) = C_i x + d_i v + f_i,s       outputs; the first is fed back: v(t) = o_0(t - L), 0 for t < L
//
// A is block triangular; `blocks` are the sizes of its diagonal blocks, so that the states are solved one after another.

import { solveInPlace } from "./linear.js";
import { COUNT, DEGREE, radau } from "./legendre.js";

const REACH = 4;
const SLIVER = 1e-9;
export const MOST_CELLS = 6000;

export class ResponseError extends Error {}

// Cells on [0, length]: as long as the fastest mode that has not yet died out allows. modes: complex numbers.
export function gradedMesh(modes, length) {
    const known = modes.map(([re, im]) => [re, Math.hypot(re, im)]).filter(([, size]) => size > 0), edges = [0];
    while (edges.at(-1) < length * (1 - SLIVER)) {
        let fastest = 0;
        for (const [re, size] of known) if (-re * edges.at(-1) < 40) fastest = Math.max(fastest, size);
        if (edges.length > MOST_CELLS) throw new ResponseError("too many periods of the fastest mode");
        edges.push(fastest ? edges.at(-1) + REACH / fastest : length);
    }
    edges[edges.length - 1] = length;
    return edges;
}

// What a cell of this length does: {map, constants, rows, width}. map: (x at the start, v at the start and the points)
// -> each output at the start and the points, x at the end; constants: what each source adds.
export function cellOperator(system, length) {
    const { n, outputs } = system, width = n + COUNT, sources = system.e.length;
    const X = statesAtPoints(system, length), columns = width + sources, rows = outputs.length * COUNT + n;
    const map = new Float64Array(rows * width), constants = system.e.map(() => new Float64Array(rows));
    outputs.forEach(({ C, d, f }, o) => {
        for (let q = 0; q < COUNT; q += 1) {
            const row = o * COUNT + q;
            for (let i = 0; i < n; i += 1) {
                if (C[i] === 0) continue;
                if (q === 0) {
                    map[row * width + i] = C[i];
                    continue;
                }
                const from = (i * DEGREE + q - 1) * columns;
                for (let j = 0; j < width; j += 1) map[row * width + j] += C[i] * X[from + j];
                for (let s = 0; s < sources; s += 1) constants[s][row] += C[i] * X[from + width + s];
            }
            map[row * width + n + q] += d;
            for (let s = 0; s < sources; s += 1) constants[s][row] += f[s];
        }
    });
    for (let i = 0; i < n; i += 1) {
        const from = (i * DEGREE + DEGREE - 1) * columns, row = outputs.length * COUNT + i;
        for (let j = 0; j < width; j += 1) map[row * width + j] = X[from + j];
        for (let s = 0; s < sources; s += 1) constants[s][row] = X[from + width + s];
    }
    return { map, constants, rows, width };
}

// x at the points, (n DEGREE) rows, as a map of x at the start, v at the start and the points, and each source.
function statesAtPoints(system, length) {
    const { n, A, b, e, blocks } = system, p = DEGREE, columns = n + COUNT + e.length, { a } = radau;
    const X = new Float64Array(n * p * columns);
    let first = 0;
    for (const size of blocks) {
        const M = new Float64Array((size * p) ** 2), right = new Float64Array(size * p * columns);
        for (let r = 0; r < size; r += 1) {
            const i = first + r;
            // what drives the block at each point: earlier states, v, the sources
            const driven = new Float64Array(p * columns);
            for (let j = 0; j < first; j += 1) {
                const coupling = A[i * n + j];
                if (coupling === 0) continue;
                for (let k = 0; k < p * columns; k += 1) driven[k] += coupling * X[j * p * columns + k];
            }
            for (let q = 0; q < p; q += 1) {
                driven[q * columns + n + 1 + q] += b[i];
                for (let s = 0; s < e.length; s += 1) driven[q * columns + n + COUNT + s] += e[s][i];
            }
            for (let q = 0; q < p; q += 1) {
                const row = (r * p + q) * columns;
                right[row + i] = 1;
                for (let l = 0; l < p; l += 1) {
                    const weight = length * a[q * p + l];
                    for (let k = 0; k < columns; k += 1) right[row + k] += weight * driven[l * columns + k];
                    for (let c = 0; c < size; c += 1) {
                        M[(r * p + q) * size * p + c * p + l] = (r === c && q === l ? 1 : 0) - weight * A[i * n + first + c];
                    }
                }
            }
        }
        X.set(solveInPlace(M, size * p, right, columns), first * p * columns);
        first += size;
    }
    return X;
}
