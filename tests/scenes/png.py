"""A PNG encoder: 8 bits a channel, grey, RGB or RGBA, no interlacing [PNG specification, third edition]."""

import struct
import zlib

_COLOUR_TYPE = {1: 0, 3: 2, 4: 6}


def chunk(kind, payload):
    return struct.pack(">I", len(payload)) + kind + payload + struct.pack(">I", zlib.crc32(kind + payload))


def header(width, height, channels):
    """The signature and IHDR chunk."""
    fields = struct.pack(">IIBBBBB", width, height, 8, _COLOUR_TYPE[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", fields)


def _cost(row):
    return sum(b if b < 128 else 256 - b for b in row)


def _filtered(row, above, channels):
    """The row with the filter byte that makes it smallest: none, left or up."""
    left = bytes(channels) + row[:-channels]
    by_left = bytes((a - b) & 255 for a, b in zip(row, left))
    by_up = bytes((a - b) & 255 for a, b in zip(row, above))
    _, kind, best = min((_cost(row), 0, row), (_cost(by_left), 1, by_left), (_cost(by_up), 2, by_up))
    return bytes((kind,)) + best


def encode(width, height, channels, pixels):
    """The file's bytes. pixels: width * height * channels bytes, top row first."""
    if len(pixels) != width * height * channels:
        raise ValueError(f"{len(pixels)} bytes are not {width} x {height} x {channels}")
    stride = width * channels
    rows = []
    above = bytes(stride)
    for y in range(height):
        row = bytes(pixels[y * stride : (y + 1) * stride])
        rows.append(_filtered(row, above, channels))
        above = row
    return header(width, height, channels) + chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b"")
