#!/usr/bin/env python3
"""Times the set operations of Katachi and of manifold3d on the same leaves, in turn, and prints a table.

    python3 -m venv venv && venv/bin/pip install numpy manifold3d
    cargo build --release --bench set_operations
    venv/bin/python tests/bench/compare.py [--runs 5] [--openscad] [model ...]

Leaves are made by Katachi and handed to Manifold as triangles; only the operation is timed, with all
threads that both take by themselves. Runs alternate, and the median of each side counts. With
`--openscad` the same leaves also go through OpenSCAD, from start to finish, for at most a minute.
"""

import argparse
import glob
import json
import os
import shutil
import statistics
import subprocess
import tempfile
import time

import manifold3d
import numpy

# The ratio to Manifold that each model must and should reach.
TARGETS = {
    "spheres24": (None, None),
    "spheres224": (0.5, 0.2),
    "spheres708": (0.5, 0.2),
    "cuboids12": (None, None),
    "cuboids60": (0.5, 0.1),
    "plate": (0.5, 0.2),
    "menger3": (0.7, 0.25),
    "menger4": (0.3, 0.05),
    "cubes512": (1.0, 0.5),
    "chain": (0.5, 0.1),
}
OPENSCAD_LIMIT = 60


def program():
    """The newest build of the models."""
    found = glob.glob("target/release/deps/set_operations-*")
    found = [f for f in found if os.access(f, os.X_OK) and not f.endswith(".d")]
    if not found:
        raise SystemExit("build it first: cargo build --release --bench set_operations")
    return max(found, key=os.path.getmtime)


def read_off(path):
    """Points and triangles of an OFF file."""
    with open(path) as file:
        words = file.read().split()
    count, faces = int(words[1]), int(words[2])
    points = numpy.array(words[4 : 4 + 3 * count], dtype=numpy.float64).reshape(-1, 3)
    corners = numpy.array(words[4 + 3 * count :], dtype=numpy.int64).reshape(faces, 4)
    return points, corners[:, 1:].astype(numpy.uint64)


def solid(path):
    """A leaf as Manifold takes it."""
    points, corners = read_off(path)
    leaf = manifold3d.Manifold(manifold3d.Mesh64(points, corners))
    assert leaf.status() == manifold3d.Error.NoError and leaf.num_tri() > 0, path
    return leaf


def evaluated(tree, leaves):
    """The tree evaluated by Manifold."""
    if isinstance(tree, int):
        return leaves[tree]
    kind, *parts = tree
    parts = [evaluated(part, leaves) for part in parts]
    operations = {
        "union": manifold3d.OpType.Add,
        "difference": manifold3d.OpType.Subtract,
        "intersection": manifold3d.OpType.Intersect,
    }
    return manifold3d.Manifold.batch_boolean(parts, operations[kind])


def time_manifold(tree, leaves):
    start = time.perf_counter()
    result = evaluated(tree, leaves)
    triangles = result.num_tri()
    return {
        "ms": (time.perf_counter() - start) * 1e3,
        "triangles": triangles,
        "volume": result.volume(),
    }


def scad(tree, folder):
    """The tree as OpenSCAD source."""
    if isinstance(tree, int):
        points, corners = read_off(f"{folder}/{tree}.off")
        return f"polyhedron({points.tolist()}, {corners[:, ::-1].tolist()});"
    return f"{tree[0]}() {{ {' '.join(scad(part, folder) for part in tree[1:])} }}"


def time_openscad(tree, folder):
    """Seconds from start to finish, or None past the limit."""
    source = f"{folder}/model.scad"
    with open(source, "w") as file:
        file.write(scad(tree, folder))
    start = time.perf_counter()
    try:
        command = ["openscad", "-o", f"{folder}/model.off", source]
        subprocess.run(command, capture_output=True, timeout=OPENSCAD_LIMIT, check=True)
    except (subprocess.TimeoutExpired, subprocess.CalledProcessError):
        return None
    return time.perf_counter() - start


class Katachi:
    """A process that evaluates a model whenever it is sent a line."""

    def __init__(self, binary, model):
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        self.process = subprocess.Popen([binary, "serve", model], text=True, **pipes)

    def time(self):
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def compare(binary, model, options):
    folder = tempfile.mkdtemp(prefix="katachi-compare-")
    subprocess.run([binary, "leaves", model, folder], check=True)
    with open(f"{folder}/tree.json") as file:
        tree = json.load(file)
    leaves = [solid(f"{folder}/{i}.off") for i in range(len(glob.glob(f"{folder}/*.off")))]
    katachi = Katachi(binary, model)
    ours, theirs = [], []
    spent = time.monotonic()
    for run in range(options.runs):
        ours.append(katachi.time())
        theirs.append(time_manifold(tree, leaves))
        if run > 0 and time.monotonic() - spent > options.seconds:
            break
    katachi.close()
    report(model, ours, theirs, time_openscad(tree, folder) if options.openscad else None)
    shutil.rmtree(folder)


def report(model, ours, theirs, openscad):
    median = lambda runs: statistics.median(run["ms"] for run in runs)
    ratio = median(ours) / median(theirs)
    must, aim = TARGETS[model]
    volume = abs(ours[0]["volume"] / theirs[0]["volume"] - 1)
    columns = [
        f"{model:11}",
        f"{median(ours):9.1f}",
        f"{median(theirs):9.1f}",
        f"{ratio:6.2f}",
        f"{must or '':>4}",
        f"{aim or '':>4}",
        f"{ours[0]['triangles']:9}",
        f"{theirs[0]['triangles']:9}",
        "yes" if ours[0]["closed"] else "NO",
        f"{volume:.0e}",
        "" if openscad is None else f"{openscad * 1e3:.0f}",
    ]
    print("| " + " | ".join(columns) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("models", nargs="*", default=list(TARGETS))
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=60, help="limit for the runs of a model")
    parser.add_argument("--openscad", action="store_true")
    options = parser.parse_args()
    print("| model | Katachi ms | Manifold ms | ratio | must | aim | triangles | Manifold's | closed | volume differs by | OpenSCAD ms |")
    print("|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
    for model in options.models:
        compare(program(), model, options)


if __name__ == "__main__":
    main()
