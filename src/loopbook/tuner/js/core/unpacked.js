// Text from its short form, see loopbook.tuner.packed.

const SIGN = "^";
const DIGITS = Array.from({ length: 92 }, (_, i) => String.fromCharCode(35 + i)).filter((c) => !"\\`^".includes(c)).slice(0, 88);
const LEAST_LENGTH = 6;

export function unpacked(short) {
    const digit = (i) => DIGITS.indexOf(short[i]), base = DIGITS.length;
    let text = "";
    for (let i = 0; i < short.length; i += 1) {
        if (short[i] !== SIGN) {
            text += short[i];
        } else if (short[i + 1] === SIGN) {
            text += SIGN;
            i += 1;
        } else {
            const back = (digit(i + 1) * base + digit(i + 2)) * base + digit(i + 3), start = text.length - back;
            for (let k = 0; k < digit(i + 4) + LEAST_LENGTH; k += 1) text += text[start + k];
            i += 4;
        }
    }
    return text;
}
