"""The width in pixels that a raster picture says it has."""

import struct


def pixel_width(data: bytes, kind: str) -> int | None:
    """The width of a PNG, JPEG, GIF or WebP; None where its bytes do not tell."""
    try:
        match kind:
            case "png":
                return struct.unpack(">I", data[16:20])[0]
            case "gif":
                return struct.unpack("<H", data[6:8])[0]
            case "jpg":
                return _jpeg(data)
            case "webp" if data[12:16] == b"VP8X":
                return 1 + int.from_bytes(data[24:27], "little")
            case "webp" if data[12:16] == b"VP8 ":
                return struct.unpack("<H", data[26:28])[0] & 0x3FFF
            case "webp" if data[12:16] == b"VP8L":
                return 1 + (struct.unpack("<H", data[21:23])[0] & 0x3FFF)
    except (struct.error, IndexError):
        return None
    return None


def _jpeg(data: bytes) -> int | None:
    at = 2
    while at + 9 < len(data):
        if data[at] != 0xFF:
            return None
        marker = data[at + 1]
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            return struct.unpack(">H", data[at + 7 : at + 9])[0]
        at += 1 if marker == 0xFF else 2 + struct.unpack(">H", data[at + 2 : at + 4])[0]
    return None
