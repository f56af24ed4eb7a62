#!/usr/bin/env python3
"""Runs the same offsets and questions through Katachi and others in one run, and prints a table.

    python3 -m venv venv && venv/bin/pip install manifold3d meshlib numpy
    python3 -m venv venv_occ && venv_occ/bin/pip install build123d
    apt-get install openscad
    cargo bench --bench fields --no-run
    venv/bin/python tests/bench/compare_fields.py [--occ venv_occ/bin/python] [--meshlib other/bin/python]

Times are processor time of the operation alone, in milliseconds, the least of some runs; Katachi's are those
that `cargo bench --bench fields` prints on one processor. Manifold and OpenSCAD grow by the Minkowski sum with a
sphere, MeshLib by its sharp offset on voxels of 0.25 mm, Open CASCADE by its offset with arcs, tessellated within
the same deviation; parry3d tells closest points of the same mesh (`tests/bench/parry`). Who is not installed is
left out. `must` and `aim` are what Katachi has set itself: times of the other's, and triangles.
"""

import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What takes more than this many seconds is run once.
LONG = 3.0

# Case, rival, what time and triangles of the rival's must be met, and what time is aimed at.
GOALS = {
    ("hole + 2 at 0.006", "Manifold"): ("1/10, 1.5 x", "1/30"),
    ("hole + 2 at 0.019", "OpenSCAD"): ("1/50", "1/200"),
    ("stepped fillet (1, 1.5)", "MeshLib"): ("1/2", "1/10"),
}
for name in ["box", "lbr", "hole"]:
    GOALS[(f"{name} + 2 at 0.01", "MeshLib")] = ("1 x, 1/8", "1/3")
    GOALS[(f"{name} + 2 at 0.015", "Open CASCADE")] = ("10 x, 3 x", "2 x, 1.5 x")


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
    """Case to time, triangles, volume and deviation, on one processor; and rates of closest points."""
    environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
    command = ["cargo", "bench", "--quiet", "--bench", "fields"]
    output = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True)
    rows = [line.split("\t") for line in output.stdout.splitlines()]
    cases = {row[0]: row[1:] for row in rows if len(row) == 5 and row[0] != "case"}
    return cases, {row[0]: float(row[1]) for row in rows if len(row) == 2}


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


SCAD = """minkowski() {
  difference() { cube(20); translate([10, 10, -5]) cylinder(r = 5, h = 30, $fn = 64); }
  sphere(2, $fn = 32);
}"""


def openscad():
    """Case to time and triangles by `minkowski` of OpenSCAD."""
    with tempfile.TemporaryDirectory() as folder:
        source, result = pathlib.Path(folder, "hole.scad"), pathlib.Path(folder, "hole.off")
        source.write_text(SCAD)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(["openscad", "-o", result, source], capture_output=True, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        taken = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        counts = next(line.split() for line in result.read_text().splitlines() if line[:1].isdigit() or len(line.split()) == 4)
        count = int(counts[2 if counts[0] == "OFF" else 1])
    return {"hole + 2 at 0.019": (taken * 1e3, count, "")}


MESHLIB = """
import json, time
import meshlib.mrmeshpy as mm

def box(x, y, z): return mm.makeCube(mm.Vector3f(x, y, z), mm.Vector3f(0, 0, 0))

def moved(mesh, x, y, z):
    mesh.transform(mm.AffineXf3f.translation(mm.Vector3f(x, y, z)))
    return mesh

def boolean(a, b, how): return mm.boolean(a, b, how).mesh

def offset(mesh, by):
    params = mm.SharpOffsetParameters()
    params.voxelSize = 0.25
    return mm.sharpOffsetMesh(mm.MeshPart(mesh), by, params)

def least(work):
    best = 1e9
    for _ in range(3):
        start = time.process_time()
        made = work()
        best = min(best, time.process_time() - start)
    return best * 1e3, made

drill = moved(mm.makeCylinder(5, 30, 64), 10, 10, -5)
union, difference = mm.BooleanOperation.Union, mm.BooleanOperation.DifferenceAB
solids = [("box", box(10, 20, 30)), ("lbr", boolean(box(30, 5, 10), box(5, 30, 10), union)),
          ("hole", boolean(box(20, 20, 20), drill, difference))]
for name, solid in solids:
    taken, made = least(lambda: offset(solid, 2))
    print(json.dumps([f"{name} + 2 at 0.01", taken, made.topology.numValidFaces(), ""]))
# The foot of the step is sunk into the plate by a little, so that faces do not lie on each other.
stepped = boolean(mm.makeCylinder(20, 5, 128), moved(mm.makeCylinder(10, 9, 128), 0, 0, 4), union)
taken, made = least(lambda: offset(offset(offset(stepped, 1.5), -2.5), 1))
change = f"change {made.volume() - stepped.volume():.2f}"
print(json.dumps(["stepped fillet (1, 1.5)", taken, made.topology.numValidFaces(), change]))
"""

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
    print(json.dumps([f"{name} + 2 at 0.015", best * 1e3, count, ""]))
"""


def told_by(python, program):
    """Case to time and triangles by a program of another Python."""
    output = subprocess.run([python, "-c", program], capture_output=True, text=True)
    rows = [json.loads(line) for line in output.stdout.splitlines() if line.startswith("[")]
    if not rows:
        print(output.stderr[-400:], file=sys.stderr)
    return {case: tuple(rest) for case, *rest in rows}


def parry():
    """Millions of closest points a second by parry3d."""
    command = ["cargo", "run", "--quiet", "--release"]
    output = subprocess.run(command, cwd=ROOT / "tests/bench/parry", capture_output=True, text=True, check=True)
    return {name: float(rate) for name, rate in (line.split("\t") for line in output.stdout.splitlines())}


def tried(work):
    """What somebody finds; nothing where he is not installed."""
    try:
        return work()
    except (ImportError, OSError, subprocess.CalledProcessError) as error:
        print(error, file=sys.stderr)
        return {}


def times(ratio):
    """A ratio below one as a part."""
    return f"1/{1 / ratio:.1f}" if ratio < 1 else f"{ratio:.2f}"


def offsets(own, rivals):
    print("| case | Katachi | triangles | off | rival | time | triangles | time ratio | triangles ratio | must | aim |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for case, (taken, triangles, _, off) in own.items():
        others = [(name, found[case]) for name, found in rivals.items() if case in found]
        for name, (theirs, count, note) in others:
            counts = times(int(triangles) / count) if isinstance(count, int) else ""
            must, aim = GOALS.get((case, name), ("", ""))
            print(
                f"| {case} | {taken} | {triangles} | {off} | {name} {note} | {theirs:.1f} | {count} "
                f"| {times(float(taken) / theirs)} | {counts} | {must} | {aim} |"
            )
        if not others:
            print(f"| {case} | {taken} | {triangles} | {off} | | | | | | | |")


def questions(own, theirs):
    print("\n| closest points, 100 k triangles | Katachi, M/s | parry3d, M/s | ratio | must |")
    print("|---|---|---|---|---|")
    for case, rate in own.items():
        other = next((r for name, r in theirs.items() if case.endswith(name)), None)
        ratio = f"{rate / other:.1f}" if other else ""
        must = "" if "with" in case else "10" if "by cell" in case else "3"
        print(f"| {case} | {rate} | {other} | {ratio} | {must} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--occ", help="a python that has build123d")
    parser.add_argument("--meshlib", default=sys.executable, help="a python that has meshlib")
    arguments = parser.parse_args()
    asked = tried(parry)
    cases, rates = katachi()
    rivals = {
        "Manifold": tried(manifold),
        "OpenSCAD": tried(openscad),
        "MeshLib": tried(lambda: told_by(arguments.meshlib, MESHLIB)),
    }
    if arguments.occ:
        rivals["Open CASCADE"] = told_by(arguments.occ, OCC)
    offsets(cases, rivals)
    questions(rates, asked)


if __name__ == "__main__":
    sys.exit(main())
