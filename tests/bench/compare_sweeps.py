#!/usr/bin/env python3
"""Runs the same sweeps through Katachi and Open CASCADE in one run, and prints a table.

    python3 -m venv venv && venv/bin/pip install build123d
    cargo bench --bench sweeps --no-run
    venv/bin/python tests/bench/compare_sweeps.py

Least of some runs in milliseconds, from curves to triangles within the same tolerance. Open CASCADE carries its sections
along the curve between both rails (`BRepOffsetAPI_MakePipeShell`; with the second rail for a normal it makes nothing of this),
winds the thread's ridge in Frenet's frame, and skins with `ThruSections`.
"""

import pathlib
import subprocess
import time

import build123d as b
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopLoc import TopLoc_Location
from OCP.BRep import BRep_Tool

ROOT = pathlib.Path(__file__).resolve().parents[2]


def tessellated(shape, tolerance):
    """The number of triangles within a tolerance."""
    BRepTools.Clean_s(shape.wrapped)
    BRepMesh_IncrementalMesh(shape.wrapped, tolerance, False, 0.5, False)
    count = 0
    for face in shape.faces():
        mesh = BRep_Tool.Triangulation_s(face.wrapped, TopLoc_Location())
        count += mesh.NbTriangles() if mesh else 0
    return count


def rails(tolerance):
    ys, zs = [10, 14, 22, 12, 16], [0, 30, -10, 20, 0]
    middle = b.Edge.make_spline([b.Vector(100 * i, 0, zs[i]) for i in range(5)], tangents=[b.Vector(1, 0, 0)] * 2)
    radii = [(10, 6), (14, 9), (22, 8), (12, 10), (16, 7)]
    sections = []
    for i, (x, y) in enumerate(radii):
        plane = b.Plane(origin=(100 * i, 0, zs[i]), x_dir=(0, 1, 0), z_dir=(1, 0, 0))
        sections.append(b.Wire([b.Edge.make_ellipse(x, y, plane)]))
    solid = b.Solid.sweep_multi(sections, b.Wire([middle]))
    return tessellated(solid, tolerance), solid.volume


def bolt(tolerance):
    pitch, outer = 1.25, 4.0
    core = outer - 0.541266 * pitch
    foot = core - 0.15 * pitch
    helix = b.Edge.make_helix(pitch, 30 + 2 * pitch, core).moved(b.Location((0, 0, 5 - pitch)))
    at = lambda r, z: (r, 0, 5 - pitch + z * pitch)
    corners = [at(foot, -0.375), at(foot, 0.375), at(core, 0.375), at(outer, 0.0625), at(outer, -0.0625), at(core, -0.375)]
    face = b.Face(b.Wire.make_polygon([b.Vector(*c) for c in corners], close=True))
    ridge = b.Solid.sweep(face, b.Wire([helix]), is_frenet=True)
    rod = b.Solid.make_cylinder(core, 30, b.Plane.XY.offset(5))
    box = b.Solid.make_box(18, 18, 30, b.Plane((-9, -9, 5)))
    wire = b.Wire.make_polygon([b.Vector(7.5, 0, 0).rotate(b.Axis.Z, 60 * i) for i in range(6)], close=True)
    head = b.Solid.extrude(b.Face(wire), b.Vector(0, 0, 5))
    solid = (rod.fuse(ridge) & box).fuse(head)
    return tessellated(solid, tolerance), solid.volume


def funnel(tolerance):
    ring = lambda n, r, z: b.Wire.make_polygon(
        [b.Vector(r, 0, z).rotate(b.Axis.Z, 360 * i / n) for i in range(n)], close=True
    )
    solid = b.Solid.make_loft([ring(200, 10, 0), ring(7, 5, 30)], True)
    return tessellated(solid, tolerance), solid.volume


CASES = {
    "two rails, 5 sections at 0.01": (rails, 0.01),
    "bolt M8 x 1.25 x 30 at 0.02": (bolt, 0.02),
    "loft of 200 and 7 corners at 0.05": (funnel, 0.05),
}


def least(work):
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        try:
            found = work()
        except Exception as error:  # what the other program refuses is told, not timed
            return None, (0, 0.0), str(error).splitlines()[0] if str(error) else type(error).__name__
        best = min(best, time.perf_counter() - start)
        if best > 5.0:
            break
    return best * 1e3, found, ""


def main():
    command = ["cargo", "bench", "--quiet", "--bench", "sweeps"]
    output = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    own = {row[0]: row[1:] for row in (line.split("\t") for line in output.splitlines()) if len(row) == 4}
    print("| case | Katachi ms | triangles | volume | Open CASCADE ms | triangles | volume | ratio | must |")
    print("|---|---|---|---|---|---|---|---|---|")
    for case, (work, tolerance) in CASES.items():
        ms, triangles, volume = own[case]
        taken, (count, other), error = least(lambda: work(tolerance))
        rival = f"{taken:.1f} | {count} | {other:.2f} | {float(ms) / taken:.3f}" if taken else f"{error} | – | – | –"
        print(f"| {case} | {float(ms):.1f} | {triangles} | {float(volume):.2f} | {rival} | 0.5 |")


if __name__ == "__main__":
    main()
