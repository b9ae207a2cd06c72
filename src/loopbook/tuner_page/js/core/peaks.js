// Ms and Mt: the largest |1/(1 + G)| and |G/(1 + G)| over all frequencies, certified by branch and bound.
// A port of loopbook.loop.sensitivity_peaks, where the bounds are explained.

import { abs, conj, div, exp, mul } from "./complex.js";
import { value, withSlope } from "./polynomials.js";
import { rootBetween } from "./search.js";
import { LoopError } from "./transfer.js";

const CERTAIN = 1e-6;
const CERTAIN_AROUND = 1e-4; // of a curve that goes around a circle for ever, where each digit costs ten times the turns
const NEARBY = [1e-2, 1e-4, 1e-6];
const MOST = 400000;

// W = k prod(s - z)/prod(s - p) exp(-L s) on the imaginary axis: G itself or 1/G, then with a negative L.
class Axis {
    constructor(loop, inverse) {
        this.num = inverse ? loop.den : loop.num;
        this.den = inverse ? loop.num : loop.den;
        this.zeros = inverse ? loop.poles : loop.zeros;
        this.poles = inverse ? loop.zeros : loop.poles;
        this.delay = inverse ? -loop.delay : loop.delay;
        this.k = Math.abs(this.num[0] / this.den[0]);
        this.certain = 1 - (this.delay && this.num.length === this.den.length ? CERTAIN_AROUND : CERTAIN);
    }

    at(w) {
        const s = [0, w];
        return mul(div(value(this.num, s), value(this.den, s)), exp([0, -this.delay * w]));
    }

    distance(w) {
        const W = this.at(w), size = Math.hypot(1 + W[0], W[1]);
        return Number.isFinite(size) ? size : Infinity;
    }

    // A positive multiple of d|1 + W|/dw in which nothing is divided by.
    slope(w) {
        const s = [0, w], [n, dn] = withSlope(this.num, s), [d, dd] = withSlope(this.den, s);
        const turn = exp([0, -this.delay * w]), turnedN = mul(n, turn), nd = mul(n, d);
        const rate = [
            mul(dn, d)[0] - mul(dd, n)[0] - this.delay * nd[0],
            mul(dn, d)[1] - mul(dd, n)[1] - this.delay * nd[1],
        ];
        const left = mul(conj([d[0] + turnedN[0], d[1] + turnedN[1]]), conj(d));
        return mul(mul(left, turn), [-rate[1], rate[0]])[0];
    }

    // Points to search between, and the best of the curve's two ends: {grid, best, at}.
    start() {
        const sizes = [...this.zeros, ...this.poles].map(abs).filter((r) => r > 0);
        if (this.delay) sizes.push(1 / Math.abs(this.delay));
        const low = 1e-3 * (sizes.length ? Math.min(...sizes) : 1), high = 2 * (sizes.length ? Math.max(...sizes) : 1);
        const grid = [0], ratio = (high / low) ** (1 / 199);
        for (let i = 0; i < 200; i += 1) grid.push(low * ratio ** i);
        const atZero = this.distance(1e-12 * low), atInfinity = this.limit();
        const [best, at] = atInfinity <= atZero ? [atInfinity, Infinity] : [atZero, 0];
        let seen = Math.min(best, 1);
        for (const w of grid.slice(1)) seen = Math.min(seen, this.distance(w));
        const steps = 2 + Math.max(0, Math.ceil(Math.log(1e12 * low / high) / Math.log(1.5)));
        for (let i = 0; i < steps; i += 1) {
            const w = high * 1.5 ** i;
            if (i) grid.push(w);
            if (this.tail(w) >= seen * this.certain) break;
        }
        return { grid, best, at };
    }

    // What |1 + W| cannot fall below beyond `start`, which exceeds every |root|: |jw - r| of a real root, and the square root of
    // that of a pair, lies between w sqrt(1 - |r|^2/w^2) and w sqrt(1 + |r|^2/w^2).
    tail(start) {
        const excess = this.zeros.length - this.poles.length, scale = this.k * start ** excess;
        const up = (found) => found.reduce((p, r) => p * Math.sqrt(1 + (abs(r) / start) ** 2), 1);
        const down = (found) => found.reduce((p, r) => p * (r[1] ? Math.sqrt(1 - (abs(r) / start) ** 2) : 1), 1);
        const least = scale * down(this.zeros) / up(this.poles);
        if (excess > 0) return least - 1;
        const most = scale * up(this.zeros) / down(this.poles);
        return excess === 0 ? Math.max(1 - most, least - 1) : 1 - most;
    }

    // The smallest value that |1 + W| comes near for w to infinity.
    limit() {
        const excess = this.zeros.length - this.poles.length;
        if (excess) return excess < 0 ? 1 : Infinity;
        return this.delay ? Math.abs(1 - this.k) : Math.abs(1 + this.num[0] / this.den[0]);
    }

    // [|1 + W| in the middle of [a, b], what it cannot fall below there].
    survey(a, b) {
        let far = this.k, near = this.k, pace = Math.abs(this.delay), bend = 0;
        for (const [re, im] of this.zeros) {
            const outside = Math.max(0, a - im, im - b), close = Math.hypot(re, outside);
            far *= Math.hypot(re, Math.max(Math.abs(a - im), Math.abs(b - im)));
            near *= close;
            pace += 1 / close;
            bend += 1 / close ** 2;
        }
        for (const [re, im] of this.poles) {
            const outside = Math.max(0, a - im, im - b), close = Math.hypot(re, outside);
            near /= Math.hypot(re, Math.max(Math.abs(a - im), Math.abs(b - im)));
            far /= close;
            pace += 1 / close;
            bend += 1 / close ** 2;
        }
        const bound = Math.max(near - 1 || -1, 1 - far || -1);
        const middle = (a + b) / 2, half = (b - a) / 2, s = [0, middle];
        const [n, dn] = withSlope(this.num, s), [d, dd] = withSlope(this.den, s);
        const W = mul(div(n, d), exp([0, -this.delay * middle]));
        if (!Number.isFinite(W[0] + W[1])) return [Infinity, bound];
        const start = [1 + W[0], W[1]], left = div(dn, n), right = div(dd, d);
        const rate = mul(W, [-(left[1] - right[1]), left[0] - right[0] - this.delay]);
        const chord = [rate[0] * half, rate[1] * half], length = chord[0] ** 2 + chord[1] ** 2;
        let foot = length ? -(chord[0] * start[0] + chord[1] * start[1]) / length : 0;
        foot = Math.max(-1, Math.min(1, foot)) || 0;
        const local = Math.hypot(start[0] + foot * chord[0], start[1] + foot * chord[1])
            - far * (pace ** 2 + bend) * half ** 2 / 2;
        return [abs(start), Number.isFinite(local) ? Math.max(local, bound) : bound];
    }
}

// [distance, w] at the minimum near w in [a, b]; beside w itself where [a, b] does not bracket one.
function polishedMinimum(curve, a, b, start) {
    let w = start;
    for (const [low, high] of [[a, b], ...NEARBY.map((share) => [w * (1 - share), w * (1 + share)])]) {
        if (low > 0 && curve.slope(low) < 0 && curve.slope(high) > 0) {
            w = rootBetween((x) => curve.slope(x), low, high);
            break;
        }
    }
    return [curve.distance(w), w];
}

// [min |1 + W|, w] over the whole curve: certified to `certain`, in fact to rounding.
export function closest(curve) {
    let { grid, best, at } = curve.start();
    let intervals = [];
    for (let i = 1; i < grid.length; i += 1) intervals.push([grid[i - 1], grid[i]]);
    for (let level = 0; level < 60; level += 1) {
        const surveys = intervals.map(([a, b]) => curve.survey(a, b));
        let lowest = 0;
        surveys.forEach(([distance], i) => { if (distance < surveys[lowest][0]) lowest = i; });
        if (surveys[lowest][0] < best * (1 - 1e-15)) {
            const [a, b] = intervals[lowest], middle = (a + b) / 2, width = b - a;
            const [distance, w] = polishedMinimum(curve, Math.max(a - width, 0), b + width, middle);
            [best, at] = distance < surveys[lowest][0] ? [distance, w] : [surveys[lowest][0], middle];
        }
        const open = intervals.filter((_, i) => surveys[i][1] < best * curve.certain);
        if (!open.length) return [best, at];
        if (open.length > MOST) break;
        intervals = open.flatMap(([a, b]) => [[a, (a + b) / 2], [(a + b) / 2, b]]);
    }
    throw new LoopError("the peak of the sensitivity could not be certified");
}

export function peakOf(distance, w) {
    if (distance < 1e-12) throw new LoopError("the loop is on the border of stability");
    return { value: 1 / distance, w };
}

// Ms = max |1/(1 + G(jw))| as {value, w}.
export function sensitivityPeak(loop) {
    if (loop.gainAtInfinity === Infinity) throw new LoopError("the loop transfer has more zeros than poles");
    const [inside, time] = loop.ownUnits, [distance, w] = closest(new Axis(inside, false));
    return peakOf(distance, w / time);
}

// Mt = max |G/(1 + G)| as {value, w}.
export function complementaryPeak(loop) {
    if (!loop.num.some((c) => c)) return { value: 0, w: 0 };
    const [inside, time] = loop.ownUnits, [distance, w] = closest(new Axis(inside, true));
    return peakOf(distance, w / time);
}
