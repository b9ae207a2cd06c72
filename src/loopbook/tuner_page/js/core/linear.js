// Small dense matrices, row by row in Float64Arrays: solving, products, the exponential.

// Solves M X = B in place: M (n x n) is destroyed, B (n x k) becomes X. Partial pivoting.
export function solveInPlace(M, n, B, k) {
    for (let c = 0; c < n; c += 1) {
        let pivot = c;
        for (let r = c + 1; r < n; r += 1) if (Math.abs(M[r * n + c]) > Math.abs(M[pivot * n + c])) pivot = r;
        if (pivot !== c) {
            swapRows(M, n, c, pivot);
            swapRows(B, k, c, pivot);
        }
        const inverse = 1 / M[c * n + c];
        for (let r = c + 1; r < n; r += 1) {
            const factor = M[r * n + c] * inverse;
            if (factor === 0) continue;
            for (let j = c + 1; j < n; j += 1) M[r * n + j] -= factor * M[c * n + j];
            for (let j = 0; j < k; j += 1) B[r * k + j] -= factor * B[c * k + j];
        }
    }
    for (let c = n - 1; c >= 0; c -= 1) {
        const inverse = 1 / M[c * n + c];
        for (let j = 0; j < k; j += 1) B[c * k + j] *= inverse;
        for (let r = 0; r < c; r += 1) {
            const factor = M[r * n + c];
            if (factor === 0) continue;
            for (let j = 0; j < k; j += 1) B[r * k + j] -= factor * B[c * k + j];
        }
    }
    return B;
}

function swapRows(M, width, a, b) {
    for (let j = 0; j < width; j += 1) {
        const kept = M[a * width + j];
        M[a * width + j] = M[b * width + j];
        M[b * width + j] = kept;
    }
}

// The product of (n x m) and (m x k).
export function times(A, B, n, m, k) {
    const product = new Float64Array(n * k);
    for (let i = 0; i < n; i += 1) {
        for (let l = 0; l < m; l += 1) {
            const factor = A[i * m + l];
            if (factor === 0) continue;
            for (let j = 0; j < k; j += 1) product[i * k + j] += factor * B[l * k + j];
        }
    }
    return product;
}

export function identity(n) {
    const one = new Float64Array(n * n);
    for (let i = 0; i < n; i += 1) one[i * n + i] = 1;
    return one;
}

const PADE = [1, 1 / 2, 3 / 26, 5 / 312, 5 / 3432, 1 / 11440, 1 / 308880];

// exp(M) for an n x n matrix: scaling, a Pade approximant of order (6, 6), squaring.
export function expm(M, n) {
    let size = 0;
    for (let i = 0; i < n; i += 1) {
        let row = 0;
        for (let j = 0; j < n; j += 1) row += Math.abs(M[i * n + j]);
        size = Math.max(size, row);
    }
    const halvings = Math.max(0, Math.ceil(Math.log2(size || 1)) + 2);
    const X = M.map((x) => x / 2 ** halvings);
    const above = identity(n), below = identity(n);
    let power = identity(n);
    for (let k = 1; k < PADE.length; k += 1) {
        power = times(power, X, n, n, n);
        for (let i = 0; i < n * n; i += 1) {
            above[i] += PADE[k] * power[i];
            below[i] += (k % 2 ? -PADE[k] : PADE[k]) * power[i];
        }
    }
    let result = solveInPlace(below, n, above, n);
    for (let k = 0; k < halvings; k += 1) result = times(result, result, n, n, n);
    return result;
}
