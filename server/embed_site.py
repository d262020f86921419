"""Writes the built web client as a C++ table (server/site.hpp). Without one, a page that says how to build it."""

import argparse
import gzip
import hashlib
import pathlib

MIME = {
    ".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8",
    ".json": "application/json", ".map": "application/json", ".svg": "image/svg+xml", ".png": "image/png",
    ".ico": "image/x-icon", ".webp": "image/webp", ".woff2": "font/woff2", ".wasm": "application/wasm",
    ".txt": "text/plain; charset=utf-8", ".webmanifest": "application/manifest+json",
}
PLACEHOLDER = b"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Limn</title></head>
<body><h1>limnd is running</h1>
<p>This build holds no web client. Build it with <code>npm ci</code> and <code>npm run build</code> in
<code>web/</code>, then build limnd again.</p></body></html>
"""


def read_site(dist):
    files = {}
    if dist.is_dir():
        for path in sorted(dist.rglob("*")):
            if path.is_file() and path.suffix != ".map":
                files["/" + path.relative_to(dist).as_posix()] = path.read_bytes()
    if "/index.html" not in files:
        files["/index.html"] = PLACEHOLDER
    return files


def array(name, data):
    body = ",".join(str(byte) for byte in data)
    return f"const unsigned char {name}[] = {{{body}}};\n"


def view(name, data):
    return f"{{reinterpret_cast<const char*>({name}), {len(data)}}}"


def write(files):
    out = ['#include "server/site.hpp"\n', "namespace limn::server {\nnamespace {\n"]
    rows = []
    for index, (path, data) in enumerate(files.items()):
        packed = gzip.compress(data, 9, mtime=0)
        pays = len(packed) < 0.9 * len(data)
        out.append(array(f"kFile{index}", data))
        if pays:
            out.append(array(f"kPacked{index}", packed))
        mime = MIME.get(pathlib.PurePosixPath(path).suffix, "application/octet-stream")
        etag = hashlib.sha256(data).hexdigest()[:16]
        immutable = "true" if path.startswith("/assets/") else "false"
        gzip_view = view(f"kPacked{index}", packed) if pays else "{}"
        bytes_view = view(f"kFile{index}", data)
        rows.append(f'  {{"{path}", "{mime}", "\\"{etag}\\"", {bytes_view}, {gzip_view}, {immutable}}},\n')
    out.append("const SiteFile kSite[] = {\n" + "".join(rows) + "};\n")
    out.append("}  // namespace\n\nstd::span<const SiteFile> builtInSite() { return kSite; }\n\n")
    out.append("}  // namespace limn::server\n")
    return "".join(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--dist", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    text = write(read_site(arguments.dist))
    if not arguments.output.exists() or arguments.output.read_text() != text:
        arguments.output.parent.mkdir(parents=True, exist_ok=True)
        arguments.output.write_text(text)


if __name__ == "__main__":
    main()
