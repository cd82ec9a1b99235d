"""Runs a scene of scene/gauntlet/ from jittered starts, and judges every frame with percale check --intersections.

    gauntlet_test.py SCENE [--runs N] [--frames N] [--seed S] [--threads N] [--keep FOLDER]

Run k starts from seed S + k: every cloth is shifted and turned a little, and random wrinkles are others. Without --runs it
is one run, cut short where the scene is slow; with --runs, or the environment variable PERCALE_GAUNTLET_RUNS, so many of
full length. The program is that of the environment variable PERCALE. Each run prints what it measured; what is broken is
told with the command that repeats it.
"""

import argparse
import csv
import dataclasses
import json
import os
import pathlib
import random
import re
import struct
import subprocess
import sys
import tempfile
import typing

ROOT = pathlib.Path(__file__).resolve().parents[2]
PERCALE = os.path.abspath(os.environ.get("PERCALE", ROOT / "build/dev/bin/percale"))


@dataclasses.dataclass
class Run:
    """What a run left: positions by frame, from 0 for the start, and the rows of its table, from frame 1."""

    frames: list
    rows: list
    intersections: dict
    complete: bool

    def spread(self, frame, axis):
        return max(p[axis] for p in self.frames[frame]) - min(p[axis] for p in self.frames[frame])

    def greatest(self, key):
        return max(float(row[key]) for row in self.rows)


# Each law yields what is broken. Those that speak of the end are asked only after a run of full length.


def knot(run):
    if run.complete and run.spread(-1, 1) > 0.75 * run.spread(0, 1):
        yield f"the knot is not tight: {run.spread(-1, 1):.3f} m across, {run.spread(0, 1):.3f} m at the start"
    half = len(run.frames[0]) // 2
    if max(p[0] for p in run.frames[-1][:half]) < min(p[0] for p in run.frames[-1][half:]):
        yield "the knot has come apart"


def twist(run):
    if run.complete and float(run.rows[-1]["greatest_stretch"]) > 1.15:
        yield f"after it has turned back the hose is still stretched {run.rows[-1]['greatest_stretch']} times"


def funnel(run):
    if run.complete and max(p[1] for p in run.frames[-1]) > -0.2:
        yield "not all of the cloth came through the funnel"


def ball(run):
    way = max(max(p[2] for p in frame) for frame in run.frames) - max(p[2] for p in run.frames[0])
    if run.complete and way < 0.3:
        yield f"the ball carried the sheet only {way:.2f} m along"


def squeeze(run):
    if run.complete and not any(int(row["squeezed"]) for row in run.rows):
        yield "the plates never closed on the cloth"
    if run.complete and int(run.rows[-1]["squeezed"]):
        yield f"{run.rows[-1]['squeezed']} vertices are still inside of the plates"


def tangled(run):
    start, counts = run.intersections.get(0, 0), [int(row["intersections"]) for row in run.rows]
    if not start:
        yield "the start is not tangled"
    if max(counts) > 2 * start:
        yield f"the count of intersections rose from {start} to {max(counts)}"
    if counts[-1] > 0:
        yield f"{counts[-1]} of {start} intersections are left"


def garment(run):
    if max(p[1] for p in run.frames[-1]) < 1.3:
        yield "the dress fell off"


def above(height):
    def law(run):
        lowest = min(p[1] for p in run.frames[-1])
        if lowest < height - 1e-3:
            yield f"the cloth is at y = {lowest:.4f}, below the floor at {height}"

    return law


def spin(run):
    yield from above(0.15)(run)
    if max(p[1] for p in run.frames[-1]) < 0.7:
        yield "the cloth slid off the sphere"


@dataclasses.dataclass
class Course:
    """How a scene is run. Jitter is in metres and degrees, about x, y and z."""

    law: typing.Callable
    frames: int
    short: int
    stretch: float  # no edge may be stretched farther
    shift: tuple = (0.01, 0.0, 0.01)
    turn: tuple = (0.0, 5.0, 0.0)


COURSES = {
    "layers50": Course(above(0.0), 60, 10, 1.3, (0.003, 0.002, 0.003), (0, 2, 0)),
    "needles": Course(above(0.05), 150, 60, 3, (0.02, 0.01, 0.02), (0, 10, 0)),
    "spin": Course(spin, 330, 120, 2, (0.02, 0.01, 0.02), (0, 20, 0)),
    "tablecloth": Course(above(0.0), 150, 90, 4, (0.005, 0.003, 0.005), (0, 1, 0)),
    "knot": Course(knot, 120, 90, 1.4, (0.002, 0.002, 0.002), (1, 1, 1)),
    "twist": Course(twist, 370, 70, 2, (0.001, 0.001, 0.001), (20, 0.5, 0.5)),
    "funnel": Course(funnel, 180, 60, 2, (0.02, 0.01, 0.02), (3, 30, 3)),
    "ball": Course(ball, 90, 40, 5, (0.03, 0.03, 0.01), (2, 5, 2)),
    "squeeze": Course(squeeze, 180, 95, 3, (0.02, 0.005, 0.02), (0, 20, 0)),
    "tangled": Course(tangled, 180, 120, 2, (0.02, 0.02, 0.02), (0, 5, 0)),
    "garment": Course(garment, 300, 25, 3, (0.003, 0.003, 0.003), (0, 5, 0)),
}


def jittered(name, seed):
    """The scene with another start, and meshes found from wherever it is put."""
    chance = random.Random(f"{name} {seed}")
    folder = ROOT / "scene/gauntlet"
    scene = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
    course = COURSES[name]

    def listed(key):
        return scene.get(key, []) if isinstance(scene.get(key, []), list) else [scene[key]]

    for cloth in listed("cloth"):
        for key, most in (("origin", course.shift), ("rotation", course.turn)):
            at = cloth.get(key, [0, 0, 0])
            cloth[key] = [a + chance.uniform(-m, m) for a, m in zip(at, most)]
        cloth["seed"] = chance.randrange(1 << 30)
    for thing in listed("cloth") + listed("collider"):
        if "mesh" in thing:
            thing["mesh"] = str((folder / thing["mesh"]).resolve())
    return scene


def read_cache(path):
    data = path.read_bytes()
    points, = struct.unpack_from("<i", data, 16)
    frames = (len(data) - 32) // (12 * points)
    return [list(struct.iter_unpack("<3f", data[32 + 12 * points * f:32 + 12 * points * (f + 1)])) for f in range(frames)]


def percale(*arguments):
    done = subprocess.run([PERCALE, *map(str, arguments)], capture_output=True, text=True, encoding="utf-8")
    if done.returncode not in (0, 1):
        raise RuntimeError(f"percale {' '.join(map(str, arguments))} ended with {done.returncode}\n{done.stderr}")
    return done.stdout


def run_once(name, seed, frames, threads, folder):
    """Yields what is broken; prints what was measured."""
    scene, cache, table = (folder / f"{name}_{seed}{end}" for end in (".json", ".pc2", ".csv"))
    scene.write_text(json.dumps(jittered(name, seed)), encoding="utf-8")
    many = ("--threads", threads) if threads else ()
    percale("simulate", scene, "--frames", frames, "-o", cache, "--csv", table, "--progress", "none", *many)
    verdict = percale("check", "--intersections", cache, *many).splitlines()
    counts = {}
    for line in verdict[:-1]:
        match = re.match(r"frame (\d+): (\d+) intersection", line)
        counts[int(match[1])] = int(match[2])
    judged, total = map(int, re.search(r": (\d+) frames?, (\d+) intersections?$", verdict[-1]).groups())
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    course = COURSES[name]
    run = Run(read_cache(cache), rows, counts, frames >= course.frames)
    seconds = sum(float(value) for row in rows for key, value in row.items() if key.endswith("_s") and key != "time_s")
    print(f"{name} seed {seed}: {len(rows)} frames, {total} intersections, {1e3 * seconds / len(rows):.0f} ms per frame, "
          f"stretch {run.greatest('greatest_stretch'):.2f} at most, {run.greatest('stretch_p99'):.2f} for 99 of 100, "
          f"lost motion {100 * run.greatest('lost_motion'):.0f} % in the worst frame, "
          f"squeezed {run.greatest('squeezed'):.0f}, {rows[-1]['intersections']} left", flush=True)
    if judged != frames + 1:
        yield f"{judged} frames were judged, expected {frames + 1}"
    if total and name != "tangled":
        yield f"{total} intersections, first: {verdict[0]}"
    if run.greatest("greatest_stretch") > course.stretch:
        yield f"an edge is stretched {run.greatest('greatest_stretch'):.2f} times, at most {course.stretch} are allowed"
    if not all(abs(c) < 100 for p in run.frames[-1] for c in p):
        yield "a vertex is not within 100 m"
    yield from course.law(run)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", choices=COURSES)
    parser.add_argument("--runs", type=int, default=int(os.environ.get("PERCALE_GAUNTLET_RUNS", 0)))
    parser.add_argument("--frames", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int)
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for the scenes, caches and tables of all runs")
    options = parser.parse_args()
    course = COURSES[options.scene]
    frames = options.frames or (course.frames if options.runs else course.short)
    failed = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for seed in range(options.seed, options.seed + max(1, options.runs)):
            broken = list(run_once(options.scene, seed, frames, options.threads, folder))
            for line in broken:
                print(f"  BROKEN: {line}", flush=True)
            if broken:
                failed += 1
                print(f"  again: PERCALE={PERCALE} {__file__} {options.scene} --seed {seed} --frames {frames}", flush=True)
            if not options.keep:
                for file in folder.iterdir():
                    file.unlink()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
