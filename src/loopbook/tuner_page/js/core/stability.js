// How many zeros of d(s) + n(s) exp(-L s) lie in the right half plane: an argument count, exact for dead time.
// A port of loopbook.loop.stability, where the formula is explained.

import { abs, add, div, exp, isFiniteNumber, mul, scale, sub } from "./complex.js";
import { roots, roundedSum, value, withSlope } from "./polynomials.js";
import { LoopError, LoopTransfer } from "./transfer.js";

const BORDER = 1e-9;
const ROUNDING = 1e-12;
const NARROW = 4e-7;
const FASTEST = 200;

export class BorderError extends LoopError {
    constructor(w, hidden = false) {
        super(hidden
            ? "process and regulator cancel a factor on the imaginary axis: the loop is not internally stable"
            : "the loop is on the border of stability");
        this.w = w;
        this.hidden = hidden;
    }
}

// The gain crossovers where the magnitude passes 1: {w, phase, falls}, ascending.
export function crossings(loop) {
    const w = loop.gainCrossovers;
    if (!w.length) return [];
    const between = [w[0] / 2];
    for (let i = 1; i < w.length; i += 1) between.push(Math.sqrt(w[i - 1] * w[i]));
    between.push(2 * w.at(-1));
    const loud = between.map((x) => loop.magnitude(x) > 1);
    return w.map((x, i) => ({ w: x, phase: loop.phase(x), falls: loud[i], passes: loud[i] !== loud[i + 1] }))
        .filter((c) => c.passes);
}

const loudAtStart = (loop, passed) => (passed.length ? passed[0].falls : loop.ownUnits[0].magnitude(1) > 1);

// The number of roots with a positive real part. Infinity for a neutral loop whose gain at infinity reaches 1.
// Throws BorderError for a root on the axis, LoopError for a loop transfer with more zeros than poles.
export function unstableRoots(loop) {
    return loop.once("unstable", () => {
        if (loop.gainAtInfinity === Infinity) throw new LoopError("the loop transfer has more zeros than poles");
        if (loop.hidden) throw new BorderError(0, true);
        const [inside, time] = loop.ownUnits;
        try {
            return !inside.delay || !inside.num.some((c) => c) ? rational(inside) : counted(inside);
        } catch (error) {
            if (error instanceof BorderError) throw new BorderError(error.w / time, error.hidden);
            throw error;
        }
    });
}

export function isStable(loop) {
    try {
        return unstableRoots(loop) === 0;
    } catch (error) {
        if (error instanceof BorderError) return false;
        throw error;
    }
}

function counted(loop) {
    if (loop.gainAtInfinity >= 1) return Infinity;
    const d = loop.den.at(-1), n = loop.num.at(-1);
    if (Math.abs(d + n) <= BORDER * (Math.abs(d) + Math.abs(n))) throw new BorderError(0);
    const passed = crossings(loop);
    let turns = 0;
    for (const crossing of passed) {
        const whole = crossing.phase / (2 * Math.PI), near = Math.round(whole);
        if (Math.abs(Math.abs(whole - near) - 0.5) < BORDER) throw new BorderError(crossing.w);
        turns += crossing.falls ? near : -near;
    }
    if (loudAtStart(loop, passed)) turns -= loop.phaseAtStart / (2 * Math.PI);
    const hidden = commonOnAxis(loop);
    if (hidden !== null) throw new BorderError(hidden, true);
    return Math.round(loop.poles.filter((p) => p[0] > 0).length - 2 * turns);
}

// The roots of d + n themselves, without dead time.
function rational(loop) {
    const total = roundedSum(loop.den, loop.num);
    if (!total[0]) throw new BorderError(Infinity);
    const found = roots(total), shift = loop.den.length - loop.num.length;
    const width = loop.den.map((c, i) => Math.abs(c) + (i < shift ? 0 : Math.abs(loop.num[i - shift])));
    for (const r of found) {
        const w = Math.abs(r[1]);
        const least = abs(value(total, [0, w])) / abs(value(width, [w, 0]));
        if (Math.abs(r[0]) <= BORDER * abs(r) || least <= ROUNDING) {
            const hidden = commonOnAxis(loop);
            throw new BorderError(hidden ?? w, hidden !== null);
        }
    }
    return found.filter((r) => r[0] > 0).length;
}

// A frequency at which num and den both vanish, or null: a mode that the loop cannot touch.
function commonOnAxis(loop) {
    for (const p of loop.poles) {
        if (p[0] === 0 && loop.zeros.some((z) => abs(sub(z, p)) <= BORDER * abs(p))) return Math.abs(p[1]);
    }
    return null;
}

// The loop with s replaced by s - sigma: its roots lie sigma further to the right.
export function shifted(loop, sigma) {
    const moved = (p) => {
        const c = [...p];
        for (let last = c.length; last > 1; last -= 1) for (let i = 1; i < last; i += 1) c[i] -= sigma * c[i - 1];
        return c;
    };
    const growth = Math.exp(loop.delay * sigma);
    return new LoopTransfer(moved(loop.num).map((c) => growth * c), moved(loop.den), loop.delay);
}

// Roots of d + n exp(-Ls) to which Newton's method leads from the given starts.
function rootsFrom(loop, starts) {
    const found = [];
    for (const start of starts) {
        let s = start;
        for (let i = 0; i < 40; i += 1) {
            const [n, dn] = withSlope(loop.num, s), [d, dd] = withSlope(loop.den, s);
            if (loop.delay * s[0] < -FASTEST) break;
            const turn = exp(scale(s, -loop.delay));
            const slope = add(dd, mul(sub(dn, scale(n, loop.delay)), turn));
            const change = div(add(d, mul(n, turn)), slope);
            if (!isFiniteNumber(change)) break;
            s = sub(s, change);
            if (abs(change) <= 1e-13 * abs(s)) {
                if (!found.some((r) => abs(sub(r, s)) <= 1e-7 * abs(s))) found.push(s);
                break;
            }
        }
    }
    return found;
}

// The closed loop's rightmost poles that Newton's method finds, at most `count` with Im >= 0, rightmost first.
export function dominantPoles(loop, count = 6) {
    const [inside, time] = loop.ownUnits;
    let found;
    if (!inside.delay) {
        found = roots(roundedSum(inside.den, inside.num));
    } else {
        const fast = Math.max(1 / inside.delay, ...inside.gainCrossovers, ...inside.poles.map(abs));
        const starts = [...inside.gainCrossovers.map((w) => [0, w]), ...inside.zeros, ...inside.poles];
        for (let k = 0; k < 10; k += 1) starts.push([-0.2 * fast, k * Math.PI / inside.delay]);
        for (const x of [0.05, 0.2, 0.5, 1, 2]) starts.push([-x * fast, 0], [-x * fast, x * fast]);
        found = rootsFrom(inside, starts);
    }
    const upper = [];
    for (const r of found) {
        const pole = [r[0], Math.abs(r[1]) <= 1e-9 * abs(r) ? 0 : Math.abs(r[1])];
        if (!upper.some((p) => abs(sub(p, pole)) <= 1e-7 * abs(pole))) upper.push(pole);
    }
    return upper.sort((a, b) => b[0] - a[0]).slice(0, count).map((p) => scale(p, 1 / time));
}

// The largest sigma with all roots to the left of -sigma. Throws LoopError for a loop that is not stable.
export function decayRate(loop) {
    if (unstableRoots(loop)) throw new LoopError("the loop is unstable: nothing decays");
    const [inside, time] = loop.ownUnits;
    const holds = (sigma) => {
        if (inside.delay * sigma > FASTEST) return false;
        try {
            return unstableRoots(shifted(inside, sigma)) === 0;
        } catch (error) {
            if (error instanceof LoopError) return false;
            throw error;
        }
    };
    const { delay } = inside;
    const foundFrom = (starts) => {
        const found = delay ? rootsFrom(inside, starts()) : roots(roundedSum(inside.den, inside.num));
        const guess = Math.min(Infinity, ...found.map((r) => -r[0]));
        return guess > 0 && holds(guess * (1 - NARROW)) && !holds(guess * (1 + NARROW)) && guess * (1 - NARROW);
    };
    const { gainCrossovers, zeros, poles } = inside;
    return (foundFrom(() => [...gainCrossovers.map((w) => [0, w]), ...zeros, ...poles]) || bisected(inside, holds, foundFrom)) / time;
}

function bisected(loop, holds, foundFrom) {
    const radius = Math.max(0, ...loop.poles.map(abs), ...loop.zeros.map(abs));
    let high = Math.max(radius, loop.delay ? 1 / loop.delay : 0) || 1;
    for (let i = 0; i < 60 && holds(high); i += 1) high *= 2;
    let low = high, steps = 0;
    for (; steps < 200; steps += 1) {
        low /= 2;
        if (holds(low)) break;
    }
    if (steps === 200) throw new LoopError("the loop decays too slowly to be told from the border of stability");
    high = low < high ? 2 * low : high;
    while (high - low > 1e-6 * high) {
        const middle = (low + high) / 2;
        if (holds(middle)) low = middle; else high = middle;
        const rate = foundFrom(() => [[-middle, 0], ...shifted(loop, middle).gainCrossovers.map((w) => [-middle, w])]);
        if (rate) return rate;
    }
    return low;
}
