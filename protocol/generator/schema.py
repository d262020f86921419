"""Loads protocol/schema.json, with what it includes, and gives its types a shape that all writers share: those of C++,
TypeScript and Markdown."""

import json
import re
from dataclasses import dataclass, field
from pathlib import Path

SCALARS = {"bool", "u8", "u16", "u32", "i32", "u53", "f32", "f64", "string", "hash"}
INTEGER_RANGE = {"u8": (0, 2**8 - 1), "u16": (0, 2**16 - 1), "u32": (0, 2**32 - 1), "i32": (-(2**31), 2**31 - 1),
                 "u53": (0, 2**53 - 1)}
FIELD_KEYS = {"name", "type", "doc", "unit", "min", "max", "soft", "optional", "inline", "kind", "cpp", "maxLength",
              "maxItems", "minItems"}


@dataclass
class Field:
    name: str
    base: str            # scalar, enum, struct or union name
    shape: str           # "one", "list", "map" or "array"
    count: int           # of an array
    optional: bool
    inline: bool
    raw: dict

    @property
    def cpp_name(self):
        return self.raw.get("cpp", self.name)

    @property
    def doc(self):
        return self.raw["doc"]

    @property
    def wire_type(self):
        return self.raw["type"]


@dataclass
class Struct:
    name: str
    doc: str
    fields: list
    op: str = ""


@dataclass
class Schema:
    raw: dict
    enums: dict = field(default_factory=dict)
    structs: dict = field(default_factory=dict)
    unions: dict = field(default_factory=dict)
    client: list = field(default_factory=list)
    server: list = field(default_factory=list)


def parse_type(text):
    match = re.fullmatch(r"(\w+)(\[\]|\{\}|\[(\d+)\])?", text)
    if not match:
        raise ValueError(f"cannot read the type {text!r}")
    base, suffix, count = match.groups()
    shape = {None: "one", "[]": "list", "{}": "map"}.get(suffix, "array")
    return base, shape, int(count or 0)


def parse_field(raw):
    unknown = set(raw) - FIELD_KEYS
    if unknown or "doc" not in raw:
        raise ValueError(f"field {raw.get('name')}: unknown keys {unknown} or no doc")
    base, shape, count = parse_type(raw["type"])
    return Field(raw["name"], base, shape, count, raw.get("optional", False), raw.get("inline", False), raw)


def parse_struct(raw, with_seq=False):
    fields = [parse_field(f) for f in raw["fields"]]
    if with_seq:
        seq = {"name": "seq", "type": "u32", "min": 1, "doc": "rises from message to message of a client"}
        fields.insert(0, parse_field(seq))
    names = [f.name for f in fields]
    if len(set(names)) != len(names):
        raise ValueError(f"{raw['name']}: a field appears twice")
    return Struct(raw["name"], raw["doc"], fields, raw.get("op", ""))


def read(path):
    """The object in a file, with the members of the files beside it that its "include" names."""
    raw = json.loads(path.read_text(encoding="utf-8"))
    for name in raw.pop("include", []):
        part = read(path.parent / name)
        if twice := set(part) & set(raw):
            raise ValueError(f"{name}: {twice} is in the file that includes it")
        raw.update(part)
    return raw


def load(path=None):
    path = path or Path(__file__).resolve().parent.parent / "schema.json"
    raw = read(Path(path))
    schema = Schema(raw)
    schema.enums = {e["name"]: e for e in raw["enums"]}
    for s in raw["structs"]:
        schema.structs[s["name"]] = parse_struct(s)
    schema.unions = {u["name"]: u for u in raw["unions"]}
    schema.client = [parse_struct(m, with_seq=True) for m in raw["clientMessages"]]
    schema.server = [parse_struct(m) for m in raw["serverMessages"]]
    check_names(schema)
    return schema


def check_names(schema):
    """Every type that is named exists, and was defined before its use (C++ needs the order)."""
    known = SCALARS | set(schema.enums)
    unions_due = {name: {member for _, member in u["members"]} for name, u in schema.unions.items()}
    for struct in [*schema.structs.values(), *schema.client, *schema.server]:
        for name, members in unions_due.items():
            if members <= known:
                known.add(name)
        for f in struct.fields:
            if f.base not in known:
                raise ValueError(f"{struct.name}.{f.name}: type {f.base} is not known at this point")
        if struct.name in known:
            raise ValueError(f"{struct.name} is defined twice")
        known.add(struct.name)


FORMATS = {"u8": 1, "u16": 2, "u32": 4, "f32": 4}


def header_layout(schema):
    """(field, offset) for each field of the binary header, and its size in bytes. Every field is aligned to its size."""
    offset, layout = 0, []
    for f in schema.raw["frameHeader"]:
        size = FORMATS[f["type"]]
        if offset % size:
            raise ValueError(f"header field {f['name']} is not aligned")
        layout.append((f, offset))
        offset += size * f.get("count", 1)
    if offset % 4:
        raise ValueError(f"the header has {offset} bytes, not a multiple of 4")
    return layout, offset


def camel(word):
    """ "display-only" → "displayOnly" """
    head, *tail = word.split("-")
    return head + "".join(t[:1].upper() + t[1:] for t in tail)


def pascal(word):
    word = camel(word)
    return word[:1].upper() + word[1:]


def number(value):
    """A schema number as C++ and JavaScript read it."""
    return repr(value) if isinstance(value, float) else str(value)


def field_kind(schema, f):
    """FieldKind of an editable field."""
    if "kind" in f.raw:
        return f.raw["kind"]
    if f.base in schema.enums:
        return "choice"
    return {"string": "text"}.get(f.base, "parameters" if f.shape == "map" else "number")


def editable_targets(schema):
    """(target, fields) of every edit that a panel can offer: members of Edit but for the view."""
    for target, member in schema.unions["Edit"]["members"]:
        fields = [f for f in schema.structs[member].fields if not (f.name == target and f.base == "u32") and f.base not in schema.structs]
        if fields:
            yield target, fields
