#!/usr/bin/env python3
"""Draws the same scenes with Katachi and with Open CASCADE or gnuplot, in turn, and prints a table.

    python3 -m venv venv && venv/bin/pip install build123d==0.13
    cargo build --release --bench drawing
    venv/bin/python tests/bench/compare_drawings.py [--runs 9] [scene ...]

The solids are made before the clock starts. Of Open CASCADE, the exact hidden-line algorithm is timed: `Update`
and `Hide` only, not the making of lines from them, which Katachi's time contains. Of gnuplot, which has no clock
for it, the whole process drawing a surface with `hidden3d` is timed. Runs alternate and the best counts, since
other work on the machine only adds. `CPU` is the time that processors worked, of all threads of Katachi together and
with what it takes to answer: where other programs want the processors too, they stretch long runs more than short
ones, and only this is fair. `ratio` is Katachi's time to the rival's, the worse one of both kinds; `must` and `aim`
are what it is measured against, in milliseconds where no rival finishes.
"""

import argparse
import json
import math
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

from compare import HERE, ROOT, Server, machine, newest, table

SCRIPT = HERE.with_name("compare_drawings.py")
SCENES = ROOT / "tests/scenes"

# The ratio to the rival that each scene must and should reach.
RATIOS = {
    "city": (1 / 10, 1 / 30),
    "overlap": (1 / 5, 1 / 15),
    "scale960": (1 / 15, 1 / 35),
    "plate": (1 / 2, 1 / 5),
    "torus": (1, 1 / 3),
    "spheres200": (1 / 2, 1 / 5),
    "graph": (1 / 10, 1 / 30),
}
# Milliseconds where there is no rival: Open CASCADE does not finish this one in five minutes.
LIMITS = {"triangles": (100, 50)}

PLOT = """set terminal svg
set output '/dev/null'
set hidden3d
set isosamples 200,200
set samples 200,200
set view 60,30
splot [-9.95:9.95][-9.95:9.95] 3*sin(sqrt(x*x+y*y))/sqrt(x*x+y*y) with lines
"""


class Gnuplot:
    """A process for each plot."""

    def __init__(self):
        self.runs = []

    def run(self):
        worked = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
        start, before = time.perf_counter(), worked()
        subprocess.run(["gnuplot"], input=PLOT, text=True, check=True, capture_output=True)
        self.runs.append({"ms": (time.perf_counter() - start) * 1e3, "cpu": (worked() - before) * 1e3})

    def close(self):
        pass


class Drawer(Server):
    """A process that draws a scene whenever it is sent an empty line."""

    def __init__(self, command):
        super().__init__(command, os.sched_getaffinity(0))

    def run(self):
        before = self.worked()
        run = self.ask()
        self.runs.append({"cpu": self.worked() - before, **run})

    def worked(self):
        """Milliseconds that processors have worked for all threads of the process."""
        tasks = pathlib.Path(f"/proc/{self.process.pid}/task").iterdir()
        return sum(int((task / "schedstat").read_text().split()[0]) for task in tasks) / 1e6

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def rival(scene):
    if scene == "graph":
        return Gnuplot() if shutil.which("gnuplot") else None
    return None if scene in LIMITS else Drawer([sys.executable, str(SCRIPT), "--serve", scene])


def compare(binary, scene, options):
    """The row of a scene."""
    sides = [Drawer([binary, "serve", scene]), rival(scene)]
    for _ in range(options.runs):
        for side in filter(None, sides):
            side.run()
    for side in filter(None, sides):
        side.close()
    best = lambda side, what: min(run[what] for run in side.runs) if side else None
    (ours, theirs), (our_work, their_work) = ([best(s, what) for s in sides] for what in ("ms", "cpu"))
    measure, limits = (our_work, LIMITS[scene]) if scene in LIMITS else (None, RATIOS[scene])
    if theirs:
        measure = max(ours / theirs, our_work / their_work)
    name = lambda limit: f"{limit} ms" if scene in LIMITS else f"1/{round(1 / limit)}"
    verdict = lambda limit, no: "" if measure is None else f"{name(limit)} {'yes' if measure <= limit else no}"
    last = sides[0].runs[-1]
    return [
        scene,
        f"{ours:.2f}",
        f"{theirs:.1f}" if theirs else "",
        f"{our_work:.2f}",
        f"{their_work:.1f}" if theirs else "",
        f"1/{1 / measure:.1f}" if theirs else "",
        verdict(limits[0], "NO"),
        verdict(limits[1], "no"),
        f"{last['visible']:.3f}",
        f"{last['hidden']:.3f}",
        f"{last['segments']}",
    ]


def serve(scene):
    """Hides lines by Open CASCADE for each line of the input; the other side of `Drawer`."""
    from OCP.HLRBRep import HLRBRep_Algo

    shape, projector = built(scene), projection(scene)
    for _ in sys.stdin:
        algorithm = HLRBRep_Algo()
        algorithm.Add(shape)
        algorithm.Projector(projector)
        start, before = time.perf_counter(), time.process_time()
        algorithm.Update()
        algorithm.Hide()
        ms, cpu = (time.perf_counter() - start) * 1e3, (time.process_time() - before) * 1e3
        print(json.dumps({"ms": ms, "cpu": cpu}), flush=True)


def read(name):
    return json.loads((SCENES / f"{name}.json").read_text())


def projection(scene):
    """A camera of a scene."""
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
    from OCP.HLRAlgo import HLRAlgo_Projector

    camera = read(f"{scene}.cam")
    toward = [e - t for e, t in zip(camera["eye"], camera["target"])]
    right = gp_Dir(*camera["up"]).Crossed(gp_Dir(*toward))
    axes = gp_Ax2(gp_Pnt(*camera["target"]), gp_Dir(*toward), right)
    return HLRAlgo_Projector(axes, math.hypot(*toward)) if camera["type"] == "persp" else HLRAlgo_Projector(axes)


def built(scene):
    """The solids of a scene as one shape."""
    import build123d as b

    if scene == "plate":
        plate = b.Box(120, 120, 10, align=(b.Align.CENTER, b.Align.CENTER, b.Align.MIN))
        hole = b.Cylinder(4, 20)
        at = [12 * i - 54 for i in range(10)]
        return (plate - [b.Pos(x, y, 5) * hole for x in at for y in at]).wrapped
    if scene == "torus":
        return b.Torus(30, 10).wrapped
    recipe = read(f"{scene}.recipe")
    if scene == "spheres200":
        return united(b, [b.Pos(*ball[:3]) * b.Sphere(ball[3]) for ball in recipe])
    boxes = [placed_box(b, box) for box in recipe]
    return united(b, boxes) if scene == "overlap" else b.Compound(boxes).wrapped


def united(b, parts):
    return parts[0].fuse(*parts[1:]).wrapped


def placed_box(b, box):
    """A box whose rotation is given by rows."""
    column = lambda i: b.Vector(*(row[i] for row in box["R"]))
    plane = b.Plane(origin=b.Vector(*box["center"]), x_dir=column(0), z_dir=column(2))
    return plane * b.Box(*box["size"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", help="those that are wanted, or all")
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--serve", metavar="SCENE", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.serve:
        return serve(options.serve)
    print(f"{machine()}; milliseconds, lengths in millimetres\n")
    heads = "scene,Katachi,rival,Katachi CPU,rival CPU,ratio,must,aim,visible,hidden,segments".split(",")
    binary = newest("deps/drawing-*")
    table(heads, (compare(binary, scene, options) for scene in options.scenes or [*RATIOS, *LIMITS]))


if __name__ == "__main__":
    main()
