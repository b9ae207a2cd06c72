// The transfer function around a sampled loop on the unit circle z = exp(j a), 0 <= a <= pi: a port of
// loopbook.loop.unit_circle and of the margins of loopbook.loop.sampled.
//
//     G = k z^-d prod(1 - z_i z^-1)/prod(1 - p_i z^-1)

import { abs, arg, div, exp, mul, scale, sub } from "./complex.js";
import { closest, peakOf } from "./peaks.js";
import { roots } from "./polynomials.js";
import { rootBetween } from "./search.js";
import { LoopError } from "./transfer.js";

const ON_CIRCLE = 1e-9;
const AT_ONE = 1e-7;
const FINEST = 1e-7;
const ROUNDING_AT_ONE = 4e-16;
const UNDECIDED = 1e-9;

// The z where p0 + p1 z^-1 + ... = 0, without the z at infinity of leading zeros.
export function zerosOf(p) {
    const first = p.findIndex((c) => c !== 0);
    return first < 0 ? [] : roots(p.slice(first));
}

export class CircleTransfer {
    // num, den: ascending in z^-1; zeros, poles: their roots in z.
    constructor(num, den, zeros, poles) {
        const first = Math.max(0, num.findIndex((c) => c !== 0)), lead = den.findIndex((c) => c !== 0);
        this.num = num;
        this.den = den;
        this.k = num[first] / den[lead];
        this.d = first - lead;
        [this.zeros, this.poles] = [zeros, poles].map((list) => list.map((r) => (abs(sub(r, [1, 0])) < AT_ONE ? [1, 0] : r)));
    }

    inverse() {
        return new CircleTransfer(this.den, this.num, this.poles, this.zeros);
    }

    at(a) {
        const c = Math.cos(a), d = Math.sin(a);
        let re = this.k * Math.cos(this.d * a), im = -this.k * Math.sin(this.d * a);
        for (const [x, y] of this.zeros) {
            const m = 1 - x * c - y * d, n = x * d - y * c, next = re * m - im * n;
            im = re * n + im * m;
            re = next;
        }
        for (const [x, y] of this.poles) {
            const m = 1 - x * c - y * d, n = x * d - y * c, size = m * m + n * n, next = (re * m + im * n) / size;
            im = (im * m - re * n) / size;
            re = next;
        }
        return [re, im];
    }

    magnitude(a) {
        return abs(this.at(a));
    }

    // d/da log G.
    logSlope(a) {
        const c = Math.cos(a), d = Math.sin(a);
        let re = 0, im = -this.d;
        const felt = (roots, sign) => {
            for (const [x, y] of roots) {
                const m = x * c + y * d, n = y * c - x * d, size = sign / ((1 - m) ** 2 + n * n);
                re -= n * size;
                im += (m - m * m - n * n) * size;
            }
        };
        felt(this.zeros, 1);
        felt(this.poles, -1);
        return [re, im];
    }

    distance(a) {
        const W = this.at(a), size = Math.hypot(1 + W[0], W[1]);
        return Number.isFinite(size) ? size : Infinity;
    }

    slope(a) {
        const W = this.at(a);
        return mul(mul([1 + W[0], -W[1]], W), this.logSlope(a))[0];
    }

    // The argument, continuous from the real axis just outside z = 1; a root on the circle counts as inside.
    phase(a) {
        let total = this.startPhase - this.d * a;
        for (const r of this.zeros) total += turnedOnCircle(r, a);
        for (const r of this.poles) total -= turnedOnCircle(r, a);
        return total;
    }

    get startPhase() {
        const sign = (list) => list.reduce((s, r) => (r[1] === 0 && r[0] > 1 ? -s : s), 1);
        return Math.sign(this.k) * sign(this.zeros) * sign(this.poles) > 0 ? 0 : -Math.PI;
    }

    // An angle below which nothing but a root at z = 1 is felt.
    get first() {
        const far = [...this.zeros, ...this.poles].map((r) => abs(sub(r, [1, 0]))).filter((x) => x > AT_ONE);
        return 1e-4 * Math.min(1, ...far);
    }

    start() {
        const grid = [0], ratio = (Math.PI / this.first) ** (1 / 199);
        for (let i = 0; i < 200; i += 1) grid.push(i === 199 ? Math.PI : this.first * ratio ** i);
        const ends = [1e-9 * this.first, Math.PI].map((a) => [this.distance(a), a]).sort((p, q) => p[0] - q[0]);
        return { grid, best: ends[0][0], at: ends[0][1] };
    }

    survey(a, b) {
        let far = Math.abs(this.k), near = far, pace = Math.abs(this.d), bend = 0;
        for (const r of this.zeros) {
            const [close, wide] = arcDistances(r, a, b), size = abs(r);
            far *= wide;
            near *= close;
            pace += size / close;
            bend += size / close ** 2;
        }
        for (const r of this.poles) {
            const [close, wide] = arcDistances(r, a, b), size = abs(r);
            near /= wide;
            far /= close;
            pace += size / close;
            bend += size / close ** 2;
        }
        const bound = Math.max(near - 1 || -1, 1 - far || -1), middle = (a + b) / 2, half = (b - a) / 2;
        const W = this.at(middle);
        if (!Number.isFinite(W[0] + W[1])) return [Infinity, bound];
        const begin = [1 + W[0], W[1]], chord = scale(mul(W, this.logSlope(middle)), half);
        const length = chord[0] ** 2 + chord[1] ** 2;
        let foot = length ? -(chord[0] * begin[0] + chord[1] * begin[1]) / length : 0;
        foot = Math.max(-1, Math.min(1, foot)) || 0;
        const local = Math.hypot(begin[0] + foot * chord[0], begin[1] + foot * chord[1])
            - far * (pace ** 2 + bend) * half ** 2 / 2;
        return [abs(begin), Number.isFinite(local) ? Math.max(local, bound) : bound];
    }

    // Cuts of [first, pi] between which one part of log G (0 real, 1 imaginary) is proved monotone.
    monotone(part) {
        const begin = this.first, ratio = (Math.PI / begin) ** (1 / 59), cuts = [];
        for (let i = 0; i < 60; i += 1) cuts.push(i === 59 ? Math.PI : begin * ratio ** i);
        const roots = [...this.zeros, ...this.poles];
        for (const r of roots.filter(onCircle)) {
            const angle = Math.abs(arg(r));
            if (angle > begin && angle < Math.PI) cuts.push(angle);
        }
        const felt = part ? roots.filter((r) => !onCircle(r)) : roots;
        cuts.sort((x, y) => x - y);
        const done = [...cuts];
        let open = [];
        for (let i = 1; i < cuts.length; i += 1) open.push([cuts[i - 1], cuts[i]]);
        while (open.length) {
            const next = [];
            for (const [low, high] of open) {
                const middle = (low + high) / 2;
                if (high - low <= FINEST * high) continue;
                if (Math.abs(this.logSlope(middle)[part]) > curvature(felt, low, high) * (high - low) / 2) continue;
                done.push(middle);
                next.push([low, middle], [middle, high]);
            }
            open = next;
        }
        return [...new Set(done)].sort((x, y) => x - y);
    }

    // All angles in (0, pi) with |G| = 1, ascending.
    get gainCrossovers() {
        this.gains ??= (() => {
            const cuts = this.monotone(0), level = (a) => Math.log(this.magnitude(a)), found = [];
            const levels = cuts.map(level);
            for (let i = 1; i < cuts.length; i += 1) {
                const [low, high] = [levels[i - 1], levels[i]];
                if (Number.isFinite(low) && Number.isFinite(high) && low * high < 0) {
                    found.push(rootBetween(level, cuts[i - 1], cuts[i]));
                }
            }
            return found;
        })();
        return this.gains;
    }

    // All angles in [0, pi] with G real and negative, ascending; the ends where G is finite there.
    get phaseCrossovers() {
        const cuts = this.monotone(1), found = [];
        for (let i = 1; i < cuts.length; i += 1) {
            const low = cuts[i - 1] + 1e-13 * cuts[i], high = cuts[i] * (1 - 1e-13);
            const start = this.phase(low), end = this.phase(high);
            const [first, last] = [(start / Math.PI - 1) / 2, (end / Math.PI - 1) / 2].sort((x, y) => x - y);
            for (let k = Math.ceil(first); k <= Math.floor(last); k += 1) {
                const gap = (a) => this.phase(a) - (2 * k + 1) * Math.PI;
                if (gap(low) * gap(high) < 0) found.push(rootBetween(gap, low, high));
            }
        }
        for (const end of [0, Math.PI]) {
            const W = this.at(end);
            if (Number.isFinite(W[0]) && W[0] < 0 && abs(W) > 1e-12) found.push(end);
        }
        const inside = found.filter((a) => a < Math.PI * (1 - 1e-9) || a === Math.PI).sort((x, y) => x - y);
        return inside.filter((a, i) => i === 0 || a > inside[i - 1]);
    }

    // The number of closed-loop poles outside the unit circle, by the argument of 1 + G; -1 on the border.
    get unstableRoots() {
        const outside = this.poles.filter((p) => abs(p) > 1 && !onCircle(p)).length, passed = this.gainCrossovers;
        const between = [passed.length ? passed[0] / 2 : 1];
        for (let i = 1; i < passed.length; i += 1) between.push((passed[i - 1] + passed[i]) / 2);
        if (passed.length) between.push((passed.at(-1) + Math.PI) / 2);
        const loud = between.map((a) => this.magnitude(a) > 1);
        let turns = 0;
        for (let i = 0; i < passed.length; i += 1) {
            if (loud[i] === loud[i + 1]) continue;
            const whole = this.phase(passed[i]) / (2 * Math.PI), near = Math.round(whole);
            if (Math.abs(Math.abs(whole - near) - 0.5) < UNDECIDED) return -1;
            turns += loud[i] ? near : -near;
        }
        if (loud[0]) turns -= this.startPhase / (2 * Math.PI);
        if (loud.at(-1)) turns += Math.round(this.phase(Math.PI) / Math.PI) / 2;
        return Math.round(outside - 2 * turns);
    }
}

// What |d2/da2 log G| cannot exceed on [a, b] by these roots.
function curvature(roots, a, b) {
    let total = 0;
    for (const r of roots) total += abs(r) / arcDistances(r, a, b)[0] ** 2;
    return total;
}

// Does a root lie on the unit circle within rounding, measured by how far from z = 1 it is?
const onCircle = (r) => Math.abs(abs(r) - 1) <= Math.max(ON_CIRCLE * abs(sub(r, [1, 0])), ROUNDING_AT_ONE);

function arcDistances(r, a, b) {
    const size = abs(r), angle = arg(r);
    const far = (x) => Math.hypot(1 - size, 2 * Math.sqrt(size) * Math.sin((x - angle) / 2));
    const ends = [far(a), far(b)], passed = a <= angle && angle <= b;
    const opposite = a <= angle + Math.PI && angle + Math.PI <= b;
    return [passed ? Math.abs(1 - size) : Math.min(...ends), opposite ? 1 + size : Math.max(...ends)];
}

// The change of arg(1 - r exp(-ja)) from the real axis outside z = 1.
function turnedOnCircle(r, a) {
    const size = abs(r), angle = arg(r);
    if (onCircle(r)) {
        if (angle === 0) return Math.PI / 2 - a / 2;
        const side = (x) => (x >= 0 ? Math.PI / 2 : -Math.PI / 2) - x / 2;
        return side(a - angle) - side(-angle);
    }
    if (size < 1) return arg(sub([1, 0], mul(r, exp([0, -a])))) - arg(sub([1, 0], r));
    return -a + arg(sub([1, 0], div(exp([0, a]), r))) - arg(sub([1, 0], div([1, 0], r)));
}

// {gain, gainLow, phase, Ms, Mt, gainCrossovers, phaseCrossovers} of a stable sampled loop, frequencies in rad/s.
export function sampledMargins(circle, h) {
    if (circle.unstableRoots !== 0) throw new LoopError("the sampled loop is unstable");
    const atPhase = circle.phaseCrossovers.map((a) => ({ w: a / h, gain: 1 / circle.magnitude(a) }))
        .map((c) => (c.gain < ON_CIRCLE ? { ...c, gain: 0 } : c));
    const atGain = circle.gainCrossovers.map((a) => ({ w: a / h, phase: arg(scale(circle.at(a), -1)) * 180 / Math.PI }));
    const [distance, at] = closest(circle), [other, where] = circle.k ? closest(circle.inverse()) : [Infinity, 0];
    const Ms = peakOf(distance, at / h), Mt = peakOf(other, where / h);
    return {
        gain: Math.min(Infinity, ...atPhase.map((c) => c.gain).filter((g) => g > 1)),
        gainLow: Math.max(0, ...atPhase.map((c) => c.gain).filter((g) => g < 1)),
        phase: atGain.length ? atGain.map((c) => c.phase).reduce((p, q) => (Math.abs(q) < Math.abs(p) ? q : p)) : Infinity,
        Ms, Mt, gainCrossovers: atGain, phaseCrossovers: atPhase,
    };
}
