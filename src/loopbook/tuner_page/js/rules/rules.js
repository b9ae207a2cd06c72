// Every rule of the registry: settings for a process, or why there are none.

import { arg } from "../core/complex.js";
import { texts } from "../core/texts.js";
import { allCautions, byAngles, gainsBy, published } from "./formulas.js";
import { gainSign, integrates, magnitudeOf, quantities, responseAt, RuleDoesNotApply, turned180 } from "./knowledge.js";
import { migo } from "./migo.js";

const FILTER = 10;
const EMPTY = { defaults: {}, refusals: [], cautions: [], dead: [], b: () => 1 };
const RADIANS = Math.PI / 180;

const phaseAt = (process, w) => arg(responseAt({ ...process, delay: 0 }, w)[0]) - w * process.delay;

const standard = ([P, I, D = 0]) => ({ K: P, Ti: P / I, Td: D / P, b: 1 });

// Rules that an algorithm computes; wish: {closed, w, margin, zeta}.
const computed = {
    "migo-pi": (process) => migo(process, "PI"),
    "migo-pid": (process) => migo(process, "PID"),
    "phase-margin-pi": (process, { w, margin }) => {
        const gains = gainsBy.margin(w, magnitudeOf(process, w), phaseAt(process, w), margin * RADIANS);
        if (!(gains[0] > 0 && gains[1] > 0)) {
            throw new RuleDoesNotApply(`a phase margin of ${margin.toPrecision(3)}° at ${w.toPrecision(3)} rad/s asks for lead, or for more lag than a PI controller has`);
        }
        return standard(gains);
    },
    // One zero at 45 degrees, the pole at 0.6.
    "phase-margin-pid": (process, { w, margin }) => {
        const zero = 45 * RADIANS, pole = 0.6 * RADIANS, b = byAngles.lead(phaseAt(process, w), margin * RADIANS, zero, pole);
        if (!(b > 0 && b < Math.PI / 2)) {
            throw new RuleDoesNotApply(`a phase margin of ${margin.toPrecision(3)}° at ${w.toPrecision(3)} rad/s asks for more lead than a PID has, or for lag`);
        }
        const given = [w, 1 / magnitudeOf(process, w), zero, b, pole];
        const [P, I, D, N] = ["P", "I", "D", "N"].map((name) => byAngles[name](...given));
        if (!(P > 0 && I > 0 && D > 0)) throw new RuleDoesNotApply("it has no standard form: its gains differ in sign");
        return { ...standard([P, I, D]), Tf: 1 / N };
    },
    "damping-pi": (process, wish) => byDamping(process, wish, "PI", 1),
    "damping-pid": (process, wish) => byDamping(process, wish, "PID", 2),
};

// The loop's poles at the natural frequency w with the damping zeta, a third one at -w.
function byDamping({ num, den, delay }, { w, zeta }, action, order) {
    if (delay) throw new RuleDoesNotApply("with dead time the loop has infinitely many poles: ask for a phase margin instead");
    if (num.length > 1 || den.length !== order + 1) throw new RuleDoesNotApply(`${action} takes a process of order ${order} without zeros`);
    const gains = gainsBy[action](num[0], ...den, w, zeta), [P, I, D = 0] = gains;
    if (!(P > 0 && I > 0 && D >= 0)) throw new RuleDoesNotApply("these poles need gains of both signs: ask for a faster loop");
    return standard(gains);
}

export const rules = texts.rules.map((words, i) => ({ ...EMPTY, ...words, ...(published[i] ?? { settings: computed[words.name] }) }));

// Text with {name} and {name:.3g}, filled in.
function filled(text, values) {
    return text.replace(/\{(\w+)(?::(?:\.(\d))?g)?\}/g, (_, name, digits) => String(Number(values[name].toPrecision(Number(digits ?? 6)))));
}

// The sentences of the cautions that hold.
const holding = (places, q) => places.map((place) => allCautions[place]).filter(([when]) => when(q)).map(([, sentence, shows]) => {
    const values = Object.fromEntries(Object.entries(shows).map(([name, formula]) => [name, formula(q)]));
    return filled(texts.sentences[sentence], { ...q, ...values });
});

// {K, Ti, Td, Tf, b, notes, values} for a process {num, den, delay, lags}. Throws RuleDoesNotApply.
export function settingsBy(rule, process, wish = {}) {
    const sign = gainSign(process), upright = sign < 0 ? turned180(process) : process;
    const found = rule.settings ? byAlgorithm(rule, upright, wish) : byFormulas(rule, upright, wish);
    return { ...found, K: sign * found.K, Tf: found.Tf ?? (found.Td ? found.Td / FILTER : 0) };
}

function byAlgorithm(rule, process, wish) {
    for (const name of rule.asks ?? []) if (!(wish[name] > 0)) throw new RuleDoesNotApply(texts.wishes[name]);
    return { ...rule.settings(process, wish), notes: [] };
}

function byFormulas(rule, process, wish) {
    const q = { ...quantities(rule.takes, process) };
    if (wish.closed) {
        q.closed = wish.closed;
        q.i = wish.closed / q.T;
    }
    for (const [name, formula] of Object.entries(rule.defaults)) q[name] ??= formula(q);
    if (rule.defaults.closed && q.closed === 0) throw new RuleDoesNotApply("without dead time its own closed-loop time is zero: give one");
    for (const name of rule.asks ?? []) {
        if (!(q[name] > 0)) throw new RuleDoesNotApply(texts.wishes.closed);
    }
    if (rule.dead.some((name) => q[name] === 0)) throw new RuleDoesNotApply("without dead time its gain is infinite");
    const [refused] = holding(rule.refusals, q);
    if (refused) throw new RuleDoesNotApply(refused);
    const K = rule.K(q), Ti = rule.Ti ? rule.Ti(q) : Infinity, Td = rule.Td ? rule.Td(q) : 0;
    if (!(K > 0 && K < Infinity && Ti > 0 && Td >= 0 && Td < Infinity)) throw new RuleDoesNotApply("it gives no regulator here");
    const notes = holding(rule.cautions, q);
    return { K, Ti, Td, b: rule.b(q), notes, values: q };
}

// Is a rule meant for such a process, and no variant of another?
export const fits = (rule, process) => (
    !rule.variantOf && (rule.integrating === null || rule.integrating === integrates(process))
);
