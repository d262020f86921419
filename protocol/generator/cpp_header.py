"""Writes messages.gen.hpp: a struct per message, enums, the frame header, constants."""

from .schema import camel, header_layout, pascal

CPP_SCALARS = {"bool": "bool", "u8": "uint8_t", "u16": "uint16_t", "u32": "uint32_t", "i32": "int32_t", "u53": "uint64_t",
               "f32": "float", "f64": "double", "string": "std::string", "hash": "Hash"}
INITIAL = {"bool": " = false", "u8": " = 0", "u16": " = 0", "u32": " = 0", "i32": " = 0", "u53": " = 0", "f32": " = 0.0f",
           "f64": " = 0.0"}


def value_type(f):
    base = CPP_SCALARS.get(f.base, f.base)
    if f.shape == "list":
        return f"std::vector<{base}>"
    if f.shape == "map":
        return f"std::vector<std::pair<std::string, {base}>>"
    if f.shape == "array":
        return f"std::array<{base}, {f.count}>"
    return base


def declaration(schema, f):
    if f.optional:
        return f"std::optional<{value_type(f)}> {f.cpp_name}"
    if f.shape == "array":
        return f"{value_type(f)} {f.cpp_name}{{}}"
    if f.shape == "one":
        initial = "{}" if f.base in schema.enums else INITIAL.get(f.base, "")
        return f"{value_type(f)} {f.cpp_name}{initial}"
    return f"{value_type(f)} {f.cpp_name}"


def comment(raw):
    unit = f" [{raw['unit']}]" if raw.get("unit", "1") != "1" else ""
    return f"  ///< {raw['doc']}{unit}"


def struct_lines(schema, struct):
    out = [f"/// {struct.doc}", f"struct {struct.name} {{"]
    if struct.op:
        out.append(f'  static constexpr std::string_view kOp = "{struct.op}";')
    for f in struct.fields:
        out.append(f"  {declaration(schema, f)};{comment(f.raw)}")
    out += [f"  bool operator==(const {struct.name}&) const = default;", "};", ""]
    return out


def enum_lines(enum):
    name = enum["name"]
    out = [f"/// {enum['doc']}", f"enum class {name} : uint8_t {{"]
    out += [f"  {camel(word)},  ///< {doc}" for word, doc in enum["values"]]
    words = ", ".join(f"{name}::{camel(word)}" for word, _ in enum["values"])
    return out + ["};", f"inline constexpr std::array k{name}s{{{words}}};",
                  f"std::string_view name({name} value);  ///< as it stands on the wire",
                  f"std::optional<{name}> {camel_first(name)}FromName(std::string_view name);", ""]


def camel_first(name):
    return name[0].lower() + name[1:]


def union_lines(union):
    members = ", ".join(member for _, member in union["members"])
    out = [f"/// {union['doc']} The wire names the alternative in \"{union['tag']}\".", f"using {union['name']} = std::variant<{members}>;",
           f"std::string_view {union['tag']}Of(const {union['name']}& value);",
            f"inline constexpr std::array<std::string_view, {len(union['members'])}> k{union['name']}{pascal(union['tag'])}s{{"
            + ", ".join(f'"{word}"' for word, _ in union["members"]) + "};", ""]
    return out


def variant_lines(name, messages, doc):
    alternatives = ", ".join(m.name for m in messages)
    return [f"/// {doc}", f"using {name} = std::variant<{alternatives}>;", f"std::string encode(const {name}& message);",
            f"std::string_view opOf(const {name}& message);",
            f"inline constexpr std::array<std::string_view, {len(messages)}> k{name}Ops{{"
            + ", ".join(f'"{m.op}"' for m in messages) + "};", ""]


def frame_header_lines(schema):
    types = {"u8": "uint8_t", "u16": "uint16_t", "u32": "uint32_t", "f32": "float"}
    layout, size = header_layout(schema)
    out = [f"inline constexpr size_t kFrameHeaderBytes = {size};", "/// Bits of FrameHeader::flags."]
    for word, bit, doc in schema.raw["frameFlags"]:
        out.append(f"inline constexpr uint8_t kFrame{pascal(word)} = {bit};  ///< {doc}")
    out += ["", "/// What stands before the payload of a binary message; magic, version and reserved are written by themselves.",
            "struct FrameHeader {"]
    for f, _ in layout:
        if "value" in f:
            continue
        if "enum" in f:
            out.append(f"  {f['enum']} {f['name']}{{}};{comment(f)}")
        elif "count" in f:
            out.append(f"  std::array<{types[f['type']]}, {f['count']}> {f['name']}{{}};{comment(f)}")
        else:
            out.append(f"  {types[f['type']]} {f['name']} = 0;{comment(f)}")
    return out + ["  bool operator==(const FrameHeader&) const = default;", "};",
                  "/// Little-endian, whatever the machine.",
                  "void encodeFrameHeader(const FrameHeader& header, std::span<uint8_t, kFrameHeaderBytes> out);",
                  "/// `message` may hold a payload too. Errors: \"bad-message\" (too short, magic, reserved), \"version\", \"out-of-range\".",
                  "Result<FrameHeader> decodeFrameHeader(std::span<const uint8_t> message);", ""]


def constant_lines(schema):
    raw = schema.raw
    out = [f'inline constexpr std::string_view kSubprotocol = "{raw["protocol"]}";',
           f"inline constexpr uint32_t kVersion = {raw['version']};", ""]
    for name, value, unit, doc in raw["limits"]:
        out.append(f"inline constexpr uint32_t k{pascal(name)} = {value};  ///< {doc}" + (f" [{unit}]" if unit != "1" else ""))
    out += ["", "/// WebSocket close codes, and when the server closes with them."]
    codes = {1000: "Normal", 1001: "GoingAway", 1002: "ProtocolError", 1003: "Unacceptable", 1007: "NotUtf8", 1008: "Policy",
             1009: "TooBig", 1011: "Internal"}
    for code, doc in raw["closeCodes"]:
        out.append(f"inline constexpr uint16_t kClose{codes[code]} = {code};  ///< {doc}")
    out += ["", "/// The codes of error messages."]
    for code, doc in raw["errorCodes"]:
        out.append(f'inline constexpr std::string_view kError{pascal(code)} = "{code}";  ///< {doc}')
    words = ", ".join(f'"{code}"' for code, _ in raw["errorCodes"])
    return out + [f"inline constexpr std::array<std::string_view, {len(raw['errorCodes'])}> kErrorCodes{{{words}}};", ""]


def write(schema):
    out = ["// Generated from protocol/schema.json by protocol/generate.py.", "#pragma once"]
    out += [f"#include <{h}>" for h in ("array", "cstddef", "cstdint", "optional", "span", "string", "string_view", "utility",
                                        "variant", "vector")]
    out += ["", '#include "renderer/base/result.hpp"', "", "namespace limn::protocol {", ""]
    out += constant_lines(schema)
    out += ["/// A 64-bit hash; 16 lower-case hexadecimal digits on the wire.", "struct Hash {", "  uint64_t value = 0;",
            "  bool operator==(const Hash&) const = default;", "};", ""]
    for enum in schema.enums.values():
        out += enum_lines(enum)
    for struct in schema.structs.values():
        out += struct_lines(schema, struct)
    for union in schema.unions.values():
        out += union_lines(union)
    for struct in [*schema.client, *schema.server]:
        out += struct_lines(schema, struct)
    out += ["// Messages of clients.", ""]
    out += variant_lines("ClientMessage", schema.client, "Everything a client sends.")
    out += ["uint32_t seqOf(const ClientMessage& message);", "",
            "/// Reads a text message of a client, strictly: an unknown op, a field that is missing, unknown, of the wrong type or out of",
            "/// range is an Error with code and place (\"seq 12 /edits/0/roughness\"). `seq`, where given, becomes the message's seq as soon",
            "/// as it could be read, else 0. Any thread.",
            "Result<ClientMessage> decodeClient(std::string_view json, uint32_t* seq = nullptr);", "",
            "// Messages of the server.", ""]
    out += variant_lines("ServerMessage", schema.server, "Everything a server sends as text.")
    out += ["enum class Strictness { tolerant, strict };",
            "/// Reads a text message of a server. Tolerant: fields that this version does not know are passed over.",
            "Result<ServerMessage> decodeServer(std::string_view json, Strictness strictness = Strictness::tolerant);", "",
            "/// What `set` can change, for the server's hello.", "const std::vector<EditableTarget>& editableTargets();", ""]
    out += frame_header_lines(schema)
    out += ["}  // namespace limn::protocol", ""]
    return "\n".join(out)
