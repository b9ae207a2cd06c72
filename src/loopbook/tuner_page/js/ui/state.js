// What the page shows: one plain object, its forms as text, and the regulator in every form.

import { convolve } from "../core/polynomials.js";

export const DEFAULTS = {
    K: 2, T1: 40, T2: 12, T3: 0, Tz: 0, L: 8, integrating: false,
    form: "standard", Kc: 0.65, Ti: 45, Td: 0, N: 10, b: 1, c: 0,
    h: 0, low: null, high: null, windup: true,
    kind: "pid", speed: 0.1, damping: 0.7, rest: 0.1, observer: 0.3,
    jump: false, smooth: true, wave: 0, freq: 1,
    r: 1, d: 0.5, uK: 0, uT: 0, uL: 20, closed: 0, margin: 60, w: 0, zeta: 0.7,
};

const WORDS = new Set(["form", "kind"]);
const FLAGS = new Set(["integrating", "windup", "jump", "smooth"]);

// The process as {num, den, delay, lags}; data.process: polynomials that no knob can make, times the gain K.
export function processOf(s, given, change = {}) {
    const { K = s.K, L = s.L, stretch = 1 } = change;
    if (given) return { num: given.num.map((c) => c * K), den: given.den.map((c, i) => c * stretch ** (given.den.length - 1 - i)), delay: L };
    const lags = [s.T1, s.T2, s.T3].filter((T) => T !== 0).map((T) => T * stretch);
    let den = lags.map((T) => [T, 1]).reduce(convolve, [1]);
    if (s.integrating) den = convolve(den, [1, 0]);
    const num = s.Tz ? [K * s.Tz, K] : [K], proper = num.length <= den.length;
    return { num: proper ? num : [K], den, delay: L, ...(lags.every((T) => T > 0) && !s.Tz ? { lags } : {}) };
}

// The regulator in parallel form {P, I, D, Tf, b, c}; it is kept in the standard one.
export function pidOf({ Kc, Ti, Td, N, b, c }) {
    return { P: Kc, I: Number.isFinite(Ti) ? Kc / Ti : 0, D: Kc * Td, Tf: Td && Number.isFinite(N) ? Td / N : 0, b, c };
}

// The numbers that the knobs of a form show.
export const FORMS = {
    standard: {
        knobs: ["Kc", "Ti", "Td", "N"],
        read: (s) => ({ Kc: s.Kc, Ti: s.Ti, Td: s.Td, N: s.N }),
        write: (v) => v,
    },
    parallel: {
        knobs: ["P", "I", "D", "Np"],
        read: ({ Kc, Ti, Td, N }) => ({ P: Kc, I: Number.isFinite(Ti) ? Kc / Ti : 0, D: Kc * Td, Np: Td ? N / Td : 0 }),
        write: ({ P, I, D, Np }, before) => {
            const Td = P ? D / P : 0;
            return { Kc: P, Ti: I ? P / I : Infinity, Td, N: Td && Np ? Np * Td : before.N };
        },
    },
    series: {
        knobs: ["Ks", "Tis", "Tds", "N"],
        read: (s) => seriesOf(s),
        write: ({ Ks, Tis, Tds, N }) => {
            if (!Number.isFinite(Tis) || !Tds) return { Kc: Ks, Ti: Tis, Td: Tds, N };
            const Tf = Number.isFinite(N) ? Tds / N : 0, Ti = Tis + Tds, Td = Tds * (Tis - Tf) / Ti;
            return { Kc: Ks * Ti / Tis, Ti, Td: Math.max(Td, 0), N: Tf ? Td / Tf : Infinity };
        },
    },
};

// The series form of a standard one, null where its zeros are complex.
function seriesOf({ Kc, Ti, Td, N }) {
    if (!Number.isFinite(Ti) || !Td) return { Ks: Kc, Tis: Ti, Tds: Td, N };
    const Tf = Number.isFinite(N) ? Td / N : 0, half = (Ti + Tf) / 2, inside = half * half - Ti * (Td + Tf);
    if (inside < 0) return null;
    const Tis = half + Math.sqrt(inside), Tds = Ti - Tis;
    return Tds < 0 ? null : { Ks: Kc * Tis / Ti, Tis, Tds, N: Tf ? Tds / Tf : Infinity };
}

export const inSeries = (s) => seriesOf(s) !== null;

// A number as short as it reads back.
const written = (x) => (x === null ? "none" : x === Infinity ? "inf" : String(Number(x.toPrecision(12))));

// The state as text for an address: what differs from `usual`.
export function toText(s, usual) {
    const parts = [];
    for (const name of Object.keys(usual)) {
        if (s[name] === usual[name]) continue;
        parts.push(`${name}=${WORDS.has(name) ? s[name] : FLAGS.has(name) ? Number(s[name]) : written(s[name])}`);
    }
    return parts.join("&");
}

// The state of such text; what it does not say, or says wrongly, is as usual.
export function fromText(text, usual) {
    const s = { ...usual };
    for (const part of text.split("&")) {
        const [name, value = ""] = part.split("=");
        if (!Object.hasOwn(usual, name)) continue;
        if (WORDS.has(name)) {
            if (name === "form" ? Object.hasOwn(FORMS, value) : ["pid", "rst"].includes(value)) s[name] = value;
        } else if (FLAGS.has(name)) {
            s[name] = value === "1";
        } else if (value === "none") {
            if (name === "low" || name === "high") s[name] = null;
        } else {
            const number = value === "inf" ? Infinity : Number(value);
            if (value !== "" && !Number.isNaN(number)) s[name] = number;
        }
    }
    return s;
}

// A number typed by a person: decimal comma or point; NaN for what is none.
export function typed(text) {
    const plain = text.trim().replace(/\s/g, "").replace(/−/g, "-").replace(",", ".");
    if (/^(inf|∞)$/i.test(plain)) return Infinity;
    return /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(plain) ? Number(plain) : NaN;
}

// A number to be read: a few digits, a real minus.
export function shown(x, digits = 3) {
    if (x === null || x === undefined || Number.isNaN(x)) return "–";
    if (!Number.isFinite(x)) return x < 0 ? "−∞" : "∞";
    if (x === 0) return "0";
    const size = Math.abs(x);
    let text;
    if (size >= 1e5 || size < 1e-3) {
        const [mantissa, power] = x.toExponential(digits - 1).split("e");
        text = `${Number(mantissa)}e${Number(power)}`;
    } else {
        text = String(Number(x.toPrecision(digits)));
    }
    return text.replace(/-/g, "−");
}
