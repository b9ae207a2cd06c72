// The plots: responses, Nyquist and poles, Bode and sensitivities. Each draws a view and says what a drag on it means.
//
// view: {s, main, pins, band, names, colours}; main and pins: {result, style}.

import { Axes, ticks } from "./axes.js";
import { shown } from "./state.js";

const GRIP = 16;

const boundsOf = (lists, floor = 0) => {
    let low = Infinity, high = -Infinity;
    for (const list of lists) for (const v of list) if (Number.isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
    if (low > high) [low, high] = [0, 1];
    const room = 0.07 * (high - low || Math.max(Math.abs(high), floor) || 1);
    return [low - room, high + 2 * room]; // the label stands above
};

// Limits of what is shown of an unstable loop: it would dwarf everything.
const tamed = ([low, high], target) => {
    const most = 3 * Math.max(Math.abs(target), 1e-12);
    return [Math.max(low, -most), Math.min(high, most)];
};

// Frequencies for the curves of a result, dense where a dead time turns them.
export function frequencies(result) {
    if (result.grid) return result.grid;
    const crossovers = (result.margins?.gainCrossovers ?? []).map((c) => c.w);
    const middle = crossovers.length ? crossovers[0] : 1 / result.time, { delay } = result.process;
    const low = middle / 100, high = Math.min(Math.max(60 * middle, ...crossovers.map((w) => 3 * w)), result.last ?? Infinity), grid = [];
    for (let w = low; w < high; w *= 1.028) {
        grid.push(w);
        const turn = 0.15 / (delay || 1e-12);
        if (delay && w * 0.028 > turn) {
            for (let x = w + turn; x < Math.min(w * 1.028, high) && grid.length < 900; x += turn) grid.push(x);
        }
    }
    grid.push(high);
    result.grid = grid;
    result.curve = grid.map((w) => result.at(w));
    return grid;
}

export class TimePlot {
    constructor(canvas) {
        this.axes = new Axes(canvas);
        this.axes.margin = { left: 50, right: 10, top: 6, bottom: 20 };
    }

    draw(view) {
        const { s, main, pins, band, names, colours, record } = view, axes = this.axes.begin(colours);
        if (record) return this.drawRecord(view, axes);
        const { run, span, stable } = main.result;
        if (!run) return axes.part(0, 1).scales([0, 1], [0, 1]).grid({ xTicks: [], yTicks: [], label: main.result.error ?? "" });
        const runs = [...pins, main].filter((p) => p.result.run), xTicks = ticks(0, span, 6);
        const shownRuns = runs.filter((p) => p.result.stable || p === main);
        const seen = s.wave && run.seen.length < 700 ? run.seen : [];
        let yRange = boundsOf([[0, s.r], seen, ...shownRuns.map((p) => p.result.run.y), ...(band ? [band.low, band.high] : [])]);
        let uRange = boundsOf([[0], ...shownRuns.map((p) => p.result.run.u), ...[s.low, s.high].filter((x) => x !== null).map((x) => [x])]);
        if (!stable) {
            yRange = tamed(yRange, s.r);
            uRange = tamed(uRange, (s.high ?? 0) || s.r * 5 / Math.abs(s.K || 1));
        }
        axes.part(0, 0.6).scales([0, span], yRange).grid({ xTicks, yTicks: ticks(...yRange, 5), xLabels: false, label: names.y });
        axes.line([0, span], [s.r, s.r], { colour: colours.quiet, dash: "dash", width: 1 });
        if (band) axes.band(band.t, band.low, band.high, colours.band);
        seen.forEach((y, i) => axes.mark(run.instants[i], y, "dot", colours.record, 1.8));
        for (const p of runs) axes.line(p.result.run.t, p.result.run.y, { ...p.style });
        axes.rule({ x: span / 2, colour: colours.frame, dash: "dot" });
        axes.text(span / 2, yRange[0], main.result.before ? "new settings" : s.d ? "load" : "", { colour: colours.quiet, dx: 4, dy: -9 });
        if (!stable) axes.text(span, yRange[1], "unstable", { colour: colours.bad, align: "right", dx: -8, dy: 12 });
        this.yScale = axes.x;
        axes.part(0.645, 1).scales([0, span], uRange).grid({ xTicks, yTicks: ticks(...uRange, 3), label: `${names.u}; t in s` });
        for (const limit of [s.low, s.high]) if (limit !== null) axes.rule({ y: limit, colour: colours.bad, dash: "dot", width: 1.5 });
        for (const p of runs) {
            const { run: own } = p.result;
            axes.line(own.stairs ? own.instants : own.t, own.u, { ...p.style, stairs: own.stairs });
        }
        return axes;
    }

    drawRecord({ record, colours, names }, axes) {
        const { t, y, u, model, fit } = record, xTicks = ticks(t[0], t.at(-1), 6), span = [t[0], t.at(-1)];
        const yRange = boundsOf([y, model]), uRange = boundsOf([u]);
        axes.part(0, 0.68).scales(span, yRange).grid({ xTicks, yTicks: ticks(...yRange, 5), xLabels: false, label: `${names.y}: record and model, fit ${shown(fit, 4)} %` });
        axes.clipped((c) => {
            c.fillStyle = colours.record;
            t.forEach((x, i) => c.fillRect(axes.x.to(x) - 1, axes.y.to(y[i]) - 1, 2.4, 2.4));
        });
        axes.line(t, model, { colour: colours.current });
        axes.part(0.72, 1).scales(span, uRange).grid({ xTicks, yTicks: ticks(...uRange, 3), label: names.u });
        axes.line(t, u, { colour: colours.record, stairs: true, width: 1.5 });
        return axes;
    }

    // The response dragged in time: its speed, by the gain.
    grab(x, y, view) {
        const { result } = view.main;
        if (view.record || !result.stable || view.s.kind === "rst") return null;
        const start = Math.max(this.axes.x.from(x), result.span / 200), { Kc } = view.s;
        if (start > result.span / 2) return null;
        return (px) => ({ Kc: Kc * Math.max(0.2, Math.min(5, start / Math.max(this.axes.x.from(px), result.span / 400))) });
    }
}

export class NyquistPlot {
    constructor(canvas) {
        this.axes = new Axes(canvas);
        this.axes.margin = { left: 34, right: 8, top: 6, bottom: 20 };
    }

    draw({ main, pins, colours, extra }) {
        this.curveAt = main.result.at;
        const axes = this.axes.begin(colours).part(0, 1), { box } = axes;
        const height = 3.3, width = height * box.w / box.h, x = [-0.72 * width, 0.28 * width], y = [-0.62 * height, 0.38 * height];
        axes.scales(x, y).grid({ xTicks: ticks(...x, 5), yTicks: ticks(...y, 5), label: "G(jω)" });
        axes.rule({ x: 0, colour: colours.frame, dash: "solid" }).rule({ y: 0, colour: colours.frame, dash: "solid" });
        axes.circle(0, 0, 1, { colour: colours.quiet, dash: "dot" });
        const Ms = main.result.margins?.Ms;
        if (Ms) axes.circle(-1, 0, 1 / Ms.value, { colour: colours.bad, dash: "dash", fill: colours.disc });
        for (const p of [...extra, ...pins, main]) {
            if (!p.result.at) continue;
            frequencies(p.result);
            axes.line(p.result.curve.map((v) => v[0]), p.result.curve.map((v) => v[1]), p.style);
        }
        axes.mark(-1, 0, "cross", colours.bad, 4);
        if (Ms) {
            axes.text(-1, 0, `Ms ${shown(Ms.value)}`, { colour: colours.bad, align: "center", dy: -10 });
            if (Number.isFinite(Ms.w) && Ms.w > 0) {
                const [re, im] = main.result.at(Ms.w);
                axes.line([-1, re], [0, im], { colour: colours.bad, width: 1.2 }).mark(re, im, "dot", colours.bad, 3);
            }
        }
        for (const { w } of main.result.margins?.gainCrossovers ?? []) {
            const [re, im] = main.result.at(w);
            axes.mark(re, im, "ring", colours.current, 4.5);
        }
        return axes;
    }

    // Where on the canvas the curve is at a frequency; for who cannot see it.
    gripAt(w) {
        const [re, im] = this.curveAt(w);
        return { x: this.axes.x.to(re), y: this.axes.y.to(im), w };
    }

    // A point of the curve dragged: the regulator that puts it there, by K and Ti.
    grab(x, y, { main, s }) {
        const { result } = main;
        if (s.kind === "rst" || !result.at) return null;
        const grid = frequencies(result);
        let best = -1, near = GRIP ** 2;
        result.curve.forEach(([re, im], i) => {
            const away = (this.axes.x.to(re) - x) ** 2 + (this.axes.y.to(im) - y) ** 2;
            if (away < near) [best, near] = [i, away];
        });
        if (best < 0) return null;
        const w = grid[best], [re, im] = result.curve[best], { Kc, Ti, Td, N } = s;
        const off = [this.axes.x.to(re) - x, this.axes.y.to(im) - y]; // the hand beside the point stays beside it
        const Tf = Td && Number.isFinite(N) ? Td / N : 0, below = 1 + (w * Tf) ** 2;
        const lead = [w * Td * w * Tf / below, w * Td / below];
        const C = [Kc * (1 + lead[0]), Kc * (lead[1] - (Number.isFinite(Ti) ? 1 / (w * Ti) : 0))];
        return (px, py) => {
            const to = [this.axes.x.from(px + off[0]), this.axes.y.from(py + off[1])], size = re * re + im * im;
            const turn = [(to[0] * re + to[1] * im) / size, (to[1] * re - to[0] * im) / size];
            const wanted = [C[0] * turn[0] - C[1] * turn[1], C[0] * turn[1] + C[1] * turn[0]];
            const K = wanted[0] / (1 + lead[0]), lag = lead[1] - wanted[1] / K;
            if (!(K * Kc > 0)) return null;
            if (!Number.isFinite(Ti)) return { Kc: K };
            return { Kc: K, Ti: lag > 0 ? Math.min(1 / (w * lag), 1e6 * result.time) : Infinity };
        };
    }
}

export class PolesPlot {
    constructor(canvas) {
        this.axes = new Axes(canvas);
        this.axes.margin = { left: 44, right: 8, top: 6, bottom: 20 };
    }

    draw({ main, pins, colours, hold }) {
        const axes = this.axes.begin(colours).part(0, 1), all = main.result.poles ?? [];
        const size = hold ?? 1.25 * Math.max(...all.slice(0, 4).map((p) => Math.hypot(...p)), 1e-9);
        const x = [-size, 0.35 * size], y = [-0.12 * size, size];
        this.size = size;
        axes.scales(x, y).grid({ xTicks: ticks(...x, 4), yTicks: ticks(...y, 4), label: "closed-loop poles, rad/s" });
        axes.clipped((c) => {
            c.fillStyle = colours.disc;
            c.fillRect(axes.x.to(0), axes.box.y, axes.box.w, axes.box.h);
        });
        axes.rule({ x: 0, colour: colours.frame, dash: "solid" }).rule({ y: 0, colour: colours.frame, dash: "solid" });
        axes.line([0, -size], [0, size], { colour: colours.quiet, dash: "dot", width: 1 });
        axes.text(-0.66 * size, 0.66 * size, "ζ 0.71", { colour: colours.quiet, dx: 6, dy: -8 });
        for (const p of [...pins, main]) for (const [re, im] of p.result.poles ?? []) axes.mark(re, im, "cross", p.style.colour, p === main ? 6 : 4);
        for (const [re, im] of main.result.wanted ?? []) axes.mark(re, im, "ring", colours.current, 9);
        return axes;
    }

    at(re, im) {
        return [this.axes.x.to(re), this.axes.y.to(im)];
    }

    // A wanted pole dragged: the pair's speed and damping, or where the others lie.
    grab(x, y, { main }) {
        const wanted = main.result.wanted ?? [];
        const found = wanted.findIndex(([re, im]) => Math.hypot(this.axes.x.to(re) - x, this.axes.y.to(im) - y) < GRIP);
        if (found < 0) return null;
        const pair = found === 0 || wanted[0][1] === 0 && found === 1;
        return (px, py) => {
            const re = Math.min(this.axes.x.from(px), -0.01 * this.size), im = Math.max(0, this.axes.y.from(py));
            if (!pair) return { rest: -re };
            const speed = Math.hypot(re, im);
            return { speed, damping: Math.min(1.2, Math.max(0.1, -re / speed)) };
        };
    }
}

export class BodePlot {
    constructor(canvas) {
        this.axes = new Axes(canvas);
        this.axes.margin = { left: 46, right: 10, top: 6, bottom: 20 };
    }

    draw({ main, pins, colours }) {
        const axes = this.axes.begin(colours), { result } = main;
        if (!result.at) return axes;
        const grid = frequencies(result), x = [grid[0], grid.at(-1)], xTicks = decades(...x), y = [1e-2, 1e2];
        const all = [...pins, main].filter((p) => p.result.at);
        for (const p of all) frequencies(p.result);
        axes.part(0, 0.52).scales(x, y, { logX: true, logY: true }).grid({ xTicks, yTicks: [0.01, 0.1, 1, 10, 100], xLabels: false, label: "|G(jω)|", low: true });
        axes.rule({ y: 1, colour: colours.quiet, dash: "dash" });
        for (const p of all) axes.line(p.result.grid, p.result.curve.map((v) => Math.hypot(...v)), p.style);
        const { gainCrossovers = [], phaseCrossovers = [], gain: most, gainLow } = result.margins ?? {};
        for (const { w } of gainCrossovers) axes.mark(w, 1, "ring", colours.current, 4.5);
        for (const { w, gain } of phaseCrossovers) {
            if (w > 0 && (gain === most || gain === gainLow)) axes.line([w, w], [1, 1 / gain], { colour: colours.bad, width: 2 });
        }
        axes.part(0.57, 1).scales(x, [-330, 30], { logX: true }).grid({ xTicks, yTicks: [0, -90, -180, -270], label: "phase, °; ω in rad/s", low: true });
        axes.rule({ y: -180, colour: colours.quiet, dash: "dash" });
        for (const p of all) axes.line(p.result.grid, unwrapped(p.result.curve), p.style);
        for (const { w, phase } of gainCrossovers) {
            axes.line([w, w], [-180, -180 + phase], { colour: colours.bad, width: 2 }).mark(w, -180 + phase, "ring", colours.current, 4.5);
        }
        return axes;
    }

    // The crossover dragged along the frequencies: by the gain.
    grab(x, y, { main, s }) {
        const { result } = main;
        if (s.kind === "rst" || !result.at) return null;
        const { Kc } = s, at = (w) => Math.hypot(...result.at(w)), w0 = this.axes.x.from(x), size = at(w0);
        return (px) => {
            const w = this.axes.x.from(px), target = at(w);
            return target > 0 ? { Kc: Kc * size / target } : null;
        };
    }
}

export class SensitivityPlot {
    constructor(canvas) {
        this.axes = new Axes(canvas);
        this.axes.margin = { left: 46, right: 10, top: 6, bottom: 20 };
    }

    draw({ main, pins, colours }) {
        const axes = this.axes.begin(colours), { result } = main;
        if (!result.at) return axes;
        const grid = frequencies(result), x = [grid[0], grid.at(-1)], all = [...pins, main].filter((p) => p.result.at);
        axes.part(0, 1).scales(x, [1e-2, 8], { logX: true, logY: true })
            .grid({ xTicks: decades(...x), yTicks: [0.01, 0.1, 1, 2, 5], label: "|S| strong, |T| thin; ω in rad/s", low: true });
        axes.rule({ y: 1, colour: colours.quiet, dash: "dash" });
        for (const p of all) {
            frequencies(p.result);
            const far = p.result.curve.map(([re, im]) => Math.hypot(1 + re, im));
            axes.line(p.result.grid, p.result.curve.map((v, i) => Math.hypot(...v) / far[i]), { ...p.style, width: 1.1 });
            axes.line(p.result.grid, far.map((v) => 1 / v), p.style);
        }
        for (const [name, peak] of [["Ms", result.margins?.Ms], ["Mt", result.margins?.Mt]]) {
            if (peak && peak.w > 0 && Number.isFinite(peak.w)) {
                axes.mark(peak.w, peak.value, "dot", colours.bad, 3.5).text(peak.w, peak.value, `${name} ${shown(peak.value)}`, { colour: colours.bad, dx: 6, dy: -9 });
            }
        }
        return axes;
    }

    grab() {
        return null;
    }
}

function decades(low, high) {
    const found = [];
    for (let p = Math.ceil(Math.log10(low) - 1e-9); p <= Math.floor(Math.log10(high) + 1e-9); p += 1) found.push(10 ** p);
    return found;
}

// The phase in degrees without jumps, from where it begins.
function unwrapped(curve) {
    let turns = 0, before = null;
    return curve.map(([re, im]) => {
        const raw = Math.atan2(im, re) * 180 / Math.PI;
        if (before === null) turns = raw > 90 ? -360 : 0;
        else turns += Math.round((before - raw) / 360) * 360;
        before = raw;
        return raw + turns;
    });
}
