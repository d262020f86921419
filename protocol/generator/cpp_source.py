"""Writes messages.gen.cpp: readers and writers of every struct in terms of protocol/reader.hpp and protocol/json_writer.hpp."""

from .cpp_header import camel_first
from .schema import INTEGER_RANGE, camel, editable_targets, field_kind, header_layout, number, pascal


def rules(f):
    """The C++ initialiser of a field's Rules; empty where there are none beyond the type's own."""
    parts = []
    for key, member in (("min", "minimum"), ("max", "maximum"), ("maxLength", "maxLength"), ("minItems", "minItems"),
                        ("maxItems", "maxItems")):
        if key in f.raw:
            parts.append(f".{member} = {number(f.raw[key])}")
    if not any(key in f.raw for key in ("min", "max")) and f.base in INTEGER_RANGE:
        low, high = INTEGER_RANGE[f.base]
        parts = [f".minimum = {low}.0", f".maximum = {high}.0"] + parts
    elif f.base in INTEGER_RANGE:
        low, high = INTEGER_RANGE[f.base]
        if "min" not in f.raw:
            parts.insert(0, f".minimum = {low}.0")
        if "max" not in f.raw:
            parts.insert(1, f".maximum = {high}.0")
    return ", Rules{" + ", ".join(parts) + "}" if parts else ""


def struct_functions(struct):
    out = [f"static void writeFields([[maybe_unused]] JsonWriter& w, [[maybe_unused]] const {struct.name}& v) {{"]
    for f in struct.fields:
        out.append(f"  writeFields(w, v.{f.cpp_name});" if f.inline else f'  w.field("{f.name}", v.{f.cpp_name});')
    out += ["}", f"static void readFields([[maybe_unused]] ObjectReader& o, [[maybe_unused]] {struct.name}& v) {{"]
    for f in struct.fields:
        if f.inline:
            out.append(f"  readFields(o, v.{f.cpp_name});")
        else:
            verb = "optional" if f.optional else "required"
            out.append(f'  o.{verb}("{f.name}", v.{f.cpp_name}{rules(f)});')
    return out + ["}", ""]


def enum_functions(enum):
    name, words = enum["name"], [word for word, _ in enum["values"]]
    table = ", ".join(f'"{w}"' for w in words)
    return [f"static constexpr std::array<std::string_view, {len(words)}> k{name}Names{{{table}}};",
            f"std::string_view name({name} value) {{ return k{name}Names[size_t(value)]; }}",
            f"std::optional<{name}> {camel_first(name)}FromName(std::string_view name) {{",
            f"  return enumFromName<{name}>(k{name}Names, name);", "}",
            f"[[maybe_unused]] static std::span<const std::string_view> namesOf({name}) {{ return k{name}Names; }}", ""]


def union_functions(union):
    tag, name = union["tag"], union["name"]
    words = f"k{name}{pascal(tag)}s"
    out = [f"std::string_view {tag}Of(const {name}& value) {{ return {words}[value.index()]; }}",
           f"static void writeFields(JsonWriter& w, const {name}& v) {{",
           f'  w.field("{tag}", {tag}Of(v));',
           "  std::visit([&w](const auto& alternative) { writeFields(w, alternative); }, v);", "}",
           f"static void readFields(ObjectReader& o, {name}& v) {{",
           f'  switch (o.tag("{tag}", {words})) {{']
    for i, (_, member) in enumerate(union["members"]):
        out.append(f"    case {i}: return readFields(o, v.emplace<{member}>());")
    return out + ["    default: return;", "  }", "}", ""]


def message_functions(name, messages, strict):
    out = [f"std::string encode(const {name}& message) {{",
           "  return std::visit([](const auto& m) { return encodeMessage(m); }, message);", "}",
           f"std::string_view opOf(const {name}& message) {{",
           "  return std::visit([](const auto& m) { return std::remove_cvref_t<decltype(m)>::kOp; }, message);", "}",
           f"static Result<{name}> dispatch(const MessageReader& reader, {name}*) {{",
           f"  switch (reader.op(k{name}Ops)) {{"]
    for i, m in enumerate(messages):
        out.append(f"    case {i}: return reader.read<{name}, {m.name}>();")
    out += ["    default: return reader.error();", "  }", "}", ""]
    return out


def header_functions(schema):
    layout, _ = header_layout(schema)
    out = ["void encodeFrameHeader(const FrameHeader& h, std::span<uint8_t, kFrameHeaderBytes> out) {"]
    for f, offset in layout:
        width = {"u8": 8, "u16": 16, "u32": 32, "f32": 0}[f["type"]]
        if "value" in f:
            out.append(f"  store(out, {offset}, uint{width}_t{{{f['value']}}});  // {f['name']}")
        elif "enum" in f:
            out.append(f"  store(out, {offset}, uint8_t(h.{f['name']}));")
        elif "count" in f:
            out.append(f"  for (size_t i = 0; i < {f['count']}; ++i) store(out, {offset} + 4 * i, h.{f['name']}[i]);")
        else:
            out.append(f"  store(out, {offset}, h.{f['name']});")
    out += ["}", "", "Result<FrameHeader> decodeFrameHeader(std::span<const uint8_t> in) {",
            "  if (in.size() < kFrameHeaderBytes) return headerError(\"bad-message\", \"shorter than a frame header\", in.size());",
            "  FrameHeader h;"]
    for f, offset in layout:
        name = f["name"]
        width = {"u8": "uint8_t", "u16": "uint16_t", "u32": "uint32_t", "f32": "float"}[f["type"]]
        load = f"load<{width}>(in, {offset})"
        if "value" in f:
            code = "version" if name == "version" else "bad-message"
            out.append(f'  if ({load} != {f["value"]}) return headerError("{code}", "{name} is not {f["value"]}", {offset});')
        elif "enum" in f:
            out.append(f'  if ({load} >= k{f["enum"]}s.size()) return headerError("out-of-range", "{name} is unknown", {offset});')
            out.append(f"  h.{name} = {f['enum']}({load});")
        elif "count" in f:
            out.append(f"  for (size_t i = 0; i < {f['count']}; ++i) h.{name}[i] = load<{width}>(in, {offset} + 4 * i);")
        else:
            out.append(f"  h.{name} = {load};")
            if "max" in f:
                out.append(f'  if (h.{name} > {f["max"]}) return headerError("out-of-range", "{name} is over {f["max"]}", {offset});')
            if f["type"] == "f32":
                bad = "std::isnan" if f.get("infinite") else "!std::isfinite"
                out.append(f'  if ({bad}(h.{name})) return headerError("out-of-range", "{name} is not a number", {offset});')
    return out + ["  return h;", "}", ""]


def editable_function(schema):
    out = ["const std::vector<EditableTarget>& editableTargets() {",
           "  static const std::vector<EditableTarget> kTargets = [] {", "    std::vector<EditableTarget> targets;"]
    for target, fields in editable_targets(schema):
        out.append(f'    targets.push_back({{"{target}", {{}}}});')
        for f in fields:
            kind = f"FieldKind::{camel(field_kind(schema, f))}"
            low, high = (number(f.raw[k]) if k in f.raw else "std::nullopt" for k in ("min", "max"))
            soft = [number(v) for v in f.raw["soft"]] if "soft" in f.raw else ["std::nullopt", "std::nullopt"]
            choices = "std::nullopt"
            if f.base in schema.enums:
                choices = "std::vector<std::string>{" + ", ".join(f'"{w}"' for w, _ in schema.enums[f.base]["values"]) + "}"
            out.append(f'    targets.back().fields.push_back({{"{f.name}", {kind}, "{f.raw.get("unit", "1")}", "{f.doc}", '
                       f"{low}, {high}, {soft[0]}, {soft[1]}, {choices}}});")
    return out + ["    return targets;", "  }();", "  return kTargets;", "}", ""]


def write(schema):
    out = ["// Generated from protocol/schema.json by protocol/generate.py.", '#include "protocol/messages.gen.hpp"', "",
           "#include <cmath>", "", '#include "protocol/frame_bytes.hpp"', '#include "protocol/json_writer.hpp"',
           '#include "protocol/reader.hpp"', "", "namespace limn::protocol {", ""]
    for enum in schema.enums.values():
        out += enum_functions(enum)
    for struct in schema.structs.values():
        out += struct_functions(struct)
    for union in schema.unions.values():
        out += union_functions(union)
    for struct in [*schema.client, *schema.server]:
        out += struct_functions(struct)
    out += ["template <class Message>", "static std::string encodeMessage(const Message& message) {", "  JsonWriter w;",
            "  w.beginObject();", '  w.field("op", Message::kOp);', "  writeFields(w, message);", "  w.endObject();",
            "  return w.take();", "}", ""]
    out += message_functions("ClientMessage", schema.client, True)
    out += message_functions("ServerMessage", schema.server, False)
    out += ["uint32_t seqOf(const ClientMessage& message) {", "  return std::visit([](const auto& m) { return m.seq; }, message);", "}",
            "Result<ClientMessage> decodeClient(std::string_view json, uint32_t* seq) {",
            "  const MessageReader reader(json, kMaxControlBytes, kMaxJsonDepth, true);",
            "  if (seq) *seq = reader.seq();", "  return dispatch(reader, static_cast<ClientMessage*>(nullptr));", "}",
            "Result<ServerMessage> decodeServer(std::string_view json, Strictness strictness) {",
            "  const MessageReader reader(json, kMaxServerTextBytes, kMaxJsonDepth, strictness == Strictness::strict);",
            "  return dispatch(reader, static_cast<ServerMessage*>(nullptr));", "}", ""]
    out += editable_function(schema) + header_functions(schema)
    out += ["}  // namespace limn::protocol", ""]
    return "\n".join(out)
