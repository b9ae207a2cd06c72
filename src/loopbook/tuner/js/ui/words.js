// What the page says in words, for those who hear it, and for those who want to know what the numbers mean.

import { shown } from "./state.js";

// One or two sentences on a result; worst: Ms at the end of the dead time's uncertainty, null where it is unstable.
export function summary(s, result, worst) {
    if (result.error) return `This setting gives no loop: ${result.error}.`;
    if (!result.stable) {
        const count = result.count;
        const many = count === null ? "it stands on the border of stability" : count === Infinity
            ? "its gain at high frequencies is too large for a dead time: infinitely many poles to the right"
            : `${count} pole${count === 1 ? "" : "s"} in the right half plane`;
        return `Unstable: ${result.h && count ? `${count} pole${count === 1 ? "" : "s"} outside the unit circle` : many}. The response grows, so there is no settling time and there are no margins.`;
    }
    const { Ms } = result.margins, grade = Ms.value < 1.3 ? "very robust" : Ms.value < 1.5 ? "robust" : Ms.value < 1.8 ? "moderately robust" : Ms.value < 2.1 ? "lively" : "fragile";
    const parts = [`Stable and ${grade}: Ms ${shown(Ms.value)}.`];
    if (s.uL > 0 && s.L > 0 && worst !== undefined) {
        parts.push(worst === null
            ? `With ${shown(s.uL)} % more dead time the loop is unstable.`
            : `${shown(s.uL)} % more dead time makes Ms ${shown(worst)}.`);
    }
    if (result.margins.gainLow > 0) {
        parts.push(`Conditionally stable: it holds for ${shown(result.margins.gainLow)} to ${shown(result.margins.gain)} times the gain.`);
    }
    if (result.limited && result.run?.stairs && !result.h) parts.push(`Limits: the program runs every ${shown(result.run.h)} s.`);
    return parts.join(" ");
}

// The numbers: [label, text, what it is].
export function numbersOf(result) {
    const m = result.margins, n = result.numbers;
    if (!m || !n) return [];
    const pole = result.poles?.[0], damping = pole ? -pole[0] / Math.hypot(...pole) : null;
    const poles = pole ? `${shown(pole[0])}${pole[1] ? ` ± ${shown(pole[1])}j` : ""}` : "–";
    return [
        ["Ms", shown(m.Ms.value, 4), "largest sensitivity; the inverse of the smallest distance from −1"],
        ["Mt", shown(m.Mt.value, 4), "largest complementary sensitivity"],
        ["gain margin", `${shown(m.gainLow)} … ${shown(m.gain)}`, "the loop is stable for gains between these factors"],
        ["phase margin", `${shown(m.phase)}°`, "smallest at all crossovers"],
        ["delay margin", m.delay === Infinity ? "∞" : `${shown(m.delay)} s`, "the dead time that can be added"],
        ["overshoot", n.overshoot === null ? "–" : `${shown(n.overshoot)} %`, "of the set-point's step"],
        ["settling", n.settling === null ? "–" : `${shown(n.settling)} s`, "into 2 % of the set-point's step"],
        ["IAE load", n.iae === null ? "∞" : shown(n.iae), "integral of the absolute error after a unit load step"],
        ["noise gain", shown(result.noise), "of the regulator at high frequencies"],
        ["variation of u", shown(n.variation), "all movements of the input after the set-point's step, added up"],
        ["slowest pole", poles, damping === null ? "" : `rad/s; damping ${shown(damping)}`],
    ];
}
