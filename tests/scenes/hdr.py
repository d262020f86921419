"""A Radiance HDR encoder: RGBE texels, rows not compressed [Ward, "Real Pixels", Graphics Gems II]."""

import math


def texel(colour):
    """The four bytes of a linear colour: mantissas that share the exponent of the greatest."""
    greatest = max(colour)
    if greatest <= 0.0:
        return bytes(4)
    mantissa, exponent = math.frexp(greatest)
    scale = mantissa * 256.0 / greatest
    return bytes([int(c * scale) for c in colour] + [exponent + 128])


def encode(width, height, colour_at):
    """The file's bytes. colour_at(x, y): the linear colour of a texel, (0, 0) top left."""
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    return header + b"".join(texel(colour_at(x, y)) for y in range(height) for x in range(width))
