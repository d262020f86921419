"""Documents broken in one place each. A case names the code the loader answers with and the JSON pointer it must
show."""

import base64
import copy
import struct

import materials
import png
import shapes
import textures
from gltf_writer import Builder, glb

CASES = []


def sound():
    """The document and binary chunk that every case breaks: a textured square under a point light. Accessors: 0
    POSITION, 1 NORMAL, 2 TEXCOORD_0, 3 indices. Nodes: 0 the square, 1 the light, 2 the camera, 3 and 4 empty.
    """
    scene = Builder("control")
    panel = shapes.grid((-1.0, 0.0, 1.0), (2.0, 0.0, 0.0), (0.0, 0.0, -2.0))
    texture = scene.add_texture("Checker", textures.checker(8, 8, 2, 2, (0.9, 0.9, 0.9), (0.2, 0.2, 0.2)))
    material = scene.add_material(materials.with_textures(materials.lambert("Checker", (1.0, 1.0, 1.0)), texture))
    mesh = scene.add_mesh("Square", [(panel, material)])
    scene.add_node("Square", mesh=mesh)
    scene.add_light("Light", "point", 3.0, position=(0.0, 1.5, 0.0))
    scene.add_camera("Camera", (0.0, 1.5, 2.5), (0.0, 0.0, 0.0), 45.0)
    scene.add_node("Empty 3")
    scene.add_node("Empty 4")
    scene.glb()
    return scene.document | {
        "buffers": [{"byteLength": len(scene.binary)}],
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_specular"],
        "extensions": {"KHR_lights_punctual": {"lights": scene.lights}},
    }, bytearray(scene.binary)


def case(name, code, pointer):
    """Registers a function that breaks (document, binary) in place, or returns the file's bytes itself."""

    def register(function):
        CASES.append((name, code, pointer, function))
        return function

    return register


def set_at(name, code, pointer, value, at=None):
    """A case that stores value at a JSON pointer: the one expected in the answer unless another is given."""

    def change(document, _):
        *path, last = (at or pointer).strip("/").split("/")
        target = document
        for key in path:
            target = target[int(key)] if isinstance(target, list) else target.setdefault(key, {})
        if isinstance(target, list):
            target[int(last)] = value
        else:
            target[last] = value

    CASES.append((name, code, pointer, change))


def build(function, document, binary):
    """The bytes of a case's file."""
    document, binary = copy.deepcopy(document), bytearray(binary)
    return function(document, binary) or glb(document, binary)


# The document as a whole.
set_at("asset-version-1", "unsupported", "/asset/version", "1.0")
set_at(
    "required-extension-unknown",
    "unsupported",
    "/extensionsRequired/0",
    ["KHR_draco_mesh_compression"],
    "/extensionsRequired",
)
set_at("scene-out-of-range", "out-of-range", "/scene", 7)
set_at("scene-node-out-of-range", "out-of-range", "/scenes/0/nodes/0", 99)
set_at("nodes-not-a-list", "bad-file", "/nodes", {"0": {}})


@case("asset-missing", "bad-file", "")
def _(document, _):
    del document["asset"]


# Accessors and what they look at.
set_at("accessor-past-view", "out-of-range", "/accessors/0/count", 5)
set_at("accessor-count-huge", "out-of-range", "/accessors/0/count", 4_000_000_000)
set_at("accessor-count-negative", "out-of-range", "/accessors/0/count", -1)
set_at("accessor-count-fraction", "bad-file", "/accessors/0/count", 3.5)
set_at("accessor-count-zero", "out-of-range", "/accessors/0/count", 0)
set_at("accessor-offset-huge", "out-of-range", "/accessors/0/count", 1_000_000_000, "/accessors/0/byteOffset")
set_at("accessor-component-type-unknown", "bad-file", "/accessors/0/componentType", 5131)
set_at("accessor-type-unknown", "bad-file", "/accessors/0/type", "VEC5")
set_at("accessor-view-out-of-range", "out-of-range", "/accessors/0/bufferView", 50)
set_at("view-past-buffer", "out-of-range", "/bufferViews/1/byteLength", 1_000_000)
set_at("view-offset-wraps", "out-of-range", "/bufferViews/1/byteLength", 2**64 - 8, "/bufferViews/1/byteOffset")
set_at("view-buffer-out-of-range", "out-of-range", "/bufferViews/1/buffer", 3)
set_at("view-stride-too-small", "bad-file", "/bufferViews/1/byteStride", 4)
set_at("buffer-zero-size", "out-of-range", "/buffers/0/byteLength", 0)
set_at("buffer-longer-than-its-chunk", "out-of-range", "/buffers/0/byteLength", 1_000_000)
set_at("indices-of-floats", "bad-file", "/meshes/0/primitives/0/indices", 1)
set_at("position-of-two-components", "bad-file", "/meshes/0/primitives/0/attributes/POSITION", 2)
set_at("attribute-out-of-range", "out-of-range", "/meshes/0/primitives/0/attributes/NORMAL", 40)
set_at("attribute-counts-differ", "bad-file", "/meshes/0/primitives/0/attributes/NORMAL", 3, "/accessors/1/count")


def _poke(document, binary, accessor, offset, data):
    start = document["bufferViews"][document["accessors"][accessor]["bufferView"]]["byteOffset"] + offset
    binary[start : start + len(data)] = data


@case("index-past-vertices", "out-of-range", "/meshes/0/primitives/0/indices")
def _(document, binary):
    _poke(document, binary, 3, 4, struct.pack("<H", 4))


@case("position-nan", "bad-file", "/accessors/0")
def _(document, binary):
    _poke(document, binary, 0, 16, struct.pack("<f", float("nan")))


@case("position-infinite", "bad-file", "/accessors/0")
def _(document, binary):
    _poke(document, binary, 0, 16, struct.pack("<f", float("-inf")))


def _sparse(document, binary, count, indices):
    """Adds a sparse part to the positions, its data at the end of the buffer."""
    start = len(binary)
    binary += struct.pack("<2H", *indices) + struct.pack("<6f", *[0.0] * 6)
    document["buffers"][0]["byteLength"] = len(binary)
    views = document["bufferViews"]
    views += [
        {"buffer": 0, "byteOffset": start, "byteLength": 4},
        {"buffer": 0, "byteOffset": start + 4, "byteLength": 24},
    ]
    document["accessors"][0]["sparse"] = {
        "count": count,
        "indices": {"bufferView": len(views) - 2, "componentType": 5123},
        "values": {"bufferView": len(views) - 1},
    }


@case("sparse-index-out-of-range", "out-of-range", "/accessors/0/sparse/indices")
def _(document, binary):
    _sparse(document, binary, 2, (1, 4))


@case("sparse-count-over-accessor", "out-of-range", "/accessors/0/sparse/count")
def _(document, binary):
    _sparse(document, binary, 5, (1, 2))


# The node graph and the references from it.
set_at("node-child-out-of-range", "out-of-range", "/nodes/3/children/0", [77], "/nodes/3/children")
set_at("node-own-child", "bad-file", "/nodes/3/children/0", [3], "/nodes/3/children")
set_at("node-mesh-out-of-range", "out-of-range", "/nodes/0/mesh", 1)
set_at("node-camera-out-of-range", "out-of-range", "/nodes/2/camera", 9)
set_at("node-light-out-of-range", "out-of-range", "/nodes/1/extensions/KHR_lights_punctual/light", 2)
set_at("node-matrix-of-15", "bad-file", "/nodes/0/matrix", [1.0] * 15)
set_at("node-scale-of-text", "bad-file", "/nodes/0/scale/0", ["1", "1", "1"], "/nodes/0/scale")
set_at("material-out-of-range", "out-of-range", "/meshes/0/primitives/0/material", 12)
set_at("mesh-without-primitives", "bad-file", "/meshes/0/primitives", [])
set_at("camera-zero-yfov", "out-of-range", "/cameras/0/perspective/yfov", 0.0)
set_at("light-type-unknown", "bad-file", "/extensions/KHR_lights_punctual/lights/0/type", "laser")


@case("node-cycle", "bad-file", "/nodes/3/children")
def _(document, _):
    document["nodes"][3]["children"], document["nodes"][4]["children"] = [4], [3]
    document["scenes"][0]["nodes"] = [0, 1, 2]


@case("node-two-parents", "bad-file", "/nodes/4/children/0")
def _(document, _):
    document["nodes"].append({"name": "Shared"})
    document["nodes"][3]["children"] = document["nodes"][4]["children"] = [5]


@case("skin-joint-out-of-range", "out-of-range", "/skins/0/joints/0")
def _(document, _):
    document["skins"] = [{"joints": [44]}]
    document["nodes"][0]["skin"] = 0


# Textures and images.
set_at("texture-out-of-range", "out-of-range", "/materials/0/pbrMetallicRoughness/baseColorTexture/index", 5)
set_at("texture-source-out-of-range", "out-of-range", "/textures/0/source", 3)
set_at("texture-sampler-out-of-range", "out-of-range", "/textures/0/sampler", 3)


def _replace_image(document, data):
    document["images"][0] = {"uri": "data:image/png;base64," + base64.b64encode(data).decode()}


@case("image-over-the-limit", "limit", "/images/0")
def _(document, _):
    body = png.chunk(b"IDAT", b"\x78\x9c\x63\x00\x00\x00\x01\x00\x01") + png.chunk(b"IEND", b"")
    _replace_image(document, png.header(60000, 60000, 4) + body)


@case("image-truncated", "bad-file", "/images/0")
def _(document, _):
    whole = textures.checker(64, 64, 7, 7, (0.9, 0.1, 0.1), (0.1, 0.1, 0.9))
    _replace_image(document, whole[: len(whole) // 2])


@case("image-of-text", "bad-file", "/images/0")
def _(document, _):
    _replace_image(document, b"this is not a picture")
