#!/usr/bin/env python3
"""Renders scenes in Blender Cycles and lists the pictures for `limn bench --pictures LIST.csv`.

cycles.py --scenes DIR --output DIR [--names A,B] [--size 256] [--samples 1,4,16,64]

Blender is optional: where it is not installed this says so, writes a list without pictures and ends well. Camera, light
units, pixel filter and materials are made the same as Limn's in cycles_scene.py; there is no denoiser and two threads.
A scene that uses what is not translated is left out, with the reason.
"""
import argparse
import csv
import json
import os
import pathlib
import shutil
import subprocess

DEFAULT_NAMES = "cornell-box,cornell-point,cornell-glossy,veach-mis,ajar-door,many-lights,thin-furniture"
SCENE_SCRIPT = pathlib.Path(__file__).with_name("cycles_scene.py")
RESULT = "cycles-result: "  # begins the one line in which the script inside Blender answers


def render(blender, scene, args):
    """The list of pictures of one scene as {"seconds", "file"}, or the reason why there are none."""
    job = {"scene": str(scene.resolve()), "output": str(args.output.resolve()), "size": args.size}
    job["samples"] = args.samples
    command = [blender, "--background", "--factory-startup", "--python", SCENE_SCRIPT, "--", json.dumps(job)]
    # Blender finds the Python that it was built with by the path: its own folder goes first.
    path = os.pathsep.join([str(pathlib.Path(blender).parent), os.environ.get("PATH", "")])
    environment = {**os.environ, "PATH": path}
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, env=environment)
    answers = [line[len(RESULT) :] for line in done.stdout.splitlines() if line.startswith(RESULT)]
    if not answers:
        return [], f"Blender ended with {done.returncode}: {(done.stderr or done.stdout).strip()[-400:]}"
    answer = json.loads(answers[0])
    return answer.get("pictures", []), answer.get("reason", "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--names", default=DEFAULT_NAMES)
    parser.add_argument("--size", type=int, default=256, help="pixels of a side; the benchmark's own must be the same")
    parser.add_argument("--samples", default="1,4,16,64")
    parser.add_argument("--blender", default=shutil.which("blender"))
    args = parser.parse_args()
    args.samples = [int(n) for n in args.samples.split(",")]
    args.output.mkdir(parents=True, exist_ok=True)
    with open(args.output / "cycles.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["scene", "name", "seconds", "file"])
        if not args.blender:
            print("Blender is not installed: its curve is absent")
            return
        for name in args.names.split(","):
            pictures, reason = render(args.blender, args.scenes / f"{name}.glb", args)
            for picture in pictures:
                writer.writerow([name, "Blender Cycles", f"{picture['seconds']:.4f}", picture["file"]])
            print(f"{name}: {len(pictures)} pictures{', ' + reason if reason else ''}", flush=True)


if __name__ == "__main__":
    main()
