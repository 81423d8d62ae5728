#!/usr/bin/env bash
# CPU time of whole processes beside that of Filament's cmgen (Debian: libfilament-tools), in turns:
# tables that a scene of Filament takes, as OpenEXR. Prints rows for BENCHMARKS.md.
#
# Usage: benches/cmgen.sh [TURNS]; it takes the splitsum of `cargo build --release`.
set -euo pipefail
cd "$(dirname "$0")/.."
turns=${1:-7}
splitsum=${CARGO_TARGET_DIR:-target}/release/splitsum
[ -x "$splitsum" ] || { echo "no $splitsum: run cargo build --release" >&2; exit 1; }
command -v cmgen >/dev/null || { echo "no cmgen: install libfilament-tools" >&2; exit 1; }
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

# The CPU time of a command, in ms.
cpu_ms() {
    local TIMEFORMAT='%3U %3S'
    { time "$@" >/dev/null 2>"$folder/errors" || touch "$folder/failed"; } 2>&1 |
        awk '{ printf "%.0f\n", 1e3 * ($1 + $2) }'
    [ ! -e "$folder/failed" ] || {
        cat "$folder/errors" >&2
        exit 1
    }
}

median() {
    sort -n | awk '{ all[NR] = $1 } END { print all[int((NR + 1) / 2)] }'
}

# compare NAME "flags of splitsum" "flags of cmgen"
compare() {
    local turn
    : >"$folder/ours"
    : >"$folder/theirs"
    for ((turn = 0; turn < turns; turn++)); do
        # The flags are words.
        # shellcheck disable=SC2086
        cpu_ms "$splitsum" bake --quiet --backend cpu $2 -o "$folder/ours.exr" >>"$folder/ours"
        # shellcheck disable=SC2086
        cpu_ms cmgen -q $3 --ibl-dfg="$folder/theirs.exr" >>"$folder/theirs"
    done
    local ours theirs
    ours=$(median <"$folder/ours")
    theirs=$(median <"$folder/theirs")
    echo "$1|$ours|$theirs" | awk -F'|' '{ printf "| %s | %d | %d | 1/%.0f |\n", $1, $2, $3, $3 / $2 }'
}

echo "| table | splitsum, CPU ms | cmgen, CPU ms | ratio |"
echo "| --- | --- | --- | --- |"
compare "dfg, 128 x 128" "--size 128" "--size=128"
compare "dfg, 512 x 512" "--size 512" "--size=512"
compare "cloth, 128 x 128: sheen beside cmgen's multiscatter and cloth" \
    "--lut sheen --masking neubelt --size 128" "--size=128 --ibl-dfg-multiscatter --ibl-dfg-cloth"
