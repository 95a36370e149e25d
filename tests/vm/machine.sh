# What the tests of tests/vm have in common: the programs, the pictures, the machine. To be sourced in the checkout's folder by
# a script whose $name is its own and that of its script in tests/vm/guest; its first word is the folder for all that it makes.
#
# $work: that folder. $tree: what kernel.sh fetched. $built: where the programs for the machine are.
set -eu
work=${1:-.build/vm-${name:?}}
built=.build/arm64/tests/vm/guest
mkdir -p "$work"

quietly() {
    "$@" >"$work/build.log" 2>&1 || { tail -n 30 "$work/build.log" >&2; echo "$name.sh: this failed: $*" >&2; exit 70; }
}

# What is built for the machine, beside the cameras. Only one of the tests builds at a time: they share the folders.
build_all() { # targets of the preset arm64
    exec 9>.build/vm.lock
    flock 9
    sh toolchain/cross/sysroot.sh arm64 >/dev/null
    quietly cmake --preset release
    quietly cmake --build --preset release --target make_frames
    quietly cmake --preset arm64
    quietly cmake --build --preset arm64 --target usbip_camera "$@"
    tree=$(sh tests/vm/kernel.sh)
    export tree
    exec 9>&-
}

# Two views of one picture, three frames of each, two sizes of the left one.
make_frames() {
    make=.build/release/tests/support/usbip_camera/make_frames
    rm -rf "$work/frames"
    mkdir -p "$work/frames/left" "$work/frames/right"
    $make algo/cloud/aloe.png "$work/frames/left" 640x480 3 0
    $make algo/cloud/aloe.png "$work/frames/left" 1280x720 3 0
    $make algo/cloud/aloe.png "$work/frames/right" 640x480 3 500
}

# Boots with both cameras' program and frames, and runs tests/vm/guest/$name.sh.
run_machine() { # seconds, words for image.sh
    seconds=$1
    shift
    sh tests/vm/image.sh -o "$work/$name.cpio" --module vhci-hcd --module uvcvideo \
        --program "$built/usbip_camera/usbip_camera" --file "$work/frames=/frames" \
        --file tests/vm/guest/cameras.sh=/vm/cameras.sh "$@" "tests/vm/guest/$name.sh"
    exec sh tests/vm/run.sh "$work/$name.cpio" --timeout "$seconds" --out "$work/out"
}
