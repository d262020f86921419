"""Procedural pictures as PNG files. Colours are authored in sRGB, 0 to 1; data maps (roughness, normals) are linear."""

import math

import png


class Random:
    """A small generator of our own [SplitMix64, Steele et al. 2014], so that no library version changes a texture."""

    def __init__(self, seed):
        self.state = seed

    def bits(self):
        self.state = (self.state + 0x9E3779B97F4A7C15) & 0xFFFFFFFFFFFFFFFF
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & 0xFFFFFFFFFFFFFFFF
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & 0xFFFFFFFFFFFFFFFF
        return z ^ (z >> 31)

    def uniform(self, low=0.0, high=1.0):
        return low + (high - low) * (self.bits() >> 11) * 2.0**-53


def noise(width, height, cells_x, cells_y, seed):
    """Smooth value noise in -1 to 1 as rows; it tiles."""
    random = Random(seed)
    lattice = [[random.uniform(-1.0, 1.0) for _ in range(cells_x)] for _ in range(cells_y)]
    columns = []
    for x in range(width):
        s = x * cells_x / width
        cell, f = int(s), s - int(s)
        columns.append((cell, (cell + 1) % cells_x, f * f * (3.0 - 2.0 * f)))
    rows = []
    for y in range(height):
        s = y * cells_y / height
        cell, f = int(s), s - int(s)
        f = f * f * (3.0 - 2.0 * f)
        blend = [a + (b - a) * f for a, b in zip(lattice[cell], lattice[(cell + 1) % cells_y])]
        rows.append([blend[i] + (blend[j] - blend[i]) * t for i, j, t in columns])
    return rows


def byte(value):
    return 0 if value <= 0.0 else 255 if value >= 1.0 else int(value * 255.0 + 0.5)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def picture(width, height, colour):
    """A PNG of colour(x, y), which returns three or four channels from 0 to 1."""
    pixels = bytearray()
    for y in range(height):
        for x in range(width):
            pixels += bytes(byte(c) for c in colour(x, y))
    return png.encode(width, height, len(pixels) // (width * height), pixels)


def normal_map(heights, strength):
    """The tangent-space normals of a tiling height field (rows, top first); green points up the picture."""
    height, width = len(heights), len(heights[0])

    def normal(x, y):
        row = heights[y]
        du = (row[(x + 1) % width] - row[x - 1]) * strength
        dv = (heights[(y + 1) % height][x] - heights[y - 1][x]) * strength
        scale = 0.5 / math.sqrt(du * du + dv * dv + 1.0)
        return (0.5 - du * scale, 0.5 + dv * scale, 0.5 + scale)

    return picture(width, height, normal)


def wood_floor(width=1024, height=512, planks=8):
    """Oak planks along u: base colour, metallic-roughness and normal maps. One tile is planks wide, two plank
    lengths long."""
    random = Random(11)
    cuts = [int(random.uniform(0.0, width / 2)) for _ in range(planks)]
    tones = [[random.uniform(-1.0, 1.0) for _ in range(2)] for _ in range(planks)]
    shifts = [[int(random.uniform(0.0, width)) for _ in range(2)] for _ in range(planks)]
    coarse, fine = noise(width, height, 10, 96, 21), noise(width, height, 24, 256, 22)
    bend = noise(width, height, 5, 2 * planks, 23)
    plank_height = height // planks
    dark, light = (0.47, 0.33, 0.21), (0.69, 0.52, 0.35)
    colours, roughness, heights = [], [], []
    for y in range(height):
        plank, in_plank = y // plank_height, y % plank_height
        height_row = []
        for x in range(width):
            along = (x + cuts[plank]) % width
            board, in_board = along // (width // 2), along % (width // 2)
            source = (x + shifts[plank][board]) % width
            rings = math.sin(0.4 * in_plank + 7.0 * bend[y][source])
            grain = 0.5 + 0.16 * rings + 0.24 * coarse[y][source] + 0.12 * fine[y][source]
            gap = in_plank < 2 or in_board < 2
            tone = 1.0 + 0.13 * tones[plank][board]
            shade = 0.35 if gap else tone
            colours.append(tuple(c * shade for c in mix(dark, light, min(max(grain, 0.0), 1.0))))
            roughness.append(0.75 if gap else 0.46 - 0.16 * grain)
            height_row.append(-1.0 if gap else 0.12 * grain)
        heights.append(height_row)
    base = picture(width, height, lambda x, y: colours[y * width + x])
    rough = picture(width, height, lambda x, y: (1.0, roughness[y * width + x], 0.0))
    return base, rough, normal_map(heights, 0.6)


def brushed_metal(width=64, height=512):
    """Fine scratches along u: metallic-roughness (metallic 1) and normal maps."""
    lines, patches = noise(width, height, 2, 256, 31), noise(width, height, 4, 16, 32)
    rough = picture(width, height, lambda x, y: (1.0, 0.3 + 0.1 * lines[y][x] + 0.05 * patches[y][x], 1.0))
    return rough, normal_map(lines, 0.12)


def rug(width=512, height=384):
    """A woven rug: a border of bands around rows of diamonds."""
    indigo, cream, rust, gold = (0.10, 0.15, 0.27), (0.83, 0.77, 0.66), (0.62, 0.25, 0.16), (0.78, 0.56, 0.25)
    weave = noise(width, height, 128, 192, 41)

    def colour(x, y):
        edge = min(x, y, width - 1 - x, height - 1 - y)
        if edge < 14:
            base = cream
        elif edge < 40:
            base = rust if (x + y) // 13 % 2 else indigo
        elif edge < 48:
            base = gold
        else:
            u, v = (x - width / 2) / 52.0, (y - height / 2) / 48.0
            cell = (math.floor(u + 0.5), math.floor(v + 0.5))
            ring = abs(u - cell[0]) + abs(v - cell[1])
            field = (cream, rust, gold)[(cell[0] + 2 * cell[1]) % 3]
            base = field if ring < 0.17 else indigo if ring < 0.30 else cream if ring < 0.36 else indigo
        shade = 0.93 + 0.12 * weave[y][x] + (0.05 if (x // 2 + y // 2) % 2 else 0.0)
        return tuple(c * shade for c in base)

    return picture(width, height, colour)


def landscape(width=320, height=384):
    """The painting on the wall: a low sun over folded hills."""
    grain = noise(width, height, 80, 120, 51)
    hills = (
        (0.50, 0.050, 1.3, 0.4, (0.86, 0.58, 0.42)),
        (0.60, 0.060, 1.9, 2.1, (0.72, 0.40, 0.32)),
        (0.70, 0.055, 1.5, 4.0, (0.42, 0.31, 0.36)),
        (0.81, 0.050, 2.3, 0.9, (0.18, 0.27, 0.34)),
        (0.92, 0.040, 1.7, 5.2, (0.07, 0.16, 0.22)),
    )

    def colour(x, y):
        u, v = x / width, y / height
        out = mix((0.93, 0.84, 0.70), (0.95, 0.70, 0.48), min(1.0, v / 0.5))
        if math.hypot((u - 0.62) * width, (v - 0.30) * height) < 0.13 * width:
            out = (0.84, 0.32, 0.18)
        for level, swing, waves, phase, hill in hills:
            if v > level + swing * (
                math.sin(waves * 6.283 * u + phase) + 0.35 * math.sin(2.7 * waves * 6.283 * u + 2.0 * phase)
            ):
                out = hill
        return tuple(c * (1.0 + 0.06 * grain[y][x]) for c in out)

    return picture(width, height, colour)


def leaf(size=256):
    """One leaf with veins on transparent ground: RGBA, alpha 0 or 1 with a soft edge."""
    speckle = noise(size, size, 32, 32, 61)

    def colour(x, y):
        u, v = 2.0 * (x + 0.5) / size - 1.0, 1.0 - (y + 0.5) / size
        half_width = 0.85 * math.sin(math.pi * min(1.0, v * 1.04)) ** 0.8 * (1.0 - 0.45 * v) if v > 0.02 else 0.0
        stem = 0.035 if v < 0.5 else 0.02
        vein = abs(u) < stem or abs(math.sin(16.0 * (v - 0.55 * abs(u)))) < 0.10
        base = (0.44, 0.56, 0.22) if vein else (0.17, 0.38, 0.12)
        alpha = min(1.0, max(0.0, (max(half_width, stem if v < 0.12 else 0.0) - abs(u)) * size * 0.25))
        return tuple(c * (1.0 + 0.12 * speckle[y][x]) for c in base) + (alpha,)

    return picture(size, size, colour)


def checker(width, height, cells_x, cells_y, first, second):
    """A chessboard of two colours."""
    return picture(
        width, height, lambda x, y: first if (x * cells_x // width + y * cells_y // height) % 2 == 0 else second
    )


def letter_f(size=64):
    """A letter F in four differently coloured quadrants, so that every flip, turn and wrap of it can be told apart."""
    quadrants = ((0.85, 0.25, 0.2), (0.25, 0.7, 0.3), (0.2, 0.4, 0.85), (0.9, 0.8, 0.25))

    def colour(x, y):
        u, v = x / size, y / size
        inside = (
            0.3 <= u < 0.42
            and 0.2 <= v < 0.8
            or 0.3 <= u < 0.7
            and 0.2 <= v < 0.32
            or 0.3 <= u < 0.6
            and 0.45 <= v < 0.56
        )
        return (0.05, 0.05, 0.05) if inside else quadrants[(u >= 0.5) + 2 * (v >= 0.5)]

    return picture(size, size, colour)
