// What the page says in words, for those who hear it, and for those who want to know what the numbers mean.

import { texts } from "../core/texts.js";
import { shown } from "./state.js";

// A sentence of words.json with its places filled.
export function say(name, ...values) {
    let i = 0;
    return texts.says[name].replace(/\{\}/g, () => {
        i += 1;
        return typeof values[i - 1] === "number" ? shown(values[i - 1]) : values[i - 1];
    });
}

const GRADES = [[1.3, "very robust"], [1.5, "robust"], [1.8, "moderately robust"], [2.1, "lively"], [Infinity, "fragile"]];

// One or two sentences on a result; worst: Ms at the end of the dead time's uncertainty, null where it is unstable.
export function summary(s, result, worst) {
    const { count } = result;
    if (result.error) return say("none", result.error);
    if (!result.stable) {
        const poles = `${count} pole${count === 1 ? "" : "s"}`;
        if (count === null) return say("unstable", say("border"));
        if (count === Infinity) return say("unstable", say("neutral"));
        return say("unstable", say(result.circle ? "circle" : "plane", poles));
    }
    const { Ms, gain, gainLow } = result.margins, [, grade] = GRADES.find(([most]) => Ms.value < most);
    const parts = [`Stable and ${grade}: Ms ${shown(Ms.value)}.`];
    if (s.uL > 0 && s.L > 0 && worst !== undefined) parts.push(worst === null ? say("lost", s.uL) : say("longer", s.uL, worst));
    if (gainLow > 0) parts.push(say("conditional", gainLow, gain));
    if (s.wave && result.circle && 2 * s.freq * result.h > 1) {
        parts.push(say("alias", result.h, s.freq, Math.abs(s.freq - Math.round(s.freq * result.h) / result.h)));
    }
    if (result.limited && result.run?.stairs && !result.circle) parts.push(say("limits", result.run.h));
    return parts.join(" ");
}

const withUnit = (value, unit, none = "–") => (value === undefined ? "…" : value === null ? none : value === Infinity ? "∞" : `${shown(value)}${unit}`);

// The numbers: [label, text, what it is].
export function numbersOf(result) {
    const m = result.margins, n = result.numbers;
    if (!m || !n) return [];
    const pole = result.poles?.[0], poles = pole ? `${shown(pole[0])}${pole[1] ? ` ± ${shown(pole[1])}j` : ""}` : "–";
    const values = [
        shown(m.Ms.value, 4), shown(m.Mt.value, 4), `${shown(m.gainLow)} … ${shown(m.gain)}`, withUnit(m.phase, "°"), withUnit(m.delay, " s"),
        withUnit(n.overshoot, " %"), withUnit(n.settling, " s"), withUnit(n.iae, "", "∞"), shown(result.noise), shown(n.variation), poles,
    ];
    return texts.numbers.map(([label, about], i) => [label, values[i], about]);
}
