// A signal in continuous time: one Legendre series per cell. Zero before its first cell.

import { COUNT, legendre, radau, series, slopeOf } from "./legendre.js";

const STILL = 1e-11;

export class Signal {
    constructor(edges, rows) {
        this.edges = edges;
        this.rows = rows;
    }

    get end() {
        return this.edges[this.rows.length];
    }

    // The same signal times `factor`, plus `level`, with time counted in units of 1/`pace`.
    scaled(factor, level = 0, pace = 1) {
        const rows = this.rows.map((row) => {
            const c = row.map((x) => factor * x);
            c[0] += level;
            return c;
        });
        return new Signal(this.edges.map((t) => t * pace), rows);
    }

    // The signal cut off at `time`.
    until(time) {
        let cells = this.rows.length;
        while (cells > 1 && this.edges[cells - 1] >= time * (1 - 1e-14)) cells -= 1;
        const rows = this.rows.slice(0, cells), edges = this.edges.slice(0, cells + 1);
        if (edges[cells] > time) {
            const start = edges[cells - 1], share = (time - start) / (edges[cells] - start);
            const values = [-1, ...radau.nodes].map((x) => series(rows[cells - 1], (x + 1) * share - 1));
            edges[cells] = time;
            rows[cells - 1] = coefficientsOf(values, 0);
        }
        return new Signal(edges, rows);
    }

    // The values at ascending times.
    at(times) {
        const found = new Float64Array(times.length);
        let i = 0;
        times.forEach((t, k) => {
            if (t < this.edges[0]) return;
            while (i < this.rows.length - 1 && t >= this.edges[i + 1]) i += 1;
            found[k] = series(this.rows[i], 2 * (t - this.edges[i]) / (this.edges[i + 1] - this.edges[i]) - 1);
        });
        return found;
    }

    last() {
        return this.rows.at(-1).reduce((a, b) => a + b, 0);
    }

    // Candidates for extremes, {t, value}: turning points and both sides of every edge.
    extremes() {
        if (this.found) return this.found;
        let largest = 0;
        for (const row of this.rows) largest = Math.max(largest, row.reduce((a, b) => a + Math.abs(b), 0));
        const found = [];
        this.rows.forEach((row, i) => {
            const t = this.edges[i], length = this.edges[i + 1] - t;
            found.push({ t, value: series(row, -1) }, { t: t + length, value: series(row, 1) });
            let lively = 0;
            for (let k = 1; k < row.length; k += 1) lively += Math.abs(row[k]);
            if (lively <= STILL * largest) return;
            for (const x of zerosOfSeries(slopeOf(row))) found.push({ t: t + (x + 1) / 2 * length, value: series(row, x) });
        });
        this.found = found;
        return found;
    }

    // All times at which the signal equals `level` or jumps across it, ascending.
    crossings(level) {
        const found = [];
        let before = -level;
        this.rows.forEach((row, i) => {
            const c = row.slice(), t = this.edges[i], length = this.edges[i + 1] - t;
            c[0] -= level;
            if (before * series(c, -1) < 0) found.push(t);
            for (const x of zerosOfSeries(c)) found.push(t + (x + 1) / 2 * length);
            before = series(c, 1);
        });
        return found;
    }

    integralOfMagnitude() {
        let total = 0;
        this.rows.forEach((row, i) => {
            const half = (this.edges[i + 1] - this.edges[i]) / 2, cuts = [-1, ...zerosOfSeries(row), 1];
            for (let k = 1; k < cuts.length; k += 1) total += half * Math.abs(integral(row, cuts[k - 1], cuts[k]));
        });
        return total;
    }

    // The sum of all its movements: jumps and what it goes up and down.
    variation() {
        let total = 0, before = 0;
        this.rows.forEach((row) => {
            const turns = [-1, ...zerosOfSeries(slopeOf(row)), 1].map((x) => series(row, x));
            total += Math.abs(turns[0] - before);
            for (let k = 1; k < turns.length; k += 1) total += Math.abs(turns[k] - turns[k - 1]);
            before = turns.at(-1);
        });
        return total;
    }
}

// Coefficients of the values at -1 and Radau's points, from `at` on.
export function coefficientsOf(values, at) {
    const c = new Float64Array(COUNT), { toCoefficients } = radau;
    for (let i = 0; i < COUNT; i += 1) {
        let total = 0;
        for (let j = 0; j < COUNT; j += 1) total += toCoefficients[i * COUNT + j] * values[at + j];
        c[i] = total;
    }
    return c;
}

// The integral of a series between two x.
function integral(c, a, b) {
    const n = c.length, low = legendre(a, n), high = legendre(b, n);
    let total = c[0] * (b - a);
    for (let k = 1; k < n; k += 1) total += c[k] * (high[k + 1] - high[k - 1] - low[k + 1] + low[k - 1]) / (2 * k + 1);
    return total;
}

const DENSITY = 3;
const grids = new Map();

function gridOf(count) {
    if (!grids.has(count)) {
        const points = [];
        for (let i = 0; i <= DENSITY * count; i += 1) points.push(-Math.cos(Math.PI * i / (DENSITY * count)));
        grids.set(count, points.map((x) => [x, legendre(x, count - 1)]));
    }
    return grids.get(count);
}

// The zeros of a series in (-1, 1], bracketed on points three times as dense as its degree, then found by Newton's
// method kept inside the bracket.
function zerosOfSeries(c) {
    let rest = 0;
    for (let k = 1; k < c.length; k += 1) rest += Math.abs(c[k]);
    if (Math.abs(c[0]) > rest) return [];
    const found = [];
    let slopes = null, before = null, at = -1;
    for (const [x, p] of gridOf(c.length)) {
        let value = 0;
        for (let k = 0; k < c.length; k += 1) value += c[k] * p[k];
        if (before !== null && before * value < 0) {
            slopes ??= slopeOf(c);
            found.push(newtonBetween(c, slopes, at, x, before));
        }
        if (value !== 0) before = value;
        at = x;
    }
    return found;
}

function newtonBetween(c, slopes, a, b, valueAtA) {
    let low = a, high = b, x = (a + b) / 2;
    for (let i = 0; i < 60; i += 1) {
        const value = series(c, x);
        if (value === 0) return x;
        if (value * valueAtA > 0) low = x; else high = x;
        let next = x - value / series(slopes, x);
        if (!(next >= low && next <= high)) next = (low + high) / 2;
        if (Math.abs(next - x) < 1e-15) return next;
        x = next;
    }
    return x;
}
