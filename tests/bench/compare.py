#!/usr/bin/env python3
"""Runs the same set operations through Katachi, Manifold and OpenSCAD, in turn, and prints tables.

    python3 -m venv venv && venv/bin/pip install numpy manifold3d
    cargo build --release --bins --bench set_operations
    venv/bin/python tests/bench/compare.py [--quick] [--runs 5] [model ...]

First table: the operation alone. Leaves are made by Katachi and handed to Manifold as triangles; each
program holds them in a process of its own. After a run of each that does not count, runs of the two
alternate, on all processors and then on one, and the median counts. `ratio` is Katachi's time to Manifold's on all processors, `must` and `aim` are what
it is measured against; `x1` the same with one processor for both. Faults of a result are found by exact
signs in one program for both: triangles that are flat (`flat`, lower than 1e-12 of the size) and pairs of
triangles that cross or cover each other (`cross`). `memory` is the highest peak of a process less what it
held before it had leaves.

Second table: from start to finished file, `katachi build` of a model of tests/bench/models against
OpenSCAD, if it is installed, on the source that `katachi build --format scad` writes of it.
"""

import argparse
import ctypes
import datetime
import json
import os
import pathlib
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve()
ROOT = HERE.parents[2]

# The ratio to Manifold that each model must and should reach; None where none is asked for.
OPERATIONS = {
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
# The models that take less than a second on both sides.
QUICK = ["spheres24", "spheres224", "cuboids12", "cuboids60", "menger3", "cubes512"]
# The same for the ratio to OpenSCAD, from start to finish.
WHOLE = (0.02, 0.005)


class Server:
    """A process that evaluates a model whenever it is sent an empty line."""

    def __init__(self, command, processors):
        confine = lambda: os.sched_setaffinity(0, processors)
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        self.process = subprocess.Popen(command, text=True, preexec_fn=confine, **pipes)
        self.runs = []

    def ask(self, line=""):
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def run(self):
        self.runs.append(self.ask())

    def result(self, judge, path):
        """What the judge says about the last result, and what the runs say."""
        self.ask(path)
        facts = json.loads(subprocess.check_output([judge, "judge", path]))
        facts["ms"] = statistics.median(run["ms"] for run in self.runs[1:])
        facts["memory"] = self.runs[0]["peak"] / 1024
        facts["volume"] = self.runs[0]["volume"]
        self.process.stdin.close()
        self.process.wait()
        return facts


def compare(binary, model, options):
    """The row of a model in the first table."""
    folder = tempfile.mkdtemp(prefix="katachi-compare-")
    subprocess.run([binary, "leaves", model, folder], check=True)
    all_processors = os.sched_getaffinity(0)
    one = {min(all_processors)}
    ours = [binary, "serve", model]
    theirs = [sys.executable, str(HERE), "--serve", folder]
    servers = [Server(c, p) for p in (all_processors, one) for c in (ours, theirs)]
    # The two that use all processors take turns, and then the two that use one.
    for pair in (servers[:2], servers[2:]):
        started = time.monotonic()
        for run in range(options.runs + 1):
            for server in pair:
                server.run()
            if run > 1 and time.monotonic() - started > options.seconds / 2:
                break
    facts = [server.result(binary, f"{folder}/result.off") for server in servers]
    shutil.rmtree(folder)
    return operation_row(model, *facts)


def operation_row(model, ours, theirs, ours_alone, theirs_alone):
    must, aim = OPERATIONS[model]
    ratio = ours["ms"] / theirs["ms"]
    fault = lambda facts: f"{'' if facts['closed'] else 'open '}{facts['slivers']} / {facts['crossings']}"
    return [
        model,
        f"{ours['ms']:.1f}",
        f"{theirs['ms']:.1f}",
        f"{ratio:.2f}",
        "" if must is None else f"{must} {'yes' if ratio <= must else 'NO'}",
        "" if aim is None else f"{aim} {'yes' if ratio <= aim else 'no'}",
        f"{ours_alone['ms']:.1f}",
        f"{theirs_alone['ms']:.1f}",
        f"{ours_alone['ms'] / theirs_alone['ms']:.2f}",
        f"{ours['triangles']}",
        f"{theirs['triangles']}",
        fault(ours),
        fault(theirs),
        f"{abs(ours['volume'] / theirs['volume'] - 1):.0e}",
        f"{ours['memory']:.0f} / {theirs['memory']:.0f}",
    ]


def whole(katachi, source, options):
    """The row of a model in the second table."""
    folder = tempfile.mkdtemp(prefix="katachi-compare-")
    build = lambda form: [katachi, "build", str(source), "--format", form, "-o", folder]
    subprocess.run(build("scad"), check=True, capture_output=True)
    (scad,) = pathlib.Path(folder).glob("*.scad")
    start = time.perf_counter()
    try:
        command = ["openscad", "-o", f"{folder}/theirs.off", str(scad)]
        subprocess.run(command, capture_output=True, timeout=options.patience, check=True)
        theirs = time.perf_counter() - start
    except subprocess.TimeoutExpired:
        theirs = None
    times = []
    for _ in range(options.runs):
        start = time.perf_counter()
        subprocess.run(build("off"), check=True, capture_output=True)
        times.append(time.perf_counter() - start)
    shutil.rmtree(folder)
    ours = statistics.median(times)
    bound = "" if theirs else "< "
    ratio = ours / (theirs or options.patience)
    return [
        source.stem,
        f"{ours * 1e3:.1f}",
        f"{theirs * 1e3:.0f}" if theirs else f"> {options.patience * 1e3:.0f}",
        f"{bound}{ratio:.4f}",
        *(f"{limit} {'yes' if ratio <= limit else 'no'}" for limit in WHOLE),
    ]


def serve(folder):
    """Evaluates a tree by Manifold for each empty line; the other side of `Server`."""
    import manifold3d
    import numpy

    kinds = {
        "union": manifold3d.OpType.Add,
        "difference": manifold3d.OpType.Subtract,
        "intersection": manifold3d.OpType.Intersect,
    }

    def solid(path):
        leaf = manifold3d.Manifold(manifold3d.Mesh64(*read_off(numpy, path)))
        assert leaf.status() == manifold3d.Error.NoError and leaf.num_tri() > 0, path
        return leaf

    def evaluated(tree):
        if isinstance(tree, int):
            return leaves[tree]
        return manifold3d.Manifold.batch_boolean([evaluated(part) for part in tree[1:]], kinds[tree[0]])

    before = memory("VmRSS")
    tree = json.loads(pathlib.Path(folder, "tree.json").read_text())
    count = len(list(pathlib.Path(folder).glob("[0-9]*.off")))
    leaves = [solid(f"{folder}/{i}.off") for i in range(count)]
    forget_peak()
    for line in sys.stdin:
        if path := line.strip():
            write_off(result.to_mesh64(), path)
            print("{}", flush=True)
            continue
        start = time.perf_counter()
        result = evaluated(tree)
        result.num_tri()
        ms = (time.perf_counter() - start) * 1e3
        peak = memory("VmHWM") - before
        print(json.dumps({"ms": ms, "peak": peak, "volume": result.volume()}), flush=True)


def read_off(numpy, path):
    """Points and triangles of an OFF file."""
    with open(path) as file:
        words = file.read().split()
    count, faces = int(words[1]), int(words[2])
    points = numpy.array(words[4 : 4 + 3 * count], dtype=numpy.float64).reshape(-1, 3)
    corners = numpy.array(words[4 + 3 * count :], dtype=numpy.int64).reshape(faces, 4)
    return points, corners[:, 1:].astype(numpy.uint64)


def write_off(mesh, path):
    points, triangles = mesh.vert_properties[:, :3].tolist(), mesh.tri_verts.tolist()
    with open(path, "w") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        file.writelines(f"{x!r} {y!r} {z!r}\n" for x, y, z in points)
        file.writelines(f"3 {a} {b} {c}\n" for a, b, c in triangles)


def memory(what):
    """A figure of this process in kilobytes."""
    status = pathlib.Path("/proc/self/status").read_text()
    return next(int(line.split()[1]) for line in status.splitlines() if line.startswith(what))


def forget_peak():
    """Gives back what reading the leaves has left over, and starts the peak anew."""
    ctypes.CDLL("libc.so.6").malloc_trim(0)
    pathlib.Path("/proc/self/clear_refs").write_text("5")


def newest(pattern):
    """The newest program of a pattern in the release folder."""
    found = [f for f in (ROOT / "target/release").glob(pattern) if os.access(f, os.X_OK) and f.suffix != ".d"]
    if not found:
        raise SystemExit("build it first: cargo build --release --bins --bench set_operations")
    return str(max(found, key=lambda f: f.stat().st_mtime))


def table(heads, rows):
    print("| " + " | ".join(heads) + " |")
    print("|" + "---|" * len(heads), flush=True)
    for row in rows:
        print("| " + " | ".join(row) + " |", flush=True)
    print()


def machine():
    """Date and processors."""
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    names = [line.split(":")[1].strip() for line in lines if line.startswith("model name")]
    kind = names[0] if names else platform.machine()
    return f"{datetime.date.today()}, {len(os.sched_getaffinity(0))} processors, {kind}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*", help="those of the first table that are wanted, or all")
    parser.add_argument("--quick", action="store_true", help="small models only")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=120, help="no new run of a model after this")
    parser.add_argument("--patience", type=float, default=60, help="seconds that OpenSCAD may take")
    parser.add_argument("--serve", metavar="FOLDER", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.serve:
        return serve(options.serve)
    models = options.models or (QUICK if options.quick else list(OPERATIONS))
    binary = newest("deps/set_operations-*")
    print(f"{machine()}; milliseconds; faults are flat / cross, memory is MB, Katachi / Manifold\n")
    heads = "model,Katachi,Manifold,ratio,must,aim,Katachi x1,Manifold x1,ratio x1,triangles,Manifold's"
    heads += ",faults,Manifold's,volumes differ by,memory"
    table(heads.split(","), (compare(binary, model, options) for model in models))
    if shutil.which("openscad"):
        sources = sorted((ROOT / "tests/bench/models").glob("*.kata"))
        sources = [s for s in sources if s.stem in models or not options.models and s.stem == "box"]
        heads = ["start to finish", "Katachi", "OpenSCAD", "ratio", "must", "aim"]
        table(heads, (whole(newest("katachi"), source, options) for source in sources))


if __name__ == "__main__":
    main()
