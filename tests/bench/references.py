#!/usr/bin/env python3
"""Renders scenes of an independent renderer with Limn and holds the pictures against its references.

references.py DIR [--limn PROGRAM] [--output DIR] [--names A,B] [--scale FACTOR]

DIR holds SCENE.glb, maybe in folders, and references/NAME.ref.exr with its two halves NAME.refhalf0.exr and
NAME.refhalf1.exr, 512x512. Prints a line a picture: samples, seconds of rendering, relMSE, "low" (relMSE after
averaging blocks of 16x16 pixels: noise nearly gone, bias stays) and whether it is within the bound. Halves of the
reference are used, so that its own noise does not count. Exit 1 when a bound is exceeded or something is missing.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIZE = "512x512"

# Scene, samples, bound on low. The bounds allow for what the models are known to differ in: Cycles has an exact
# dielectric Fresnel and a separable masking function, and its references some noise after averaging.
SCENES = [
    ("cornell-point", 192, 5e-5),
    ("cornell-box", 128, 5e-5),
    ("cornell-glossy", 160, 5e-4),
    ("dragon-bunny", 64, 2e-4),
    ("room", 64, 2e-3),
    ("veach-mis", 64, 1e-3),
    ("khronos/DamagedHelmet", 64, 5e-3),
    ("khronos/EmissiveStrengthTest", 64, 5e-3),
]
# The same with light cut off after so many indirect bounces; the reference is NAME.bN.
CUT_OFF = [(name, samples, bound, n) for name, samples, bound in SCENES[0:4:3] for n in range(3)]


def pictures():
    """(name of the reference, scene, samples, bound, flags) of every picture."""
    for scene, samples, bound in SCENES:
        yield scene.split("/")[-1], scene, samples, bound, []
    for scene, samples, bound, bounces in CUT_OFF:
        yield f"{scene}.b{bounces}", scene, samples, bound, ["--set", f"maxBounces={bounces}"]


def run(command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip().splitlines()[-1] if done.stderr.strip() else f"exit {done.returncode}")
    return done.stdout


def measure(args, output, name, scene, samples, flags):
    """(seconds, relMSE, low) of one picture."""
    picture, stats = output / f"{name}.exr", output / f"{name}.json"
    reference = args.scenes / "references" / name
    run([args.limn, "render", args.scenes / f"{scene}.glb", "--output", picture, "--size", SIZE, "--spp", samples,
         "--stats", stats, *flags])
    halves = f"{reference}.refhalf0.exr,{reference}.refhalf1.exr"
    errors = json.loads(run([args.limn, "compare", picture, f"{reference}.ref.exr", "--halves", halves, "--low",
                             "--json"]))
    seconds = json.loads(stats.read_text())["seconds"]["render"]
    return seconds, errors["relmse"], errors["low"]["relmse"]


def measure_all(args, output):
    """Prints the table; the number of pictures that are not within their bounds."""
    wanted = args.names.split(",") if args.names else None
    print("| scene | samples | seconds | relMSE | low | bound | |\n|---|---|---|---|---|---|---|")
    bad = 0
    for name, scene, samples, bound, flags in pictures():
        if wanted and name not in wanted:
            continue
        samples = max(1, round(samples * args.scale))
        try:
            seconds, error, low = measure(args, output, name, scene, samples, flags)
        except RuntimeError as reason:
            print(f"| {name} | {samples} | | | | {bound:.0e} | {reason} |", flush=True)
            bad += 1
            continue
        within = low <= bound
        bad += not within
        verdict = "within" if within else "over"
        print(f"| {name} | {samples} | {seconds:.1f} | {error:.2e} | {low:.2e} | {bound:.0e} | {verdict} |", flush=True)
    return bad


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", type=pathlib.Path, metavar="DIR")
    parser.add_argument("--limn", default=ROOT / "build" / "release" / "bin" / "limn", metavar="PROGRAM")
    parser.add_argument("--output", type=pathlib.Path, metavar="DIR", help="keep the pictures there")
    parser.add_argument("--names", metavar="A,B", help="these references alone")
    parser.add_argument("--scale", type=float, default=1.0, metavar="FACTOR", help="times the samples")
    args = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as scratch:
        output = args.output or pathlib.Path(scratch)
        output.mkdir(parents=True, exist_ok=True)
        bad = measure_all(args, output)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
