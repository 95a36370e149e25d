#!/bin/sh
# How long forty pairs of 1280 x 720 take, detection and solution, on one thread and on all.
#
#   calibrate_bench.sh DICOT [DATA]
#
# DATA holds calibration/board10x10_41mm and calibration/board8x8_46mm of the rendered rig, 20 pairs each; by default
# ../shared/data/rig-dev beside the checkout. Nothing is judged: what is allowed stands beside what was
# measured. Processor time is what counts on a machine that others use too.
set -eu
LC_ALL=C
export LC_ALL

dicot=${1:?calibrate_bench.sh: name the dicot program}
data=${2:-$(dirname "$0")/../../../shared/data/rig-dev}/calibration
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [ ! -d "$data/board10x10_41mm" ] || [ ! -d "$data/board8x8_46mm" ]; then
    echo "calibrate_bench.sh: NOT RUN: $data does not hold both boards" >&2
    exit 66
fi

key() { sed -n "s/^  \"$1\": \([0-9.e+-]*\),*\$/\1/p" "$work/report"; }

echo "threads  pairs used  boards found   solved  processor time  allowed  peak memory  allowed"
for threads in 1 0; do
    "$dicot" calibrate --images "$data/board10x10_41mm" --squares 10x10 --square-mm 41 \
        --images "$data/board8x8_46mm" --squares 8x8 --square-mm 46 \
        --threads "$threads" --json -o "$work/rig.yaml" >"$work/report"
    awk -v threads="$(key threads)" -v pairs="$(key pairs_used)" -v found="$(key found_s)" -v solved="$(key solved_s)" \
        -v processor="$(key processor_s)" -v bytes="$(key peak_memory_bytes)" 'BEGIN {
        printf "%7d  %10d  %10.2f s  %5.2f s  %12.2f s  %5d s  %7.1f MiB  %3d MiB\n", threads, pairs, found, solved,
            processor, 20, bytes / 1048576, 256
    }'
done
