// Real polynomials as arrays of coefficients from the highest power down: values, products, roots.

import { abs, add, div, mul, sub } from "./complex.js";
import { octaves } from "./units.js";

// Without leading zeros; the zero polynomial is [0].
export function trimmed(p) {
    let first = 0;
    while (first < p.length - 1 && p[first] === 0) first += 1;
    return p.slice(first);
}

export function convolve(p, q) {
    const product = new Array(p.length + q.length - 1).fill(0);
    p.forEach((a, i) => q.forEach((b, j) => { product[i + j] += a * b; }));
    return product;
}

export function sum(p, q, factor = 1) {
    const n = Math.max(p.length, q.length);
    const total = new Array(n).fill(0);
    p.forEach((a, i) => { total[n - p.length + i] += a; });
    q.forEach((b, i) => { total[n - q.length + i] += factor * b; });
    return total;
}

// p + q, a coefficient that is nothing but rounding of two that cancel taken as zero: each by its own size.
export function roundedSum(p, q) {
    const sizes = sum(p.map(Math.abs), q.map(Math.abs));
    return sum(p, q).map((c, i) => (Math.abs(c) > 8 * Number.EPSILON * sizes[i] ? c : 0));
}

export function product(lists) {
    return lists.reduce(convolve, [1]);
}

// p(s) at complex s by Horner's rule.
export function value(p, s) {
    let re = p[0], im = 0;
    for (let i = 1; i < p.length; i += 1) {
        const next = re * s[0] - im * s[1] + p[i];
        im = re * s[1] + im * s[0];
        re = next;
    }
    return [re, im];
}

export function valueAtReal(p, x) {
    let total = p[0];
    for (let i = 1; i < p.length; i += 1) total = total * x + p[i];
    return total;
}

// [p(s), p'(s)] at complex s.
export function withSlope(p, s) {
    let re = p[0], im = 0, slopeRe = 0, slopeIm = 0;
    for (let i = 1; i < p.length; i += 1) {
        const nextSlope = slopeRe * s[0] - slopeIm * s[1] + re;
        slopeIm = slopeRe * s[1] + slopeIm * s[0] + im;
        slopeRe = nextSlope;
        const next = re * s[0] - im * s[1] + p[i];
        im = re * s[1] + im * s[0];
        re = next;
    }
    return [[re, im], [slopeRe, slopeIm]];
}

export function derivative(p) {
    const n = p.length - 1;
    return n ? p.slice(0, -1).map((c, i) => c * (n - i)) : [0];
}

// The polynomial with these roots, complex ones in pairs, and the leading coefficient 1.
export function fromRoots(roots) {
    let p = [[1, 0]];
    for (const r of roots) {
        const next = [...p, [0, 0]];
        p.forEach((c, i) => { next[i + 1] = sub(next[i + 1], mul(c, r)); });
        p = next;
    }
    return p.map((c) => c[0]);
}

// All complex roots of a real polynomial, by Aberth's method from the radii of Newton's polygon; those of a real
// polynomial come in exact pairs. Zeros at the origin are exact.
export function roots(polynomial) {
    const whole = trimmed(polynomial);
    const found = [];
    let n = whole.length;
    while (n > 1 && whole[n - 1] === 0) { n -= 1; found.push([0, 0]); }
    const p = whole.slice(0, n);
    if (n === 2) return [...found, [-p[1] / p[0], 0]];
    if (n === 3) return [...found, ...quadratic(p)];
    if (n < 2) return found;
    const reversed = [...p].reverse();
    const radii = octaves(p).map((o) => 2 ** o);
    const z = radii.map((r, i) => [r * Math.cos(2 * Math.PI * i / radii.length + 0.7 + 0.1 * i), r * Math.sin(2 * Math.PI * i / radii.length + 0.7 + 0.1 * i)]);
    const moving = new Array(z.length).fill(true);
    for (let round = 0; round < 120 && moving.some(Boolean); round += 1) {
        for (let i = 0; i < z.length; i += 1) {
            if (!moving[i]) continue;
            const step = newton(p, reversed, z[i]);
            if (step === null) { moving[i] = false; continue; }
            let repelled = [0, 0];
            for (let j = 0; j < z.length; j += 1) {
                if (j === i) continue;
                const apart = sub(z[i], z[j]);
                if (apart[0] !== 0 || apart[1] !== 0) repelled = add(repelled, div([1, 0], apart));
            }
            const change = div(step, sub([1, 0], mul(step, repelled)));
            if (!Number.isFinite(change[0] + change[1])) continue;
            z[i] = sub(z[i], change);
            if (abs(change) <= 4e-16 * abs(z[i])) moving[i] = false;
        }
    }
    return [...found, ...paired(p, z)];
}

// p/p' at z, from the reversed polynomial where |z| > 1 could overflow; null where p vanishes within rounding.
function newton(p, reversed, z) {
    const n = p.length - 1;
    if (abs(z) <= 1) {
        const [value, slope] = withSlope(p, z);
        return stalled(p, value, abs(z)) ? null : div(value, slope);
    }
    const inverse = div([1, 0], z);
    const [value, slope] = withSlope(reversed, inverse);
    if (stalled(reversed, value, abs(inverse))) return null;
    return div(z, sub([n, 0], mul(inverse, div(slope, value))));
}

function stalled(p, at, size) {
    let width = 0;
    for (const c of p) width = width * size + Math.abs(c);
    return Math.abs(at[0]) + Math.abs(at[1]) <= 2e-17 * width;
}

function quadratic([a, b, c]) {
    const half = -b / 2, inside = half * half - a * c;
    if (inside < 0) {
        const re = half / a, im = Math.sqrt(-inside) / Math.abs(a);
        return [[re, im], [re, -im]];
    }
    const far = half + Math.sign(half || 1) * Math.sqrt(inside);
    return far === 0 ? [[0, 0], [0, 0]] : [[far / a, 0], [c / far, 0]];
}

// Roots that are real within rounding set on the real axis, the others made exact pairs.
function paired(p, z) {
    const left = z.map((r) => (Math.abs(r[1]) <= 1e-10 * abs(r) ? [polishedRoot(p, r[0]), 0] : r));
    const result = [];
    while (left.length) {
        const r = left.pop();
        if (r[1] === 0) { result.push(r); continue; }
        let nearest = -1;
        left.forEach((other, i) => {
            if (other[1] * r[1] < 0 && (nearest < 0 || gap(other, r) < gap(left[nearest], r))) nearest = i;
        });
        if (nearest < 0) { result.push([r[0], 0]); continue; }
        const [other] = left.splice(nearest, 1);
        const re = (r[0] + other[0]) / 2, im = (Math.abs(r[1]) + Math.abs(other[1])) / 2;
        result.push([re, im], [re, -im]);
    }
    return result;
}

const gap = (a, b) => Math.hypot(a[0] - b[0], a[1] + b[1]);

function polishedRoot(p, x) {
    const [value, slope] = withSlope(p, [x, 0]);
    const change = value[0] / slope[0];
    return Math.abs(change) < 1e-9 * Math.abs(x) ? x - change : x;
}
