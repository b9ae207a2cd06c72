// A root of f between a and b, where it changes sign: Brent's method.

export function rootBetween(f, a, b, tolerance = 1e-14) {
    let fa = f(a), fb = f(b);
    if (fa === 0) return a;
    if (fb === 0) return b;
    let c = a, fc = fa, step = b - a, before = step;
    for (let i = 0; i < 200; i += 1) {
        if (Math.sign(fb) === Math.sign(fc)) { c = a; fc = fa; step = b - a; before = step; }
        if (Math.abs(fc) < Math.abs(fb)) { [a, b, c] = [b, c, b]; [fa, fb, fc] = [fb, fc, fb]; }
        const allowed = 2 * Number.EPSILON * Math.abs(b) + tolerance * Math.abs(b) / 2;
        const middle = (c - b) / 2;
        if (Math.abs(middle) <= allowed || fb === 0) return b;
        if (Math.abs(before) < allowed || Math.abs(fa) <= Math.abs(fb)) {
            step = middle;
            before = middle;
        } else {
            let p, q;
            const s = fb / fa;
            if (a === c) {
                p = 2 * middle * s;
                q = 1 - s;
            } else {
                const r = fb / fc, t = fa / fc;
                p = s * (2 * middle * t * (t - r) - (b - a) * (r - 1));
                q = (t - 1) * (r - 1) * (s - 1);
            }
            if (p > 0) q = -q; else p = -p;
            if (2 * p < Math.min(3 * middle * q - Math.abs(allowed * q), Math.abs(before * q))) {
                before = step;
                step = p / q;
            } else {
                step = middle;
                before = middle;
            }
        }
        a = b;
        fa = fb;
        b += Math.abs(step) > allowed ? step : Math.sign(middle) * allowed;
        fb = f(b);
    }
    return b;
}
