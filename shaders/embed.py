#!/usr/bin/env python3
"""Writes a C++ file that holds SPIR-V modules as arrays: embed.py OUT.cpp MODULE.spv...

Every float operation of a module with specialization constants is marked NoContraction on the way: a driver that may
reassociate or contract does so differently in each variant, and an edit would then give other bits than a fresh load.
"""
import pathlib
import struct
import sys

HEADER_WORDS = 5
OP_DECORATE, NO_CONTRACTION = 71, 42
OP_TYPES = range(19, 40)
OP_SPEC_CONSTANTS = range(48, 53)
# OpFNegate, OpFAdd, OpFSub, OpFMul, OpFDiv, OpFRem, OpFMod, products of vectors and matrices, OpDot
OP_FLOATS = {127, 129, 131, 133, 136, 140, 141, 142, 143, 144, 145, 146, 147, 148}


def instructions(words):
    at = HEADER_WORDS
    while at < len(words):
        yield at, words[at] & 0xffff
        at += words[at] >> 16


def without_contraction(words):
    found = list(instructions(words))
    if not any(op in OP_SPEC_CONSTANTS for _, op in found):
        return words
    marked = {words[at + 1] for at, op in found if op == OP_DECORATE and words[at + 2] == NO_CONTRACTION}
    floats = [words[at + 2] for at, op in found if op in OP_FLOATS]
    decorations = [w for i in floats if i not in marked for w in (3 << 16 | OP_DECORATE, i, NO_CONTRACTION)]
    types = next(at for at, op in found if op in OP_TYPES)
    return [*words[:types], *decorations, *words[types:]]


out, modules = pathlib.Path(sys.argv[1]), [pathlib.Path(p) for p in sys.argv[2:]]
parts = ['#include "shaders/embedded_shaders.hpp"\n', "namespace limn {", "namespace {"]
for index, path in enumerate(modules):
    data = path.read_bytes()
    words = without_contraction(struct.unpack(f"<{len(data) // 4}I", data))
    rows = (",".join(hex(w) for w in words[i:i + 16]) for i in range(0, len(words), 16))
    parts.append(f"const uint32_t kModule{index}[] = {{\n" + ",\n".join(rows) + "};")
parts.append("}  // namespace")
parts.append("std::span<const uint32_t> embeddedShader(std::string_view name) {")
for index, path in enumerate(modules):
    parts.append(f'  if (name == "{path.stem}") return kModule{index};')
parts.append("  (void)name;\n  return {};\n}\n}  // namespace limn\n")
out.write_text("\n".join(parts))
