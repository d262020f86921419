#!/usr/bin/env python3
"""Writes broken glTF and GLB files into DIR/files and what must be said about each into DIR/expected.json.

expected.json: {"control": file, "cases": [{"file", "code", "pointer"}, ...]}, files relative to DIR. `code` is the
loader's error code, `pointer` the JSON pointer after '#' of the error's place, empty where the file as a whole is at
fault. The control file is sound; every case differs from it in one thing. The asset root is the folder of the file,
DIR/files; DIR/outside.bin lies outside it.
"""

import argparse
import json
import pathlib
import struct
import sys

import malformed_cases
from gltf_writer import glb


def _container_cases(document, binary):
    """Files whose frame or text is broken."""
    whole = glb(document, binary)
    text = json.dumps(document).encode()
    json_length = struct.unpack_from("<I", whole, 12)[0]
    header = struct.pack("<4sII", b"glTF", 2, len(whole))

    def patched(offset, value):
        return whole[:offset] + struct.pack("<I", value) + whole[offset + 4 :]

    deep = b'{"asset":{"version":"2.0"},"extras":' + b"[" * 100000 + b"]" * 100000 + b"}"
    return [
        ("empty.glb", "bad-json", "", b""),
        ("glb-header-cut.glb", "bad-json", "", whole[:8]),
        ("glb-bad-magic.glb", "bad-json", "", b"glTX" + whole[4:]),
        ("glb-version-1.glb", "unsupported", "", patched(4, 1)),
        ("glb-truncated.glb", "bad-file", "", whole[: -len(binary) // 2]),
        ("glb-length-lies.glb", "bad-file", "", patched(8, 0xFFFFFFFF)),
        ("glb-json-chunk-lies.glb", "bad-file", "", patched(12, 0x7FFFFFFF)),
        ("glb-binary-chunk-lies.glb", "bad-file", "", patched(20 + json_length, len(binary) + 4096)),
        ("glb-first-chunk-binary.glb", "bad-file", "", patched(16, 0x004E4942)),
        ("glb-no-chunk.glb", "bad-file", "", struct.pack("<4sII", b"glTF", 2, 12)),
        ("glb-header-only.glb", "bad-file", "", header),
        ("json-syntax.gltf", "bad-json", "", text[:-1] + b",}"),
        ("json-cut.gltf", "bad-json", "", text[: len(text) // 2]),
        ("json-not-utf8.gltf", "bad-json", "", text.replace(b"Checker", b"Ch\xff\xfecker", 1)),
        ("json-deep.gltf", "limit", "", deep),
        ("json-a-list.gltf", "bad-file", "", b"[]"),
    ]


def _uri_cases(document, binary):
    """Files whose buffer or image is named by a URI."""

    def buffer(uri):
        return json.dumps(document | {"buffers": [{"byteLength": len(binary), "uri": uri}]}).encode()

    def image(uri):
        return glb(document | {"images": [{"uri": uri}]}, binary)

    at_buffer = [
        ("uri-traversal.gltf", "path", "../../../../../../../../etc/passwd"),
        ("uri-traversal-near.gltf", "path", "../outside.bin"),
        ("uri-traversal-inside.gltf", "path", "a-directory/../../outside.bin"),
        ("uri-traversal-encoded.gltf", "path", "%2e%2e/outside.bin"),
        ("uri-traversal-encoded-slash.gltf", "path", "..%2foutside.bin"),
        ("uri-absolute.gltf", "path", "/etc/passwd"),
        ("uri-file-scheme.gltf", "path", "file:///etc/passwd"),
        ("uri-http-scheme.gltf", "path", "http://localhost/outside.bin"),
        ("uri-symbolic-link.gltf", "path", "link.bin"),
        ("uri-a-directory.gltf", "path", "a-directory"),
        ("uri-not-there.gltf", "io", "not-there.bin"),
        ("uri-bad-base64.gltf", "bad-file", "data:application/octet-stream;base64,AAAA*AAA"),
        ("uri-no-comma.gltf", "bad-file", "data:application/octet-stream;base64"),
        ("uri-bad-escape.gltf", "bad-file", "%zz.bin"),
        ("uri-a-number.gltf", "bad-file", 7),
    ]
    cases = [(name, code, "/buffers/0/uri", buffer(uri)) for name, code, uri in at_buffer]
    cases.append(("uri-file-too-short.gltf", "out-of-range", "/buffers/0/byteLength", buffer("short.bin")))
    cases.append(("image-a-directory.glb", "path", "/images/0/uri", image("a-directory")))
    cases.append(("image-not-there.glb", "io", "/images/0/uri", image("not-there.png")))
    cases.append(("image-traversal.glb", "path", "/images/0/uri", image("../outside.bin")))
    return cases


def all_cases():
    """(file name, code, pointer, bytes) of every broken file, and the bytes of the control."""
    document, binary = malformed_cases.sound()
    cases = _container_cases(document, binary) + _uri_cases(document, binary)
    for name, code, pointer, function in malformed_cases.CASES:
        cases.append((f"{name}.glb", code, pointer, malformed_cases.build(function, document, binary)))
    return cases, glb(document, binary)


def write(output):
    files = output / "files"
    (files / "a-directory").mkdir(parents=True, exist_ok=True)
    (output / "outside.bin").write_bytes(bytes(4096))
    (files / "short.bin").write_bytes(bytes(16))
    link = files / "link.bin"
    if not link.is_symlink():
        link.symlink_to(pathlib.Path("..") / "outside.bin")
    cases, control = all_cases()
    (files / "control.glb").write_bytes(control)
    for name, _, _, data in cases:
        (files / name).write_bytes(data)
    listing = {
        "control": "files/control.glb",
        "cases": [{"file": f"files/{name}", "code": code, "pointer": pointer} for name, code, pointer, _ in cases],
    }
    (output / "expected.json").write_text(json.dumps(listing, indent=1) + "\n")


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=pathlib.Path, required=True, metavar="DIR")
    write(parser.parse_args(arguments).output)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
