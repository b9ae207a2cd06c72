// Stability margins with exact dead time, on both sides: a port of loopbook.loop.margins.

import { arg, scale } from "./complex.js";
import { complementaryPeak, sensitivityPeak } from "./peaks.js";
import { unstableRoots } from "./stability.js";
import { LoopError } from "./transfer.js";

const FLOORS = [0.5, 0.1, 0.02, 1e-3, 1e-5, 1e-8, 1e-12];
const degrees = 180 / Math.PI;

// [{w, phase [degrees], delay [s]}] at all gain crossovers, of any loop.
export function atGainCrossovers(loop) {
    return loop.gainCrossovers.map((w) => {
        const angle = arg(scale(loop.onAxis(w), -1));
        const positive = angle < 0 ? angle + 2 * Math.PI : angle;
        return { w, phase: angle * degrees, delay: positive / w };
    });
}

// [{w, gain}] where G is real and negative: all with |G| > 1 and, below it, enough to show the largest |G| < 1.
export function atPhaseCrossovers(loop) {
    const first = atZero(loop);
    const at = (floor) => [...first, ...loop.phaseCrossovers(floor).map((w) => ({ w, gain: 1 / loop.magnitude(w) }))];
    if (!loop.delay) return at(1e-15).filter((c) => c.gain < 1e12);
    let found = [];
    for (const wanted of FLOORS) {
        const floor = Math.max(wanted, loop.gainAtInfinity * (1 + 1e-6));
        found = at(floor);
        if (found.some((c) => c.gain > 1) || floor > 0.5) break;
    }
    return found;
}

function atZero(loop) {
    if (loop.den.at(-1) === 0 || loop.num.at(-1) === 0) return [];
    const gain = loop.num.at(-1) / loop.den.at(-1);
    return gain < 0 ? [{ w: 0, gain: -1 / gain }] : [];
}

// The gain that makes the loop's limit at infinite frequency reach 1 (with dead time) or -1 (without).
function atInfinity(loop) {
    if (loop.num.length < loop.den.length) return [];
    const limit = loop.num[0] / loop.den[0];
    if (loop.delay) return [1 / Math.abs(limit)];
    return limit < 0 ? [-1 / limit] : [];
}

// All margins of a stable loop. Throws LoopError for an unstable one.
export function margins(loop) {
    const count = unstableRoots(loop);
    if (count) throw new LoopError(`the loop is unstable (${count} roots in the right half plane)`);
    const gainCrossovers = atGainCrossovers(loop), phaseCrossovers = atPhaseCrossovers(loop);
    const factors = [...phaseCrossovers.map((c) => c.gain), ...atInfinity(loop)];
    const phases = gainCrossovers.map((c) => c.phase);
    return {
        gain: Math.min(Infinity, ...factors.filter((g) => g > 1)),
        gainLow: Math.max(0, ...factors.filter((g) => g < 1)),
        phase: phases.length ? phases.reduce((a, b) => (Math.abs(b) < Math.abs(a) ? b : a)) : Infinity,
        delay: Math.min(Infinity, ...gainCrossovers.map((c) => c.delay)),
        Ms: sensitivityPeak(loop),
        Mt: complementaryPeak(loop),
        gainCrossovers,
        phaseCrossovers,
    };
}
