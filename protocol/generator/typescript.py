"""Writes the TypeScript module: types, the schema as a table, and runtime.ts that reads and writes by it."""

import json
from pathlib import Path

from .schema import header_layout, number, pascal

TS_SCALARS = {"bool": "boolean", "string": "string", "hash": "string"}
RULE_KEYS = ("min", "max", "minItems", "maxItems", "maxLength")


def value_type(schema, f):
    known = f.base in schema.enums or f.base in schema.structs or f.base in schema.unions
    base = f.base if known else TS_SCALARS.get(f.base, "number")
    if f.shape == "list":
        return f"{base}[]"
    if f.shape == "map":
        return f"{{ [name: string]: {base} }}"
    if f.shape == "array":
        return "[" + ", ".join([base] * f.count) + "]"
    return base


def comment(raw):
    unit = f" [{raw['unit']}]" if raw.get("unit", "1") != "1" else ""
    return f"/** {raw['doc']}{unit} */"


def struct_type(schema, struct):
    out = [f"/** {struct.doc} */"]
    inlined = [f for f in struct.fields if f.inline]
    members = [f'  op: "{struct.op}";'] if struct.op else []
    for f in struct.fields:
        if not f.inline:
            mark = "?" if f.optional else ""
            members.append(f"  {f.name}{mark}: {value_type(schema, f)};  {comment(f.raw)}")
    if inlined:
        tail = " & ".join(f.base for f in inlined)
        return out + [f"export type {struct.name} = {{", *members, f"}} & {tail};", ""]
    return out + [f"export interface {struct.name} {{", *members, "}", ""]


def enum_type(enum):
    words = [json.dumps(word) for word, _ in enum["values"]]
    return [f"/** {enum['doc']} */", f"export type {enum['name']} = {' | '.join(words)};",
            f"export const k{enum['name']}s: readonly {enum['name']}[] = [{', '.join(words)}];", ""]


def union_type(union):
    parts = " | ".join(f'({{ {union["tag"]}: "{word}" }} & {member})' for word, member in union["members"])
    return [f"/** {union['doc']} */", f"export type {union['name']} = {parts};", ""]


def field_table(struct):
    rows = []
    for f in struct.fields:
        parts = [f'name: "{f.name}"', f'type: "{f.wire_type}"']
        parts += ["optional: true"] if f.optional else []
        parts += ["inline: true"] if f.inline else []
        parts += [f"{key}: {number(f.raw[key])}" for key in RULE_KEYS if key in f.raw]
        rows.append("    { " + ", ".join(parts) + " },")
    return [f"  {struct.name}: [", *rows, "  ],"] if rows else [f"  {struct.name}: [],"]


def tables(schema):
    out = ["const kEnums: { [name: string]: readonly string[] } = {"]
    out += [f"  {name}: k{name}s," for name in schema.enums] + ["};", ""]
    out.append("const kUnions: { [name: string]: { tag: string; members: { [word: string]: string } } } = {")
    for name, union in schema.unions.items():
        members = ", ".join(f'{word}: "{member}"' for word, member in union["members"])
        out.append(f'  {name}: {{ tag: "{union["tag"]}", members: {{ {members} }} }},')
    out += ["};", "", "const kStructs: { [name: string]: readonly Field[] } = {"]
    for struct in [*schema.structs.values(), *schema.client, *schema.server]:
        out += field_table(struct)
    out += ["};", ""]
    for side, messages in (("Client", schema.client), ("Server", schema.server)):
        ops = ", ".join(f'{m.op}: "{m.name}"' for m in messages)
        out += [f"const k{side}Ops: {{ [op: string]: string }} = {{ {ops} }};", ""]
    return out


def frame_header(schema):
    layout, size = header_layout(schema)
    shown = [(f, offset) for f, offset in layout if "value" not in f]
    getter = {"u8": "getUint8({})", "u16": "getUint16({}, true)", "u32": "getUint32({}, true)", "f32": "getFloat32({}, true)"}
    out = [f"export const kFrameHeaderBytes = {size};"]
    out += [f"export const kFrame{pascal(word)} = {bit};  /** {doc} */" for word, bit, doc in schema.raw["frameFlags"]]
    out += ["", "/** What stands before the payload of a binary message. */", "export interface FrameHeader {"]
    for f, _ in shown:
        kind = f.get("enum", "number[]" if "count" in f else "number")
        out.append(f"  {f['name']}: {kind};  {comment(f)}")
    out += ["}", "", "/** Reads the header of a binary message. Throws ProtocolError. */",
            "export function decodeFrameHeader(view: DataView): FrameHeader {",
            "  if (view.byteLength < kFrameHeaderBytes) "
            'throw new ProtocolError("bad-message", "shorter than a frame header", `byte ${view.byteLength}`);']
    for f, offset in layout:
        if "value" in f:
            code = "version" if f["name"] == "version" else "bad-message"
            out.append(f"  if (view.{getter[f['type']].format(offset)} !== {f['value']}) "
                       f'throw new ProtocolError("{code}", "{f["name"]} is not {f["value"]}", "byte {offset}");')
    out += ["  const word = <T>(words: readonly T[], offset: number): T => {", "    const value = words[view.getUint8(offset)];",
            '    if (value === undefined) throw new ProtocolError("out-of-range", "unknown value", `byte ${offset}`);',
            "    return value;", "  };", "  return {"]
    for f, offset in shown:
        if "enum" in f:
            out.append(f"    {f['name']}: word(k{f['enum']}s, {offset}),")
        elif "count" in f:
            items = ", ".join("view." + getter[f["type"]].format(offset + 4 * i) for i in range(f["count"]))
            out.append(f"    {f['name']}: [{items}],")
        else:
            out.append(f"    {f['name']}: view.{getter[f['type']].format(offset)},")
    return out + ["  };", "}", "", *frame_header_writer(layout)]


def frame_header_writer(layout):
    setter = {"u8": "setUint8({}, {})", "u16": "setUint16({}, {}, true)", "u32": "setUint32({}, {}, true)",
              "f32": "setFloat32({}, {}, true)"}
    out = ["/** Writes a header, little-endian. Throws ProtocolError where a word is not one of the schema's. */",
           "function encodeFrameHeader(header: FrameHeader, view: DataView): void {",
           "  const index = <T>(words: readonly T[], word: T, offset: number): number => {",
           "    const found = words.indexOf(word);",
           '    if (found < 0) throw new ProtocolError("out-of-range", "unknown value", `byte ${offset}`);',
           "    return found;", "  };"]
    for f, offset in layout:
        name = f"header.{f['name']}"
        values = [name]
        if "value" in f:
            values = [f["value"]]
        elif "enum" in f:
            values = [f"index(k{f['enum']}s, {name}, {offset})"]
        elif "count" in f:
            values = [f"{name}[{i}] as number" for i in range(f["count"])]
        out += [f"  view.{setter[f['type']].format(offset + 4 * i, value)};" for i, value in enumerate(values)]
    return out + ["}", ""]


def constants(schema):
    raw = schema.raw
    out = [f'export const kSubprotocol = "{raw["protocol"]}";', f"export const kVersion = {raw['version']};", ""]
    for name, value, unit, doc in raw["limits"]:
        out.append(f"export const k{pascal(name)} = {value};  {comment({'doc': doc, 'unit': unit})}")
    codes = " | ".join(json.dumps(code) for code, _ in raw["errorCodes"])
    closes = ", ".join(f"{code}: {json.dumps(doc)}" for code, doc in raw["closeCodes"])
    return out + ["", f"export type ErrorCode = {codes};", "",
                  f"export const kCloseCodes: {{ [code: number]: string }} = {{ {closes} }};", ""]


def write(schema):
    out = ["// Generated from protocol/schema.json by protocol/generate.py --typescript.", ""]
    out += constants(schema)
    for enum in schema.enums.values():
        out += enum_type(enum)
    for struct in schema.structs.values():
        out += struct_type(schema, struct)
    for union in schema.unions.values():
        out += union_type(union)
    for struct in [*schema.client, *schema.server]:
        out += struct_type(schema, struct)
    out += ["/** Everything a client sends. */", "export type ClientMessage = " + " | ".join(m.name for m in schema.client) + ";", "",
            "/** Everything a server sends as text. */",
            "export type ServerMessage = " + " | ".join(m.name for m in schema.server) + ";", ""]
    runtime = (Path(__file__).resolve().parent / "runtime.ts").read_text(encoding="utf-8")
    return "\n".join(out + frame_header(schema) + tables(schema)) + "\n" + runtime
