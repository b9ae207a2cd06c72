// State space of a rational transfer function with several outputs.

import { convolve, roots, sum } from "./polynomials.js";

const CLOSE = 1e-14;

// The poles of a process: of its lags where these are known, which roots of a multiple pole are not.
export function polesOf({ lags, den }) {
    if (!lags) return roots(den);
    return [...lags.map((T) => [-1 / T, 0]), ...(den.at(-1) === 0 ? [[0, 0]] : [])];
}

// 1/den in state space, {A, b, n, blocks, poles, row}: as a chain where the poles give the polynomial back, which those
// found of a multiple pole do not. row(num): {C, d} of the output num/den.
export function realised(den, poles = roots(den)) {
    const factors = factorsOf(poles), again = factors.reduce(convolve, [1]);
    const scale = Math.max(...den.map(Math.abs));
    const told = den.every((c, i) => Math.abs(again[i] * den[0] - c) <= CLOSE * (Math.abs(c) || scale));
    const n = den.length - 1, monic = den.map((c) => c / den[0]), form = told ? chain(n, factors) : companion(n, monic);
    const row = (num) => {
        const whole = num.map((c) => c / den[0]), d = whole.length > n ? whole[0] : 0;
        const rest = whole.length > n ? sum(whole, monic, -d).slice(1) : whole;
        return { C: told ? chainRow(n, factors, rest) : companionRow(n, rest), d };
    };
    return { ...form, n, poles, row };
}

// The monic factors of degree 1 and 2, fastest first: the other way, slow states would be large and cancel.
function factorsOf(poles) {
    const factors = [];
    poles.forEach(([re, im]) => {
        if (im === 0) factors.push([1, -re]);
        else if (im > 0) factors.push([1, -2 * re, re * re + im * im]);
    });
    const size = (q) => Math.abs(q.at(-1)) ** (1 / (q.length - 1));
    return factors.sort((p, q) => size(q) - size(p));
}

// One block, in the form in which the last state's derivatives are the others.
function companion(n, a) {
    const A = new Float64Array(n * n), b = new Float64Array(n);
    for (let i = 0; i < n - 1; i += 1) A[i * n + i + 1] = 1;
    for (let i = 0; i < n; i += 1) A[(n - 1) * n + i] = -a[n - i];
    b[n - 1] = 1;
    return { A, b, blocks: [n] };
}

function companionRow(n, num) {
    const C = new Float64Array(n);
    num.forEach((c, i) => { C[num.length - 1 - i] = c; });
    return C;
}

// A chain of lags and pairs, block triangular; its outputs are num/den = sum of r_i(s) / (q_1(s) ... q_i(s)).
function chain(n, factors) {
    const A = new Float64Array(n * n), b = new Float64Array(n), blocks = factors.map((q) => q.length - 1);
    let first = 0, input = -1;
    factors.forEach((q, f) => {
        const last = first + blocks[f] - 1;
        if (blocks[f] === 1) {
            A[first * n + first] = -q[1];
        } else {
            A[first * n + last] = 1;
            A[last * n + first] = -q[2];
            A[last * n + last] = -q[1];
        }
        if (f) A[last * n + input] = 1; else b[last] = 1;
        input = first;
        first = last + 1;
    });
    return { A, b, blocks };
}

function chainRow(n, factors, num) {
    const C = new Float64Array(n);
    let rest = num, last = n;
    [...factors].reverse().forEach((q) => {
        const [quotient, remainder] = divided(rest, q), first = last - (q.length - 1);
        remainder.forEach((c, i) => { C[first + remainder.length - 1 - i] = c; });
        rest = quotient;
        last = first;
    });
    return C;
}

// [quotient, remainder] of a polynomial by a monic one.
function divided(p, q) {
    const rest = [...p], quotient = [];
    while (rest.length >= q.length) {
        const c = rest[0];
        quotient.push(c);
        q.forEach((x, i) => { rest[i] -= c * x; });
        rest.shift();
    }
    while (rest.length < q.length - 1) rest.unshift(0);
    return [quotient.length ? quotient : [0], rest];
}
