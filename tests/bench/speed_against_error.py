#!/usr/bin/env python3
"""Error against time of each technique on generated scenes, in one run on an otherwise idle machine.

speed_against_error.py --limn build/release/bin/limn --scenes DIR --output DIR [--names A,B] [--times T,T] [--reference-spp N]

For every scene a reference is rendered with another seed and many samples (kept in the output folder and reused), then one
render a technique with checkpoints; relMSE is that of `limn compare`, without the 0.1 % largest quotients. Writes errors.csv
and errors.svg (gnuplot). The reference's own noise is in errors.csv: no figure near it means anything.
"""
import argparse
import csv
import json
import pathlib
import subprocess

DEFAULT_SCENES = "cornell-box,cornell-point,cornell-glossy,demo"
DEFAULT_TIMES = "0.25,0.5,1,2,4,8,16,32"


def run(*command):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True).stdout


def rel_mse(limn, picture, reference):
    return json.loads(run(limn, "compare", picture, reference, "--metric", "relmse", "--json"))["relmse"]


def render(limn, scene, output, *flags):
    stats = output.with_suffix(".json")
    run(limn, "render", scene, "--output", output, "--stats", stats, *flags)
    return json.loads(stats.read_text())


def make_reference(args, name):
    """Renders the reference once; returns its path and the relMSE it estimates of itself."""
    path = args.output / f"{name}.ref.exr"
    stats = path.with_suffix(".json")
    if not path.exists():
        render(args.limn, args.scenes / f"{name}.glb", path, "--spp", args.reference_spp, "--seed", 1, "--set", "adaptive=0",
               "--aov", "samples")
    return path, json.loads(stats.read_text())["estimatedError"]


def measure(args, name, technique):
    """Renders once with checkpoints; yields (seconds as they really were, relMSE)."""
    reference, noise = make_reference(args, name)
    picture = args.output / f"{name}.{technique}.exr"
    stats = render(args.limn, args.scenes / f"{name}.glb", picture, "--technique", technique, "--time", args.times[-1],
                   "--checkpoints", ",".join(str(t) for t in args.times), "--set", "adaptive=0", "--aov", "samples")
    for point in stats["checkpoints"]:
        yield point["seconds"], rel_mse(args.limn, args.output / point["file"], reference), noise


def plot(args, rows):
    curves = sorted({(scene, technique) for scene, technique, *_ in rows})
    commands = ["set terminal svg size 820,520 font 'sans,13' background rgb 'white'", f"set output '{args.output}/errors.svg'",
                "set logscale xy", "set grid", "set xlabel 'seconds after the first step'", "set ylabel 'relMSE'",
                "set key outside right"]
    parts = []
    for index, (scene, technique) in enumerate(curves):
        commands.append(f"$curve{index} << EOD")
        commands += [f"{t} {e}" for s, q, t, e, _ in rows if (s, q) == (scene, technique)]
        commands.append("EOD")
        parts.append(f"$curve{index} using 1:2 with linespoints linewidth 2 pointtype 7 pointsize 0.5 title '{scene}, {technique}'")
    commands.append("plot " + ", ".join(parts))
    subprocess.run(["gnuplot"], input="\n".join(commands), text=True, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limn", type=pathlib.Path, required=True)
    parser.add_argument("--scenes", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--names", default=DEFAULT_SCENES)
    parser.add_argument("--times", default=DEFAULT_TIMES)
    parser.add_argument("--techniques", default="path-tracing")
    parser.add_argument("--reference-spp", type=int, default=1024)
    args = parser.parse_args()
    args.times = [float(t) for t in args.times.split(",")]
    args.output.mkdir(parents=True, exist_ok=True)
    rows = [(name, technique, seconds, error, noise) for name in args.names.split(",") for technique in args.techniques.split(",")
            for seconds, error, noise in measure(args, name, technique)]
    with open(args.output / "errors.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "technique", "seconds", "relMSE", "noise of the reference"])
        writer.writerows(rows)
    plot(args, rows)


if __name__ == "__main__":
    main()
