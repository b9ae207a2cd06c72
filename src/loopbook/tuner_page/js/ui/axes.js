// A canvas with axes: ticks at round numbers, lines, points, bands, in the page's own colours.

import { shown } from "./state.js";

const FONT = "11px system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
const DASHES = { solid: [], dash: [7, 4], dot: [2, 3], mixed: [8, 3, 2, 3] };

// Round ticks between two numbers.
export function ticks(low, high, count = 5) {
    const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw)), share = raw / power;
    const step = power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10), found = [];
    for (let x = Math.ceil(low / step - 1e-9) * step; x <= high + step * 1e-9; x += step) found.push(Math.abs(x) < step / 1e6 ? 0 : x);
    return found;
}

export class Axes {
    constructor(canvas) {
        this.canvas = canvas;
        this.context = canvas.getContext("2d");
        this.margin = { left: 46, right: 10, top: 8, bottom: 20 };
    }

    // Sets the canvas to its size on the screen and clears it. colours: by name.
    begin(colours) {
        const ratio = globalThis.devicePixelRatio || 1, { clientWidth, clientHeight } = this.canvas;
        const width = Math.round(clientWidth * ratio), height = Math.round(clientHeight * ratio);
        if (this.canvas.width !== width) this.canvas.width = width;
        if (this.canvas.height !== height) this.canvas.height = height;
        this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
        this.context.clearRect(0, 0, clientWidth, clientHeight);
        this.colours = colours;
        this.width = clientWidth;
        this.height = clientHeight;
        const { left, right, top, bottom } = this.margin;
        this.box = { x: left, y: top, w: Math.max(10, clientWidth - left - right), h: Math.max(10, clientHeight - top - bottom) };
        return this;
    }

    // A part of the box, from one share of its height to another.
    part(from, to) {
        const { top, bottom } = this.margin, all = this.height - top - bottom;
        this.box = { ...this.box, y: top + all * from, h: all * (to - from) };
        return this;
    }

    scales(x, y, { logX = false, logY = false } = {}) {
        const map = ([low, high], log, from, size) => {
            const [a, b] = log ? [Math.log10(low), Math.log10(high)] : [low, high];
            return {
                to: (v) => from + ((log ? Math.log10(v) : v) - a) / (b - a) * size,
                from: (p) => { const v = a + (p - from) / size * (b - a); return log ? 10 ** v : v; },
            };
        };
        this.x = map(x, logX, this.box.x, this.box.w);
        this.y = map([y[1], y[0]], logY, this.box.y, this.box.h);
        this.range = { x, y, logX, logY };
        return this;
    }

    grid({ xTicks, yTicks, xLabels = true, label = "", low = false, format = (v) => shown(v, 4) }) {
        const { context: c, box, colours } = this;
        c.lineWidth = 1;
        c.font = FONT;
        c.strokeStyle = colours.grid;
        c.fillStyle = colours.quiet;
        c.textBaseline = "middle";
        c.textAlign = "right";
        for (const v of yTicks) {
            const y = Math.round(this.y.to(v)) + 0.5;
            c.beginPath();
            c.moveTo(box.x, y);
            c.lineTo(box.x + box.w, y);
            c.stroke();
            c.fillText(format(v), box.x - 5, y);
        }
        c.textBaseline = "top";
        c.textAlign = "center";
        for (const v of xTicks) {
            const x = Math.round(this.x.to(v)) + 0.5;
            c.beginPath();
            c.moveTo(x, box.y);
            c.lineTo(x, box.y + box.h);
            c.stroke();
            if (xLabels) c.fillText(shown(v, 4), Math.max(box.x + 6, Math.min(x, box.x + box.w - 8)), box.y + box.h + 4);
        }
        if (label) {
            c.textAlign = "left";
            c.textBaseline = low ? "bottom" : "top";
            c.fillStyle = colours.ink;
            c.fillText(label, box.x + 6, low ? box.y + box.h - 4 : box.y + 4);
        }
        c.strokeStyle = colours.frame;
        c.strokeRect(box.x + 0.5, box.y + 0.5, box.w, box.h);
        return this;
    }

    clipped(draw) {
        const { context: c, box } = this;
        c.save();
        c.beginPath();
        c.rect(box.x, box.y, box.w, box.h);
        c.clip();
        draw(c);
        c.restore();
        return this;
    }

    // A line through points; stairs: each value holds until the next.
    line(xs, ys, { colour, width = 2, dash = "solid", stairs = false }) {
        return this.clipped((c) => {
            c.strokeStyle = colour;
            c.lineWidth = width;
            c.lineJoin = "round";
            c.setLineDash(DASHES[dash]);
            c.beginPath();
            const top = this.box.y - 4000, bottom = this.box.y + this.box.h + 4000;
            let begun = false, before = 0;
            for (let i = 0; i < xs.length; i += 1) {
                const x = this.x.to(xs[i]), y = Math.max(top, Math.min(bottom, this.y.to(ys[i])));
                if (!Number.isFinite(x) || !Number.isFinite(y)) { begun = false; continue; }
                if (!begun) c.moveTo(x, y);
                else if (stairs) { c.lineTo(x, before); c.lineTo(x, y); } else c.lineTo(x, y);
                begun = true;
                before = y;
            }
            c.stroke();
        });
    }

    band(xs, lows, highs, colour) {
        return this.clipped((c) => {
            c.fillStyle = colour;
            c.beginPath();
            xs.forEach((x, i) => (i ? c.lineTo(this.x.to(x), this.y.to(highs[i])) : c.moveTo(this.x.to(x), this.y.to(highs[i]))));
            for (let i = xs.length - 1; i >= 0; i -= 1) c.lineTo(this.x.to(xs[i]), this.y.to(lows[i]));
            c.closePath();
            c.fill();
        });
    }

    circle(x, y, radius, { colour, dash = "solid", width = 1.2, fill = null }) {
        return this.clipped((c) => {
            const rx = Math.abs(this.x.to(x + radius) - this.x.to(x)), ry = Math.abs(this.y.to(y + radius) - this.y.to(y));
            c.beginPath();
            c.ellipse(this.x.to(x), this.y.to(y), rx, ry, 0, 0, 2 * Math.PI);
            c.setLineDash(DASHES[dash]);
            c.lineWidth = width;
            if (fill) { c.fillStyle = fill; c.fill(); }
            c.strokeStyle = colour;
            c.stroke();
        });
    }

    // A mark: "dot", "ring", "cross".
    mark(x, y, kind, colour, size = 4) {
        return this.clipped((c) => {
            const px = this.x.to(x), py = this.y.to(y);
            c.strokeStyle = colour;
            c.fillStyle = colour;
            c.lineWidth = 2;
            c.setLineDash([]);
            c.beginPath();
            if (kind === "cross") {
                c.moveTo(px - size, py - size);
                c.lineTo(px + size, py + size);
                c.moveTo(px + size, py - size);
                c.lineTo(px - size, py + size);
                c.stroke();
                return;
            }
            c.arc(px, py, size, 0, 2 * Math.PI);
            if (kind === "dot") c.fill(); else c.stroke();
        });
    }

    rule({ x = null, y = null, colour, dash = "dash", width = 1 }) {
        const { box } = this;
        return x !== null
            ? this.line([x, x], [this.y.from(box.y), this.y.from(box.y + box.h)], { colour, dash, width })
            : this.line([this.x.from(box.x), this.x.from(box.x + box.w)], [y, y], { colour, dash, width });
    }

    text(x, y, words, { colour = this.colours.ink, align = "left", base = "middle", dx = 0, dy = 0 } = {}) {
        const { context: c } = this;
        c.font = FONT;
        c.fillStyle = colour;
        c.textAlign = align;
        c.textBaseline = base;
        c.fillText(words, this.x.to(x) + dx, this.y.to(y) + dy);
        return this;
    }
}
