"""The things in the demo room, each a mesh (or pairs of mesh and material key) standing at its own origin on y = 0."""

import math

import shapes
import vec
from mesh import merged
from shapes import bevel_box, catmull_rom, cylinder, lathe, tube
from textures import Random


def leg(foot, head, foot_radius, head_radius, segments=20):
    """A tapered round leg between two points."""
    return tube([foot, head], [foot_radius, head_radius], segments)


def coffee_table(width=1.15, depth=0.62, height=0.42):
    top = bevel_box((width, 0.034, depth), 0.012, 3, 1.0).moved((0.0, height - 0.017, 0.0))
    parts = [top]
    for sx in (-1.0, 1.0):
        for sz in (-1.0, 1.0):
            head = (sx * (0.5 * width - 0.13), height - 0.03, sz * (0.5 * depth - 0.10))
            foot = (sx * (0.5 * width - 0.06), 0.0, sz * (0.5 * depth - 0.05))
            parts.append(leg(foot, head, 0.013, 0.022))
    rail = bevel_box((width - 0.24, 0.045, 0.02), 0.004, 1).moved((0.0, height - 0.057, 0.0))
    return merged(parts + [rail])


def _chair_back(y):
    """z of the rear posts' centre line at height y: splayed below the seat, reclined above."""
    return -0.18 - 0.05 * (1.0 - y / 0.44) ** 2 if y < 0.44 else -0.18 - 0.45 * (y - 0.44) ** 2


def chair():
    """A dining chair that faces +z, seat 0.45 m high."""
    seat = bevel_box((0.44, 0.032, 0.43), 0.014, 3).moved((0.0, 0.45, 0.0))
    parts = [seat]
    for sx in (-1.0, 1.0):
        parts.append(leg((sx * 0.20, 0.0, 0.19), (sx * 0.17, 0.44, 0.16), 0.011, 0.018))
        post = [(sx * 0.19, 0.88 * k / 20.0, _chair_back(0.88 * k / 20.0)) for k in range(21)]
        parts.append(tube(post, [0.012 + 0.006 * math.sin(math.pi * y / 0.9) for _, y, _ in post], 12))
        parts.append(leg((sx * 0.188, 0.20, 0.176), (sx * 0.188, 0.24, -0.20), 0.009, 0.009, 12))
    for y in (0.60, 0.71, 0.82):
        lean = -math.degrees(math.atan(10.0 * (_chair_back(y) - _chair_back(y + 0.1))))
        slat = bevel_box((0.38, 0.056, 0.014), 0.005, 2)
        parts.append(slat.moved((0.0, y, _chair_back(y)), vec.quaternion(vec.X, lean)))
    return merged(parts)


def blue_vase():
    """A bulbous bottle of glass 5 mm thick, walked from the foot up the outside and down the inside."""
    outer = catmull_rom(
        [(0.045, 0.004), (0.082, 0.05), (0.094, 0.11), (0.062, 0.19), (0.026, 0.25), (0.025, 0.30), (0.042, 0.335)], 5
    )
    inner = [(max(r - 0.005, 0.001), max(y, 0.014)) for r, y in reversed(outer)]
    foot = [(0.0, 0.0), (0.041, 0.0)]
    rim = [outer[-1], (0.0405, 0.3375), inner[0]]
    return lathe([foot, [foot[-1], outer[0]], outer, rim, inner, [inner[-1], (0.0, 0.014)]], 44)


def floor_vase():
    """A tall ceramic vase with an open neck."""
    outer = catmull_rom(
        [(0.07, 0.0), (0.125, 0.10), (0.165, 0.28), (0.135, 0.44), (0.062, 0.54), (0.055, 0.60), (0.082, 0.64)], 5
    )
    inner = [(0.074, 0.634), (0.048, 0.60), (0.054, 0.53), (0.12, 0.42)]
    return lathe(
        [[(0.0, 0.0), outer[0]], outer, [outer[-1], (0.079, 0.643), inner[0]], inner, [inner[-1], (0.0, 0.40)]], 44
    )


def bowl():
    outer = catmull_rom([(0.045, 0.0), (0.055, 0.012), (0.10, 0.035), (0.138, 0.085)], 5)
    inner = catmull_rom([(0.131, 0.085), (0.095, 0.043), (0.05, 0.022), (0.0, 0.018)], 5)
    return lathe([[(0.0, 0.004), (0.04, 0.004), outer[0]], outer, [outer[-1], (0.1345, 0.088), inner[0]], inner], 44)


def orange(radius=0.038):
    profile = [(0.0, -0.95 * radius)]
    for k in range(1, 14):
        t = math.pi * k / 14
        dimple = 1.0 - 0.10 * math.exp(-18.0 * (1.0 + math.cos(math.pi - t)))
        profile.append((radius * math.sin(t), -0.95 * radius * math.cos(t) * dimple))
    profile.append((0.0, 0.95 * radius * 0.9))
    return lathe([profile], 22)


def oranges():
    """Five oranges that rest in the bowl."""
    places = (
        (0.045, 0.062, 0.02),
        (-0.038, 0.062, 0.034),
        (-0.028, 0.063, -0.044),
        (0.048, 0.066, -0.052),
        (0.004, 0.116, 0.0),
    )
    turned = [orange().moved(p, vec.quaternion((1.0, 0.3 * k, 0.5), 35.0 * k - 60.0)) for k, p in enumerate(places)]
    return merged(turned)


def book(width, depth, thickness):
    """Cover and pages of a lying book, its spine towards -x."""
    board = 0.003
    boards = [
        bevel_box((width, board, depth), 0.0012, 1).moved((0.0, y, 0.0)) for y in (0.5 * board, thickness - 0.5 * board)
    ]
    spine = bevel_box((board, thickness, depth), 0.0012, 1).moved((0.5 * (board - width), 0.5 * thickness, 0.0))
    pages = shapes.box((width - 0.008, thickness - 2.0 * board, depth - 0.010)).moved((-0.002, 0.5 * thickness, 0.0))
    return merged(boards + [spine]), pages


def plant_blades(count=17):
    """Upright sword leaves that bend outwards from a common root; front and back are the same surface."""
    random = Random(71)
    blades = []
    for k in range(count):
        turn = 360.0 * (k * 0.381966 % 1.0) + random.uniform(-14.0, 14.0)
        tall = random.uniform(0.42, 0.78) * (1.0 - 0.25 * k / count)
        lean, curl = random.uniform(0.04, 0.12) + 0.010 * k, random.uniform(0.10, 0.30)
        root, wide = 0.012 + 0.0045 * k, random.uniform(0.026, 0.036)
        blade = shapes.grid((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), 4, 14)
        points, normals = [], []
        for s, t, _ in blade.positions:
            across = (s - 0.5) * 2.0
            half = wide * (0.55 + 0.9 * t - 1.43 * t**3.2)
            reach = root + tall * (lean * t + curl * t**2.6)
            fold = 0.35 * half * across * across
            points.append((across * half, tall * (t - 0.12 * curl * t**3), reach - fold))
            normals.append(vec.normalize((-0.7 * across, -(lean + 2.6 * curl * t**1.6), 1.0)))
        blade.positions, blade.normals = points, normals
        blades.append(blade.moved((0.0, 0.0, 0.0), vec.quaternion(vec.Y, turn)))
    return merged(blades)


def plant_pot():
    outer = catmull_rom([(0.095, 0.0), (0.115, 0.06), (0.145, 0.20), (0.152, 0.27)], 5)
    return lathe(
        [
            [(0.0, 0.0), outer[0]],
            outer,
            [outer[-1], (0.155, 0.275), (0.150, 0.28), (0.141, 0.275)],
            [(0.141, 0.275), (0.132, 0.22)],
        ],
        44,
        (1.0, 1.0),
    )


def soil():
    return lathe([[(0.136, 0.235), (0.08, 0.245), (0.0, 0.25)]], 40)


def arc_lamp(reach, top, drop):
    """A marble block, the steel arc that rises from it and bends towards +x, and the end of the arc."""
    base = bevel_box((0.22, 0.16, 0.30), 0.012, 3).moved((0.0, 0.08, 0.0))
    path = [(0.0, 0.14 + 0.11 * k, 0.0) for k in range(10)]
    start = path[-1][1]
    for k in range(1, 33):
        t = k / 32.0
        angle = math.pi * 0.80 * t
        path.append(
            (
                reach * (1.0 - math.cos(angle)) / (1.0 - math.cos(math.pi * 0.80)),
                start + (top - start) * math.sin(angle),
                0.0,
            )
        )
    end = path[-1]
    stem = [end, (end[0] + 0.004, end[1] - 0.4 * drop, 0.0), (end[0] + 0.004, end[1] - drop, 0.0)]
    return base, tube(path, 0.012, 16).append(tube(stem, 0.008, 12)), stem[-1]


def lamp_dome(radius=0.17):
    """A dome open below, its rim at y = 0: the outside and the inside."""
    arc = [(radius * math.cos(math.radians(a)), 0.9 * radius * math.sin(math.radians(a))) for a in range(0, 91, 9)]
    arc[-1] = (0.0, 0.9 * radius)
    thin = [(0.965 * r, 0.965 * y) for r, y in reversed(arc)]
    cap = cylinder(0.028, 0.05, 24, 0.016).moved((0.0, 0.885 * radius, 0.0))
    return lathe([arc, [thin[-1], arc[0]]], 40).append(cap), lathe([thin], 40)


def window_frame(width, height):
    """Frame, bars and sill around a width x height opening, facing +z, its back at z = 0."""
    bar, deep = 0.055, 0.05
    parts = []
    for s in (-1.0, 1.0):
        parts.append(
            bevel_box((bar, height + 2.0 * bar, deep), 0.006, 2).moved((s * 0.5 * (width + bar), 0.0, 0.5 * deep))
        )
        parts.append(bevel_box((width, bar, deep), 0.006, 2).moved((0.0, s * 0.5 * (height + bar), 0.5 * deep)))
    parts.append(bevel_box((0.03, height, 0.03), 0.004, 1).moved((0.0, 0.0, 0.03)))
    parts.append(bevel_box((width, 0.03, 0.03), 0.004, 1).moved((0.0, 0.12 * height, 0.03)))
    parts.append(bevel_box((width + 0.24, 0.03, 0.15), 0.01, 2).moved((0.0, -0.5 * height - bar - 0.012, 0.075)))
    return merged(parts)
