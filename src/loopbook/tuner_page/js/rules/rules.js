// Every rule of the registry: settings for a process, or why there are none.

import { arg } from "../core/complex.js";
import { byAngles, published } from "./formulas.js";
import { gainSign, integrates, magnitudeOf, quantities, responseAt, RuleDoesNotApply, turned180 } from "./knowledge.js";
import { migo } from "./migo.js";

const FILTER = 10;

const computedRule = (name, title, action, source, settings) => ({
    name, title, action, takes: "process", integrating: null, source, year: 1998, aim: "load, a given robustness M", settings,
});

const MIGO_SOURCE = "Åström, Panagopoulos, Hägglund (1998, 2002); pid-report, section 5.3";

// Rules that an algorithm computes; wish: {closed, w, margin}.
const computed = [
    ...["PI", "PID"].map((action) => computedRule(
        `migo-${action.toLowerCase()}`, `MIGO, ${action}`, action, MIGO_SOURCE, (process) => migo(process, action),
    )),
    {
        ...computedRule(
            "phase-margin-pid", "phase margin, PID", "PID",
            "a zero and a pole by their angles at the crossover frequency; double-tank, the fine-tuned PID",
            (process, wish) => angles(process, wish.w, wish.margin),
        ),
        year: null, aim: "a phase margin at a crossover frequency", asks: ["w"],
    },
];

export const rules = [...published, ...computed];

// A PID with the phase margin [degrees] at the crossover frequency w; one zero at 45 degrees, the pole at 0.6.
function angles(process, w, margin) {
    if (!w) throw new RuleDoesNotApply("the loop has no crossover frequency: give it a gain first");
    const radians = Math.PI / 180, zero = 45 * radians, pole = 0.6 * radians, [g] = responseAt({ ...process, delay: 0 }, w);
    const b = byAngles.lead(arg(g) - w * process.delay, margin * radians, zero, pole);
    if (!(b > 0 && b < Math.PI / 2)) {
        throw new RuleDoesNotApply(`a phase margin of ${margin.toPrecision(3)}° at ${w.toPrecision(3)} rad/s asks for more lead than a PID has, or for lag`);
    }
    const given = [w, 1 / magnitudeOf(process, w), zero, b, pole];
    const [P, I, D, N] = ["P", "I", "D", "N"].map((name) => byAngles[name](...given));
    if (!(P > 0 && I > 0 && D > 0)) throw new RuleDoesNotApply("it has no standard form: its gains differ in sign");
    return { K: P, Ti: P / I, Td: D / P, Tf: 1 / N, b: 1 };
}

// Text with {name} and {name:.3g}, filled in.
function filled(text, values) {
    return text.replace(/\{(\w+)(?::(?:\.(\d))?g)?\}/g, (_, name, digits) => String(Number(values[name].toPrecision(Number(digits ?? 6)))));
}

const sentence = ([, text, shows], q) => {
    const shown = Object.fromEntries(Object.entries(shows).map(([name, formula]) => [name, formula(q)]));
    return filled(text, { ...q, ...shown });
};

// {K, Ti, Td, Tf, b, notes, values} for a process {num, den, delay, lags}. Throws RuleDoesNotApply.
export function settingsBy(rule, process, wish = {}) {
    const sign = gainSign(process), upright = sign < 0 ? turned180(process) : process;
    const found = rule.settings ? { ...rule.settings(upright, wish), notes: [] } : byFormulas(rule, upright, wish);
    return { ...found, K: sign * found.K, Tf: found.Tf ?? (found.Td ? found.Td / FILTER : 0) };
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
        if (!(q[name] > 0)) throw new RuleDoesNotApply("it needs a wanted time constant of the closed loop");
    }
    if (rule.dead.some((name) => q[name] === 0)) throw new RuleDoesNotApply("without dead time its gain is infinite");
    for (const refusal of rule.refusals) if (refusal[0](q)) throw new RuleDoesNotApply(sentence(refusal, q));
    const K = rule.K(q), Ti = rule.Ti ? rule.Ti(q) : Infinity, Td = rule.Td ? rule.Td(q) : 0;
    if (!(K > 0 && K < Infinity && Ti > 0 && Td >= 0 && Td < Infinity)) throw new RuleDoesNotApply("it gives no regulator here");
    const notes = rule.cautions.filter((caution) => caution[0](q)).map((caution) => sentence(caution, q));
    return { K, Ti, Td, b: rule.b(q), notes, values: q };
}

// Is a rule meant for such a process, and no variant of another?
export const fits = (rule, process) => (
    !rule.variantOf && (rule.integrating === null || rule.integrating === integrates(process))
);
