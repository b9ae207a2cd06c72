// Legendre polynomials on [-1, 1], Radau's points, and what leads from values there to coefficients and back.

import { identity, solveInPlace } from "./linear.js";

export const DEGREE = 16;
export const COUNT = DEGREE + 1;

// P_0(x) ... P_n(x).
export function legendre(x, n = DEGREE) {
    const p = new Float64Array(n + 1);
    p[0] = 1;
    if (n) p[1] = x;
    for (let k = 1; k < n; k += 1) p[k + 1] = ((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1);
    return p;
}

// sum c_k P_k(x), by Clenshaw's recursion.
export function series(c, x) {
    let after = 0, last = 0;
    for (let k = c.length - 1; k > 0; k -= 1) {
        const next = c[k] + (2 * k + 1) / (k + 1) * x * after - (k + 1) / (k + 2) * last;
        last = after;
        after = next;
    }
    return c[0] + x * after - 0.5 * last;
}

// The coefficients of the derivative by x.
export function slopeOf(c) {
    const n = c.length, d = new Float64Array(n);
    for (let k = n - 2; k >= 0; k -= 1) d[k] = (2 * k + 1) * (c[k + 1] + (k + 2 < n ? d[k + 2] / (2 * k + 5) : 0));
    return d;
}

// The roots of P_n - P_(n-1), ascending: they end at 1.
function radauPoints(n) {
    const points = [];
    for (let i = 0; i < n; i += 1) {
        let x = i === 0 ? 1 : Math.cos(2 * Math.PI * i / (2 * n - 1));
        for (let k = 0; i > 0 && k < 60; k += 1) {
            const p = legendre(x, n), value = p[n] - p[n - 1];
            const slopeN = n * (x * p[n] - p[n - 1]) / (x * x - 1);
            const slopeM = (n - 1) * (x * p[n - 1] - p[n - 2]) / (x * x - 1);
            const change = value / (slopeN - slopeM);
            x -= change;
            if (Math.abs(change) < 1e-16) break;
        }
        points.unshift(x);
    }
    return points;
}

// Points in (-1, 1], the matrix of the integrals from -1 to each point (on [0, 1]), and the matrix from the values at
// -1 and the points to coefficients; computed once.
export const radau = (() => {
    const nodes = radauPoints(DEGREE), p = DEGREE;
    const all = [-1, ...nodes].map((x) => legendre(x, p));
    const toCoefficients = new Float64Array(COUNT * COUNT);
    all.forEach((row, i) => toCoefficients.set(row, i * COUNT));
    const inverse = solveInPlace(toCoefficients, COUNT, identity(COUNT), COUNT);
    // integral of P_k from -1 to a node; k < p
    const integrals = new Float64Array(p * p), values = new Float64Array(p * p);
    nodes.forEach((x, j) => {
        const row = legendre(x, p);
        for (let k = 0; k < p; k += 1) {
            values[k * p + j] = row[k];
            integrals[k * p + j] = k ? (row[k + 1] - row[k - 1]) / (2 * k + 1) : x + 1;
        }
    });
    // a with sum_j a_ij P_k(x_j) = integral_i / 2
    const solved = solveInPlace(values, p, integrals, p), a = new Float64Array(p * p);
    for (let i = 0; i < p; i += 1) for (let j = 0; j < p; j += 1) a[i * p + j] = solved[j * p + i] / 2;
    return { nodes, a, toCoefficients: inverse };
})();
