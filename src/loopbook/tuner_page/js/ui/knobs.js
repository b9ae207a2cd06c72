// A knob: a label, a slider that is logarithmic where the quantity is, and the number itself, to be typed. words.json says
// of each quantity its label, unit, what it is, whether 0 or infinity stand at an end of the slider (zero, infinite),
// whether it may be negative (signed), has a number alone (plain) that may be empty, and the range of a linear one.

import { texts } from "../core/texts.js";
import { h } from "./elements.js";
import { shown, typed } from "./state.js";

const STEPS = 400;

export class Knob {
    // change(name, value, done): done is false while the slider moves.
    constructor(name, around, change) {
        this.name = name;
        this.about = texts.quantities[name];
        this.change = change;
        const { label, unit, about, linear, plain } = this.about, id = `lbt-${name}-${(Knob.made = (Knob.made ?? 0) + 1)}`;
        const [low, high] = linear ?? this.rangeAround(around);
        this.low = low;
        this.high = high;
        this.number = h("input.lbt-number", {
            id, type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false", title: about, "data-knob": name,
            onchange: () => this.typedIn(), onkeydown: (event) => this.key(event), onfocus: () => this.number.select(),
        });
        this.slider = plain ? null : h("input.lbt-slider", {
            type: "range", min: 0, max: STEPS, step: 1, title: about, "data-slider": name,
            "aria-label": `${about.split(";")[0]}${unit ? `, ${unit}` : ""}`,
            oninput: () => this.moved(false), onchange: () => this.moved(true),
        });
        this.element = h(
            "div.lbt-knob", {}, h("label", { for: id, title: about }, label), this.slider ?? h("span.lbt-gap"),
            this.number, h("span.lbt-unit", {}, unit ?? ""),
        );
    }

    rangeAround(around) {
        if (this.about.low) return [this.about.low, this.about.high];
        const middle = Math.abs(Number.isFinite(around) && around ? around : this.about.usual ?? 1);
        return [10 ** (Math.log10(middle) - 1.3), 10 ** (Math.log10(middle) + 1.3)];
    }

    // The slider's range goes along where a value leaves it.
    show(value) {
        const { linear, zero, infinite, empty } = this.about;
        this.value = value;
        if (document.activeElement !== this.number) {
            this.number.value = empty && value === null ? "" : shown(value, 4).replace("–", "");
            this.number.classList.remove("lbt-wrong");
        }
        if (!this.slider) return;
        const size = Math.abs(value);
        if (!linear && value && Number.isFinite(value)) {
            while (size > this.high * 1.0001) this.high *= 10;
            while (size < this.low * 0.9999) this.low /= 10;
        }
        let at;
        if (linear) at = (value - this.low) / (this.high - this.low) * STEPS;
        else if (zero && value === 0) at = 0;
        else if (infinite && value === Infinity) at = STEPS;
        else at = this.first + (Math.log(size / this.low) / Math.log(this.high / this.low)) * (this.last - this.first);
        this.slider.value = Math.round(Math.max(0, Math.min(STEPS, at)));
        this.slider.setAttribute("aria-valuetext", `${shown(value, 4)} ${this.about.unit ?? ""}`);
        this.slider.style.setProperty("--share", `${100 * Math.max(0, Math.min(STEPS, at)) / STEPS}%`);
    }

    get first() { return this.about.zero ? 8 : 0; }

    get last() { return this.about.infinite ? STEPS - 8 : STEPS; }

    moved(done) {
        const at = Number(this.slider.value), { linear, zero, infinite } = this.about;
        let value;
        if (linear) value = this.low + (this.high - this.low) * at / STEPS;
        else if (zero && at < this.first) value = 0;
        else if (infinite && at > this.last) value = Infinity;
        else value = this.low * (this.high / this.low) ** ((at - this.first) / (this.last - this.first));
        if (Number.isFinite(value)) value = Number(value.toPrecision(3));
        const sign = this.about.signed && this.value < 0 ? -1 : 1;
        this.change(this.name, sign * value, done);
    }

    typedIn() {
        const text = this.number.value, value = this.about.empty && text.trim() === "" ? null : typed(text);
        if (value !== null && !this.allowed(value)) {
            this.number.classList.add("lbt-wrong");
            this.number.setAttribute("aria-invalid", "true");
            return;
        }
        this.number.removeAttribute("aria-invalid");
        this.number.classList.remove("lbt-wrong");
        this.change(this.name, value, true);
    }

    allowed(value) {
        const { signed, zero, infinite, linear, plain } = this.about;
        if (Number.isNaN(value) || (value === Infinity && !infinite) || value === -Infinity) return false;
        if (plain) return true;
        if (linear) return value >= 0;
        if (value === 0) return Boolean(zero);
        return value > 0 || Boolean(signed);
    }

    // Arrows in the number move it by two per cent, with shift by twenty; Escape takes back what was typed.
    key(event) {
        const way = { ArrowUp: 1, ArrowDown: -1 }[event.key];
        if (event.key === "Escape") {
            this.number.blur();
            this.show(this.value);
        }
        if (event.key === "Enter") this.typedIn();
        if (!way || this.value === null || !Number.isFinite(this.value)) return;
        event.preventDefault();
        const by = event.shiftKey ? 1.2 : 1.02, { linear } = this.about;
        const value = linear ? this.value + way * (linear[1] - linear[0]) / (event.shiftKey ? 10 : 100) : this.value * by ** way;
        this.change(this.name, Number((linear ? Math.max(0, value) : value).toPrecision(4)), true);
        this.number.value = shown(this.value, 4);
    }
}
