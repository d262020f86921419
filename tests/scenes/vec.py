"""Vectors as tuples of three floats, rotations as row-major 3x3 tuples or glTF quaternions (x, y, z, w). Right-
handed, y up."""

import math

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def mul(a, b):
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def normalize(a):
    """The unit vector along a; the zero vector stays zero."""
    size = length(a)
    return scale(a, 1.0 / size) if size > 0.0 else a


def lerp(a, b, t):
    return (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t)


def quaternion(axis, degrees):
    """The rotation by degrees about axis, counter-clockwise seen against the axis."""
    half = math.radians(degrees) * 0.5
    x, y, z = scale(normalize(axis), math.sin(half))
    return (x, y, z, math.cos(half))


def rotate(q, v):
    """v rotated by the unit quaternion q."""
    u, w = (q[0], q[1], q[2]), q[3]
    t = scale(cross(u, v), 2.0)
    return add(add(v, scale(t, w)), cross(u, t))


def quaternion_from_basis(x, y, z):
    """The rotation that takes the coordinate axes to the orthonormal right-handed x, y, z."""
    trace = x[0] + y[1] + z[2]
    if trace > 0.0:
        s = math.sqrt(trace + 1.0) * 2.0
        q = ((y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s, 0.25 * s)
    elif x[0] >= y[1] and x[0] >= z[2]:
        s = math.sqrt(1.0 + x[0] - y[1] - z[2]) * 2.0
        q = (0.25 * s, (y[0] + x[1]) / s, (z[0] + x[2]) / s, (y[2] - z[1]) / s)
    elif y[1] >= z[2]:
        s = math.sqrt(1.0 + y[1] - x[0] - z[2]) * 2.0
        q = ((y[0] + x[1]) / s, 0.25 * s, (z[1] + y[2]) / s, (z[0] - x[2]) / s)
    else:
        s = math.sqrt(1.0 + z[2] - x[0] - y[1]) * 2.0
        q = ((z[0] + x[2]) / s, (z[1] + y[2]) / s, 0.25 * s, (x[1] - y[0]) / s)
    return q


def look_rotation(direction, up=Y):
    """The rotation that points a glTF camera or light (which looks along -z) along direction."""
    z = normalize(scale(direction, -1.0))
    if abs(dot(z, normalize(up))) > 0.9999:
        up = Z if abs(z[2]) < 0.9 else X
    x = normalize(cross(up, z))
    return quaternion_from_basis(x, cross(z, x), z)
