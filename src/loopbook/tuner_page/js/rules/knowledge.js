// What a tuning rule is told of a process: a port of loopbook.tuning.process_data and of the exact experiments.
// A process is {num, den, delay}, with `lags` where they are known better than as roots of den.

import { abs, div, mul } from "../core/complex.js";
import { derivative, roots, trimmed, value } from "../core/polynomials.js";
import { rootBetween } from "../core/search.js";
import { realised } from "../core/state.js";
import { isStable } from "../core/stability.js";
import { solve } from "../core/steps.js";
import { LoopTransfer } from "../core/transfer.js";
import { twoLagEquations } from "./formulas.js";

const REACHED = 1 - Math.exp(-1);
const REAL = 1e-3;
const EDGE = 1e-6;

export class RuleDoesNotApply extends Error {}

const last = (p) => p.at(-1);

export const integrates = (process) => last(process.den) === 0 && last(process.num) !== 0;

// The sign of the response in the long run; each real unstable pole, which grows the other way, turns it.
export const gainSign = ({ num, den }) => (
    Math.sign(last(num) / den.filter((c) => c !== 0).at(-1)) * (-1) ** roots(den).filter((p) => p[0] > 0).length
);

// The same process with the sign of its gain turned.
export const turned180 = (process) => ({ ...process, num: process.num.map((c) => -c) });

const staticGain = (process) => (integrates(process) ? Infinity : last(process.num) / last(process.den));

// {Kp, T, L, tau}: tangent and 63 % of the exact step response; a lag with dead time gives its own.
function step(process) {
    if (integrates(process)) throw new RuleDoesNotApply("the process integrates: its step response has no final level");
    const Kp = staticGain(process);
    if (process.den.length === 2 && process.num.length === 1 && process.den[0] / process.den[1] > 0) {
        const T = process.den[0] / process.den[1];
        return { Kp, T, L: process.delay, tau: process.delay / (process.delay + T) };
    }
    const found = tangent(process, Kp);
    return { ...found, tau: found.L / (found.L + found.T) };
}

function tangent(process, Kp) {
    const den = trimmed(process.den), num = trimmed(process.num), poles = roots(den);
    if (poles.some((p) => p[0] >= 0)) throw new RuleDoesNotApply("the process is unstable by itself: no step experiment ends");
    const horizon = 6 * poles.reduce((total, p) => total + 1 / Math.abs(p[0]), 0);
    const form = realised(den), { n, A, b, blocks } = form, { C, d } = form.row(num);
    // y' = C (A x + b), and y'' from it
    const slope = new Float64Array(n);
    for (let i = 0; i < n; i += 1) for (let j = 0; j < n; j += 1) slope[j] += C[i] * A[i * n + j];
    const begin = C.reduce((total, c, i) => total + c * b[i], 0);
    const outputs = [{ C, d: 0, f: [d] }, { C: slope, d: 0, f: [begin] }];
    const system = { n, A, b: new Float64Array(n), e: [b], x0: [new Float64Array(n)], outputs, delay: 0, blocks };
    const [[y, rate]] = solve(system, horizon, poles);
    const steepest = rate.extremes().reduce((best, point) => (point.value > best.value ? point : best));
    const start = steepest.t - y.at([steepest.t])[0] / steepest.value, [reached] = y.crossings(REACHED * Kp);
    const L = process.delay + (start > 1e-12 * reached ? start : 0);
    return { Kp, T: Math.max(process.delay + reached - L, 0), L };
}

function integratingStep(process) {
    const num = [0, 0, ...process.num], den = [0, ...process.den];
    if (!integrates(process) || den.at(-2) === 0) throw new RuleDoesNotApply("the process does not integrate");
    return { Kv: last(num) / den.at(-2), L: process.delay + den.at(-3) / den.at(-2) - num.at(-2) / last(num) };
}

// {lags, inverse} of a process with real poles; Infinity for an integrator.
function lagsOf(process) {
    const zeros = roots(process.num);
    const lags = process.lags ? [...process.lags, ...(integrates(process) ? [Infinity] : [])] : roots(process.den).map((p) => {
        if (abs(p) === 0) return Infinity;
        if (Math.abs(p[1]) > REAL * abs(p)) throw new RuleDoesNotApply("the half rule takes real lags");
        return -Math.sign(p[0]) / abs(p);
    });
    if (lags.some((T) => T < 0)) throw new RuleDoesNotApply("the process is unstable by itself");
    if (zeros.some((z) => z[0] < 0 || Math.abs(z[1]) > REAL * abs(z))) {
        throw new RuleDoesNotApply("the half rule takes zeros in the right half plane alone");
    }
    return { lags: lags.sort((a, b) => b - a), inverse: zeros.map((z) => 1 / z[0]) };
}

// Skogestad's half rule.
function halfRule(process, order) {
    const { lags, inverse } = lagsOf(process), many = Math.min(order, lags.length);
    const kept = lags.slice(0, many), rest = lags.slice(many), half = (rest[0] ?? 0) / 2;
    kept[many - 1] += half;
    const L = [...rest.slice(1), ...inverse].reduce((a, b) => a + b, process.delay + half);
    const T2 = kept[1] ?? 0;
    if (kept[0] === Infinity) return { Kv: integratingStep(process).Kv, T2, L };
    return { Kp: staticGain(process), T: kept[0], T2, L };
}

// The process with the sign that makes its gain positive, as {transfer, start}: its phase is that of the transfer plus
// start; a real pole in the right half plane begins at -180 degrees.
function uprightTransfer({ num, den, delay }) {
    const transfer = new LoopTransfer(num, den, delay);
    const begins = -Math.PI * transfer.poles.filter((p) => p[0] > 0 && p[1] === 0).length;
    const odd = Math.round((transfer.phaseAtStart - begins) / Math.PI) % 2;
    const found = odd ? new LoopTransfer(num.map((c) => -c), den, delay) : transfer;
    return { transfer: found, start: begins - found.phaseAtStart };
}

// The phase of a process without jumps, as a function.
export function phaseOf(process) {
    const { transfer, start } = uprightTransfer(process);
    return (w) => transfer.phase(w) + start;
}

// The lowest frequency at which the phase passes `angle`.
export function frequencyAt(process, angle) {
    const { transfer, start } = uprightTransfer(process), found = firstPassing(transfer, () => [angle - start]);
    if (found === null) throw new RuleDoesNotApply(`the phase does not pass ${Math.round(angle * 180 / Math.PI)} degrees`);
    return found;
}

// The lowest w at which the phase crosses one of the levels between its values at two ends; null where it does not.
function firstPassing(transfer, levels) {
    const [inside, time] = transfer.ownUnits, ends = [inside.beginning, ...inside.monotonePhase, whereItEnds(inside)];
    for (let i = 1; i < ends.length; i += 1) {
        const low = ends[i - 1] * (1 + 1e-13), high = ends[i] * (1 - 1e-13), before = inside.phase(low), after = inside.phase(high);
        for (const level of levels(before, after).sort((x, y) => Math.abs(x - before) - Math.abs(y - before))) {
            if ((before - level) * (after - level) < 0) {
                const w = Math.exp(rootBetween((x) => inside.phase(Math.exp(x)) - level, Math.log(low), Math.log(high), 1e-15));
                return inside.polished(w, level) / time;
            }
        }
    }
    return null;
}

// A frequency beyond which the phase turns no more; with dead time, beyond which it has turned once more.
function whereItEnds(inside) {
    const corners = [...inside.zeros, ...inside.poles].map(abs);
    if (!inside.delay) return 1e9 * Math.max(0, ...corners) || 1e9;
    let w = Math.max(...corners, ...inside.monotonePhase, 1 / inside.delay);
    const last = Math.min(inside.phase(w), -Math.PI);
    while (inside.phase(w) > last - 2 * Math.PI) w *= 2;
    return w;
}

// The lowest and the highest odd multiple of pi between two phases.
function oddTurns(before, after) {
    const low = Math.min(before, after), high = Math.max(before, after);
    const [first, last] = [Math.ceil((low / Math.PI - 1) / 2), Math.floor((high / Math.PI - 1) / 2)];
    return first <= last ? [first, last].map((i) => (2 * i + 1) * Math.PI) : [];
}

// Where a proportional loop just keeps oscillating: a port of loopbook.loop.ultimate_point.
function frequency(process) {
    const { transfer } = uprightTransfer(process), point = (gain, w) => ({ K180: 1 / gain, T180: 2 * Math.PI / w, Ku: gain });
    if (!transfer.zeros.length && transfer.poles.every((p) => p[1] === 0 && p[0] <= 0)) {
        const w = frequencyAt(process, -Math.PI);
        return point(1 / transfer.magnitude(w), w);
    }
    const first = firstPassing(transfer, oddTurns);
    if (first === null) throw new RuleDoesNotApply("the phase does not pass -180 degrees");
    let begins = null;
    for (const turns of transfer.delay ? [1 + 1e-9, 30, 1e3] : [1e12]) {
        const found = borders(transfer, transfer.magnitude(first) / turns), between = found.map(([gain], i) => (i ? Math.sqrt(found[i - 1][0] * gain) : gain / 2));
        if (found.length) between.push(2 * found.at(-1)[0]);
        let held = false;
        for (let i = 0; i < between.length; i += 1) {
            const holds = isStable(new LoopTransfer(transfer.num.map((c) => between[i] * c), transfer.den, transfer.delay));
            const [gain, w] = found[i - 1] ?? [0, 0];
            if (w && held && !holds) return point(gain, w);
            if (w && holds && !held && begins === null) begins = point(gain, w);
            held = holds;
        }
    }
    if (begins !== null) return begins;
    throw new RuleDoesNotApply("no proportional gain holds the process, or only the lowest bounds it");
}

// [gain, w] at which the proportional loop has a root on the axis, ascending in the gain; w = 0: no oscillation.
function borders(transfer, least) {
    const atInfinity = transfer.gainAtInfinity, floor = transfer.delay ? Math.max(least, atInfinity * (1 + 1e-13)) : least;
    const found = transfer.phaseCrossovers(floor).map((w) => [1 / transfer.magnitude(w), w]), [n, d] = [last(transfer.num), last(transfer.den)];
    if (n && d && n / d < 0) found.push([-d / n, 0]);
    if (atInfinity && (transfer.delay || transfer.num[0] / transfer.den[0] < 0)) found.push([1 / atInfinity, 0]);
    return found.sort((p, q) => p[0] - q[0]);
}

export const magnitudeOf = (process, w) => abs(div(value(process.num, [0, w]), value(process.den, [0, w])));

function frequencyAndGain(process) {
    const found = frequency(process), gain = staticGain(process);
    if (!(gain > 0)) throw new RuleDoesNotApply("the static gain has not the sign of the response in the long run");
    return { ...found, kappa: gain === Infinity ? 0 : found.K180 / gain };
}

function twoLags(process) {
    if (integrates(process)) throw new RuleDoesNotApply("the process integrates: two lags do not describe it");
    const stepped = step(process), { tau } = stepped;
    if (process.num.length === 1 && process.den.length <= 3) {
        let own = null;
        try {
            own = lagsOf(process).lags;
        } catch (error) {
            if (!(error instanceof RuleDoesNotApply)) throw error;
        }
        if (own) return { Kp: stepped.Kp, T1: own[0], T2: own[1] ?? 0, L1: process.delay, tau };
    }
    return { ...combined(stepped, frequency(process)), tau };
}

// Two lags and a dead time with this step and frequency data; loopbook.experiments.combination.
function combined({ Kp, T, L }, { K180, T180, Ku }) {
    const w = 2 * Math.PI / T180, T63 = T + L, { firstLag, deadTime, lacks, lacksEqual } = twoLagEquations;
    if (K180 / Kp >= 1) throw new RuleDoesNotApply("kappa = K180/Kp >= 1: no lag lowers the gain at -180 degrees");
    const alphas = [];
    for (let i = 0; i < 59; i += 1) alphas.push(1e-9 * 1e7 ** (i / 59));
    for (let i = 0; i < 199; i += 1) alphas.push(0.01 + 0.99 * i / 198);
    const lags = (alpha) => {
        const T1 = firstLag(alpha, w, Kp, Ku);
        return { T1, T2: alpha * T1, L1: deadTime(w, T1, alpha * T1) };
    };
    const residual = (alpha) => {
        const { T1, T2, L1 } = lags(alpha);
        if (T63 <= L1) return Math.exp(-1) - 1;
        return Math.abs(alpha - 1) < 1e-9 ? lacksEqual(T1, T1, L1, T63) : lacks(T1, T2, L1, T63);
    };
    const points = alphas.map((alpha) => ({ alpha, left: residual(alpha), possible: lags(alpha).L1 >= 0 }));
    const found = [];
    for (let i = 1; i < points.length; i += 1) {
        const [p, q] = [points[i - 1], points[i]];
        if (p.possible && q.possible && (p.left < 0) !== (q.left < 0)) found.push(lags(rootBetween(residual, p.alpha, q.alpha)));
    }
    if (found.length) {
        const away = (model) => Math.abs(ownTangent(model) - L);
        return { Kp, ...found.reduce((a, b) => (away(b) < away(a) ? b : a)) };
    }
    const open = points.filter((p) => p.possible);
    const near = open.length ? open.reduce((a, b) => (Math.abs(b.left) < Math.abs(a.left) ? b : a)) : null;
    if (!near || Math.abs(near.left) > EDGE) throw new RuleDoesNotApply("two lags and a dead time do not describe the process");
    return { Kp, ...lags(near.alpha) };
}

function ownTangent({ T1, T2, L1 }) {
    if (T2 < 1e-9 * T1) return L1;
    const ratio = T1 / T2, t = Math.abs(ratio - 1) < 1e-6 ? T1 : Math.log(ratio) * T1 / (ratio - 1);
    const slope = Math.exp(-t / T1) / T1;
    return L1 + t - (1 - (T1 + T2) * slope) / slope;
}

function pulse(process) {
    if (!integrates(process)) throw new RuleDoesNotApply("the process does not integrate");
    const { lags } = lagsOf(process);
    if (lags.length <= 2 && process.num.length === 1) {
        return { Kv: integratingStep(process).Kv, T2: lags[1] ?? 0, L1: process.delay };
    }
    const { Kp, T, L } = step({ num: process.num, den: process.den.slice(0, -1), delay: process.delay });
    return { Kv: Kp, T2: T, L1: L };
}

const means = {
    step, integratingStep, frequency, frequencyAndGain, twoLags, pulse,
    oneLag: (process) => halfRule(process, 1),
    twoLagsOfModel: (process) => halfRule(process, 2),
};

// The quantities that a rule of this kind takes, of a process with a positive gain. Throws RuleDoesNotApply.
export const quantities = (takes, process) => means[takes](process);

// [G(jw), dG/dw], G(jw) with its dead time.
export function responseAt(process, w) {
    const s = [0, w], n = value(process.num, s), d = value(process.den, s), turn = [Math.cos(process.delay * w), -Math.sin(process.delay * w)];
    const g = mul(div(n, d), turn);
    const dn = div(value(derivative(process.num), s), n), dd = div(value(derivative(process.den), s), d);
    const rate = [dn[0] - dd[0] - process.delay, dn[1] - dd[1]];
    return [g, mul([-g[1], g[0]], rate)];
}
