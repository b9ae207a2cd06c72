// From the state to everything that is drawn and said: one evaluation.

import { abs } from "../core/complex.js";
import { CircleTransfer, sampledMargins, zerosOf } from "../core/circle.js";
import { margins } from "../core/margins.js";
import { absoluteError, inputMeasures, stepMeasures } from "../core/measures.js";
import { place } from "../core/placement.js";
import { convolve, fromRoots } from "../core/polynomials.js";
import { finalValues, loopTransfer, stepResponses } from "../core/response.js";
import { pidPolynomials, rstController, simulate } from "../core/run.js";
import { pulseTransfer, sample } from "../core/sampled.js";
import { decayRate, dominantPoles, isStable, unstableRoots } from "../core/stability.js";
import { emittedLaw } from "../generated/law.js";
import { programSettings } from "./pythonic.js";
import { pidOf, processOf } from "./state.js";

const POINTS = 420;
const SETTLED_BY = 25;
const NICE = [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10];
const MOST_SAMPLES = 6000;
const QUIET_BAND = 0.02;

// The next round number of seconds.
export function nice(time) {
    const power = 10 ** Math.floor(Math.log10(time));
    return power * NICE.find((x) => x * power >= time * (1 - 1e-9));
}

// A time in which the process itself moves.
export function processTime(process) {
    const lags = process.den.length > 1 ? process.den.map(Math.abs) : [1, 1];
    const sumOfLags = lags.at(-1) ? lags.at(-2) / lags.at(-1) : (lags.length > 2 ? lags.at(-3) / lags.at(-2) : 0);
    return sumOfLags + process.delay || 1;
}

const failed = (error) => ({ error: error.message });

// {process, pid, loop, stable, count, margins, poles, run, numbers, sampledAt, error}. change: of the process, which the
// regulator does not know. before: the setting that runs until half-time, where this one is to follow one. placed: the
// regulator, where poles have been placed already.
export function evaluate(s, given, change = {}, { before, placed } = {}) {
    const process = processOf(s, given, change), pid = pidOf(s), follows = s.jump && before?.kind === "pid" ? before : null;
    const limited = s.low !== null || s.high !== null || s.wave !== 0 || follows !== null;
    const found = { process, pid, loop: loopTransfer(process, pid), time: processTime(process), limited, before: follows, placed };
    try {
        if (s.kind === "rst" || s.h > 0) sampledLoop(s, found);
        else continuousLoop(s, found);
    } catch (error) {
        Object.assign(found, { stable: false, count: null }, failed(error));
    }
    return found;
}

function continuousLoop(s, found) {
    const { loop, process, pid } = found;
    found.stable = isStable(loop);
    found.count = found.stable ? 0 : countOf(loop);
    found.margins = found.stable ? margins(loop) : null;
    found.poles = dominantPoles(loop);
    found.at = (w) => loop.onAxis(w);
    found.noise = pid.D && !pid.Tf ? Infinity : Math.abs(pid.P) * (pid.D ? 1 + s.N : 1);
    found.rate = found.stable ? decayRate(loop) : 0;
    found.signals = signalsOf(process, pid, found);
    found.span = spanOf(found);
    const { limited } = found;
    if (limited) {
        const wave = s.wave ? [1 / (20 * s.freq)] : [];
        const h = Math.min(found.span / 1200, ...wave, ...(pid.Tf ? [pid.Tf / 2] : []), ...(process.delay ? [process.delay / 4] : []));
        runProgram(s, found, Math.max(h, found.span / MOST_SAMPLES));
    } else {
        found.run = linearRun(s, found);
    }
    found.numbers = found.stable ? measuresOf(s, found) : null;
}

function countOf(loop) {
    try {
        return unstableRoots(loop);
    } catch {
        return null;
    }
}

// Responses up to where they have settled; of an unstable loop some of the process's own times.
function signalsOf(process, pid, { stable, rate, time }) {
    const settled = SETTLED_BY / rate + 3 * process.delay, most = 80 * time + 60 * process.delay;
    const horizon = stable ? Math.min(settled, most) : 5 * time;
    try {
        return { ...stepResponses(process, pid, horizon), horizon };
    } catch (error) {
        if (stable) throw error;
        return { ...stepResponses(process, pid, horizon / 4), horizon: horizon / 4 };
    }
}

// How much time is shown: twice what the slower of both responses takes to settle.
function spanOf({ signals, stable, process, pid }) {
    if (!stable) return signals.horizon;
    const final = finalValues(process, pid), reference = stepMeasures(signals.reference.y, final.reference.y);
    const y = signals.load.y, peak = y.extremes().reduce((m, { value }) => Math.max(m, Math.abs(value - final.load.y)), 0);
    const band = QUIET_BAND * 2.5 * peak || 1;
    const back = Math.max(0, ...y.crossings(final.load.y + band), ...y.crossings(final.load.y - band));
    const slowest = Math.max(reference ? reference.settling : signals.horizon / 3, back, 3 * process.delay);
    return Math.min(nice(2.2 * slowest), 2 * signals.horizon);
}

// The set-point steps at once, the load half-way.
function linearRun(s, { signals, span }) {
    const half = span / 2, t = [], until = signals.horizon;
    for (let i = 0; i <= POINTS; i += 1) t.push(span * i / POINTS);
    t.push(half * (1 - 1e-9));
    t.sort((a, b) => a - b);
    const course = (first, second) => {
        const early = first.at(t.map((x) => Math.min(x, until))), late = second.at(t.map((x) => Math.max(Math.min(x - half, until), -1)));
        return t.map((_, i) => s.r * early[i] + s.d * late[i]);
    };
    return { t, y: course(signals.reference.y, signals.load.y), u: course(signals.reference.u, signals.load.u), stairs: false };
}

function measuresOf(s, { signals, process, pid, run }) {
    const final = finalValues(process, pid), step = stepMeasures(signals.reference.y, final.reference.y);
    const { peak, variation } = inputMeasures(signals.reference.u);
    const numbers = {
        overshoot: step ? step.overshoot : null, settling: step ? step.settling : null, rise: step ? step.rise : null,
        iae: absoluteError(signals.load.y, 0, final.load.y), peak: peak * Math.abs(s.r), variation: variation * Math.abs(s.r),
    };
    return run.stairs ? { ...numbers, ...measured(s, run) } : numbers;
}

// What a run through the program gave: from its samples.
function measured(s, { t, y, u, span }) {
    const half = span / 2, target = s.r;
    let top = -Infinity, settling = 0, iae = 0, variation = 0;
    t.forEach((x, i) => {
        if (x < half) {
            top = Math.max(top, (y[i] - target) / target);
            if (Math.abs(y[i] - target) > QUIET_BAND * Math.abs(target)) settling = x;
        } else if (i) {
            iae += (Math.abs(y[i] - target) + Math.abs(y[i - 1] - target)) / 2 * (x - t[i - 1]);
        }
    });
    u.forEach((value, i) => { if (i * span / u.length < half) variation += Math.abs(value - (i ? u[i - 1] : 0)); });
    const settled = settling < half * 0.98;
    return { overshoot: settled ? Math.max(0, 100 * top) : null, settling: settled ? settling : null, iae: s.d ? iae / Math.abs(s.d) : NaN, variation };
}

// The program of the regulator: a controller with step(r, y), from rest at zero.
function programOf(s, h, placed) {
    if (placed) return rstController(placed, s.low ?? -Infinity, s.high ?? Infinity);
    const law = emittedLaw(programSettings(s, h));
    law.start(0, 0, 0, 0);
    law.state.arriving = false;
    return { step: (r, y) => law.step(r, y, 0), state: law.state, law };
}

// The program of one setting that gets those of another at a sample: as the law changes them, or with its states kept.
export function changingProgram(first, then, h, at) {
    const { law, state } = programOf(first, h);
    return {
        step(r, y, k) {
            if (k === at) {
                const { I, x } = state;
                law.change(programSettings(then, h));
                if (!then.smooth) Object.assign(state, { I, x });
            }
            return law.step(r, y, 0);
        },
    };
}

function runProgram(s, found, h, placed = null) {
    const sampled = sample(found.process, h), steps = Math.max(2, Math.min(MOST_SAMPLES, Math.round(found.span / h)));
    const half = Math.round(steps / 2) * h, points = Math.max(1, Math.round(POINTS / steps));
    const noise = (t) => (s.wave ? s.wave * Math.sin(2 * Math.PI * s.freq * t) : 0), { before } = found;
    const courses = { reference: () => s.r, load: (t) => (t >= half - h / 1e6 ? s.d : 0), noise, points };
    const program = before ? changingProgram({ ...before, low: s.low, high: s.high }, s, h, Math.round(steps / 2)) : programOf(s, h, placed);
    const run = simulate(sampled, program, steps, courses);
    found.run = { ...run, stairs: true, span: steps * h, h };
    found.span = steps * h;
}

// A loop that is sampled: its transfer function on the unit circle, its program on the exact process.
function sampledLoop(s, found) {
    const h = s.h || found.time / 20, sampled = sample(found.process, h), { B, A, modes } = pulseTransfer(sampled);
    const placed = s.kind === "rst" ? found.placed ?? placement(s, h, B, A, found) : null;
    const { R, S } = placed ?? pidPolynomials(programOf(s, h).state), circle = circleOf(R, S, B, A, modes);
    const count = circle.unstableRoots;
    Object.assign(found, {
        placed, circle, h, stable: count === 0, count: count < 0 ? null : count,
        at: (w) => circle.at(w * h), last: Math.PI / h, noise: Math.abs(S[0]),
    });
    found.margins = found.stable ? { ...sampledMargins(circle, h), delay: undefined } : null;
    found.poles = found.wanted ?? closedPoles(convolve(A, R), convolve(B, S), h);
    const slow = found.poles.filter((p) => p[0] < 0).map((p) => 1 / -p[0]);
    const settle = slow.length && found.stable ? 3 * Math.max(...slow) + 2 * slow.slice(0, 3).reduce((a, b) => a + b) : 4 * found.time;
    found.span = nice(2.2 * (settle + 2 * found.process.delay));
    runProgram(s, found, h, placed);
    found.numbers = found.stable ? { peak: Math.max(...found.run.u.map(Math.abs)), rise: null, ...measured(s, found.run) } : null;
}

// The loop transfer S B/(R A) on the unit circle; modes: the roots of A.
function circleOf(R, S, B, A, modes) {
    const most = Math.max(...B.map(Math.abs)), clean = B.map((c) => (Math.abs(c) < 1e-14 * most ? 0 : c));
    return new CircleTransfer(convolve(S, clean), convolve(R, A), [...zerosOf(S), ...zerosOf(clean)], [...zerosOf(R), ...modes]);
}

// The closed loop's slow poles in s, log(z)/h; of short polynomials alone.
function closedPoles(p, q, h) {
    const n = Math.max(p.length, q.length);
    if (n > 40) return [];
    const total = Array.from({ length: n }, (_, i) => (p[i] ?? 0) + (q[i] ?? 0));
    return zerosOf(total).filter((z) => abs(z) > 1e-3).map((z) => [Math.log(abs(z)) / h, Math.abs(Math.atan2(z[1], z[0])) / h])
        .filter((p, i, all) => all.findIndex((q) => Math.hypot(q[0] - p[0], q[1] - p[1]) < 1e-9 * (1 + Math.hypot(...p))) === i)
        .sort((a, b) => b[0] - a[0]).slice(0, 6);
}

// R, S, T with the poles wanted: a pair of this speed and damping, the others at `rest`, the observer at `observer`.
function placement(s, h, B, A, found) {
    const count = A.length, wanted = [], z = [];
    const pair = s.damping < 1
        ? [[-s.damping * s.speed, s.speed * Math.sqrt(1 - s.damping ** 2)]]
        : [-1, 1].map((sign) => [-s.speed * (s.damping + sign * Math.sqrt(s.damping ** 2 - 1)), 0]);
    if (count > 1) for (const p of pair) wanted.push(p); else wanted.push([-s.speed, 0]);
    const seen = () => wanted.reduce((n, p) => n + (p[1] ? 2 : 1), 0);
    while (seen() < count) wanted.push([-s.rest, 0]);
    const image = ([re, im]) => [Math.exp(re * h) * Math.cos(im * h), Math.exp(re * h) * Math.sin(im * h)];
    for (const p of wanted) {
        z.push(image(p));
        if (p[1]) z.push([image(p)[0], -image(p)[1]]);
    }
    found.wanted = wanted;
    const observer = s.observer > 0 ? [1, -Math.exp(-s.observer * h)] : [1];
    return place(B, A, fromRoots(z), observer, 1);
}

// The smallest dead time that, added to the process, makes a stable sampled loop unstable: by halving, from what the
// phase says. It takes its time.
export function delayMargin(s, found) {
    const { R, S } = found.placed ?? pidPolynomials(programOf(s, found.h).state);
    const guesses = found.margins.gainCrossovers.map(({ w, phase }) => ((phase + 360) % 360) * Math.PI / 180 / w);
    if (!guesses.length) return Infinity;
    const holds = (more) => {
        const { process } = found, { B, A, modes } = pulseTransfer(sample({ ...process, delay: process.delay + more }, found.h));
        return circleOf(R, S, B, A, modes).unstableRoots === 0;
    };
    let low = 0, high = Math.min(...guesses) * 1.3;
    if (holds(high)) return high / 1.3;
    for (let i = 0; i < 12; i += 1) {
        const middle = (low + high) / 2;
        if (holds(middle)) low = middle; else high = middle;
    }
    return (low + high) / 2;
}

// The same setting on models at the ends of what is uncertain: gain, lags and dead time, in per cent.
export function variants(s) {
    const [K, T, L] = [s.uK, s.uT, s.uL].map((p) => p / 100), list = [];
    const add = (k, t, l) => list.push({ K: s.K * (1 + k * K), stretch: 1 + t * T, L: s.L * (1 + l * L) });
    if (L || K || T) add(1, -1, 1);
    if (L || K || T) add(-1, 1, -1);
    if ((K || T) && L) {
        add(-1, -1, 1);
        add(1, 1, -1);
    }
    return list;
}
