// Complex numbers as pairs [re, im].

export const add = (a, b) => [a[0] + b[0], a[1] + b[1]];
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1]];
export const mul = (a, b) => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
export const scale = (a, x) => [a[0] * x, a[1] * x];
export const conj = (a) => [a[0], -a[1]];
export const abs = (a) => Math.hypot(a[0], a[1]);
export const arg = (a) => Math.atan2(a[1], a[0]);
export const exp = (a) => [Math.exp(a[0]) * Math.cos(a[1]), Math.exp(a[0]) * Math.sin(a[1])];
export const isFiniteNumber = (a) => Number.isFinite(a[0]) && Number.isFinite(a[1]);

// a / b by Smith's method, which does not overflow in between.
export function div(a, b) {
    if (Math.abs(b[0]) >= Math.abs(b[1])) {
        const ratio = b[1] / b[0];
        const below = b[0] + b[1] * ratio;
        return [(a[0] + a[1] * ratio) / below, (a[1] - a[0] * ratio) / below];
    }
    const ratio = b[0] / b[1];
    const below = b[0] * ratio + b[1];
    return [(a[0] * ratio + a[1]) / below, (a[1] * ratio - a[0]) / below];
}
