"""The Cornell box under a point light, made awkward in one way each. Unless a scene says otherwise its picture is
cornell-point's. tests/techniques/hard_cases_box_test.cpp holds every technique to that."""

import functools
import math

import materials
import scenes_cornell
import shapes
import vec
from gltf_writer import Builder
from mesh import Mesh, merged
from scenes_cornell import (
    EMISSION,
    POINT_COLOUR,
    POINT_INTENSITY,
    POINT_POSITION,
    add_camera,
    block,
    wall_materials,
    walls,
)
from textures import Random

FAR = (1.0e5, 1.0e5, 1.0e5)
TURN = vec.quaternion((1.0, 2.0, 3.0), 77.0)


def objects():
    return walls(False) + [("Short block", block("Short block"), "white"), ("Tall block", block("Tall block"), "white")]


def cornell(
    name,
    change=lambda mesh: mesh,
    overrides=None,
    point=lambda p: p,
    intensity=POINT_INTENSITY,
    root=None,
    extra=None,
    near=0.001,
):
    """cornell-point with change applied to every mesh and point to every position outside meshes. root: a transform
    of a node over everything; extra: called with the builder, returns further nodes."""
    scene = Builder(name)
    palette = {key: scene.add_material(m) for key, m in wall_materials().items()}
    overrides = {key: scene.add_material(m) for key, m in (overrides or {}).items()}
    nodes = [scene.add_object(part, change(mesh), overrides.get(part, palette[key])) for part, mesh, key in objects()]
    nodes += extra(scene) if extra else []
    nodes.append(scene.add_light("Light", "point", intensity, POINT_COLOUR, point(POINT_POSITION)))
    eye, target = point((0.278, 0.273, -0.8)), point((0.278, 0.273, 0.0))
    nodes.append(scene.add_camera("Camera", eye, target, 39.3077, near=near))
    if root:
        scene.add_node("Root", children=nodes, **root)
    return scene.glb()


def scaled(name, factor):
    """The box factor times as large, its light factor^2 times as strong: the same picture."""
    return cornell(
        name,
        lambda m: m.moved(scale=factor),
        point=lambda p: vec.scale(p, factor),
        intensity=POINT_INTENSITY * factor * factor,
        near=0.001 * factor,
    )


def far_baked():
    """A ten times larger box 1e5 m away in every axis, in its vertices: single precision leaves steps of 8 mm, 1/700
    of the box."""
    return cornell(
        "hard-far-baked",
        lambda m: m.moved(FAR, scale=10.0),
        point=lambda p: vec.add(vec.scale(p, 10.0), FAR),
        intensity=100.0 * POINT_INTENSITY,
        near=0.01,
    )


def far_node():
    """A ten times larger box 1e5 m away by its root node, camera and light included."""
    return cornell(
        "hard-far-node",
        lambda m: m.moved(scale=10.0),
        point=lambda p: vec.scale(p, 10.0),
        intensity=100.0 * POINT_INTENSITY,
        near=0.01,
        root={"translation": FAR},
    )


def rotated():
    """Everything turned about an odd axis by its root node."""
    return cornell("hard-rotated", root={"rotation": TURN})


def mirrored():
    """Vertices mirrored in x and mirrored back by a node of negative determinant; winding follows the vertices."""

    def mirror(mesh):
        out = mesh.flipped()
        out.positions = [(-p[0], p[1], p[2]) for p in out.positions]
        out.normals = [(n[0], -n[1], -n[2]) for n in out.normals]
        return out

    scene = Builder("hard-mirrored")
    palette = {key: scene.add_material(m) for key, m in wall_materials().items()}
    nodes = [scene.add_object(part, mirror(mesh), palette[key]) for part, mesh, key in objects()]
    scene.add_node("Mirror", children=nodes, scale=(-1.0, 1.0, 1.0))
    scene.add_light("Light", "point", POINT_INTENSITY, POINT_COLOUR, POINT_POSITION)
    add_camera(scene)
    return scene.glb()


def permuted():
    """Vertices and triangles in a shuffled order, and triangles begun at another corner."""
    random = Random(121)

    def shuffled(count):
        order = list(range(count))
        for k in range(count - 1, 0, -1):
            j = int(random.uniform(0.0, k + 1.0))
            order[k], order[j] = order[j], order[k]
        return order

    def permute(mesh):
        out, order = Mesh(), shuffled(len(mesh.positions))
        place = {old: new for new, old in enumerate(order)}
        for old in order:
            out.vertex(mesh.positions[old], mesh.normals[old], mesh.uvs[old])
        for t in shuffled(mesh.triangle_count):
            a, b, c = (place[i] for i in mesh.indices[3 * t : 3 * t + 3])
            out.indices += (b, c, a)
        return out

    return cornell("hard-permuted", permute)


def doubled_vertices():
    """Every triangle with its own corners, and every vertex stored twice."""

    def double(mesh):
        out = Mesh()
        for k in mesh.indices:
            out.vertex(mesh.positions[k], mesh.normals[k], mesh.uvs[k])
            out.indices.append(out.vertex(mesh.positions[k], mesh.normals[k], mesh.uvs[k]))
        return out

    return cornell("hard-doubled-vertices", double)


def coplanar():
    """Every triangle twice in the same place."""
    return cornell("hard-coplanar", lambda m: merged([m, m]))


def degenerate():
    """Zero-area triangles (repeated corners, collinear corners, a single point) and needles 1e-7 m wide in every
    mesh."""

    def degrade(mesh):
        out = merged([mesh])
        a, b, c = mesh.indices[:3]
        pa, pb, normal = mesh.positions[a], mesh.positions[b], mesh.normals[a]
        middle = out.vertex(vec.lerp(pa, pb, 0.5), normal)
        aside = vec.scale(vec.normalize(vec.sub(mesh.positions[c], pa)), 1.0e-7)
        needle = out.vertex(vec.add(pa, aside), normal)
        out.indices += (a, a, b, a, a, a, a, middle, b, a, b, needle)
        return out

    return cornell("hard-degenerate", degrade)


def bad_normals():
    """Zero, unnormalised, tiny and huge normals: a zero normal stands for the face's own, the others for their
    direction."""
    factors = (0.0, 3.0, 1.0e-12, 1.0e12, 1.0)

    def spoil(mesh):
        out = merged([mesh])
        out.normals = [vec.scale(n, factors[k % len(factors)]) for k, n in enumerate(out.normals)]
        return out

    return cornell("hard-bad-normals", spoil)


def split_emitters():
    """cornell-box with its lamp as 8x8 cells of unequal size, two triangles each: the picture of cornell-box."""

    def split(light):
        (x1, y, z0), (x0, _, z1) = light[0], light[2]
        steps = [k * k / 64.0 for k in range(9)]
        xs, zs = [x0 + (x1 - x0) * t for t in steps], [z0 + (z1 - z0) * t for t in steps]
        return merged(
            [
                shapes.quad((b, y, c), (b, y, d), (a, y, d), (a, y, c))
                for a, b in zip(xs, xs[1:])
                for c, d in zip(zs, zs[1:])
            ]
        )

    return scenes_cornell.cornell("hard-split-emitters", lamp=split)


def tiny_light():
    """A sphere of radius 0.5 mm that sends 1e6 W/sr, in place of the point: a picture like cornell-point's, 4e6
    times brighter."""
    radius, intensity = 0.5e-3, 1.0e6
    radiance = intensity / (math.pi * radius * radius)
    scene = Builder("hard-tiny-light")
    palette = {key: scene.add_material(m) for key, m in wall_materials().items()}
    for part, mesh, key in objects():
        scene.add_object(part, mesh, palette[key])
    tint = vec.scale(EMISSION, radiance / max(EMISSION))
    scene.add_object(
        "Light",
        shapes.sphere(radius, 16, 8),
        scene.add_material(materials.emitter("Light", tint)),
        translation=POINT_POSITION,
    )
    add_camera(scene)
    return scene.glb()


def smooth_metal(name, roughness):
    """Both blocks of metal with this roughness; 1e-4 looks like 0."""
    metal = materials.metal(f"Metal roughness {roughness}", (0.9, 0.9, 0.9), roughness)
    return cornell(name, overrides={"Short block": metal, "Tall block": metal})


def _sphere_in_the_box(material, position):
    def add(scene):
        return [
            scene.add_object("Sphere", shapes.sphere(0.06, 64, 32), scene.add_material(material), translation=position)
        ]

    return add


def ior_1():
    """A sphere of index 1 without absorption hangs over the short block: it bends and reflects nothing, so light
    passes as if it were not there (where shadow rays stop at it, its shadow is dark)."""
    return cornell(
        "hard-ior-1", extra=_sphere_in_the_box(materials.glass("Nothing", 1.0, thickness=0.12), (0.186, 0.26, 0.168))
    )


def touching():
    """A glass sphere that touches the floor in a point, and a block that stands exactly on the short block's top."""

    def add(scene):
        grey = scene.add_material(materials.lambert("Grey", (0.4, 0.4, 0.4)))
        cube = shapes.box((0.08, 0.08, 0.08))
        above = scene.add_object("Cube", cube, grey, translation=(0.186, 0.165 + 0.04, 0.168))
        return _sphere_in_the_box(materials.glass("Glass", 1.5, thickness=0.12), (0.42, 0.06, 0.12))(scene) + [above]

    return cornell("hard-touching", extra=add)


SCENES = {
    "hard-scale-1e-3": functools.partial(scaled, "hard-scale-1e-3", 1.0e-3),
    "hard-scale-1e4": functools.partial(scaled, "hard-scale-1e4", 1.0e4),
    "hard-far-baked": far_baked,
    "hard-far-node": far_node,
    "hard-rotated": rotated,
    "hard-permuted": permuted,
    "hard-split-emitters": split_emitters,
    "hard-doubled-vertices": doubled_vertices,
    "hard-coplanar": coplanar,
    "hard-degenerate": degenerate,
    "hard-bad-normals": bad_normals,
    "hard-mirrored": mirrored,
    "hard-tiny-light": tiny_light,
    "hard-roughness-0": functools.partial(smooth_metal, "hard-roughness-0", 0.0),
    "hard-roughness-1e-4": functools.partial(smooth_metal, "hard-roughness-1e-4", 1.0e-4),
    "hard-ior-1": ior_1,
    "hard-touching": touching,
}
