"""Assembles a glTF 2.0 asset and writes it as one GLB whose bytes depend on nothing but the calls made."""

import array
import json
import math
import struct
import sys

import vec

FLOAT, UINT32, UINT16, INT16, UINT8, INT8 = 5126, 5125, 5123, 5122, 5121, 5120
_TYPECODE = {FLOAT: "f", UINT32: "I", UINT16: "H", INT16: "h", UINT8: "B", INT8: "b"}
_WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_VERTICES, _INDICES = 34962, 34963
_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942


def glb(document, binary=b""):
    """The bytes of a GLB with the given JSON (a dictionary, or text taken as it is) and binary chunk."""
    text = document if isinstance(document, bytes) else json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), _JSON_CHUNK) + text
    if binary:
        padded = bytes(binary) + bytes(-len(binary) % 4)
        chunks += struct.pack("<II", len(padded), _BINARY_CHUNK) + padded
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def flat(vectors):
    return [c for v in vectors for c in v]


def _rounded(values):
    return [round(v, 9) + 0.0 for v in values]


def _extensions_in(value, found):
    if isinstance(value, dict):
        found.update(value.get("extensions", {}))
        for child in value.values():
            _extensions_in(child, found)
    elif isinstance(value, list):
        for child in value:
            _extensions_in(child, found)
    return found


class Builder:
    """Collects an asset. The add_ functions return the index of what they added; nodes are roots unless they are
    children."""

    def __init__(self, name):
        self.binary = bytearray()
        self.lights = []
        self.children = set()
        self.required = []
        self.document = {
            "asset": {"version": "2.0", "generator": "Limn scene generator"},
            "scene": 0,
            "scenes": [{"name": name}],
        }

    def add(self, kind, item):
        """Appends item to the top-level array called kind."""
        items = self.document.setdefault(kind, [])
        items.append(item)
        return len(items) - 1

    def add_view(self, data, target=None, stride=None):
        """Appends bytes to the buffer, aligned to four."""
        self.binary += bytes(-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if stride:
            view["byteStride"] = stride
        if target:
            view["target"] = target
        self.binary += data
        return self.add("bufferViews", view)

    def add_accessor(self, values, kind, component=FLOAT, target=_VERTICES, bounds=False, normalized=False):
        """A tightly packed accessor over a flat sequence of numbers."""
        packed = array.array(_TYPECODE[component], values)
        width = _WIDTH[kind]
        accessor = {"componentType": component, "count": len(packed) // width, "type": kind}
        if bounds:
            accessor["min"] = [min(packed[c::width]) for c in range(width)]
            accessor["max"] = [max(packed[c::width]) for c in range(width)]
        if normalized:
            accessor["normalized"] = True
        if sys.byteorder == "big":
            packed.byteswap()
        accessor["bufferView"] = self.add_view(packed.tobytes(), target)
        return self.add("accessors", accessor)

    def add_indices(self, indices, vertex_count):
        component = UINT16 if vertex_count < 65535 else UINT32
        return self.add_accessor(indices, "SCALAR", component, _INDICES)

    def primitive(self, mesh, material=None, uvs=False, normals=True):
        """The glTF primitive of a mesh; UVs are written only when asked for."""
        attributes = {"POSITION": self.add_accessor(flat(mesh.positions), "VEC3", bounds=True)}
        if normals:
            attributes["NORMAL"] = self.add_accessor(flat(mesh.normals), "VEC3")
        if uvs:
            attributes["TEXCOORD_0"] = self.add_accessor(flat(mesh.uvs), "VEC2")
        primitive = {"attributes": attributes, "indices": self.add_indices(mesh.indices, len(mesh.positions))}
        if material is not None:
            primitive["material"] = material
        return primitive

    def _has_texture(self, material):
        return material is not None and "Texture" in json.dumps(self.document["materials"][material])

    def add_mesh(self, name, parts, normals=True):
        """parts: pairs of a mesh and a material index."""
        primitives = [self.primitive(mesh, material, self._has_texture(material), normals) for mesh, material in parts]
        return self.add("meshes", {"name": name, "primitives": primitives})

    def add_material(self, material):
        return self.add("materials", material)

    def add_image(self, name, png_bytes):
        return self.add("images", {"name": name, "mimeType": "image/png", "bufferView": self.add_view(png_bytes)})

    def add_texture(self, name, png_bytes, wrap_u=10497, wrap_v=10497, magnify=9729, minify=9987):
        """A texture with its own image and sampler; wraps are 10497 repeat, 33071 clamp, 33648 mirror."""
        sampler = {"magFilter": magnify, "minFilter": minify, "wrapS": wrap_u, "wrapT": wrap_v}
        samplers = self.document.setdefault("samplers", [])
        if sampler not in samplers:
            samplers.append(sampler)
        return self.add(
            "textures", {"name": name, "sampler": samplers.index(sampler), "source": self.add_image(name, png_bytes)}
        )

    def add_node(self, name, *, translation=None, rotation=None, scale=None, children=None, light=None, **more):
        node = {"name": name, **more}
        if translation:
            node["translation"] = _rounded(translation)
        if rotation:
            node["rotation"] = _rounded(rotation)
        if scale:
            node["scale"] = list(scale)
        if children:
            node["children"] = list(children)
            self.children.update(children)
        if light is not None:
            node["extensions"] = {"KHR_lights_punctual": {"light": light}}
        return self.add("nodes", node)

    def add_object(self, name, parts, material=None, **node):
        """A node with its own mesh of the same name. parts: a mesh (then with material) or pairs of mesh and
        material."""
        pairs = parts if isinstance(parts, (list, tuple)) else [(parts, material)]
        return self.add_node(name, mesh=self.add_mesh(name, pairs), **node)

    def add_camera(self, name, eye, target, yfov_degrees, aspect=1.0, near=0.01, far=None, up=vec.Y):
        perspective = {"aspectRatio": round(aspect, 9), "yfov": round(math.radians(yfov_degrees), 9), "znear": near}
        if far:
            perspective["zfar"] = far
        camera = self.add("cameras", {"type": "perspective", "name": name, "perspective": perspective})
        return self.add_node(name, camera=camera, translation=eye, rotation=vec.look_rotation(vec.sub(target, eye), up))

    def add_light(self, name, kind, intensity, colour=(1.0, 1.0, 1.0), position=None, direction=None, **more):
        """A punctual light in W/sr (point, spot) or W/m^2 (directional), shining along direction."""
        light = {"name": name, "type": kind, "color": _rounded(colour), "intensity": intensity, **more}
        self.lights.append(light)
        rotation = vec.look_rotation(direction) if direction else None
        return self.add_node(name, light=len(self.lights) - 1, translation=position, rotation=rotation)

    def glb(self):
        """The whole asset as bytes."""
        document = dict(self.document)
        document["scenes"][0]["nodes"] = [i for i in range(len(document.get("nodes", []))) if i not in self.children]
        if self.lights:
            document["extensions"] = {"KHR_lights_punctual": {"lights": self.lights}}
        used = sorted(set(_extensions_in(document, set())) | set(self.required))
        if used:
            document["extensionsUsed"] = used
        if self.required:
            document["extensionsRequired"] = sorted(self.required)
        if self.binary:
            document["buffers"] = [{"byteLength": len(self.binary)}]
        return glb(document, self.binary)
