"""Meshes stored in the less usual ways glTF allows. Each function adds a mesh of about 0.8 m around the origin,
facing +z, and returns the arguments of its node."""

import array
import math
import struct

import shapes
import vec
from gltf_writer import FLOAT, INT8, UINT8, UINT16, flat

TRIANGLE_STRIP, TRIANGLE_FAN = 5, 6


def panel(cells=1, uv=1.0):
    """The square every flat exhibit starts from."""
    return shapes.grid((-0.4, -0.4, 0.0), (0.8, 0.0, 0.0), (0.0, 0.8, 0.0), cells, cells, (uv, uv))


def _mesh(scene, name, attributes, material, indices=None, **more):
    primitive = {"attributes": attributes, "material": material, **more}
    if indices is not None:
        primitive["indices"] = indices
    return scene.add("meshes", {"name": name, "primitives": [primitive]})


def sparse(scene, name, material):
    """A flat grid whose middle is raised to a pyramid by a sparse accessor over its positions."""
    mesh = panel(8)
    raised = [(k, p) for k, p in enumerate(mesh.positions) if max(abs(p[0]), abs(p[1])) < 0.25]
    lifted = [(p[0], p[1], 0.25 - max(abs(p[0]), abs(p[1]))) for _, p in raised]
    position = scene.add_accessor(flat(mesh.positions), "VEC3")
    indices = scene.add_view(array.array("H", [k for k, _ in raised]).tobytes())
    values = scene.add_view(array.array("f", flat(lifted)).tobytes())
    every = [p for p in mesh.positions] + lifted
    scene.document["accessors"][position].update(
        {
            "min": [min(array.array("f", [p[c] for p in every])) for c in range(3)],
            "max": [max(array.array("f", [p[c] for p in every])) for c in range(3)],
            "sparse": {
                "count": len(raised),
                "indices": {"bufferView": indices, "componentType": UINT16},
                "values": {"bufferView": values},
            },
        }
    )
    return {
        "mesh": _mesh(
            scene, name, {"POSITION": position}, material, scene.add_indices(mesh.indices, len(mesh.positions))
        )
    }


def interleaved(scene, name, material):
    """Position, normal and UV of a sphere in one view, 32 bytes a vertex."""
    mesh = shapes.sphere(0.36, 32, 16)
    packed = b"".join(struct.pack("<8f", *p, *n, *uv) for p, n, uv in zip(mesh.positions, mesh.normals, mesh.uvs))
    view = scene.add_view(packed, 34962, 32)
    attributes = {}
    for semantic, offset, kind in (("POSITION", 0, "VEC3"), ("NORMAL", 12, "VEC3"), ("TEXCOORD_0", 24, "VEC2")):
        accessor = {
            "bufferView": view,
            "byteOffset": offset,
            "componentType": FLOAT,
            "count": len(mesh.positions),
            "type": kind,
        }
        if semantic == "POSITION":
            columns = [array.array("f", [p[c] for p in mesh.positions]) for c in range(3)]
            accessor.update({"min": [min(c) for c in columns], "max": [max(c) for c in columns]})
        attributes[semantic] = scene.add("accessors", accessor)
    return {"mesh": _mesh(scene, name, attributes, material, scene.add_indices(mesh.indices, len(mesh.positions)))}


def quantized(scene, name, material):
    """A torus knot with 16-bit positions, 8-bit normals and 16-bit UVs [KHR_mesh_quantization]; its node scales it
    back."""
    scene.required.append("KHR_mesh_quantization")
    mesh = shapes.torus_knot(2, 3, 0.22, 0.09, 0.06, 120, 12)
    step = 0.4 / 65535.0
    positions, normals = array.array("H"), array.array("b")
    for p, n in zip(mesh.positions, mesh.normals):
        positions.extend([int((c + 0.4) / (2.0 * step) + 0.5) for c in p] + [0])
        normals.extend([round(c * 127.0) for c in n] + [0])
    count = len(mesh.positions)
    columns = [positions[c::4] for c in range(3)]
    attributes = {
        "POSITION": scene.add(
            "accessors",
            {
                "bufferView": scene.add_view(positions.tobytes(), 34962, 8),
                "componentType": UINT16,
                "count": count,
                "type": "VEC3",
                "min": [min(c) for c in columns],
                "max": [max(c) for c in columns],
            },
        ),
        "NORMAL": scene.add(
            "accessors",
            {
                "bufferView": scene.add_view(normals.tobytes(), 34962, 4),
                "componentType": INT8,
                "normalized": True,
                "count": count,
                "type": "VEC3",
            },
        ),
        "TEXCOORD_0": scene.add_accessor(
            [int(c % 1.0 * 65535.0) for c in flat(mesh.uvs)], "VEC2", UINT16, normalized=True
        ),
    }
    child = scene.add_node(
        name + ", dequantized",
        translation=(-0.4, -0.4, -0.4),
        scale=[2.0 * step] * 3,
        mesh=_mesh(scene, name, attributes, material, scene.add_indices(mesh.indices, count)),
    )
    return {"children": [child]}


def strip(scene, name, material):
    """A wave as one triangle strip without indices or normals."""
    points = []
    for k in range(17):
        x, z = -0.4 + 0.05 * k, 0.08 * math.sin(0.75 * k)
        points += [(x, 0.4, z), (x, -0.4, z)]
    return {
        "mesh": _mesh(
            scene,
            name,
            {"POSITION": scene.add_accessor(flat(points), "VEC3", bounds=True)},
            material,
            mode=TRIANGLE_STRIP,
        )
    }


def fan(scene, name, material):
    """A disc as a triangle fan with 8-bit indices."""
    points = [(0.0, 0.0, 0.08)] + [
        (0.4 * math.cos(k * math.pi / 12.0), 0.4 * math.sin(k * math.pi / 12.0), 0.0) for k in range(24)
    ]
    indices = scene.add_accessor(list(range(25)) + [1], "SCALAR", UINT8, 34963)
    attributes = {"POSITION": scene.add_accessor(flat(points), "VEC3", bounds=True)}
    return {"mesh": _mesh(scene, name, attributes, material, indices, mode=TRIANGLE_FAN)}


def vertex_colours(scene, name, material):
    """Normalised 8-bit RGBA colours of the corners, multiplied with the base colour."""
    mesh = panel()
    corners = [255, 40, 40, 255, 40, 255, 40, 255, 255, 220, 40, 255, 40, 80, 255, 255]
    primitive = scene.primitive(mesh, material)
    primitive["attributes"]["COLOR_0"] = scene.add_accessor(corners, "VEC4", UINT8, normalized=True)
    return {"mesh": scene.add("meshes", {"name": name, "primitives": [primitive]})}


def second_uv(scene, name, material):
    """TEXCOORD_1 shows the whole texture upright, TEXCOORD_0 only its corner; the material asks for the second."""
    mesh = panel()
    primitive = scene.primitive(mesh, material)
    primitive["attributes"]["TEXCOORD_0"] = scene.add_accessor([0.1 * c for c in flat(mesh.uvs)], "VEC2")
    primitive["attributes"]["TEXCOORD_1"] = scene.add_accessor(flat(mesh.uvs), "VEC2")
    return {"mesh": scene.add("meshes", {"name": name, "primitives": [primitive]})}


def tangents(scene, name, material):
    """A panel with tangents of its own, for a normal map: along +u, handedness 1."""
    mesh = panel()
    primitive = scene.primitive(mesh, material, uvs=True)
    primitive["attributes"]["TANGENT"] = scene.add_accessor([1.0, 0.0, 0.0, 1.0] * len(mesh.positions), "VEC4")
    return {"mesh": scene.add("meshes", {"name": name, "primitives": [primitive]})}


def morphed(scene, name, material):
    """A grid with two morph targets at weights 0.75 and 0.5: a hill, and a shear to the right."""
    mesh = panel(8)
    hill = [(0.0, 0.0, 0.3 * math.cos(math.pi * p[0] / 0.8) * math.cos(math.pi * p[1] / 0.8)) for p in mesh.positions]
    shear = [(0.3 * p[1], 0.0, 0.0) for p in mesh.positions]
    primitive = scene.primitive(mesh, material, normals=False)
    primitive["targets"] = [
        {"POSITION": scene.add_accessor(flat(deltas), "VEC3", bounds=True)} for deltas in (hill, shear)
    ]
    return {"mesh": scene.add("meshes", {"name": name, "primitives": [primitive], "weights": [0.75, 0.5]})}


def skinned(scene, name, material):
    """A post of two joints; the upper joint leans 50 degrees, so the post is bent although nothing is animated."""
    mesh = shapes.lathe([[(0.10, -0.4 + 0.05 * k) for k in range(17)]], 24)
    joints, weights = [], []
    for _, y, _ in mesh.positions:
        upper = min(max(0.5 + y / 0.4, 0.0), 1.0)
        joints += (0 if upper < 1.0 else 1, 1 if 0.0 < upper < 1.0 else 0, 0, 0)
        weights += (1.0 - upper if upper < 1.0 else 1.0, upper if upper < 1.0 else 0.0, 0.0, 0.0)
    primitive = scene.primitive(mesh, material)
    primitive["attributes"]["JOINTS_0"] = scene.add_accessor(joints, "VEC4", UINT8)
    primitive["attributes"]["WEIGHTS_0"] = scene.add_accessor(weights, "VEC4")
    bound = scene.add("meshes", {"name": name, "primitives": [primitive]})
    upper = scene.add_node(name + ", upper joint", translation=(0.0, 0.4, 0.0), rotation=vec.quaternion(vec.Z, -50.0))
    lower = scene.add_node(name + ", lower joint", translation=(0.0, -0.4, 0.0), children=[upper])
    inverse = []
    for y in (-0.4, 0.0):
        inverse += [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -y, 0.0, 1.0]
    matrices = scene.add_accessor(inverse, "MAT4", target=None)
    skin = scene.add("skins", {"name": name, "joints": [lower, upper], "inverseBindMatrices": matrices})
    scene.add_node(name + ", skin", mesh=bound, skin=skin)
    return {"children": [lower]}
