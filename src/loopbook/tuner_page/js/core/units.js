// A problem in units of its own: time in a characteristic time, gains in a characteristic gain, both powers of two, so
// that going there and back rounds nothing.

export const powerOfTwo = (value) => (value ? 2 ** Math.round(Math.log2(value)) : 1);

// log2 |root| of the roots that are not zero, within a few octaves: the slopes of Newton's polygon.
export function octaves(p) {
    const points = [];
    [...p].reverse().forEach((c, power) => { if (c) points.push([power, Math.log2(Math.abs(c))]); });
    const hull = [];
    for (const [x, y] of points) {
        while (hull.length > 1) {
            const [u, v] = hull[hull.length - 2], [s, t] = hull[hull.length - 1];
            if ((t - v) * (x - u) > (y - v) * (s - u)) break;
            hull.pop();
        }
        hull.push([x, y]);
    }
    const slopes = [];
    for (let i = 1; i < hull.length; i += 1) {
        const [x, y] = hull[i - 1], [u, v] = hull[i];
        for (let k = x; k < u; k += 1) slopes.push((y - v) / (u - x));
    }
    return slopes;
}

// A power of two near the time in which num(s)/den(s) exp(-delay s) moves.
export function characteristicTime(num, den, delay) {
    const found = [...octaves(num), ...octaves(den)].sort((a, b) => a - b);
    if (found.length) {
        return 2 ** -Math.round((found[found.length >> 1] + found[(found.length - 1) >> 1]) / 2);
    }
    if (delay) return powerOfTwo(delay);
    const excess = den.length - num.length;
    if (excess && num[0]) return 2 ** Math.round((Math.log2(Math.abs(den[0])) - Math.log2(Math.abs(num[0]))) / excess);
    return 1;
}

// The coefficients of p(s/time)/gain.
export function inUnits(p, time, gain = 1) {
    return p.map((c, i) => c / time ** (p.length - 1 - i) / gain);
}

export const size = (p) => powerOfTwo(Math.max(...p.map(Math.abs)));

// [num', den', gain] with num/den = gain num'(s time)/den'(s time), the largest coefficients near one.
export function ratioInUnits(num, den, time) {
    const above = inUnits(num, time), below = inUnits(den, time);
    const a = size(above), b = size(below);
    return [inUnits(above, 1, a), inUnits(below, 1, b), a / b];
}
