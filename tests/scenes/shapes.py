"""Building blocks as meshes in metres, normals outward, y up."""

import math

import vec
from mesh import Mesh, merged


def grid(origin, edge_u, edge_v, cells_u=1, cells_v=1, uv_scale=(1.0, 1.0)):
    """A flat parallelogram of cells; its normal is edge_u x edge_v, its UVs run from 0 to uv_scale."""
    mesh = Mesh()
    normal = vec.normalize(vec.cross(edge_u, edge_v))
    for j in range(cells_v + 1):
        for i in range(cells_u + 1):
            u, v = i / cells_u, j / cells_v
            position = vec.add(origin, vec.add(vec.scale(edge_u, u), vec.scale(edge_v, v)))
            mesh.vertex(position, normal, (u * uv_scale[0], (1.0 - v) * uv_scale[1]))
    row = cells_u + 1
    for j in range(cells_v):
        for i in range(cells_u):
            a = j * row + i
            mesh.quad(a, a + 1, a + row + 1, a + row)
    return mesh


def quad(a, b, c, d, uvs=((0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0))):
    """A flat quadrilateral, counter-clockwise seen from its front."""
    mesh = Mesh()
    normal = vec.normalize(vec.cross(vec.sub(b, a), vec.sub(d, a)))
    mesh.quad(*[mesh.vertex(p, normal, uv) for p, uv in zip((a, b, c, d), uvs)])
    return mesh


def prism(base, height):
    """A block without a bottom over a counter-clockwise (seen from above) quadrilateral in the plane y = base[0].y."""
    top = [vec.add(p, (0.0, height, 0.0)) for p in base]
    sides = [quad(base[i], base[(i + 1) % 4], top[(i + 1) % 4], top[i]) for i in range(4)]
    return merged([quad(*top)] + sides)


_FACES = (  # axis of the normal, axis of u, axis of v, each with a sign, right-handed
    (vec.X, vec.scale(vec.Z, -1.0), vec.Y),
    (vec.scale(vec.X, -1.0), vec.Z, vec.Y),
    (vec.Y, vec.X, vec.scale(vec.Z, -1.0)),
    (vec.scale(vec.Y, -1.0), vec.X, vec.Z),
    (vec.Z, vec.X, vec.Y),
    (vec.scale(vec.Z, -1.0), vec.scale(vec.X, -1.0), vec.Y),
)


def box(size, uv_per_metre=1.0):
    """A sharp-edged box centred at the origin."""
    mesh = Mesh()
    half = vec.scale(size, 0.5)
    for normal, u, v in _FACES:
        extent_u, extent_v = abs(vec.dot(half, u)), abs(vec.dot(half, v))
        corner = vec.sub(vec.mul(normal, half), vec.add(vec.scale(u, extent_u), vec.scale(v, extent_v)))
        mesh.append(
            grid(
                corner,
                vec.scale(u, 2.0 * extent_u),
                vec.scale(v, 2.0 * extent_v),
                uv_scale=(2.0 * extent_u * uv_per_metre, 2.0 * extent_v * uv_per_metre),
            )
        )
    return mesh


def bevel_box(size, radius, segments=2, uv_per_metre=1.0):
    """A box centred at the origin whose edges are rounded by radius, in segments steps a 45 degrees."""
    mesh = Mesh()
    half = vec.scale(size, 0.5)
    inner = vec.sub(half, (radius, radius, radius))
    bevel = [radius * math.tan(math.radians(45.0 * k / segments)) for k in range(1, segments + 1)]
    for normal, u, v in _FACES:
        flat_u, flat_v = abs(vec.dot(inner, u)), abs(vec.dot(inner, v))
        along_u = [-flat_u - b for b in reversed(bevel)] + [-flat_u, flat_u] + [flat_u + b for b in bevel]
        along_v = [-flat_v - b for b in reversed(bevel)] + [-flat_v, flat_v] + [flat_v + b for b in bevel]
        base = len(mesh.positions)
        for t in along_v:
            for s in along_u:
                on_cube = vec.add(vec.mul(normal, half), vec.add(vec.scale(u, s), vec.scale(v, t)))
                core = tuple(max(-inner[k], min(inner[k], on_cube[k])) for k in range(3))
                outward = vec.normalize(vec.sub(on_cube, core))
                uv = ((s + flat_u + radius) * uv_per_metre, (flat_v + radius - t) * uv_per_metre)
                mesh.vertex(vec.add(core, vec.scale(outward, radius)), outward, uv)
        row = len(along_u)
        for j in range(row - 1):
            for i in range(row - 1):
                a = base + j * row + i
                mesh.quad(a, a + 1, a + row + 1, a + row)
    return mesh


def catmull_rom(points, steps):
    """A smooth profile through 2D control points, steps pieces between neighbours."""
    out = []
    for i in range(len(points) - 1):
        p0, p1, p2 = points[max(i - 1, 0)], points[i], points[i + 1]
        p3 = points[min(i + 2, len(points) - 1)]
        for k in range(steps):
            t = k / steps
            out.append(
                tuple(
                    0.5
                    * (
                        2.0 * p1[c]
                        + (p2[c] - p0[c]) * t
                        + (2.0 * p0[c] - 5.0 * p1[c] + 4.0 * p2[c] - p3[c]) * t * t
                        + (3.0 * p1[c] - p0[c] - 3.0 * p2[c] + p3[c]) * t * t * t
                    )
                    for c in range(2)
                )
            )
    return [(max(r, 0.0), y) for r, y in out] + [points[-1]]


def lathe(runs, segments=48, uv_scale=(1.0, 1.0)):
    """A surface of revolution about y. Each run is a smooth list of (radius, y); between runs lies a crease.
    Walked upwards a run faces away from the axis, walked downwards it faces the axis."""
    mesh = Mesh()
    for run in runs:
        lengths = [0.0]
        for (r0, y0), (r1, y1) in zip(run, run[1:]):
            lengths.append(lengths[-1] + math.hypot(r1 - r0, y1 - y0))
        base = len(mesh.positions)
        for j, (r, y) in enumerate(run):
            before, after = run[max(j - 1, 0)], run[min(j + 1, len(run) - 1)]
            slope = vec.normalize((after[1] - before[1], before[0] - after[0], 0.0))
            if r == 0.0:
                slope = (0.0, 1.0 if slope[1] > 0.0 else -1.0, 0.0)
            for i in range(segments + 1):
                angle = 2.0 * math.pi * (i % segments) / segments
                c, s = math.cos(angle), math.sin(angle)
                uv = (uv_scale[0] * i / segments, uv_scale[1] * (1.0 - lengths[j] / lengths[-1]))
                mesh.vertex((r * c, y, r * s), (slope[0] * c, slope[1], slope[0] * s), uv)
        for j in range(len(run) - 1):
            for i in range(segments):
                a = base + j * (segments + 1) + i
                mesh.quad(a, a + segments + 1, a + segments + 2, a + 1)
    return mesh


def sphere(radius, segments=48, rings=24):
    """A sphere about the origin; vertices lie on it, so its area and volume are slightly smaller."""
    profile = [
        (radius * math.sin(math.pi * k / rings), -radius * math.cos(math.pi * k / rings)) for k in range(rings + 1)
    ]
    profile[0], profile[-1] = (0.0, -radius), (0.0, radius)
    mesh = lathe([profile], segments)
    mesh.normals = [vec.scale(p, 1.0 / radius) for p in mesh.positions]
    return mesh


def cylinder(radius, height, segments=32, top_radius=None):
    """A capped cylinder or cone frustum standing on y = 0."""
    top = radius if top_radius is None else top_radius
    return lathe(
        [[(0.0, 0.0), (radius, 0.0)], [(radius, 0.0), (top, height)], [(top, height), (0.0, height)]], segments
    )


def tube(path, radius, segments=16):
    """A round tube along an open polyline, closed by flat caps. radius is a number or a list, one a point."""
    radii = radius if isinstance(radius, (list, tuple)) else [radius] * len(path)
    mesh = Mesh()
    tangents = [vec.normalize(vec.sub(path[min(k + 1, len(path) - 1)], path[max(k - 1, 0)])) for k in range(len(path))]
    side = vec.normalize(vec.cross(tangents[0], vec.X if abs(tangents[0][0]) < 0.8 else vec.Z))
    frames = []
    for tangent in tangents:  # carry the side vector along, so that the tube does not twist
        side = vec.normalize(vec.sub(side, vec.scale(tangent, vec.dot(side, tangent))))
        frames.append((side, vec.cross(tangent, side)))
    travelled = 0.0
    for k, (point, (n, b)) in enumerate(zip(path, frames)):
        travelled += vec.length(vec.sub(point, path[max(k - 1, 0)]))
        for i in range(segments + 1):
            angle = 2.0 * math.pi * (i % segments) / segments
            outward = vec.add(vec.scale(n, math.cos(angle)), vec.scale(b, math.sin(angle)))
            mesh.vertex(vec.add(point, vec.scale(outward, radii[k])), outward, (i / segments, travelled))
    for k in range(len(path) - 1):
        for i in range(segments):
            a = k * (segments + 1) + i
            mesh.quad(a, a + 1, a + segments + 2, a + segments + 1)
    for k, facing in ((0, -1.0), (len(path) - 1, 1.0)):
        normal = vec.scale(tangents[k], facing)
        rim = [mesh.vertex(mesh.positions[k * (segments + 1) + i], normal) for i in range(segments)]
        centre = mesh.vertex(path[k], normal, (0.5, 0.5))
        for i in range(segments):
            a, b = rim[i], rim[(i + 1) % segments]
            mesh.triangle(centre, *((a, b) if facing > 0.0 else (b, a)))
    return mesh


def torus_knot(p, q, ring_radius, coil_radius, tube_radius, steps=240, segments=20):
    """A tube along the (p, q) knot on a torus about y; its frame is the torus' own normal, so it closes without a
    seam."""
    mesh = Mesh()

    def core(t):
        phi, theta = p * t, q * t
        reach = ring_radius + coil_radius * math.cos(theta)
        point = (reach * math.cos(phi), coil_radius * math.sin(theta), reach * math.sin(phi))
        normal = (math.cos(theta) * math.cos(phi), math.sin(theta), math.cos(theta) * math.sin(phi))
        return point, normal

    for k in range(steps + 1):
        t = 2.0 * math.pi * (k % steps) / steps
        point, normal = core(t)
        tangent = vec.normalize(vec.sub(core(t + 1e-4)[0], core(t - 1e-4)[0]))
        binormal = vec.normalize(vec.cross(tangent, normal))
        normal = vec.cross(binormal, tangent)
        for i in range(segments + 1):
            angle = 2.0 * math.pi * (i % segments) / segments
            outward = vec.add(vec.scale(normal, math.cos(angle)), vec.scale(binormal, math.sin(angle)))
            mesh.vertex(vec.add(point, vec.scale(outward, tube_radius)), outward, (12.0 * k / steps, i / segments))
    row = segments + 1
    for k in range(steps):
        for i in range(segments):
            a = k * row + i
            mesh.quad(a, a + 1, a + row + 1, a + row)
    return mesh


def picture_frame(width, height, border, depth):
    """A mitred frame around a width x height opening in the plane z = 0, facing +z, its back at z = 0."""
    profile = (
        (0.0, 0.0),
        (0.0, 0.55 * depth),
        (0.3 * border, 0.6 * depth),
        (0.55 * border, depth),
        (0.9 * border, depth),
        (border, 0.85 * depth),
        (border, 0.0),
    )
    corners = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))

    def at(corner, outward, z):
        return (corner[0] * (0.5 * width + outward), corner[1] * (0.5 * height + outward), z)

    mesh = Mesh()
    for k in range(4):
        a, b = corners[k], corners[(k + 1) % 4]
        for (d0, z0), (d1, z1) in zip(profile, profile[1:]):
            mesh.append(quad(at(a, d1, z1), at(b, d1, z1), at(b, d0, z0), at(a, d0, z0)))
    return mesh
