"""Fills the tables of spec.md between `<!-- NAME -->` and `<!-- /NAME -->`."""

import json
import re
from pathlib import Path

from .schema import header_layout

GOLDEN = Path(__file__).resolve().parent.parent / "golden"


def bound(value):
    return "" if value is None else f"{value:.9g}"


def range_text(f):
    low, high = f.raw.get("min"), f.raw.get("max")
    parts = []
    if low is not None or high is not None:
        parts.append(f"{bound(low)} … {bound(high)}".strip())
    if "maxLength" in f.raw:
        parts.append(f"≤ {f.raw['maxLength']} bytes")
    if "maxItems" in f.raw:
        parts.append(f"{f.raw.get('minItems', 0)} to {f.raw['maxItems']} items")
    return ", ".join(parts)


def field_rows(fields):
    out = ["| field | type | unit | range | |", "|---|---|---|---|---|"]
    for f in fields:
        name = f"*{f.base}*" if f.inline else f"`{f.name}`"
        kind = ("fields of " if f.inline else "") + f.wire_type + (", optional" if f.optional else "")
        out.append(f"| {name} | {kind} | {f.raw.get('unit', '')} | {range_text(f)} | {f.doc} |")
    return out


def structs(schema):
    out = []
    for s in schema.structs.values():
        out += [f"#### {s.name}", "", s.doc, "", *field_rows(s.fields), ""]
    for u in schema.unions.values():
        out += [f"#### {u['name']}", "", f"{u['doc']} `{u['tag']}` says which:", "", f"| `{u['tag']}` | further fields |", "|---|---|"]
        out += [f"| `{word}` | {member} |" for word, member in u["members"]] + [""]
    return out


def enums(schema):
    out = ["| type | words |", "|---|---|"]
    for e in schema.enums.values():
        words = "; ".join(f"`{word}` {doc}" for word, doc in e["values"])
        out.append(f"| {e['name']} | {words} |")
    return out


def wrapped(line, width=118):
    """One message over several lines, broken after commas that stand outside strings."""
    pieces = re.findall(r'(?:"(?:[^"\\]|\\.)*"|[^",])*(?:,|$)', line)
    out = [""]
    for piece in pieces:
        if len(out[-1]) + len(piece) > width:
            out.append("  ")
        out[-1] += piece
    return out


def examples(side):
    """The first golden message of each op; of set, of each target."""
    found = {}
    for path in sorted(GOLDEN.glob(f"{side}_*.jsonl")):
        for line in path.read_text(encoding="utf-8").splitlines():
            message = json.loads(line)
            found.setdefault(message["op"], {}).setdefault(message.get("target", "") if message["op"] == "set" else "", line)
    return found


def messages(which, side):
    out, golden = [], examples(side)
    for m in which:
        out += [f"### `{m.op}`", "", m.doc, ""]
        fields = [f for f in m.fields if side == "server" or f.name != "seq"]
        out += field_rows(fields) + [""] if fields else []
        lines = [line for example in golden[m.op].values() for line in wrapped(example)]
        out += ["```json", *lines, "```", ""]
    return out


def header(schema):
    layout, size = header_layout(schema)
    out = ["| offset | field | type | unit | |", "|---|---|---|---|---|"]
    for f, offset in layout:
        kind = f["type"] + (f"[{f['count']}]" if "count" in f else "") + (f", {f['enum']}" if "enum" in f else "")
        value = f"{f['value']:#x}: " if f["name"] == "magic" else ""
        out.append(f"| {offset} | `{f['name']}` | {kind} | {f.get('unit', '')} | {value}{f['doc']} |")
    return out + [f"| {size} | payload | | | `payloadBytes` bytes |"]


def flags(schema):
    return ["| bit | flag | |", "|---|---|---|"] + [f"| {bit} | `{word}` | {doc} |" for word, bit, doc in schema.raw["frameFlags"]]


def codes(schema, key):
    return ["| code | |", "|---|---|"] + [f"| `{code}` | {doc} |" for code, doc in schema.raw[key]]


def limits(schema):
    return ["| limit | value | unit | |", "|---|---|---|---|"] + [
        f"| `{name}` | {value} | {unit} | {doc} |" for name, value, unit, doc in schema.raw["limits"]]


def fill(schema, text):
    sections = {"enums": enums(schema), "structs": structs(schema), "client messages": messages(schema.client, "client"),
                "server messages": messages(schema.server, "server"), "frame header": header(schema), "frame flags": flags(schema),
                "error codes": codes(schema, "errorCodes"), "close codes": codes(schema, "closeCodes"), "limits": limits(schema)}
    for name, lines in sections.items():
        pattern = re.compile(f"(<!-- {name} -->\n).*?(<!-- /{name} -->)", re.S)
        if len(pattern.findall(text)) != 1:
            raise ValueError(f"spec.md must have the section {name!r} once")
        body = "\n".join(lines).strip() + "\n"
        text = pattern.sub(lambda m, body=body: m.group(1) + body + m.group(2), text)
    return text
