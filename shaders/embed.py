#!/usr/bin/env python3
"""Writes a C++ file that holds SPIR-V modules as arrays: embed.py OUT.cpp MODULE.spv..."""
import pathlib
import struct
import sys

out, modules = pathlib.Path(sys.argv[1]), [pathlib.Path(p) for p in sys.argv[2:]]
parts = ['#include "shaders/embedded_shaders.hpp"\n', "namespace limn {", "namespace {"]
for index, path in enumerate(modules):
    data = path.read_bytes()
    words = struct.unpack(f"<{len(data) // 4}I", data)
    rows = (",".join(hex(w) for w in words[i:i + 16]) for i in range(0, len(words), 16))
    parts.append(f"const uint32_t kModule{index}[] = {{\n" + ",\n".join(rows) + "};")
parts.append("}  // namespace")
parts.append("std::span<const uint32_t> embeddedShader(std::string_view name) {")
for index, path in enumerate(modules):
    parts.append(f'  if (name == "{path.stem}") return kModule{index};')
parts.append("  (void)name;\n  return {};\n}\n}  // namespace limn\n")
out.write_text("\n".join(parts))
