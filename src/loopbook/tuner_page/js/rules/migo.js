// MIGO: the PI and PID regulators of largest integral gain for the joint robustness M; a port of loopbook.tuning.migo,
// where the method is explained. Processes with a positive gain.

import { abs } from "../core/complex.js";
import { loopTransfer } from "../core/response.js";
import { rootBetween } from "../core/search.js";
import { unstableRoots } from "../core/stability.js";
import { roots } from "../core/polynomials.js";
import { migoBranch } from "./formulas.js";
import { frequencyAt, phaseOf, responseAt, RuleDoesNotApply } from "./knowledge.js";

const TOLERANCE = 1e-7;

const space = (low, high, n) => Array.from({ length: n }, (_, i) => low * (high / low) ** (i / (n - 1)));

export class MigoSearch {
    constructor(process, M) {
        this.process = process;
        this.C = migoBranch.centre(M);
        this.R = migoBranch.radius(M);
        if (roots(process.den).some((p) => p[0] > 1e-12)) throw new RuleDoesNotApply("the process is unstable by itself");
        this.scale = frequencyAt(process, -150 * Math.PI / 180);
    }

    // {k, ki, kd} on the smooth branch at a touching frequency.
    branch(w) {
        const [g, slope] = responseAt(this.process, w), given = [w, g[0], g[1], abs(g), slope[0], slope[1], this.C, this.R];
        const kd = migoBranch.kd(...given);
        return { k: migoBranch.k(...given), ki: migoBranch.ki(...given) + w * w * kd, kd };
    }

    clearance({ k, ki, kd }, w, [re, im] = responseAt(this.process, w)[0]) {
        const lead = kd * w - ki / w;
        return Math.hypot(this.C + re * k - im * lead, im * k + re * lead) - this.R;
    }

    // The largest kd where dead time turns a loop gain that does not fade.
    get kdLimit() {
        const { num, den, delay } = this.process, last = num[0] / den[0], degree = den.length - num.length;
        if (degree > 1 || (!delay && last > 0)) return Infinity;
        return degree ? (this.C - this.R) / Math.abs(last) : 0;
    }

    // Frequencies dense enough to see every approach to the circle, with the process's response there.
    grid(all, density) {
        const { scale, process: { delay } } = this, points = space(scale * 1e-3, scale * 10 ** 2.5, 850 * density);
        if (delay) {
            const most = (name) => Math.max(...all.map((gains) => Math.abs(gains[name])));
            const [k, ki, kd] = [most("k"), most("ki"), most("kd")];
            let end = 0;
            for (const w of space(0.1 / delay, 1e4 / delay, 300)) {
                if (abs(responseAt(this.process, w)[0]) * Math.hypot(k, kd * w + ki / w) >= this.C - this.R) end = w;
            }
            end = Number.isFinite(this.kdLimit) ? 150 / delay : Math.min(end, 2000 / delay);
            for (let x = 0.2 / density; x < 1 + end * delay; x += 0.2 / density) points.push(x / delay);
        }
        return points.map((w) => [w, responseAt(this.process, w)[0]]);
    }

    // [{depth, at}] of each of `all` gains: the smallest clearance and where.
    deepest(all, density = 1) {
        const grid = this.grid(all, density);
        return all.map((gains) => {
            if (gains.kd > this.kdLimit) return { depth: -1, at: Infinity };
            let found = { depth: Infinity, at: 0 };
            for (const [w, g] of grid) {
                const depth = this.clearance(gains, w, g);
                if (depth < found.depth) found = { depth, at: w };
            }
            return found;
        });
    }

    // The touching frequency of the PI optimum: where kd rises through zero with positive gains, ki largest.
    pi() {
        const steps = space(this.scale * 1e-3, this.scale * 10 ** 0.7, 400), points = steps.map((w) => this.branch(w));
        const phase = phaseOf(this.process);
        let best = -1;
        for (let i = 1; i < steps.length; i += 1) {
            const rises = points[i - 1].kd <= 0 && points[i].kd > 0 && points[i].ki > 0 && points[i].k > 0 && phase(steps[i]) > -Math.PI;
            if (rises && (best < 0 || points[i - 1].ki > points[best].ki)) best = i - 1;
        }
        if (best < 0) throw new RuleDoesNotApply("ki has no smooth maximum under this robustness");
        const w = rootBetween((x) => this.branch(x).kd, steps[best], steps[best + 1]);
        const { k, ki } = this.branch(w);
        const [{ depth }] = this.deepest([{ k, ki, kd: 0 }]);
        if (depth < -TOLERANCE) throw new RuleDoesNotApply("the smooth optimum enters the circle at another frequency");
        return w;
    }

    pid() {
        const start = this.pi(), bracket = this.firstViolation(start, this.branchEnd(start));
        if (bracket.second === Infinity) {
            const limit = this.kdLimit;
            return rootBetween((w) => this.branch(w).kd - limit, bracket.low, bracket.high, 1e-13);
        }
        return this.secondTouch(start, bracket);
    }

    branchEnd(start) {
        const steps = space(start, start * 10 ** 2.5, 800);
        let before = this.branch(steps[0]);
        for (let i = 1; i < steps.length; i += 1) {
            const next = this.branch(steps[i]);
            if (next.kd < before.kd || next.ki <= 0) return steps[i - 1];
            before = next;
        }
        return steps.at(-1);
    }

    firstViolation(start, end) {
        let low = start, high = end, second = NaN;
        while (high / low > 1.002) {
            const steps = space(low, high, 24).slice(1), found = this.deepest(steps.map((w) => this.branch(w)));
            const first = found.findIndex(({ depth }) => depth < -TOLERANCE);
            if (first < 0) {
                if (Number.isNaN(second)) throw new RuleDoesNotApply("no second touch: ki grows with kd without bound");
                return { low: steps.at(-2), high: steps.at(-1), second };
            }
            high = steps[first];
            second = found[first].at;
            if (first) low = steps[first - 1];
        }
        return { low, high, second };
    }

    // The smallest clearance within 10 % of `near`, and where, for the settings of the branch at w.
    local(w, near) {
        const gains = this.branch(w);
        let span = 1.1, centre = near, room = [], i = 0;
        for (let k = 0; k < 5; k += 1) {
            const x = space(centre / span, centre * span, 41);
            room = x.map((at) => this.clearance(gains, at));
            i = Math.min(39, Math.max(1, room.indexOf(Math.min(...room))));
            centre = x[i];
            span **= 1 / 8;
        }
        const [left, middle, right] = room.slice(i - 1, i + 2), bend = left - 2 * middle + right;
        return { depth: bend > 0 ? middle - (right - left) ** 2 / (8 * bend) : middle, at: centre };
    }

    secondTouch(start, bracket) {
        let { low, high, second: near } = bracket;
        for (let k = 0; k < 5; k += 1) {
            if (this.local(low, near).depth <= 0) [low, high] = [start, low];
            if (!(this.local(low, near).depth > 0 && this.local(high, near).depth < 0)) break;
            const about = near, w = rootBetween((x) => this.local(x, about).depth, low, high, 1e-12);
            const [{ depth, at }] = this.deepest([this.branch(w)], 8);
            if (depth >= -TOLERANCE) return w;
            near = at;
            high = w;
        }
        return this.halved(start, high);
    }

    halved(start, end) {
        let low = start, high = end;
        for (let k = 0; k < 40; k += 1) {
            const middle = Math.sqrt(low * high), [{ depth }] = this.deepest([this.branch(middle)], 4);
            if (depth < -TOLERANCE) high = middle; else low = middle;
        }
        return low;
    }
}

// {K, Ti, Td, b} of the optimum; action: "PI" or "PID".
export function migo(process, action, M = 1.4) {
    const search = new MigoSearch(process, M), w = action === "PI" ? search.pi() : search.pid(), { k, ki, kd } = search.branch(w);
    const D = action === "PI" ? 0 : kd;
    if (!(k > 0 && ki > 0 && D >= 0)) throw new RuleDoesNotApply("the smooth optimum has gains of different signs");
    if (unstableRoots(loopTransfer(process, { P: k, I: ki, D, Tf: 0 }))) throw new RuleDoesNotApply("the loop would be unstable");
    return { K: k, Ti: k / ki, Td: D / k, b: 0 };
}
