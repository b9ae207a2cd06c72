// The closed loop after a unit step of the set-point and of the load, with exact dead time.
//
//     u = P (b r - y) + I/s (r - y) + D s/(1 + s Tf) (c r - y),      y = B/A exp(-L s) (u + d)

import { ResponseError } from "./cells.js";
import { mul } from "./complex.js";
import { LoopTransfer } from "./transfer.js";
import { convolve, roots, roundedSum, sum, trimmed } from "./polynomials.js";
import { solve } from "./steps.js";
import { ratioInUnits } from "./units.js";

const CLOSE = 1e-14;

// S and R of the feedback path -u/y = S/R.
export function feedbackPath({ P, I, D, Tf }) {
    const filter = D ? Tf : 0, lag = [filter, 1];
    if (!I) return { S: trimmed(sum(lag.map((c) => P * c), [D, 0])), R: trimmed(lag) };
    const S = sum(sum([P * filter, P, 0], [I * filter, I]), [D, 0, 0]);
    return { S: trimmed(S), R: trimmed([filter, 1, 0]) };
}

// Factors s that numerator and denominator share taken out.
function withoutCommonIntegrators(num, den) {
    let above = num, below = den;
    while (above.length > 1 && below.length > 1 && above.at(-1) === 0 && below.at(-1) === 0) {
        above = above.slice(0, -1);
        below = below.slice(0, -1);
    }
    return [above, below];
}

export function loopTransfer(process, pid) {
    const [num, den] = withoutCommonIntegrators(process.num, process.den), { S, R } = feedbackPath(pid);
    return new LoopTransfer(convolve(S, num), convolve(R, den), process.delay);
}

// num/den in state space, {A, b, C, d, n, blocks, poles}: as a chain where the poles found give the polynomial back,
// which those of a multiple pole do not.
function realised(num, den) {
    const poles = roots(den), factors = factorsOf(poles), again = factors.reduce(convolve, [1]);
    const scale = Math.max(...den.map(Math.abs));
    const told = den.every((c, i) => Math.abs(again[i] * den[0] - c) <= CLOSE * (Math.abs(c) || scale));
    return { ...(told ? chain(num, den, factors) : companion(num, den)), poles };
}

// The monic factors of degree 1 and 2, slowest first.
function factorsOf(poles) {
    const factors = [];
    poles.forEach(([re, im]) => {
        if (im === 0) factors.push([1, -re]);
        else if (im > 0) factors.push([1, -2 * re, re * re + im * im]);
    });
    return factors.sort((p, q) => Math.abs(p.at(-1)) - Math.abs(q.at(-1)));
}

// One block, in the form in which the last state's derivatives are the others.
function companion(num, den) {
    const n = den.length - 1, a = den.map((c) => c / den[0]), row = new Array(n + 1 - num.length).fill(0).concat(num);
    const A = new Float64Array(n * n), b = new Float64Array(n), C = new Float64Array(n), d = row[0] / den[0];
    for (let i = 0; i < n - 1; i += 1) A[i * n + i + 1] = 1;
    for (let i = 0; i < n; i += 1) {
        A[(n - 1) * n + i] = -a[n - i];
        C[i] = row[n - i] / den[0] - d * a[n - i];
    }
    b[n - 1] = 1;
    return { A, b, C, d, n, blocks: [n] };
}

// As a chain of lags and pairs, block triangular:
//     num/den = d + sum of r_i(s) / (q_1(s) ... q_i(s))
function chain(num, den, factors) {
    const lead = den[0], n = den.length - 1, blocks = factors.map((q) => q.length - 1);
    let rest = num.map((c) => c / lead), d = 0;
    if (rest.length === n + 1) {
        d = rest[0];
        rest = sum(rest, factors.reduce(convolve, [1]), -d).slice(1);
    }
    const A = new Float64Array(n * n), b = new Float64Array(n), C = new Float64Array(n);
    let last = n;
    for (let f = factors.length - 1; f >= 0; f -= 1) {
        const [quotient, remainder] = divided(rest, factors[f]), size = blocks[f], first = last - size;
        remainder.forEach((c, i) => { C[first + remainder.length - 1 - i] = c; });
        rest = quotient;
        if (size === 1) {
            A[first * n + first] = -factors[f][1];
        } else {
            A[first * n + first + 1] = 1;
            A[(first + 1) * n + first] = -factors[f][2];
            A[(first + 1) * n + first + 1] = -factors[f][1];
        }
        if (f > 0) A[(last - 1) * n + first - blocks[f - 1]] = 1; else b[last - 1] = 1;
        last = first;
    }
    return { A, b, C, d, n, blocks };
}

// [quotient, remainder] of a polynomial by a monic one.
function divided(p, q) {
    const rest = [...p], quotient = [];
    while (rest.length >= q.length) {
        const c = rest[0];
        quotient.push(c);
        q.forEach((x, i) => { rest[i] -= c * x; });
        rest.shift();
    }
    while (rest.length < q.length - 1) rest.unshift(0);
    return [quotient.length ? quotient : [0], rest];
}

// The loop as a delay equation; sources: the set-point, the load.
function equation(plant, pid, delay) {
    const { P, I, D, Tf, b: weightP, c: weightD } = pid, smooth = plant.d === 0;
    const filtered = D !== 0 && Tf > 0;
    if (D && !Tf && weightD) throw new ResponseError("an unfiltered derivative of the set-point's step is an impulse");
    if (D && !Tf && !smooth) throw new ResponseError("an unfiltered derivative of a process that acts at once");
    const m = plant.n, n = m + (I ? 1 : 0) + (filtered ? 1 : 0);
    const A = new Float64Array(n * n), b = new Float64Array(n), Cy = new Float64Array(n), Cw = new Float64Array(n);
    for (let i = 0; i < m; i += 1) for (let j = 0; j < m; j += 1) A[i * n + j] = plant.A[i * m + j];
    b.set(plant.b);
    Cy.set(plant.C);
    // dy/dt = rate x + through v, where y is smooth
    const rate = new Float64Array(n);
    let through = 0;
    for (let i = 0; i < m; i += 1) {
        for (let j = 0; j < m; j += 1) rate[j] += plant.C[i] * plant.A[i * m + j];
        through += plant.C[i] * plant.b[i];
    }
    const e = [new Float64Array(n), new Float64Array(n)], x0 = [new Float64Array(n), new Float64Array(n)];
    let dw = -P * plant.d;
    const fw = [weightP * P, 1];
    for (let j = 0; j < m; j += 1) Cw[j] = -P * plant.C[j];
    let next = m;
    if (I) {
        for (let j = 0; j < m; j += 1) A[next * n + j] = -I * plant.C[j];
        b[next] = -I * plant.d;
        e[0][next] = I;
        Cw[next] = 1;
        next += 1;
    }
    if (filtered) {
        A[next * n + next] = -1 / Tf;
        Cw[next] = 1;
        if (smooth) {
            for (let j = 0; j < m; j += 1) A[next * n + j] = -D / Tf * rate[j];
            b[next] = -D / Tf * through;
            x0[0][next] = weightD * D / Tf;
        } else {
            const level = D / Tf;
            for (let j = 0; j < m; j += 1) {
                A[next * n + j] = level / Tf * plant.C[j];
                Cw[j] -= level * plant.C[j];
            }
            b[next] = level / Tf * plant.d;
            dw -= level * plant.d;
            e[0][next] = -level / Tf * weightD;
            fw[0] += level * weightD;
        }
    } else if (D) {
        for (let j = 0; j < m; j += 1) Cw[j] -= D * rate[j];
        dw -= D * through;
    }
    const more = n - m, blocks = [...plant.blocks, ...new Array(more).fill(1)];
    return { n, A, b, e, x0, Cw, dw, fw, Cy, dy: plant.d, fy: [0, 0], delay, blocks };
}

// The same equation with v eliminated, for a dead time of 0.
function closed(system) {
    const { n, A, b, e, Cw, dw, fw, Cy, dy, fy } = system, gap = 1 - dw;
    if (Math.abs(gap) < 1e-12) throw new ResponseError("algebraic loop: process and regulator act at once");
    const loop = new Float64Array(n * n);
    for (let i = 0; i < n; i += 1) for (let j = 0; j < n; j += 1) loop[i * n + j] = A[i * n + j] + b[i] * Cw[j] / gap;
    return {
        ...system, A: loop, b: new Float64Array(n), dw: 0, dy: 0, delay: 0, blocks: [n],
        e: e.map((row, s) => row.map((x, i) => x + b[i] * fw[s] / gap)),
        Cw: Cw.map((x) => x / gap), fw: fw.map((f) => f / gap),
        Cy: Cy.map((x, i) => x + dy * Cw[i] / gap), fy: fy.map((f, s) => f + dy * fw[s] / gap),
    };
}

// {reference: {y, u}, load: {y, u}}: signals on [0, horizon]. Throws ResponseError where a response does not exist.
export function stepResponses(process, pid, horizon) {
    const transfer = loopTransfer(process, pid), time = transfer.ownUnits[1];
    const [num, den, gain] = ratioInUnits(trimmed(process.num), trimmed(process.den), time);
    const inside = { ...pid, P: pid.P * gain, I: pid.I * gain * time, D: pid.D * gain / time, Tf: pid.Tf / time };
    const plant = realised(num, den), delay = process.delay / time;
    let system = equation(plant, inside, delay), modes = plant.poles;
    if (delay) {
        if (inside.D && inside.Tf) modes = [...modes, [-1 / inside.Tf, 0]];
    } else {
        const [own] = transfer.ownUnits;
        system = closed(system);
        modes = roots(roundedSum(own.den, own.num));
    }
    const [reference, load] = solve(system, horizon / time, modes);
    return {
        reference: { y: reference.y.scaled(1, 0, time), u: reference.w.scaled(1 / gain, 0, time) },
        load: { y: load.y.scaled(gain, 0, time), u: load.w.scaled(1, -1, time) },
    };
}

// What (y, u) tend to after a unit step of each source, by the final value theorem.
export function finalValues(process, pid) {
    const [num, den] = withoutCommonIntegrators(process.num, process.den), { S, R } = feedbackPath(pid);
    const [B, A, s0, r0] = [num, den, S, R].map((p) => p.at(-1)), t0 = pid.I ? s0 : pid.b * pid.P;
    const below = r0 * A + s0 * B;
    return { reference: { y: t0 * B / below, u: t0 * A / below }, load: { y: r0 * B / below, u: -s0 * B / below } };
}

// G(jw) with the factor of the regulator's path: C(jw).
export function regulatorAt(pid, w) {
    const { S, R } = feedbackPath(pid);
    return [S, R].map((p) => p.reduce((total, c) => { const next = mul(total, [0, w]); return [next[0] + c, next[1]]; }, [0, 0]));
}
