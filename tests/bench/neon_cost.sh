#!/bin/sh
# Prints how many instructions the NEON kernels run for one unit of work, on both ARM architectures, beside the law's.
# Each kernel runs alone under qemu-user with a counting plugin, at two numbers of repeats; the difference is the kernel.
# It measures the very objects of the cross builds in .build/arm64 and .build/armhf, which must be there
# (tests/system/cross_test.sh makes them).
set -eu
checkout=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

gcc -O2 -Wall -Wextra -shared -fPIC -o "$work/insn.so" "$checkout/tests/bench/insn_plugin/insn.c"

count() { # emulator, sysroot, program, level, kernel, repeats -> instructions
    "$1" -L "$2" -plugin "$work/insn.so" "$3" "$4" "$5" "$6" 2>&1 >"$work/units" | awk '$1 == "instructions" { print $2 }'
}

printf '%-7s%-17s%20s%20s\n' "" kernel "NEON instructions" "scalar instructions"
for arch in arm64 armhf; do
    case $arch in
        arm64) triple=aarch64-linux-gnu emulator=qemu-aarch64 ;;
        armhf) triple=arm-linux-gnueabihf emulator=qemu-arm ;;
    esac
    sysroot=$checkout/.cache/sysroot-$arch
    kernels=$checkout/.build/$arch/algo/kernels/libdicot_kernels.a
    if [ ! -f "$kernels" ]; then
        echo "neon_cost.sh: $kernels is missing; run tests/system/cross_test.sh first" >&2
        exit 66
    fi
    "$triple-g++" --sysroot="$sysroot" -std=c++20 -O2 -I"$checkout/algo/kernels/include" \
        -o "$work/alone-$arch" "$checkout/tests/bench/kernel_alone.cpp" "$kernels"
    for kernel in aggregate support_weights match_cost normalise path_step winners right_winners; do
        line=$(printf '%-7s%-17s' $arch $kernel)
        for level in neon scalar; do
            # shellcheck disable=SC2086 # the emulator is a command with its words
            few=$(count $emulator "$sysroot" "$work/alone-$arch" $level $kernel 2)
            # shellcheck disable=SC2086
            many=$(count $emulator "$sysroot" "$work/alone-$arch" $level $kernel 12)
            units=$(cat "$work/units")
            each=$(awk -v few="$few" -v many="$many" -v units="$units" 'BEGIN { printf "%.3f", (many - few) / (10 * units) }')
            line="$line$(printf '%20s' "$each")"
        done
        echo "$line"
    done
done
