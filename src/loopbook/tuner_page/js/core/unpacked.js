// Text from its short form, see loopbook.tuner_page.packed.

const LETTERS = Array.from({ length: 92 }, (_, i) => String.fromCharCode(35 + i)).filter((c) => c !== "\\").join("");
const SHORTEST = 4;
const MOST_SYMBOLS = 384;
const SLOTS = 20;

// A canonical code from the lengths of its words: the symbol of "1" + word.
function codeOf(lengths) {
    const symbols = lengths.map((length, symbol) => [length, symbol]).filter(([length]) => length).sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const found = new Map();
    let code = 0, before = 0;
    for (const [length, symbol] of symbols) {
        code *= 2 ** (length - before);
        found.set(2 ** length + code, symbol);
        before = length;
        code += 1;
    }
    return found;
}

export function unpacked(short) {
    const digits = Array.from(short, (c) => LETTERS.indexOf(c)), lengths = [], bytes = [];
    const size = (digits[0] * 91 + digits[1]) * 91 + digits[2];
    let at = 3, held = 0, count = 0;
    for (; lengths.length < MOST_SYMBOLS + SLOTS; at += 1) lengths.push(...(digits[at] < 16 ? [digits[at]] : new Array(digits[at] - 16).fill(0)));
    const words = codeOf(lengths.slice(0, MOST_SYMBOLS)), distances = codeOf(lengths.slice(MOST_SYMBOLS));
    const bit = () => {
        if (!count) {
            held = digits[at] * 91 + digits[at + 1];
            at += 2;
            count = 13;
        }
        count -= 1;
        return (held >> count) & 1;
    };
    const symbol = (code) => {
        let word = 1;
        do word = 2 * word + bit(); while (!code.has(word));
        return code.get(word);
    };
    while (bytes.length < size) {
        const found = symbol(words);
        if (found < 256) {
            bytes.push(found);
            continue;
        }
        let back = 1;
        for (let n = symbol(distances); n > 1; n -= 1) back = 2 * back + bit();
        for (let n = found - 256 + SHORTEST; n > 0; n -= 1) bytes.push(bytes[bytes.length - back]);
    }
    return decodeURIComponent(bytes.map((b) => `%${b.toString(16).padStart(2, "0")}`).join(""));
}
