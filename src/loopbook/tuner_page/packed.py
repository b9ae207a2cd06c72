"""Text made short for a page, and unpacked there by thirty lines: repetitions as references, then Huffman's code.

The same text gives the same characters with every Python, which zlib does not promise.

    symbols   0..255 a byte; 256 + n: n + LEAST bytes that stood there before, how far back follows
    distance  the number of its bits as a symbol of a second code, then these bits but the first
    written   13 bits as two of the 91 LETTERS; before them the lengths of both codes' words, a letter each, 16 + n
              for n zeros
"""

import heapq
from collections import Counter, defaultdict
from collections.abc import Iterable
from itertools import groupby

LETTERS = "".join(chr(c) for c in range(35, 127) if chr(c) != "\\")
LEAST, MOST = 4, 131
SYMBOLS, SLOTS = 256 + MOST - LEAST + 1, 20
LONGEST, RUN = 15, 74
CANDIDATES = 1000


def _references(data: bytes) -> Iterable[tuple[int, int]]:
    """(byte, 0), or (length, distance) of what is repeated."""
    seen: dict[bytes, list[int]] = defaultdict(list)
    at = 0
    while at < len(data):
        length, back = _longest(data, at, seen[data[at : at + LEAST]])
        if length and at + 1 < len(data):  # one byte later there may be a longer one
            later, _ = _longest(data, at + 1, seen[data[at + 1 : at + 1 + LEAST]])
            if later > length + 1:
                length = 0
        yield (length, back) if length else (data[at], 0)
        for i in range(at, at + (length or 1)):
            seen[data[i : i + LEAST]].append(i)
        at += length or 1


def _longest(data: bytes, at: int, places: list[int]) -> tuple[int, int]:
    best, back = 0, 0
    if at + LEAST <= len(data):
        for start in places[: -CANDIDATES - 1 : -1]:
            if best and data[start + best : start + best + 1] != data[at + best : at + best + 1]:
                continue
            length = LEAST
            while length < MOST and at + length < len(data) and data[start + length] == data[at + length]:
                length += 1
            if length > best:
                best, back = length, at - start
    return best, back


def _lengths(counts: Counter[int], size: int) -> list[int]:
    """The length of each symbol's word in Huffman's code, 0 for those that do not occur."""
    weights = dict(counts)
    while True:
        heap: list[tuple[int, int, tuple[int, ...]]] = [(n, symbol, (symbol,)) for symbol, n in sorted(weights.items())]
        heapq.heapify(heap)
        lengths = [0] * size
        if len(heap) == 1:
            lengths[heap[0][1]] = 1
        while len(heap) > 1:
            (a, i, first), (b, j, second) = heapq.heappop(heap), heapq.heappop(heap)
            for symbol in first + second:
                lengths[symbol] += 1
            heapq.heappush(heap, (a + b, min(i, j), first + second))
        if max(lengths) <= LONGEST:
            return lengths
        weights = {symbol: (n + 1) // 2 for symbol, n in weights.items()}


def _words(lengths: list[int]) -> dict[int, str]:
    """The canonical code with these lengths: bits as text."""
    code, before, words = 0, 0, {}
    for length, symbol in sorted((n, s) for s, n in enumerate(lengths) if n):
        code <<= length - before
        words[symbol], before = f"{code:0{length}b}", length
        code += 1
    return words


def _with_runs(lengths: list[int]) -> Iterable[int]:
    for length, run in groupby(lengths):
        count = len(list(run))
        while not length and count:
            yield 16 + min(count, RUN)
            count -= min(count, RUN)
        yield from [length] * count


def packed(text: str) -> str:
    """The short form, of printable ASCII without backslashes and double quotes.

    >>> len(packed("a valve, " * 100)) < 400
    True
    """
    tokens = list(_references(text.encode()))
    symbols = Counter(a if not back else 256 + a - LEAST for a, back in tokens)
    slots = Counter(back.bit_length() for _, back in tokens if back)
    code_lengths = _lengths(symbols, SYMBOLS), _lengths(slots or Counter([1]), SLOTS)
    word, slot = map(_words, code_lengths)
    bits = []
    for a, back in tokens:
        bits.append(word[256 + a - LEAST if back else a])
        if back:
            bits.append(slot[back.bit_length()] + f"{back:b}"[1:])
    stream = "".join(bits)
    stream += "0" * (-len(stream) % 13)
    pairs = (divmod(int(stream[i : i + 13], 2), 91) for i in range(0, len(stream), 13))
    head = "".join(LETTERS[n] for n in _with_runs([*code_lengths[0], *code_lengths[1]]))
    size = len(text.encode())
    written = "".join(LETTERS[size // 91**k % 91] for k in (2, 1, 0))
    return written + head + "".join(LETTERS[a] + LETTERS[b] for a, b in pairs)
