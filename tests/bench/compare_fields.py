#!/usr/bin/env python3
"""Runs the same offsets through Katachi, Manifold and Open CASCADE and prints a table.

    python3 -m venv venv && venv/bin/pip install numpy manifold3d
    python3 -m venv venv_occ && venv_occ/bin/pip install build123d
    cargo bench --bench fields --no-run
    venv/bin/python tests/bench/compare_fields.py [--occ venv_occ/bin/python]

Times are processor time of the operation alone, in milliseconds, the least of some runs; Katachi's are those
that `cargo bench --bench fields` prints on one processor. Manifold grows by the Minkowski sum with a sphere,
Open CASCADE by its offset with arcs, tessellated within the same deviation.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What takes more than this many seconds is run once.
LONG = 3.0


def least(work, runs=3):
    """The least processor time of some runs in ms, and what the last one made."""
    best, made = float("inf"), None
    for _ in range(runs):
        start = time.process_time()
        made = work()
        taken = time.process_time() - start
        best = min(best, taken)
        if taken > LONG:
            break
    return best * 1e3, made


def katachi():
    """Case to time, triangles, volume and deviation, on one processor."""
    environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
    command = ["cargo", "bench", "--quiet", "--bench", "fields"]
    output = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True)
    rows = [line.split("\t") for line in output.stdout.splitlines()]
    return {row[0]: row[1:] for row in rows if len(row) == 5 and row[0] != "case"}


def manifold():
    """Case to time and triangles by Minkowski sums."""
    from manifold3d import Manifold

    hole = Manifold.cube([20, 20, 20]) - Manifold.cylinder(30, 5, 5, 64).translate([10, 10, -5])
    found = {}
    for case, segments in [("hole + 2 at 0.006", 64), ("hole + 2 at 0.019", 32)]:
        ball = Manifold.sphere(2, segments)
        taken, made = least(lambda: evaluated(hole.minkowski_sum(ball)))
        found[case] = (taken, made.num_tri(), f"genus {made.genus()}")
    return found


def evaluated(solid):
    """Manifold evaluates when it is asked for something."""
    solid.num_tri()
    return solid


OCC = """
import json, sys, time
from build123d import Box, Cylinder, Align, Kind, Pos, offset
low = (Align.MIN,) * 3
box = Box(10, 20, 30, align=low)
lbr = Box(30, 5, 10, align=low) + Box(5, 30, 10, align=low)
hole = Box(20, 20, 20, align=low) - Pos(10, 10, 10) * Cylinder(5, 30)
for name, solid in [("box", box), ("lbr", lbr), ("hole", hole)]:
    best = 1e9
    for _ in range(3):
        start = time.process_time()
        try:
            made = offset(solid, 2, kind=Kind.ARC)
            _, triangles = made.tessellate(0.015, 0.35)
            count = len(triangles)
        except Exception as error:
            count = str(error)[:40]
        best = min(best, time.process_time() - start)
    print(json.dumps([f"{name} + 2 at 0.015", best * 1e3, count]))
"""


def open_cascade(python):
    """Case to time and triangles by Open CASCADE."""
    import json

    output = subprocess.run([python, "-c", OCC], capture_output=True, text=True)
    rows = [json.loads(line) for line in output.stdout.splitlines() if line.startswith("[")]
    return {case: (taken, count, "") for case, taken, count in rows}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--occ", help="a python that has build123d")
    arguments = parser.parse_args()
    own = katachi()
    rivals = {"Manifold": manifold()}
    if arguments.occ:
        rivals["Open CASCADE"] = open_cascade(arguments.occ)
    print("| case | Katachi | triangles | off | rival | time | triangles | ratio |")
    print("|---|---|---|---|---|---|---|---|")
    for case, (taken, triangles, _, off) in own.items():
        others = [(name, found[case]) for name, found in rivals.items() if case in found]
        for name, (theirs, count, note) in others:
            ratio = f"1/{theirs / float(taken):.0f}" if theirs > float(taken) else f"{float(taken) / theirs:.2f}"
            print(f"| {case} | {taken} | {triangles} | {off} | {name} {note} | {theirs:.1f} | {count} | {ratio} |")
        if not others:
            print(f"| {case} | {taken} | {triangles} | {off} | | | | |")


if __name__ == "__main__":
    sys.exit(main())
