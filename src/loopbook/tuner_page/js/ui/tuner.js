// The page's one object: state, history, pins, what is drawn, what is said.

import { replay, fitOf } from "../core/replay.js";
import { texts } from "../core/texts.js";
import { fits, rules, settingsBy } from "../rules/rules.js";
import { delayMargin, evaluate, processTime, variants } from "./compute.js";
import { download, h, on, put } from "./elements.js";
import { Knob } from "./knobs.js";
import { BodePlot, NyquistPlot, PolesPlot, SensitivityPlot, TimePlot } from "./plots.js";
import { chosenInterval, modelToml, programSettings, programTexts, regulatorJson } from "./pythonic.js";
import { DEFAULTS, FORMS, fromText, inSeries, processOf, shown, toText } from "./state.js";
import { numbersOf, say, summary } from "./words.js";

const LIGHT = {
    ink: "#16202b", quiet: "#5a6673", grid: "#e8ecf1", frame: "#b8c2cc", bad: "#a4272b", band: "rgba(11,99,165,.14)", disc: "rgba(164,39,43,.07)",
    record: "#7c8894", current: "#0b63a5", pins: ["#c2500a", "#00775a", "#8f3f8c"],
};
const DARK = {
    ink: "#e4e9ef", quiet: "#9aa8b6", grid: "#252e38", frame: "#4a5764", bad: "#f29a9d", band: "rgba(111,182,238,.18)", disc: "rgba(242,154,157,.1)",
    record: "#8694a2", current: "#6fb6ee", pins: ["#f2a25c", "#4fc9a4", "#dd9ad9"],
};
const PIN_DASHES = ["dash", "dot", "mixed"];
const MOST_PINS = 3;
const PATIENCE = 9;
const REMEMBERED = 200;

export class Tuner {
    // data: what a notebook or the command gives, see loopbook.tuner_page.settings; place: the element that the page fills.
    constructor(place, data, number) {
        this.data = data;
        this.place = place;
        this.key = `tuner${number ? number + 1 : ""}:`;
        this.given = data.process ?? null;
        this.usual = { ...DEFAULTS, ...data.state };
        for (const knobs of [this.usual, ...(data.pins ?? [])]) for (const name of Object.keys(knobs)) if (knobs[name] === "inf") knobs[name] = Infinity;
        this.names = { y: data.names?.y || "output y", u: data.names?.u || "input u" };
        this.state = { ...this.usual };
        this.pins = (data.pins ?? []).map((pin) => ({ state: { ...this.usual, ...pin } }));
        this.past = [];
        this.future = [];
        this.view = { right: "nyquist", low: "bode", record: false };
        this.dark = globalThis.matchMedia?.("(prefers-color-scheme: dark)");
        this.times = [];
        this.listeners = [];
        this.readAddress();
        this.build();
        this.refresh();
        if (this.dark) on(this.dark, "change", () => this.refresh());
        on(globalThis, "beforeprint", () => { this.printing = true; this.refresh(); });
        on(globalThis, "afterprint", () => { this.printing = false; this.refresh(); });
        on(globalThis, "hashchange", () => { if (this.readAddress()) this.later(); });
        new ResizeObserver(() => this.later()).observe(place);
    }

    // --- state ---

    // Sets some of the state. done: a step that can be undone; false while something is dragged.
    change(some, done = true) {
        if (!this.before) this.before = { ...this.state };
        Object.assign(this.state, some);
        if (done) this.settle();
        this.later();
    }

    settle() {
        if (this.before && toText(this.before, DEFAULTS) !== toText(this.state, DEFAULTS)) {
            this.past.push(this.before);
            if (this.past.length > REMEMBERED) this.past.shift();
            this.future = [];
        }
        this.before = null;
    }

    // From one history to the other.
    travel(from, to) {
        if (!from.length) return;
        to.push({ ...this.state });
        this.state = from.pop();
        this.before = null;
        this.later();
    }

    // What the address holds: the state, then each pin.
    get address() {
        return this.key + [this.state, ...this.pins.map((pin) => pin.state)].map((s) => toText(s, this.usual)).join("|");
    }

    readAddress() {
        const text = decodeURIComponent(globalThis.location?.hash.slice(1) ?? "");
        if (!text.startsWith(this.key) || text === this.written) return false;
        const [own, ...pinned] = text.slice(this.key.length).split("|");
        this.state = fromText(own, this.usual);
        this.pins = pinned.slice(0, MOST_PINS).map((part) => ({ state: fromText(part, this.usual) }));
        return true;
    }

    writeAddress() {
        clearTimeout(this.writing);
        this.writing = setTimeout(() => {
            const others = globalThis.location.hash.slice(1);
            if (!this.past.length && !this.pins.length && !others.startsWith(this.key)) return;
            this.written = this.address;
            try {
                globalThis.history.replaceState(null, "", `#${this.written}`);
            } catch {
                // a page in a frame has no address of its own
            }
        }, 250);
    }

    // --- what is there ---

    build() {
        const knobs = (names) => names.map((name) => this.knob(name).element);
        this.knobs = {};
        this.plots = {};
        const process = h("fieldset.lbt-card", {}, h("legend", {}, "Process"), this.formula = h("p.lbt-formula"));
        const { given, usual } = this, boxes = h("div.lbt-row"), folded = (title, names, open) => h("details", { open }, h("summary", {}, title), ...knobs(names));
        process.append(...knobs(given ? ["K", "L"] : ["K", "T1", "T2", "L"]));
        if (!given) {
            boxes.append(this.integrating = this.check("integrates", "integrating"));
            process.append(folded("a third lag, a zero", ["T3", "Tz"], Boolean(usual.T3 || usual.Tz)));
        }
        if (this.data.record) boxes.append(this.toggle("the record behind", false, (on) => { this.view.record = on; this.later(); }));
        process.append(...knobs(["uL"]), folded("if gain and lags are others", given ? ["uK"] : ["uK", "uT"], Boolean(usual.uK || usual.uT)),
            folded("a sine on the measurement", ["wave", "freq"], Boolean(usual.wave)), boxes);

        this.formKnobs = h("div");
        this.form = h("select", { "aria-label": "form of the PID regulator", onchange: () => this.change({ form: this.form.value }) },
            ...Object.keys(FORMS).map((form) => h("option", { value: form }, form)));
        this.kind = this.tabs([["pid", "PID"], ["rst", "poles"]], "kind of the regulator", (kind) => this.change({ kind }));
        this.pid = h("div", {}, h("div.lbt-row", {}, "form", this.form), this.formKnobs, ...knobs(["b", "c"]));
        this.rst = h("div", {}, ...knobs(["speed", "damping", "rest", "observer"]));
        const limits = h("div.lbt-two", {}, ...knobs(["low", "high", "r", "d"]));
        this.windup = this.check("anti-windup", "windup");
        this.jump = this.check("from pin 1 at half-time", "jump");
        this.smooth = this.check("bumpless", "smooth");
        const regulator = h("fieldset.lbt-card", {}, h("legend", {}, "Regulator", this.kind), this.pid, this.rst, ...knobs(["h"]), limits, h("div.lbt-row", {}, this.windup, this.jump, this.smooth));
        const side = h("div.lbt-side", {}, process, regulator);

        const grid = h("div.lbt-grid", {}, side, this.plotCard("time", "Responses", { time: TimePlot }, true),
            this.plotCard("right", "", { nyquist: NyquistPlot, poles: PolesPlot }), this.plotCard("low", "", { bode: BodePlot, sensitivity: SensitivityPlot }));
        this.numbers = h("dl.lbt-numbers", { "aria-label": "numbers of the loop" });
        this.words = h("p.lbt-words", { role: "status", "aria-live": "polite" });
        this.note = h("p.lbt-note", { role: "status" });
        this.keyRow = h("div.lbt-key", { "aria-label": "pinned settings" });
        const doing = {
            pin: () => this.pin(), undo: () => this.travel(this.past, this.future), redo: () => this.travel(this.future, this.past),
            reset: () => this.change({ ...this.usual }), link: () => this.link(), TOML: () => this.save("toml"), JSON: () => this.save("json"),
            C: () => this.save("c"), ST: () => this.save("st"),
        };
        this.buttons = Object.fromEntries(Object.entries(texts.actions).map(([name, title]) => [name, h("button", { type: "button", title, onclick: doing[name] }, name)]));
        const actions = h("div.lbt-row", { role: "group", "aria-label": "actions" }, ...Object.values(this.buttons));
        const foot = h("div.lbt-foot", {}, this.numbers, this.words);
        this.root = h("section.lbt", { "aria-label": "interactive tuner", onkeydown: (event) => this.shortcut(event) }, grid, this.ruleCard(), foot, h("div.lbt-bar", {}, this.keyRow, actions), this.note);
        this.place.replaceChildren(this.root);
    }

    knob(name) {
        const knob = new Knob(name, this.valueOf(name), (key, value, done) => this.set(key, value, done));
        this.knobs[name] = knob;
        return knob;
    }

    valueOf(name) {
        for (const form of Object.values(FORMS)) if (form.knobs.includes(name)) return form.read(this.state)?.[name] ?? this.state.Kc;
        const around = { h: this.scale / 20, wave: this.state.r / 5, closed: this.scale, w: 2 / this.scale, speed: this.state.speed, T2: this.state.T1, T3: this.state.T1, Tz: this.state.T1 };
        return this.state[name] || around[name] || 1;
    }

    // What the plots of time show; for who cannot see it.
    get run() {
        return this.result.run;
    }

    get scale() {
        return processTime(processOf(this.state, this.given));
    }

    // A knob's value into the state; those of a form through it.
    set(name, value, done) {
        const form = FORMS[this.state.form];
        if (!form.knobs.includes(name)) {
            this.change({ [name]: value }, done);
            return;
        }
        this.change(form.write({ ...form.read(this.state), [name]: value }, this.state), done);
    }

    check(label, name) {
        const box = this.toggle(label, this.state[name], (on) => this.change({ [name]: on }));
        box.show = () => { box.firstChild.checked = this.state[name]; };
        return box;
    }

    toggle(label, on, change) {
        const box = h("input", { type: "checkbox", onchange: () => change(box.checked) });
        box.checked = on;
        return h("label.lbt-check", {}, box, label);
    }

    tabs(options, label, choose) {
        const group = h("span.lbt-tabs", { role: "group", "aria-label": label });
        for (const [value, text] of options) group.append(h("button", { type: "button", "data-value": value, onclick: () => choose(value) }, text));
        group.show = (chosen) => { for (const button of group.children) button.setAttribute("aria-pressed", String(button.dataset.value === chosen)); };
        return group;
    }

    plotCard(name, title, kinds, times = false) {
        const canvas = h("canvas", { role: "img", tabindex: -1 }), options = Object.keys(kinds), head = h("div.lbt-title", {}, title);
        const plots = Object.fromEntries(options.map((kind) => [kind, new kinds[kind](canvas)]));
        this.plots[name] = { canvas, plots };
        if (options.length > 1) {
            const tabs = this.tabs(options.map((kind) => [kind, kind[0].toUpperCase() + kind.slice(1)]), "plot", (kind) => { this.view[name] = kind; this.later(); });
            this.plots[name].tabs = tabs;
            head.append(tabs);
            tabs.style.marginLeft = "0";
        }
        this.drags(name, canvas);
        return h(times ? "div.lbt-card.lbt-plot.lbt-times" : "div.lbt-card.lbt-plot", {}, head, canvas);
    }

    ruleCard() {
        this.chips = ["P", "PI", "PID"].map((action) => {
            const chips = rules.filter((rule) => rule.action === action).map((rule) => {
                const label = rule.title.replace(/, (P|PI|PID)$/, "").replace("Ziegler-Nichols", "ZN").replace("Chien-Hrones-Reswick", "CHR");
                const title = [rule.aim, ...(rule.equations ?? []), rule.source].join("\n");
                const chip = h("button", { type: "button", title, "data-rule": rule.name, onclick: () => this.useRule(rule) }, label);
                chip.rule = rule;
                return chip;
            });
            return h("div.lbt-chips", { role: "group", "aria-label": `rules for ${action}` }, h("span", {}, action), ...chips);
        });
        this.more = this.toggle(say("more"), false, () => this.showRules());
        const wishes = h("div.lbt-wishes", {}, ...["closed", "margin", "w", "zeta"].map((name) => this.knob(name).element), this.more);
        return h("fieldset.lbt-card.lbt-rules", {}, h("legend", {}, "Rules"), ...this.chips, wishes);
    }

    showRules() {
        const process = processOf(this.state, this.given), all = this.more.firstChild.checked;
        for (const row of this.chips) for (const chip of row.children) if (chip.rule) chip.hidden = !all && !fits(chip.rule, process);
    }

    useRule(rule) {
        const { state } = this, w = state.w || this.result.margins?.gainCrossovers[0]?.w ?? this.result.loop?.gainCrossovers?.[0] ?? 0;
        try {
            const found = settingsBy(rule, processOf(state, this.given), { ...state, w });
            const N = found.Tf ? found.Td / found.Tf : state.N;
            this.change({ kind: "pid", Kc: found.K, Ti: found.Ti, Td: found.Td, N, b: found.b, c: 0, form: state.form === "series" ? "standard" : state.form });
            const mind = found.notes.length ? ` Mind: ${found.notes.join("; ")}.` : "";
            this.say(`${rule.title}: K ${shown(found.K, 4)}, Ti ${shown(found.Ti, 4)} s, Td ${shown(found.Td, 4)} s, b ${found.b}. ${rule.source}.${mind}`);
        } catch (error) {
            this.say(`${rule.title} does not apply: ${error.message}.`);
        }
    }

    say(text) {
        this.note.textContent = text;
    }

    // --- pins, files, keys ---

    pin() {
        if (this.pins.length >= MOST_PINS) this.pins.shift();
        this.pins.push({ state: { ...this.state } });
        this.later();
    }

    link() {
        this.written = this.address;
        globalThis.history.replaceState(null, "", `#${this.written}`);
        const { href } = globalThis.location;
        const copied = globalThis.navigator.clipboard?.writeText(href);
        (copied ?? Promise.reject()).then(() => this.say(say("copied")), () => this.say(say("address")));
    }

    save(kind) {
        const { state, given } = this, interval = this.result.h || chosenInterval(state, this.scale, state.L), name = this.data.name || "pid";
        if (kind === "toml") {
            const text = modelToml(state, given);
            if (text === null) this.say(say("model"));
            else download("process.toml", text);
            return;
        }
        if (kind === "json") {
            download("regulator.json", regulatorJson(state, given, interval, name, this.result.placed));
            return;
        }
        if (this.result.placed) {
            this.say(say("rst"));
            return;
        }
        const texts = programTexts(programSettings(state, interval));
        for (const [file, text] of Object.entries(texts)) if (kind === "st" ? file.endsWith(".st") : !file.endsWith(".st")) download(file, text);
        if (!state.h) this.say(say("interval", interval));
    }

    shortcut(event) {
        if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
        const key = event.key.toLowerCase();
        if (key === "z" && !event.shiftKey) this.travel(this.past, this.future);
        else if (key === "y" || (key === "z" && event.shiftKey)) this.travel(this.future, this.past);
        else return;
        event.preventDefault();
    }

    // --- drags ---

    // The plot that is shown in a card.
    plotOf(name) {
        const { plots } = this.plots[name], kinds = Object.keys(plots);
        return plots[kinds.length > 1 ? this.view[name] : kinds[0]];
    }

    drags(name, canvas) {
        const plotOf = () => this.plotOf(name);
        const at = (event) => {
            const box = canvas.getBoundingClientRect();
            return [event.clientX - box.left, event.clientY - box.top];
        };
        let move = null;
        on(canvas, "pointerdown", (event) => {
            if (!this.drawn) return;
            move = plotOf().grab(...at(event), this.drawn);
            if (!move) return;
            this.drawn.hold = plotOf().size;
            this.holding = plotOf().size;
            canvas.setPointerCapture(event.pointerId);
            event.preventDefault();
        });
        on(canvas, "pointermove", (event) => {
            if (move) {
                const some = move(...at(event));
                if (some) this.change(some, false);
                return;
            }
            if (event.pointerType === "mouse" && this.drawn) canvas.classList.toggle("lbt-grabs", Boolean(plotOf().grab(...at(event), this.drawn)));
        });
        const end = () => {
            if (!move) return;
            move = null;
            this.holding = undefined;
            this.settle();
            this.later();
        };
        on(canvas, "pointerup", end);
        on(canvas, "pointercancel", end);
    }

    // --- drawing ---

    later() {
        if (this.waiting) return;
        this.waiting = true;
        requestAnimationFrame(() => {
            this.waiting = false;
            this.refresh();
        });
    }

    refresh() {
        const begun = performance.now(), { state, given } = this;
        this.colours = this.dark?.matches && !this.printing ? DARK : LIGHT;
        const before = this.pins[0]?.state, text = toText(state, DEFAULTS) + (state.jump && before ? toText(before, DEFAULTS) : "");
        if (this.evaluated !== text) {
            this.result = evaluate(state, given, {}, { before });
            this.evaluated = text;
            this.band = null;
            this.worst = undefined;
            if (this.result.stable) this.lastStable = { ...state };
            clearTimeout(this.banding);
        }
        for (const pin of this.pins) pin.result ??= evaluate(pin.state, given);
        this.showKnobs();
        this.draw();
        this.tell();
        this.writeAddress();
        this.times.push(performance.now() - begun);
        if (this.times.length > 2000) this.times.shift();
        if (!this.band && this.result.stable) this.bandSoon(performance.now() - begun);
        for (const listener of this.listeners) listener(this);
    }

    // The band of what is uncertain: at once where there is time left, else when nothing moves.
    bandSoon(spent) {
        clearTimeout(this.banding);
        const { circle, margins } = this.result, list = variants(this.state).slice(0, 4);
        const run = () => {
            const begun = performance.now();
            if (circle) margins.delay = delayMargin(this.state, this.result);
            const same = { placed: this.result.placed, before: this.result.before };
            const results = list.map((change) => evaluate(this.state, this.given, change, same)), { t } = this.result.run;
            const courses = results.filter((r) => r.run && r.stable).map((r) => resampled(r.run, t));
            this.band = { t, low: Float64Array.from(this.result.run.y), high: Float64Array.from(this.result.run.y) };
            for (const course of courses) course.forEach((y, i) => { this.band.low[i] = Math.min(this.band.low[i], y); this.band.high[i] = Math.max(this.band.high[i], y); });
            const longer = this.state.uL > 0 && this.state.L > 0 ? evaluate(this.state, this.given, { L: this.state.L * (1 + this.state.uL / 100) }, same) : null;
            this.longer = longer;
            this.worst = longer ? (longer.stable ? longer.margins.Ms.value : null) : undefined;
            this.cost = performance.now() - begun;
            this.draw();
            this.tell();
        };
        if (spent + (this.cost ?? PATIENCE) < PATIENCE) run();
        else this.banding = setTimeout(run, this.before ? 60 : 0);
    }

    showKnobs() {
        const { state } = this, form = FORMS[state.form], values = form.read(state);
        if (values === null) {
            this.say(say("series"));
            state.form = "standard";
            this.showKnobs();
            return;
        }
        const wanted = form.knobs.join();
        if (this.formShown !== wanted) {
            this.formShown = wanted;
            this.formKnobs.replaceChildren(...form.knobs.map((name) => (this.knobs[name] ?? this.knob(name)).element));
        }
        for (const [name, knob] of Object.entries(this.knobs)) {
            if (name in state) knob.show(state[name]);
            else if (name in values) knob.show(values[name]);
        }
        if (this.knobs.N && form.knobs.includes("N")) this.knobs.N.show(values.N);
        this.form.value = state.form;
        this.form.options[2].disabled = !inSeries(state);
        this.pid.hidden = state.kind !== "pid";
        this.rst.hidden = state.kind !== "rst";
        this.kind.show(state.kind);
        this.integrating?.show();
        this.windup.show();
        this.windup.hidden = state.low === null && state.high === null;
        this.jump.show();
        this.smooth.show();
        this.jump.hidden = !this.pins.length || state.kind === "rst";
        this.smooth.hidden = this.jump.hidden || !state.jump;
        if (state.kind === "rst" && this.kindShown !== "rst") this.view.right = "poles";
        this.kindShown = state.kind;
        this.formula.replaceChildren(this.data.formula ?? formulaOf(state));
        const { process } = this.result, integrates = process.den.at(-1) === 0;
        if (this.rulesFor !== integrates) {
            this.rulesFor = integrates;
            this.showRules();
        }
        this.buttons.undo.disabled = !this.past.length;
        this.buttons.redo.disabled = !this.future.length;
    }

    draw() {
        const { colours } = this, current = { colour: colours.current, width: 2.2 };
        const pins = this.pins.map((pin, i) => ({ result: pin.result, style: { colour: colours.pins[i], dash: PIN_DASHES[i], width: 1.8 } }));
        const extra = this.longer && this.band && this.longer.at ? [{ result: this.longer, style: { colour: colours.band, width: 5 } }] : [];
        this.drawn = {
            s: this.state, main: { result: this.result, style: current }, pins, band: this.band, names: this.names, colours, extra,
            record: this.view.record ? this.replayed() : null, hold: this.holding,
        };
        for (const [name, { plots, tabs, canvas }] of Object.entries(this.plots)) {
            const kind = tabs ? this.view[name] : Object.keys(plots)[0];
            tabs?.show(kind);
            plots[kind].draw(this.drawn);
            canvas.setAttribute("aria-label", say("plot", kind));
        }
    }

    replayed() {
        const { t, u, y, u0, y0 } = this.data.record, text = `${toText(this.state, DEFAULTS)}`;
        if (this.replay?.text !== text) {
            const model = Array.from(replay(processOf(this.state, this.given), t, u.map((x) => x - u0)), (x) => x + y0);
            this.replay = { text, t, u, y, model, fit: fitOf(y, model) };
        }
        return this.replay;
    }

    tell() {
        const { result, state } = this, words = summary(state, result, this.worst);
        this.words.classList.toggle("lbt-alarm", !result.stable);
        const back = !result.stable && this.lastStable
            ? h("button", { type: "button", onclick: () => this.change({ ...this.lastStable }) }, say("back")) : null;
        if (this.told !== words) {
            this.told = words;
            this.words.replaceChildren(h("span", {}, words), ...(back ? [back] : []));
        }
        const rows = numbersOf(result), text = JSON.stringify(rows);
        if (text !== this.rowsTold) {
            this.rowsTold = text;
            this.numbers.hidden = !rows.length;
            this.numbers.replaceChildren(...rows.map(([label, value, about]) => h("div", { title: about }, h("dt", {}, label), h("dd", { "data-number": label }, value))));
        }
        const key = this.pins.map((pin) => `${toText(pin.state, DEFAULTS)}${pin.result?.margins?.Ms.value}`).join() + this.colours.ink;
        if (key !== this.keyTold) {
            this.keyTold = key;
            this.keyRow.replaceChildren(...this.pins.map((pin, i) => this.pinButton(pin, i)));
        }
    }

    pinButton(pin, i) {
        const Ms = pin.result?.margins?.Ms.value, line = document.createElementNS("http://www.w3.org/2000/svg", "svg"), stroke = document.createElementNS("http://www.w3.org/2000/svg", "path");
        put(stroke, { d: "M0 4H26", stroke: this.colours.pins[i], "stroke-width": 2.4, "stroke-dasharray": ["7 4", "2 3", "8 3 2 3"][i] });
        line.append(stroke);
        const words = Ms ? `Ms ${shown(Ms)}` : "unstable";
        return h("span", {},
            h("button", { type: "button", title: "go to this setting", onclick: () => this.change({ ...pin.state }) }, line, words),
            h("button", { type: "button", "aria-label": `remove pin ${i + 1}`, title: "remove", onclick: () => { this.pins.splice(i, 1); this.later(); } }, "×"));
    }
}

// A run at other times: stairs and lines alike by the value before.
function resampled({ t, y }, times) {
    let i = 0;
    return times.map((x) => {
        while (i < t.length - 2 && t[i + 1] <= x) i += 1;
        const share = Math.max(0, Math.min(1, (x - t[i]) / (t[i + 1] - t[i] || 1)));
        return y[i] + share * (y[i + 1] - y[i]);
    });
}

const MATHML = "http://www.w3.org/1998/Math/MathML";

function m(tag, ...children) {
    const element = document.createElementNS(MATHML, tag);
    element.append(...children);
    return element;
}

const number = (x) => m("mn", shown(x, 4));

// The transfer function as a formula.
function formulaOf(s) {
    const lag = (T) => (T === 0 ? [] : [m("mo", "("), m("mn", "1"), m("mo", T < 0 ? "−" : "+"), ...(Math.abs(T) === 1 ? [] : [number(Math.abs(T))]), m("mi", "s"), m("mo", ")")]);
    const below = [...(s.integrating ? [m("mi", "s")] : []), ...lag(s.T1), ...lag(s.T2), ...lag(s.T3)];
    const above = m("mrow", number(s.K), ...lag(s.Tz)), late = s.L ? [m("msup", m("mi", "e"), m("mrow", m("mo", "−"), number(s.L), m("mi", "s")))] : [];
    const math = m("math", m("mi", "G"), m("mo", "="), below.length ? m("mfrac", above, m("mrow", ...below)) : above, ...late);
    math.setAttribute("displaystyle", "true");
    return math;
}
