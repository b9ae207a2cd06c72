// Linear differential equations with one delayed feedback, solved by the method of steps: a port of
// loopbook.numerics.method_of_steps and long_cells.
//
// Between two multiples of the dead time the delayed signal is known, so each segment is an ordinary linear equation,
// solved in a few cells, which are the same in every segment. Where the corners of the start have worn off and the
// horizon holds many dead times more, cells longer than one go on: their delayed signal is partly their own.

import { cellOperator, gradedMesh, MOST_CELLS, ResponseError } from "./cells.js";
import { COUNT, DEGREE, legendre, radau, series } from "./legendre.js";
import { solveInPlace } from "./linear.js";
import { coefficientsOf, Signal } from "./signals.js";

const RESOLVED = 1e-12;
const ROUNDED = 1e-8;
const MANY = 40;
const WORN_OFF = 24;
const NOTHING = 1e-17;

// After how many dead times the corners have worn off; Infinity where they never do.
function smoothFrom(system) {
    const again = Math.abs(system.outputs[0].d);
    if (again >= 1) return Infinity;
    return WORN_OFF + (again ? Math.ceil(Math.log(NOTHING) / Math.log(again)) : 0);
}

function apply(operator, s, input, out) {
    const { map, width, rows, constants } = operator, constant = constants[s];
    for (let r = 0; r < rows; r += 1) {
        let total = constant[r];
        const at = r * width;
        for (let j = 0; j < width; j += 1) total += map[at + j] * input[j];
        out[r] = total;
    }
}

// The outputs after each source on [0, horizon]: a row of signals for each source. modes: of A, which tell the cells.
export function solve(system, horizon, modes) {
    if (!(horizon > 0 && Number.isFinite(horizon))) throw new ResponseError("a positive horizon is expected");
    const segments = system.delay ? Math.max(1, Math.ceil(horizon / system.delay * (1 - 1e-12))) : 1;
    const short = segments > MANY ? Math.min(segments, smoothFrom(system)) : segments;
    const begun = shortCells(system, system.delay || horizon, short, modes);
    if (short < segments) continueLong(system, begun, horizon - short * system.delay);
    return begun.runs.map(({ rows }) => rows.map((cells) => new Signal(begun.edges, cells).until(horizon)));
}

// Each dead time in the same cells, halved until the last coefficients are rounding.
function shortCells(system, length, segments, modes) {
    let mesh = gradedMesh(modes, length), best = Infinity, stalled = 0;
    for (let round = 0; round < 30; round += 1) {
        if (segments * (mesh.length - 1) > MOST_CELLS) throw new ResponseError("the horizon holds too many dead times");
        const marched = march(system, mesh, segments, length);
        const worst = Math.max(...marched.tails);
        stalled = worst > best / 4 ? stalled + 1 : 0;
        best = Math.min(best, worst);
        if (!Number.isFinite(worst)) throw new ResponseError("the response grows beyond all numbers");
        if (worst <= RESOLVED || (stalled === 2 && best < ROUNDED)) return marched;
        if (stalled === 5) throw new ResponseError("rounding limits the response");
        const halves = [];
        marched.tails.forEach((tail, i) => { if (tail > RESOLVED) halves.push((mesh[i] + mesh[i + 1]) / 2); });
        mesh = [...mesh, ...halves].sort((a, b) => a - b);
    }
    throw new ResponseError("the response could not be resolved");
}

function march(system, mesh, segments, length) {
    const { n } = system, cells = mesh.length - 1, kept = new Map();
    const operators = [];
    for (let i = 0; i < cells; i += 1) {
        const key = Number((mesh[i + 1] - mesh[i]).toPrecision(13));
        if (!kept.has(key)) kept.set(key, cellOperator(system, key));
        operators.push(kept.get(key));
    }
    const many = system.outputs.length, input = new Float64Array(n + COUNT), out = new Float64Array(many * COUNT + n);
    const edges = new Float64Array(segments * cells + 1), tails = new Array(cells).fill(0);
    for (let k = 0; k < segments; k += 1) for (let i = 0; i < cells; i += 1) edges[k * cells + i] = k * length + mesh[i];
    edges[segments * cells] = segments * length;
    const runs = system.e.map((_, s) => {
        const fed = [], rows = system.outputs.map(() => []), largest = new Array(many).fill(0);
        const ends = operators.map(() => new Array(many).fill(0));
        let x = Float64Array.from(system.x0[s]);
        for (let k = 0; k < segments; k += 1) {
            for (let i = 0; i < cells; i += 1) {
                input.set(x);
                if (k) input.set(fed[(k - 1) * cells + i], n); else input.fill(0, n);
                apply(operators[i], s, input, out);
                if (segments > 1) fed.push(out.slice(0, COUNT));
                x = out.slice(many * COUNT);
                for (let o = 0; o < many; o += 1) {
                    const c = coefficientsOf(out, o * COUNT), end = lastOf(c);
                    rows[o].push(c);
                    largest[o] = Math.max(largest[o], largestIn(out, o));
                    if (!(end <= ends[i][o])) ends[i][o] = end;
                }
            }
        }
        ends.forEach((row, i) => row.forEach((end, o) => { tails[i] = Math.max(tails[i], share(end, largest[o])); }));
        return { rows, x, largest };
    });
    return { edges, runs, tails };
}

const lastOf = (c) => Math.max(Math.abs(c[DEGREE]), Math.abs(c[DEGREE - 1]));

const share = (part, whole) => (Number.isFinite(part) && Number.isFinite(whole) ? part / (whole || 1) : Infinity);

function largestIn(out, o) {
    let found = 0;
    for (let q = o * COUNT; q < (o + 1) * COUNT; q += 1) found = Math.max(found, Math.abs(out[q]));
    return found;
}

// More cells after those of `begun`, over `span`, as long as they resolve the response.
function continueLong(system, begun, span) {
    const kept = new Map(), lengths = [];
    for (let i = 1; i < begun.edges.length; i += 1) lengths.push(begun.edges[i] - begun.edges[i - 1]);
    const cell = (length) => {
        if (!kept.has(length)) kept.set(length, longCell(system, length));
        return kept.get(length);
    };
    let length = 2 * system.delay, done = 0;
    while (done < span) {
        if (lengths.length > MOST_CELLS) throw new ResponseError("too many periods of the fastest mode");
        const accepted = longest(cell, system, begun.runs, lengths, length);
        length = accepted.length;
        begun.runs.forEach((run, s) => {
            run.rows.forEach((cells, o) => {
                cells.push(coefficientsOf(accepted.out[s], o * COUNT));
                run.largest[o] = Math.max(run.largest[o], largestIn(accepted.out[s], o));
            });
            run.x = accepted.out[s].slice(run.rows.length * COUNT);
        });
        lengths.push(length);
        done += length;
        length *= 2;
    }
    const edges = new Float64Array(lengths.length + 1);
    edges.set(begun.edges);
    for (let i = begun.edges.length - 1; i < lengths.length; i += 1) edges[i + 1] = edges[i] + lengths[i];
    begun.edges = edges;
}

// The longest of `start`, start/2, ... whose last coefficients are rounding: {out, length}.
function longest(cell, system, runs, lengths, start) {
    let length = start, before = null;
    for (;;) {
        const operator = cell(length);
        let tail = 0;
        const out = runs.map((run, s) => {
            const input = new Float64Array(operator.width);
            input.set(run.x);
            input.set(fedBack(run.rows[0], lengths, operator.past), system.n);
            const found = new Float64Array(operator.rows);
            apply(operator, s, input, found);
            run.largest.forEach((size, o) => {
                tail = Math.max(tail, share(lastOf(coefficientsOf(found, o * COUNT)), size));
            });
            return found;
        });
        if (tail <= RESOLVED) return { out, length };
        if (before && before.tail < ROUNDED && tail > before.tail / 4) return before;
        if (length < system.delay / 64) {
            throw new ResponseError(Number.isFinite(tail) ? "rounding limits the response" : "the response grows beyond all numbers");
        }
        before = { tail, out, length };
        length /= 2;
    }
}

// A cell that may be longer than the dead time: (x at the start, v at the start and at points that lie in the past) ->
// as `cellOperator`. past: those points as times from the cell's start, all <= 0.
function longCell(system, length) {
    const { n } = system, plain = cellOperator(system, length), { rows, width } = plain;
    const after = radau.nodes.map((x) => (x + 1) / 2 * length - system.delay);
    const past = [], own = [];
    after.forEach((t, q) => (t < 0 ? past : own).push(q));
    const m = own.length, given = n + 1 + past.length, sources = system.e.length;
    const column = (j) => (j < n + 1 ? j : n + 1 + past[j - n - 1]);
    // v at its own points is the cell's own w there: reading, a matrix from w at the start and the points
    const reading = own.map((q) => {
        const p = legendre(2 * after[q] / length - 1), row = new Float64Array(COUNT);
        for (let j = 0; j < COUNT; j += 1) for (let k = 0; k < COUNT; k += 1) row[j] += p[k] * radau.toCoefficients[k * COUNT + j];
        return row;
    });
    const M = new Float64Array(m * m), columns = given + sources, inner = new Float64Array(m * columns);
    reading.forEach((row, i) => {
        for (let q = 0; q < COUNT; q += 1) {
            for (let j = 0; j < m; j += 1) M[i * m + j] -= row[q] * plain.map[q * width + n + 1 + own[j]];
            for (let j = 0; j < given; j += 1) inner[i * columns + j] += row[q] * plain.map[q * width + column(j)];
            for (let s = 0; s < sources; s += 1) inner[i * columns + given + s] += row[q] * plain.constants[s][q];
        }
        M[i * m + i] += 1;
    });
    solveInPlace(M, m, inner, columns);
    const map = new Float64Array(rows * given), constants = plain.constants.map((c) => c.slice());
    for (let r = 0; r < rows; r += 1) {
        for (let j = 0; j < given; j += 1) map[r * given + j] = plain.map[r * width + column(j)];
        for (let i = 0; i < m; i += 1) {
            const factor = plain.map[r * width + n + 1 + own[i]];
            if (factor === 0) continue;
            for (let j = 0; j < given; j += 1) map[r * given + j] += factor * inner[i * columns + j];
            for (let s = 0; s < sources; s += 1) constants[s][r] += factor * inner[i * columns + given + s];
        }
    }
    return { map, constants, rows, width: given, past: [-system.delay, ...past.map((q) => after[q])] };
}

// w at `times` <= 0, counted from the end of the cells known so far.
function fedBack(rows, lengths, times) {
    return times.map((t) => {
        let i = lengths.length - 1, start = -lengths[i];
        while (start > t && i > 0) {
            i -= 1;
            start -= lengths[i];
        }
        return series(rows[i], 2 * (t - start) / lengths[i] - 1);
    });
}
