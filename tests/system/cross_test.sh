#!/bin/sh
# Builds dicot's packages for aarch64 and armhf, holds them against what is promised, proves the kernels of the program in
# them under qemu-user, and checks that the files it writes are byte for byte those of the native program.
#
#   cross_test.sh NATIVE_DICOT [LEFT RIGHT [BOARDS]]
#
# The pair that is always matched is made here; LEFT and RIGHT are a real one (JPEG or PNG) to be matched as well, BOARDS is
# a folder of pictures of OpenCV's chessboard, left01.jpg and right01.jpg onwards; empty words are left out.
# The cross builds stay in .build/arm64 and .build/armhf, the sysroots in .cache.
set -eu
LC_ALL=C
export LC_ALL

native=${1:?cross_test.sh: name the native dicot program}
left=${2:-}
right=${3:-}
boards=${4:-}
checkout=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

for program in cmake ninja mmdebstrap qemu-aarch64 qemu-arm aarch64-linux-gnu-g++ arm-linux-gnueabihf-g++; do
    if ! command -v $program >/dev/null; then
        echo "cross_test.sh: $program is missing; install ninja-build cmake mmdebstrap qemu-user" \
            "g++-aarch64-linux-gnu g++-arm-linux-gnueabihf" >&2
        exit 69
    fi
done

judge() { # what, exit code of the check
    if [ "$2" = 0 ]; then
        echo "ok      $1"
    else
        echo "FAILED  $1"
        failed=1
    fi
}

# Coloured noise, and the same seen from the right: a ramp from 3 to 9 px and a box in front of it at 13 px.
make_pair() {
    awk -v side="$1" 'BEGIN {
        width = 160; height = 96
        printf "P6\n%d %d\n255\n", width, height
        state = 12345
        for (y = 0; y < height; ++y) {
            for (x = 0; x < width + 16; ++x)
                for (c = 0; c < 3; ++c) {
                    state = (state * 1103 + 12347) % 1000003
                    noise[x, c] = (state % 200) + 1 + int(50 * x / (width + 16))
                }
            for (x = 0; x < width; ++x) {
                d = 3 + int(6 * y / height)
                if (side == "right" && x > 47 && x < 87 && y > 30 && y < 70 || \
                    side == "left" && x > 60 && x < 100 && y > 30 && y < 70)
                    d = 13
                for (c = 0; c < 3; ++c)
                    printf "%c", noise[side == "right" ? x + d : x, c]
            }
        }
    }' > "$work/$1.ppm"
}
make_pair left
make_pair right

cat > "$work/rig.yaml" <<'RIG'
%YAML:1.0
---
id: "made-for-the-cross-test"
unit: mm
image_width: 160
image_height: 96
near_mm: 1600
far_mm: 9000
P1: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 400., 0., 79.5, 0., 0., 400., 47.5, 0., 0., 0., 1., 0. ]
P2: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 400., 0., 79.5, -24000., 0., 400., 47.5, 0., 0., 0., 1., 0. ]
RIG

raw_rig=$checkout/tests/fuzz/corpus/rig/unrectified.yaml # two webcams of 1280 x 720 px

# Everything that is compared, written into one folder by `program` (a command line).
write_all() { # program, folder
    mkdir -p "$2"
    for method in paper fast standard best; do
        $1 match "$work/left.ppm" "$work/right.ppm" -o "$2/$method.pfm" --disparities 24 --method $method >/dev/null
        $1 match "$work/left.ppm" "$work/right.ppm" -o "$2/$method-dense.png" --disparities 24 --method $method --dense \
            >/dev/null
    done
    $1 process "$work/left.ppm" "$work/right.ppm" --rig "$work/rig.yaml" -o "$2/cloud.drc" --ply "$2/cloud.ply" >/dev/null
    for keep in 0 1; do
        $1 rig tables "$raw_rig" --keep $keep -o "$2/keep-$keep.maps" >/dev/null
    done
    if [ -n "$right" ]; then
        $1 match "$left" "$right" -o "$2/real.pfm" --disparities 64 --window 9 >/dev/null
    fi
    if [ -n "$boards" ]; then
        SOURCE_DATE_EPOCH=1767225600 $1 calibrate --images "$work/boards" --corners 9x6 --square-mm 30 --force \
            -o "$2/webcams.yaml" >/dev/null
    fi
}
if [ -n "$boards" ]; then
    mkdir "$work/boards"
    # Seven pairs: emulated, each takes seconds.
    cp "$boards"/left0[1-7].jpg "$boards"/right0[1-7].jpg "$work/boards"
fi
write_all "$native" "$work/native"
for file in "$work"/native/*; do
    # Files of nothing but gaps would be equal too.
    judge "native $(basename "$file") says something" "$([ "$(od -An -v -tx1 -w4 "$file" | sort -u | wc -l)" -gt 300 ]; echo $?)"
done

for arch in arm64 armhf; do
    case $arch in
        arm64) emulator="qemu-aarch64 -cpu cortex-a53" ;;
        armhf) emulator="qemu-arm -cpu cortex-a7" ;;
    esac
    sysroot=$(sh "$checkout/toolchain/cross/sysroot.sh" $arch)
    cmake -S "$checkout" --preset $arch >"$work/cmake.log" 2>&1 || { tail -30 "$work/cmake.log" >&2; exit 70; }
    cmake --build "$checkout/.build/$arch" --target all package >"$work/build.log" 2>&1 ||
        { tail -30 "$work/build.log" >&2; exit 70; }
    package=$checkout/.build/$arch/dicot_$("$native" --version | sed 's/^dicot //')_$arch.deb
    sh "$checkout/tests/system/package_test.sh" "$package" $arch "$emulator -L $sysroot" || failed=1
    dpkg-deb -x "$package" "$work/board-$arch"
    program="$emulator -L $sysroot $work/board-$arch/usr/bin/dicot"

    code=0
    sh "$checkout/tests/kernels/no_shared_code.sh" nm \
        "$checkout/.build/$arch/algo/kernels/CMakeFiles/dicot_kernels.dir/neon/neon.cpp.o" || code=$?
    judge "$arch vector file shares no code" $code

    code=0
    $program selftest >"$work/selftest" || code=$?
    cat "$work/selftest"
    judge "$arch selftest" $code
    judge "$arch selftest reached all eight NEON kernels" "$([ "$(grep -c '^neon .*equal' "$work/selftest")" = 8 ]; echo $?)"

    code=0
    write_all "$program" "$work/$arch" || code=$?
    judge "$arch commands" $code
    for file in "$work"/native/*; do
        name=$(basename "$file")
        judge "$arch $name is the native one" "$(cmp "$file" "$work/$arch/$name" >&2; echo $?)"
    done
done
exit $failed
