#!/usr/bin/env python3
"""Writes everything that follows from protocol/schema.json.

  generate.py --cpp DIR            DIR/messages.gen.hpp and DIR/messages.gen.cpp
  generate.py --typescript FILE    the TypeScript module
  generate.py --spec FILE          the tables between the markers of spec.md, in place
  --check                          writes nothing; exit 1 when a file differs from what would be written
"""

import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from generator import cpp_header, cpp_source, schema as schemas, spec_tables, typescript  # noqa: E402


def deliver(path, text, check):
    """True when the file already holds the text; writes it otherwise, unless only asked to check."""
    path = Path(path)
    same = path.is_file() and path.read_text(encoding="utf-8") == text
    if not same and not check:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return same


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cpp", metavar="DIR")
    parser.add_argument("--typescript", metavar="FILE")
    parser.add_argument("--spec", metavar="FILE")
    parser.add_argument("--check", action="store_true")
    args = parser.parse_args()
    schema = schemas.load()

    results = {}
    if args.cpp:
        results[f"{args.cpp}/messages.gen.hpp"] = cpp_header.write(schema)
        results[f"{args.cpp}/messages.gen.cpp"] = cpp_source.write(schema)
    if args.typescript:
        results[args.typescript] = typescript.write(schema)
    if args.spec:
        results[args.spec] = spec_tables.fill(schema, Path(args.spec).read_text(encoding="utf-8"))
    stale = [path for path, text in results.items() if not deliver(path, text, args.check)]
    if args.check and stale:
        print("not what protocol/schema.json says, run protocol/generate.py: " + ", ".join(stale), file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
