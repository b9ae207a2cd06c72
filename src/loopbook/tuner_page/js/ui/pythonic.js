// Numbers and texts as Python writes them: programs with their numbers, models and regulators to be read by the command.

import { texts } from "../core/texts.js";


const UNLIMITED = 3e38;

// repr(float): the shortest digits that read back.
export function pythonNumber(x) {
    if (Object.is(x, -0)) return "-0.0";
    const [mantissa, exponent] = x.toExponential().split("e"), power = Number(exponent);
    if (power >= 16 || power < -4) {
        const sign = power < 0 ? "-" : "+", digits = String(Math.abs(power)).padStart(2, "0");
        return `${mantissa}e${sign}${digits}`;
    }
    const text = power >= 0 || x === 0 ? x.toFixed(Math.max(0, mantissa.replace("-", "").replace(".", "").length - 1 - power)) : smallNumber(mantissa, power);
    return text.includes(".") ? text : `${text}.0`;
}

function smallNumber(mantissa, power) {
    const sign = mantissa.startsWith("-") ? "-" : "", digits = mantissa.replace("-", "").replace(".", "");
    return `${sign}0.${"0".repeat(-power - 1)}${digits}`;
}

// format(x, "g"): six digits.
function sixDigits(x) {
    const [mantissa, power] = x.toExponential(5).split("e").map(Number);
    if (power >= -4 && power < 6) return String(Number(x.toPrecision(6)));
    return `${mantissa}e${power < 0 ? "-" : "+"}${String(Math.abs(power)).padStart(2, "0")}`;
}

// A literal of C (c), of Structured Text (s), plain (p), or with six digits (g).
function literal(form, value) {
    if (form === "g") return sixDigits(value);
    const finite = Number.isFinite(value) ? value : Math.sign(value) * UNLIMITED, text = pythonNumber(Math.abs(finite));
    const sign = finite < 0 ? "-" : "";
    if (form === "c") return `${sign}(lb_real)${text}`;
    if (form === "s") return `${sign}REAL#${inStructuredText(text)}`;
    return sign + text;
}

function inStructuredText(text) {
    const [digits, power] = text.split("e");
    if (power === undefined) return text;
    return `${digits.includes(".") ? digits : `${digits}.0`}E${Number(power)}`;
}

// The settings of the program by the names of its law.
export function programSettings(s, h) {
    const integral = Number.isFinite(s.Ti), Ti = integral ? s.Ti : 0, Tf = s.Td && Number.isFinite(s.N) ? s.Td / s.N : 0;
    const tracking = s.Td ? Math.sqrt(Ti * s.Td) : Ti / 2;
    return {
        K: s.Kc, Ti, Td: s.Td, Tf, b: s.b, c: s.c, Tt: s.windup && integral ? Math.max(tracking, h) : Infinity, h,
        u_low: s.low ?? -Infinity, u_high: s.high ?? Infinity, rate: 0,
    };
}

// The texts of the C and Structured Text programs by file name.
export function programTexts(settings) {
    const filledIn = (text) => text.replace(/\u0002(.)(\w+)\u0003/g, (_, form, key) => literal(form, settings[key]));
    return Object.fromEntries(Object.entries(texts.programs).map(([name, text]) => [name, filledIn(text)]));
}

// A sampling interval for a program of a loop that has none: short against its filter and what it does.
export function chosenInterval(s, time, delay) {
    const fast = Math.min(time / 20, ...(delay ? [delay / 4] : []), ...(s.Td && Number.isFinite(s.N) ? [s.Td / s.N] : []));
    return Number(fast.toPrecision(1));
}

// What `loopbook design` reads; null for a process that its model file cannot hold.
export function modelToml(s, given) {
    const lags = [s.T1, s.T2, s.T3].filter((T) => T !== 0);
    if (given || s.Tz || lags.some((T) => T < 0) || (!lags.length && !s.integrating)) return null;
    return [
        "# A process for loopbook design, from the tuner's page; times are in seconds.", "[process]",
        `gain = ${pythonNumber(s.K)}`, `time_constants = [${lags.map(pythonNumber).join(", ")}]`,
        `delay = ${pythonNumber(s.L)}`, `integrating = ${s.integrating}`, "",
    ].join("\n");
}

// What `loopbook code` and `loopbook tune` read.
export function regulatorJson(s, given, h, name, placed) {
    const limits = { u_low: s.low, u_high: s.high }, lags = [s.T1, s.T2, s.T3].filter((T) => T !== 0);
    const process = given ? { num: given.num.map((c) => c * s.K), den: given.den, "delay": s.L }
        : { gain: s.K, time_constants: lags, "delay": s.L, integrating: s.integrating, ...(s.Tz ? { zero: s.Tz } : {}) };
    if (placed) return JSON.stringify({ name, process, form: "rst", R: placed.R, S: placed.S, T: placed.T, observer: placed.observer, h, limits }, null, 2);
    const { K, Ti, Td, Tf, b, c, Tt } = programSettings(s, h);
    const settings = { K, ...(Ti ? { Ti } : {}), Td, Tf, b, c, h, ...(Number.isFinite(Tt) ? { Tt } : Ti ? { anti_windup: "none" } : {}) };
    return JSON.stringify({ name, process, form: "standard", settings, limits }, null, 2);
}

