#!/usr/bin/env python3
"""Times half-tones with shadows by Katachi and by POV-Ray in turn, and prints a table.

    cargo build --release --bench halftone     # and POV-Ray: apt-get install povray
    python3 tests/bench/compare_halftones.py [--runs 5]

Both get the same triangles, eye, size and one parallel light. POV-Ray's time is its own account of parsing and
tracing without anti-aliasing; Katachi's is light, shadows and pixels with anti-aliasing. The median counts.
"""

import argparse
import json
import os
import pathlib
import re
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Columns and rows, and the seconds a picture may take.
SCENES = {
    "city": (1024, 768, 0.15),
    "hospital": (1024, 768, 0.25),
    "triangles": (2048, 1536, 2.0),
    "dots": (1024, 768, 0.3),
}


def newest():
    found = (ROOT / "target/release/deps").glob("halftone-*")
    found = [f for f in found if os.access(f, os.X_OK) and f.suffix != ".d"]
    if not found:
        raise SystemExit("build it first: cargo build --release --bench halftone")
    return str(max(found, key=lambda f: f.stat().st_mtime))


def povray(binary, scene, width, height, folder):
    source = pathlib.Path(folder, f"{scene}.pov")
    if not source.exists():
        source.write_bytes(subprocess.check_output([binary, "povray", scene]))
    command = ["povray", f"+I{source}", f"+W{width}", f"+H{height}", "-A", "-D", f"+O{folder}/{scene}.png"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stderr
    parts = [re.search(rf"{name} Time:.*?\(([\d.]+) seconds\)", said) for name in ("Parse", "Trace")]
    return sum(float(part.group(1)) for part in parts if part)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()
    binary = newest()
    print("| scene | pixels | Katachi, s | must | POV-Ray, s | ratio | must |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for scene, (width, height, must) in SCENES.items():
            pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
            server = subprocess.Popen([binary, "serve", scene], text=True, **pipes)
            ours, theirs = [], []
            for _ in range(options.runs):
                server.stdin.write("\n")
                server.stdin.flush()
                ours.append(json.loads(server.stdout.readline())["ms"] / 1e3)
                if scene != "dots":
                    theirs.append(povray(binary, scene, width, height, folder))
            server.stdin.close()
            server.wait()
            mine = statistics.median(ours)
            row = [scene, f"{width} x {height}", f"{mine:.3f}", f"{must} {'yes' if mine <= must else 'NO'}"]
            if theirs:
                ratio = mine / max(statistics.median(theirs), 1e-9)
                row += [f"{statistics.median(theirs):.3f}", f"{ratio:.2f}", f"0.5 {'yes' if ratio <= 0.5 else 'NO'}"]
            else:
                row += ["", "", ""]
            print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
