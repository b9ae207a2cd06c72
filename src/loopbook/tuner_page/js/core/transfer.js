// The transfer function around a loop, n(s)/d(s) exp(-L s), and its exact magnitude and phase on the imaginary axis.
// A port of loopbook.loop.transfer: |n/d| has no dead time in it, so gain crossovers are roots of a polynomial; the
// phase is monotone between the roots of another, so that no crossover can hide between points of a grid.

import { abs, arg, div, exp, mul, scale } from "./complex.js";
import { convolve, derivative, roots, sum, trimmed, value, withSlope } from "./polynomials.js";
import { rootBetween } from "./search.js";
import { characteristicTime, inUnits, size } from "./units.js";

const ON_AXIS = 1e-9;
const TOUCHES = 1e-7;
const BESIDE = 1e-13;
const SAME = 1e-9;

export class LoopError extends Error {}

// Re(p(jw) conj(q(jw))) as a polynomial in x = w^2.
function withMirror(p, q) {
    const mirrored = q.map((c, i) => ((q.length - 1 - i) % 2 ? -c : c));
    const product = convolve(p, mirrored), even = [];
    for (let i = product.length - 1, k = 0; i >= 0; i -= 2, k += 1) even.unshift(k % 2 ? -product[i] : product[i]);
    return even;
}

export const magnitudeSquared = (p) => withMirror(p, p);
const slopeOfPhase = (p) => (p.length > 1 ? withMirror(derivative(p), p) : [0]);

// The w > 0 at which a real polynomial in x = w^2 vanishes, ascending.
function positiveRoots(p) {
    const x = roots(p).filter((r) => r[0] > 0 && Math.abs(r[1]) <= 1e-6 * abs(r));
    return x.map((r) => Math.sqrt(r[0])).sort((a, b) => a - b);
}

const snapped = (found) => found.map((r) => (Math.abs(r[0]) <= ON_AXIS * abs(r) ? [0, r[1]] : r));

// The change of arg(s - root), summed over the roots, from s = 0+ to s = jw; roots on the axis count as left.
function turned(found, w) {
    let total = 0;
    for (const [re, im] of found) {
        if (re === 0) total += (w >= im ? Math.PI / 2 : -Math.PI / 2) + Math.sign(im) * Math.PI / 2;
        else total -= Math.sign(re) * (Math.atan2(w - im, Math.abs(re)) - Math.atan2(-im, Math.abs(re)));
    }
    return total;
}

function distinct(found) {
    const w = [...found].sort((a, b) => a - b);
    return w.filter((x, i) => i === 0 || x - w[i - 1] > SAME * x);
}

const lastNonzero = (p) => [...p].reverse().find((c) => c !== 0) ?? 1;

export class LoopTransfer {
    constructor(num, den, delay = 0, hidden = 0) {
        this.num = trimmed(num);
        this.den = trimmed(den);
        this.delay = delay;
        this.hidden = hidden;
        while (this.num.length > 1 && this.den.length > 1 && this.num.at(-1) === 0 && this.den.at(-1) === 0) {
            this.num = this.num.slice(0, -1);
            this.den = this.den.slice(0, -1);
            this.hidden += 1;
        }
        this.kept = new Map();
    }

    // A value that is computed when it is first asked for.
    once(name, compute) {
        if (!this.kept.has(name)) this.kept.set(name, compute());
        return this.kept.get(name);
    }

    // [the same loop with time in units of its own, that unit in seconds].
    get ownUnits() {
        return this.once("units", () => {
            const time = characteristicTime(this.num, this.den, this.delay);
            const num = inUnits(this.num, time), den = inUnits(this.den, time), gain = size(den);
            const inside = new LoopTransfer(inUnits(num, 1, gain), inUnits(den, 1, gain), this.delay / time, this.hidden);
            inside.kept.set("units", [inside, 1]);
            return [inside, time];
        });
    }

    get zeros() {
        return this.once("zeros", () => {
            const [inside, time] = this.ownUnits;
            return snapped(roots(inside.num)).map((r) => scale(r, 1 / time));
        });
    }

    get poles() {
        return this.once("poles", () => {
            const [inside, time] = this.ownUnits;
            return snapped(roots(inside.den)).map((r) => scale(r, 1 / time));
        });
    }

    at(s) {
        return mul(div(value(this.num, s), value(this.den, s)), exp(scale(s, -this.delay)));
    }

    // G(jw), from the loop in its own units.
    onAxis(w) {
        const [inside, time] = this.ownUnits;
        return inside.at([0, w * time]);
    }

    get gainAtInfinity() {
        const excess = this.num.length - this.den.length;
        return excess < 0 ? 0 : excess > 0 ? Infinity : Math.abs(this.num[0] / this.den[0]);
    }

    magnitude(w) {
        const [inside, time] = this.ownUnits, s = [0, w * time];
        return abs(value(inside.num, s)) / abs(value(inside.den, s));
    }

    get phaseAtStart() {
        return lastNonzero(this.num) / lastNonzero(this.den) > 0 ? 0 : -Math.PI;
    }

    // The continuous argument for w > 0; a pole on the axis counts as if it lay to the left.
    phase(w) {
        return this.phaseAtStart + turned(this.zeros, w) - turned(this.poles, w) - this.delay * w;
    }

    // All w > 0 with |n/d| = 1, ascending.
    get gainCrossovers() {
        return this.once("crossovers", () => {
            const [inside, time] = this.ownUnits;
            const difference = sum(magnitudeSquared(inside.den), magnitudeSquared(inside.num), -1);
            if (!difference.some((c) => c)) throw new LoopError("the loop's magnitude is 1 at every frequency");
            const candidates = positiveRoots(difference);
            if (!candidates.length) return [];
            const between = [candidates[0] / 2];
            for (let i = 1; i < candidates.length; i += 1) between.push(Math.sqrt(candidates[i - 1] * candidates[i]));
            between.push(2 * candidates.at(-1));
            const loud = between.map((w) => inside.logMagnitude(w)[0] > 0);
            const found = candidates.flatMap((w, i) => (
                loud[i] !== loud[i + 1] ? [inside.crossing(w, between[i], between[i + 1], loud[i])] : inside.touch(w)
            ));
            return distinct(found).map((w) => w / time);
        });
    }

    // The w in (a, b) at which the magnitude, above 1 at a if it falls, becomes 1: Newton's method, kept inside.
    crossing(start, from, to, falls) {
        let w = start, a = from, b = to;
        for (let i = 0; i < 80; i += 1) {
            const [level, slope] = this.logMagnitude(w);
            if (level === 0) break;
            if ((level > 0) === falls) a = w; else b = w;
            let after = slope ? w * Math.exp(Math.max(Math.min(-level / slope, 40), -40)) : 0;
            if (!(a < after && after < b)) after = Math.sqrt(a * b);
            if (Math.abs(after - w) <= 4e-16 * w) return after;
            w = after;
        }
        return w;
    }

    touch(start) {
        let w = start;
        for (let i = 0; i < 4; i += 1) {
            const [level, slope] = this.logMagnitude(w);
            if (slope === 0) break;
            w *= Math.exp(Math.min(Math.max(-level / slope, -1e-3), 1e-3));
        }
        return Math.abs(this.logMagnitude(w)[0]) < TOUCHES ? [w] : [];
    }

    // log|n/d| at jw and its slope over log w.
    logMagnitude(w) {
        const s = [0, w], [n, dn] = withSlope(this.num, s), [d, dd] = withSlope(this.den, s);
        const above = abs(n), below = abs(d);
        if (!above || !below) return [below ? -Infinity : Infinity, 0];
        return [Math.log(above / below), -w * (div(dn, n)[1] - div(dd, d)[1])];
    }

    // The w > 0 that cut the axis into intervals of monotone phase.
    get monotonePhase() {
        return this.once("monotone", () => {
            const [inside, time] = this.ownUnits, n = inside.num, d = inside.den;
            const n2 = magnitudeSquared(n), d2 = magnitudeSquared(d);
            let slope = sum(convolve(slopeOfPhase(n), d2), convolve(slopeOfPhase(d), n2), -1);
            slope = sum(slope, convolve(n2, d2), -inside.delay);
            const axis = [...inside.zeros, ...inside.poles].filter((r) => r[0] === 0 && r[1] > 0).map((r) => r[1]);
            return [...positiveRoots(slope), ...axis].sort((a, b) => a - b).map((w) => w / time);
        });
    }

    // All w > 0 where G is real and negative and |G| at least `floor`, ascending.
    phaseCrossovers(floor) {
        if (this.delay && !(floor > this.gainAtInfinity)) {
            throw new LoopError(`the loop gain tends to ${this.gainAtInfinity}: infinitely many phase crossovers`);
        }
        const [inside, time] = this.ownUnits, last = inside.lastFrequency(floor);
        const cuts = [0, ...inside.monotonePhase.filter((w) => w < last), last], found = [];
        for (let i = 1; i < cuts.length; i += 1) found.push(...inside.levels(cuts[i - 1], cuts[i]));
        return distinct(found.filter((w) => inside.magnitude(w) >= floor)).map((w) => w / time);
    }

    // Beyond it |n/d| stays below the floor; without dead time, where all turning is over.
    lastFrequency(floor) {
        const difference = sum(magnitudeSquared(this.den).map((c) => floor ** 2 * c), magnitudeSquared(this.num), -1);
        const radius = Math.max(0, ...[...this.zeros, ...this.poles].map(abs)) || 1;
        const highest = Math.max(0, ...positiveRoots(difference), ...this.monotonePhase);
        return 1.001 * Math.max(highest, this.delay ? 0 : 1e3 * radius, 1e-9 * radius);
    }

    // A frequency below which nothing turns but what lies at s = 0.
    get beginning() {
        const paces = [...this.zeros, ...this.poles].map(abs).filter((r) => r);
        if (this.delay) paces.push(1 / this.delay);
        return 1e-14 * (paces.length ? Math.min(...paces) : 1);
    }

    // The w in (a, b), where the phase is monotone, at which it is an odd multiple of pi.
    levels(a, b) {
        const low = a ? a * (1 + BESIDE) : Math.min(this.beginning, b / 2), high = b * (1 - BESIDE);
        if (!(low < high)) return [];
        const start = this.phase(low), end = this.phase(high), found = [];
        const [first, last] = [(start / Math.PI - 1) / 2, (end / Math.PI - 1) / 2].sort((x, y) => x - y);
        for (let k = Math.ceil(first); k <= Math.floor(last); k += 1) {
            const level = (2 * k + 1) * Math.PI;
            if ((start - level) * (end - level) < 0) {
                const gap = (x) => this.phase(Math.exp(x)) - level;
                found.push(this.polished(Math.exp(rootBetween(gap, Math.log(low), Math.log(high)))));
            }
        }
        return found;
    }

    // A last Newton step with the polynomials themselves, which are more exact than their roots.
    polished(start, angle = Math.PI) {
        let w = start;
        for (let i = 0; i < 2; i += 1) {
            const s = [0, w], [n, dn] = withSlope(this.num, s), [d, dd] = withSlope(this.den, s);
            if (!abs(n) || !abs(d)) return w;
            const ratio = mul(div(n, d), exp([0, -this.delay * w - angle]));
            const slope = div(dn, n)[0] - div(dd, d)[0] - this.delay;
            const change = slope ? arg(ratio) / slope : 0;
            if (!(Math.abs(change) < 1e-6 * w)) return w;
            w -= change;
        }
        return w;
    }
}
