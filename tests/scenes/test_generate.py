"""Tests of the scene generator: same bytes every time, sound files, the expected triangles, a camera and a light in
each."""

import array
import hashlib
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import generate
import hdr
import malformed
import malformed_cases
import png
import vec

HERE = pathlib.Path(__file__).resolve().parent
TYPECODE = {5126: "f", 5125: "I", 5123: "H", 5121: "B"}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}

TRIANGLES = {
    "cornell-box": 38,
    "cornell-point": 30,
    "cornell-indirect": 42,
    "cornell-glossy": 38,
    "cornell-caustic": 2 * 2 * 128 * 63 + 18,
    "furnace-diffuse-05": 2 * 16 * 7 + 2 * 64 * 31,
    "analytic-point": 2,
    "analytic-quad": 4,
    "analytic-sphere": 2 * 128 * 63,
    "hard-coplanar": 60,
    "hard-split-emitters": 36 + 128,
    "hard-degenerate": 30 + 7 * 4,
    "million-instances": 1000 + 2 + 2,
}
INVISIBLE_FLAWS = {"hard-degenerate", "hard-bad-normals", "textures"}  # their geometry is odd on purpose


class Glb:
    """A GLB taken apart."""

    def __init__(self, data):
        magic, version, size = struct.unpack_from("<4sII", data, 0)
        assert (magic, version, size) == (b"glTF", 2, len(data))
        json_size = struct.unpack_from("<I", data, 12)[0]
        self.document = json.loads(data[20 : 20 + json_size])
        self.binary = data[28 + json_size :]

    def accessor(self, index):
        """The numbers of a tightly packed accessor."""
        accessor = self.document["accessors"][index]
        view = self.document["bufferViews"][accessor["bufferView"]]
        numbers = array.array(TYPECODE[accessor["componentType"]])
        start = view["byteOffset"] + accessor.get("byteOffset", 0)
        numbers.frombytes(self.binary[start : start + accessor["count"] * WIDTH[accessor["type"]] * numbers.itemsize])
        return numbers

    def primitives(self):
        for mesh in self.document.get("meshes", []):
            for primitive in mesh["primitives"]:
                yield mesh["name"], primitive

    def triangle_count(self):
        return sum(
            self.document["accessors"][p["indices"]]["count"] // 3 for _, p in self.primitives() if "indices" in p
        )

    def has_emitter(self):
        return any(sum(m.get("emissiveFactor", [0.0])) > 0.0 for m in self.document.get("materials", []))

    def environment(self):
        return self.document.get("extras", {}).get("limn", {}).get("environment")


def corners(numbers, index):
    return tuple(numbers[3 * index : 3 * index + 3])


class GeneratedScenes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.data = {name: generate.SCENES[name]() for name in generate.default_names()}
        cls.files = {name: Glb(data) for name, data in cls.data.items()}

    def test_another_process_writes_the_same_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, "-B", str(HERE / "generate.py"), "--output", folder]
            subprocess.run(command, check=True, env={**os.environ, "PYTHONHASHSEED": "4711"})
            written = {p.stem: hashlib.sha256(p.read_bytes()).hexdigest() for p in pathlib.Path(folder).glob("*.glb")}
        self.assertEqual(written, {name: hashlib.sha256(data).hexdigest() for name, data in self.data.items()})

    def test_triangle_counts(self):
        files = {**self.files, "million-instances": Glb(generate.SCENES["million-instances"]())}
        self.assertEqual({name: files[name].triangle_count() for name in TRIANGLES}, TRIANGLES)
        self.assertTrue(10_000 <= self.files["demo"].triangle_count() <= 40_000)

    def test_every_scene_has_a_placed_camera_and_a_light(self):
        for name, file in self.files.items():
            nodes = file.document["nodes"]
            with self.subTest(name):
                self.assertEqual(sum("camera" in node for node in nodes), 1)
                self.assertTrue(
                    file.has_emitter()
                    or any("KHR_lights_punctual" in n.get("extensions", {}) for n in nodes)
                    or file.environment() in generate.FILES[name]
                )

    def test_everything_has_a_name(self):
        for name, file in self.files.items():
            for kind in ("nodes", "meshes", "materials", "textures", "images", "cameras"):
                for item in file.document.get(kind, []):
                    self.assertTrue(item.get("name"), f"{name}: {kind} {item}")

    def test_views_lie_in_the_buffer_and_indices_among_the_vertices(self):
        for name, file in self.files.items():
            size = file.document["buffers"][0]["byteLength"]
            for view in file.document["bufferViews"]:
                self.assertLessEqual(view["byteOffset"] + view["byteLength"], size, name)
            for mesh, primitive in file.primitives():
                if "indices" in primitive:
                    vertices = file.document["accessors"][primitive["attributes"]["POSITION"]]["count"]
                    self.assertLess(max(file.accessor(primitive["indices"])), vertices, f"{name}: {mesh}")

    def test_faces_look_where_their_normals_point(self):
        for name in set(self.files) - INVISIBLE_FLAWS:
            file = self.files[name]
            for mesh, primitive in file.primitives():
                positions = file.accessor(primitive["attributes"]["POSITION"])
                normals = file.accessor(primitive["attributes"]["NORMAL"])
                indices = file.accessor(primitive["indices"])
                for t in range(0, len(indices), 3):
                    a, b, c = (corners(positions, k) for k in indices[t : t + 3])
                    face = vec.cross(vec.sub(b, a), vec.sub(c, a))
                    self.assertGreater(
                        vec.dot(face, corners(normals, indices[t])), 0.0, f"{name}: {mesh}, triangle {t // 3}"
                    )

    def test_demo_shows_what_the_renderer_can(self):
        demo = self.files["demo"].document
        names = {node["name"] for node in demo["nodes"]}
        self.assertLessEqual({"Lamp", "Window light", "Gold knot", "Blue vase", "Copper pot"}, names)
        used = set(demo["extensionsUsed"])
        self.assertLessEqual({"KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_clearcoat"}, used)
        self.assertTrue(any("normalTexture" in m for m in demo["materials"]))
        for image in demo["images"]:
            self.assertLessEqual(demo["bufferViews"][image["bufferView"]]["byteLength"], 1 << 20, image["name"])

    def test_an_unknown_scene_is_refused(self):
        with open(os.devnull, "w", encoding="utf-8") as quiet:
            command = [sys.executable, "-B", str(HERE / "generate.py"), "--output", "nowhere", "no-such-scene"]
            self.assertEqual(subprocess.run(command, stderr=quiet, check=False).returncode, 2)


class Pictures(unittest.TestCase):
    def test_png_holds_the_pixels_it_was_given(self):
        width, height = 5, 4
        pixels = bytes((37 * k * k + 11 * k) & 255 for k in range(width * height * 3))
        data = png.encode(width, height, 3, pixels)
        start = data.index(b"IDAT") + 4
        rows = zlib.decompress(data[start : start + struct.unpack_from(">I", data, start - 8)[0]])
        decoded, above = b"", bytes(3 * width)
        for y in range(height):
            kind, row = rows[y * (3 * width + 1)], bytearray(rows[y * (3 * width + 1) + 1 : (y + 1) * (3 * width + 1)])
            for k in range(3 * width):
                left = row[k - 3] if k >= 3 else 0
                row[k] = (row[k] + (0, left, above[k])[kind]) & 255
            decoded, above = decoded + bytes(row), row
        self.assertEqual(decoded, pixels)


    def test_hdr_texels_come_back_within_a_part_in_128(self):
        for colour in ((1.0, 1.0, 1.0), (5000.0, 20.0, 0.0), (0.3, 0.7, 1e-3)):
            *mantissas, exponent = hdr.texel(colour)
            for mantissa, c in zip(mantissas, colour):
                self.assertAlmostEqual(mantissa * 2.0 ** (exponent - 136), c, delta=max(colour) / 128.0)
        self.assertEqual(hdr.texel((0.0, 0.0, 0.0)), bytes(4))
        self.assertTrue(hdr.encode(3, 2, lambda x, y: (x, y, 1.0)).endswith(hdr.texel((2, 1, 1.0))))


class MalformedFiles(unittest.TestCase):
    def test_each_differs_from_the_control_and_is_listed_once(self):
        with tempfile.TemporaryDirectory() as folder:
            output = pathlib.Path(folder)
            malformed.write(output)
            listing = json.loads((output / "expected.json").read_text())
            control = (output / listing["control"]).read_bytes()
            names = [case["file"] for case in listing["cases"]]
            self.assertEqual(len(names), len(set(names)))
            self.assertGreaterEqual(len(names), 24)
            for name in names:
                self.assertNotEqual((output / name).read_bytes(), control, name)

    def test_pointers_name_a_place_in_the_document_or_its_parent(self):
        document, binary = malformed_cases.sound()
        for name, _, pointer, function in malformed_cases.CASES:
            data = malformed_cases.build(function, document, binary)
            here = Glb(data).document
            for key in pointer.split("/")[1:]:
                here = here[int(key)] if isinstance(here, list) else here[key]
            self.assertIsNotNone(here, name)


if __name__ == "__main__":
    unittest.main()
