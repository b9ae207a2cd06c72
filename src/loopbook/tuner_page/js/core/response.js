// The closed loop after a unit step of the set-point and of the load, with exact dead time.
//
//     u = P (b r - y) + I/s (r - y) + D s/(1 + s Tf) (c r - y),      y = B/A exp(-L s) (u + d)

import { ResponseError } from "./cells.js";
import { LoopTransfer } from "./transfer.js";
import { convolve, roundedSum, sum, trimmed } from "./polynomials.js";
import { solve } from "./steps.js";
import { realised } from "./state.js";
import { ratioInUnits } from "./units.js";

// S and R of the feedback path -u/y = S/R.
export function feedbackPath({ P, I, D, Tf }) {
    const filter = D ? Tf : 0, lag = [filter, 1];
    if (!I) return { S: trimmed(sum(lag.map((c) => P * c), [D, 0])), R: trimmed(lag) };
    const S = sum(sum([P * filter, P, 0], [I * filter, I]), [D, 0, 0]);
    return { S: trimmed(S), R: trimmed([filter, 1, 0]) };
}

// T of the set-point's path u/r = T/R.
function setPointPath({ P, I, D, Tf, b, c }, R) {
    const filter = D ? Tf : 0, lag = I ? [filter, 1] : [1];
    const derivative = I ? [c * D, 0, 0] : [c * D, 0];
    return trimmed(sum(sum(R.map((x) => b * P * x), I ? lag.map((x) => I * x) : [0]), derivative));
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

// The loop as a delay equation; sources: the set-point, the load.
function equation(plant, pid, delay) {
    const { P, I, D, Tf, b: weightP, c: weightD } = pid, smooth = plant.output.d === 0;
    const filtered = D !== 0 && Tf > 0;
    if (D && !Tf && weightD) throw new ResponseError("an unfiltered derivative of the set-point's step is an impulse");
    if (D && !Tf && !smooth) throw new ResponseError("an unfiltered derivative of a process that acts at once");
    const m = plant.n, { C, d } = plant.output, n = m + (I ? 1 : 0) + (filtered ? 1 : 0);
    const A = new Float64Array(n * n), b = new Float64Array(n), Cy = new Float64Array(n), Cw = new Float64Array(n);
    for (let i = 0; i < m; i += 1) for (let j = 0; j < m; j += 1) A[i * n + j] = plant.A[i * m + j];
    b.set(plant.b);
    Cy.set(C);
    // dy/dt = rate x + through v, where y is smooth
    const rate = new Float64Array(n);
    let through = 0;
    for (let i = 0; i < m; i += 1) {
        for (let j = 0; j < m; j += 1) rate[j] += C[i] * plant.A[i * m + j];
        through += C[i] * plant.b[i];
    }
    const e = [new Float64Array(n), new Float64Array(n)], x0 = [new Float64Array(n), new Float64Array(n)];
    let dw = -P * d;
    const fw = [weightP * P, 1];
    for (let j = 0; j < m; j += 1) Cw[j] = -P * C[j];
    let next = m;
    if (I) {
        for (let j = 0; j < m; j += 1) A[next * n + j] = -I * C[j];
        b[next] = -I * d;
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
                A[next * n + j] = level / Tf * C[j];
                Cw[j] -= level * C[j];
            }
            b[next] = level / Tf * d;
            dw -= level * d;
            e[0][next] = -level / Tf * weightD;
            fw[0] += level * weightD;
        }
    } else if (D) {
        for (let j = 0; j < m; j += 1) Cw[j] -= D * rate[j];
        dw -= D * through;
    }
    const more = n - m, blocks = [...plant.blocks, ...new Array(more).fill(1)];
    const outputs = [{ C: Cw, d: dw, f: fw }, { C: Cy, d, f: [0, 0] }];
    return { n, A, b, e, x0, outputs, delay, blocks };
}

// Without dead time all four responses are those of rational functions with one denominator, A R + B S.
function rationalResponses(num, den, pid, horizon) {
    const { S, R } = feedbackPath(pid), T = setPointPath(pid, R), below = roundedSum(convolve(den, R), convolve(num, S));
    if (below.length !== trimmed(below).length) throw new ResponseError("algebraic loop: process and regulator act at once");
    if (T.length > R.length) throw new ResponseError("an unfiltered derivative of the set-point's step is an impulse");
    const numerators = [convolve(num, T), convolve(den, T), convolve(num, R), convolve(num, S).map((c) => -c)];
    const form = realised(below), { n, A, b, blocks, poles } = form;
    const outputs = numerators.map((p) => form.row(trimmed(p))).map(({ C, d }) => ({ C, d: 0, f: [d] }));
    const system = { n, A, b: new Float64Array(n), e: [b], x0: [new Float64Array(n)], outputs, delay: 0, blocks };
    const [[yr, ur, yl, ul]] = solve(system, horizon, poles);
    return { reference: { y: yr, u: ur }, load: { y: yl, u: ul } };
}

function delayedResponses(num, den, pid, delay, horizon) {
    const form = realised(den), plant = { ...form, output: form.row(num) };
    const modes = pid.D && pid.Tf ? [...form.poles, [-1 / pid.Tf, 0]] : form.poles;
    const [[ur, yr], [ul, yl]] = solve(equation(plant, pid, delay), horizon, modes);
    return { reference: { y: yr, u: ur }, load: { y: yl, u: ul.scaled(1, -1) } };
}

// {reference: {y, u}, load: {y, u}}: signals on [0, horizon]. Throws ResponseError where a response does not exist.
export function stepResponses(process, pid, horizon) {
    const transfer = loopTransfer(process, pid), time = transfer.ownUnits[1];
    const [num, den, gain] = ratioInUnits(trimmed(process.num), trimmed(process.den), time);
    const inside = { ...pid, P: pid.P * gain, I: pid.I * gain * time, D: pid.D * gain / time, Tf: pid.Tf / time };
    const delay = process.delay / time, until = horizon / time;
    const found = delay ? delayedResponses(num, den, inside, delay, until) : rationalResponses(num, den, inside, until);
    const outside = (signal, factor) => signal.scaled(factor, 0, time);
    return {
        reference: { y: outside(found.reference.y, 1), u: outside(found.reference.u, 1 / gain) },
        load: { y: outside(found.load.y, gain), u: outside(found.load.u, 1) },
    };
}

// What (y, u) tend to after a unit step of each source, by the final value theorem.
export function finalValues(process, pid) {
    const [num, den] = withoutCommonIntegrators(process.num, process.den), { S, R } = feedbackPath(pid);
    const [B, A, s0, r0] = [num, den, S, R].map((p) => p.at(-1)), t0 = pid.I ? s0 : pid.b * pid.P;
    const below = r0 * A + s0 * B;
    return { reference: { y: t0 * B / below, u: t0 * A / below }, load: { y: r0 * B / below, u: -s0 * B / below } };
}
