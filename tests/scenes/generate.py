#!/usr/bin/env python3
"""Writes Limn's test and demo scenes as GLB files, what they name beside them. The same names give the same bytes."""

import argparse
import pathlib
import sys

import scenes_analytic
import scenes_cornell
import scenes_demo
import scenes_furnace
import scenes_hard
import scenes_large
import scenes_places
import scenes_plant
import scenes_textures

REGISTRIES = (
    scenes_demo,
    scenes_cornell,
    scenes_furnace,
    scenes_analytic,
    scenes_places,
    scenes_plant,
    scenes_textures,
    scenes_hard,
    scenes_large,
)
SCENES = {name: make for module in REGISTRIES for name, make in module.SCENES.items()}
FILES = {name: files for module in REGISTRIES for name, files in getattr(module, "FILES", {}).items()}
ON_REQUEST = frozenset(scenes_large.SCENES)


def default_names():
    return [name for name in SCENES if name not in ON_REQUEST]


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=pathlib.Path, help="the folder to write NAME.glb into")
    parser.add_argument(
        "--list", action="store_true", help="print the names, one a line; * marks those made only when named"
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="scenes to make (all but the marked ones)")
    options = parser.parse_args(arguments)
    if options.list:
        for name in SCENES:
            print(name + (" *" if name in ON_REQUEST else ""))
        return 0
    unknown = [name for name in options.names if name not in SCENES]
    if unknown:
        parser.error(f"unknown scene: {', '.join(unknown)}")
    if options.output is None:
        parser.error("--output is needed")
    options.output.mkdir(parents=True, exist_ok=True)
    for name in options.names or default_names():
        (options.output / f"{name}.glb").write_bytes(SCENES[name]())
        for file, make in FILES.get(name, {}).items():
            (options.output / file).write_bytes(make())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
