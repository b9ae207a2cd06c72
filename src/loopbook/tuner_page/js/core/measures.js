// The measures of a step response that is known as a signal: a port of loopbook.response.signal_metrics.

const KNOWN = 1e-11;
const NO_STEP = 1e-12;
const SETTLED = 1e-9;

const largestOf = (signal) => signal.extremes().reduce((m, { value }) => Math.max(m, Math.abs(value)), 0);

// {rise, settling, overshoot [%], undershoot [%]} of a response from 0 to `final`; null where it takes no step, or has
// not settled within `band` at its end.
export function stepMeasures(y, final, band = 0.02) {
    if (Math.abs(final) <= NO_STEP * Math.max(largestOf(y), Math.abs(final))) return null;
    if (Math.abs(y.last() - final) > band * Math.abs(final)) return null;
    const entries = [...y.crossings((1 + band) * final), ...y.crossings((1 - band) * final)];
    let top = -Infinity, bottom = Infinity;
    for (const { value } of y.extremes()) {
        top = Math.max(top, value / final);
        bottom = Math.min(bottom, value / final);
    }
    return {
        rise: y.crossings(0.9 * final)[0] - y.crossings(0.1 * final)[0],
        settling: Math.max(0, ...entries),
        overshoot: top > 1 + KNOWN ? 100 * (top - 1) : 0,
        undershoot: bottom < -KNOWN ? -100 * bottom : 0,
    };
}

// The integral of |wanted - y|; null where the error does not vanish, NaN where it has not by the end.
export function absoluteError(y, wanted, final) {
    const error = y.scaled(-1, wanted), largest = Math.max(largestOf(error), 1e-300);
    if (Math.abs(wanted - final) > 1e-9 * largest) return null;
    return Math.abs(error.last()) > SETTLED * largest ? NaN : error.integralOfMagnitude();
}

// The largest |u|, and the sum of all its movements.
export const inputMeasures = (u) => ({ peak: largestOf(u), variation: u.variation() });
