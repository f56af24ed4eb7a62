#!/usr/bin/env python3
"""Volume, area, bounding box, genus and shells of OFF files, with nothing but Python.

    measure.py [name...]              writes expected.json beside each openscad.off (all or named cases)
    measure.py --compare DIR [name..] compares DIR/<name>.off with expected.json (all there, or named)

Points with equal coordinates are one point. The Euler number is that of the closed boundary,
genus = shells - euler / 2 as in the language.
"""

import json
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
# OpenSCAD prints six significant digits. A case may have its own figure, as "relative" in expected.json.
RELATIVE = 1e-5


def read(path):
    words = path.read_text().split()
    assert words[0] == "OFF", f"{path}: not an OFF file"
    points, faces = int(words[1]), int(words[2])
    at = 4
    corners = [tuple(float(x) + 0.0 for x in words[at + 3 * i : at + 3 * i + 3]) for i in range(points)]
    at += 3 * points
    polygons = []
    for _ in range(faces):
        n = int(words[at])
        polygons.append([corners[int(i)] for i in words[at + 1 : at + 1 + n]])
        at += 1 + n
    return polygons


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def triangles(polygons):
    for p in polygons:
        for i in range(1, len(p) - 1):
            if len({p[0], p[i], p[i + 1]}) == 3:
                yield p[0], p[i], p[i + 1]


def shells(faces):
    """Connected components of the faces over shared points."""
    parent = {}

    def root(p):
        while parent[p] != p:
            parent[p] = parent[parent[p]]
            p = parent[p]
        return p

    for face in faces:
        for p in face:
            parent.setdefault(p, p)
        for p in face[1:]:
            parent[root(p)] = root(face[0])
    return sum(1 for p in parent if root(p) == p)


def measure(path):
    faces = list(triangles(read(path)))
    edges = {}
    for face in faces:
        for i in range(3):
            a, b = face[i], face[(i + 1) % 3]
            key = (min(a, b), max(a, b))
            edges[key] = edges.get(key, 0) + (1 if a < b else -1)
    assert not any(edges.values()), f"{path}: the boundary is not closed"
    points = {p for face in faces for p in face}
    normals = [cross(minus(b, a), minus(c, a)) for a, b, c in faces]
    count = shells(faces)
    euler = len(points) - len(edges) + len(faces)
    return {
        "volume": round(math.fsum(dot(a, cross(b, c)) for a, b, c in faces) / 6, 6),
        "area": round(math.fsum(math.sqrt(dot(n, n)) for n in normals) / 2, 6),
        "bbox": [[pick(p[i] for p in points) for i in range(3)] for pick in (min, max)],
        "genus": count - euler // 2,
        "shells": count,
    }


def differences(found, expected):
    relative = expected.get("relative", RELATIVE)
    for key in ("volume", "area"):
        if abs(found[key] - expected[key]) > relative * abs(expected[key]):
            yield f"{key} {found[key]}, expected {expected[key]}"
    low, high = expected["bbox"]
    size = max(h - l for l, h in zip(low, high))
    pairs = zip(sum(found["bbox"], []), sum(expected["bbox"], []))
    if any(abs(a - b) > relative * size for a, b in pairs):
        yield f"bbox {found['bbox']}, expected {expected['bbox']}"
    for key in ("genus", "shells"):
        if found[key] != expected[key]:
            yield f"{key} {found[key]}, expected {expected[key]}"


def compare(folder, names):
    names = names or sorted(path.stem for path in folder.glob("*.off"))
    faults = 0
    for name in names:
        expected = json.loads((HERE / name / "expected.json").read_text())
        found = list(differences(measure(folder / f"{name}.off"), expected))
        faults += len(found)
        print(f"{name}: {'; '.join(found) or 'agrees'}")
    return 1 if faults or not names else 0


def record(names):
    for name in names or sorted(path.parent.name for path in HERE.glob("*/openscad.off")):
        file = HERE / name / "expected.json"
        known = json.loads(file.read_text()) if file.exists() else {}
        kept = {"relative": known["relative"]} if "relative" in known else {}
        file.write_text(json.dumps(measure(HERE / name / "openscad.off") | kept) + "\n")
    return 0


if __name__ == "__main__":
    arguments = sys.argv[1:]
    if arguments[:1] == ["--compare"]:
        sys.exit(compare(Path(arguments[1]), arguments[2:]))
    sys.exit(record(arguments))
