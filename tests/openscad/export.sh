#!/bin/sh
# Writes openscad.off beside each model.scad with OpenSCAD, all cases or the named ones:
#   tests/openscad/export.sh [name...]
# With OUT=DIR the exports go to DIR/<name>.off instead, so that they can be compared.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
[ $# -gt 0 ] || set -- $(cd "$here" && ls -d */ | tr -d /)
for name in "$@"; do
    folder=$here/$name
    target=${OUT:+$OUT/$name.off}
    target=${target:-$folder/openscad.off}
    log=$(openscad --hardwarnings -o "$target" "$folder/model.scad" 2>&1) || {
        printf '%s failed:\n%s\n' "$name" "$log" >&2
        exit 1
    }
    printf '%s\n' "$name"
done
