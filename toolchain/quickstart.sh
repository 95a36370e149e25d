#!/bin/sh
# From a bare Debian 12 to a 3D cloud of a real plant: sh toolchain/quickstart.sh
set -eu

cd "$(dirname "$0")/.."
build=.build/quickstart
out=.build/quickstart-out
cache=.cache
pictures=$cache/opencv-doc
log=.build/quickstart.log
. toolchain/packages.sh

step() { printf '\n[%s/7] %s\n' "$1" "$2"; }

fail() {
    echo "quickstart: $1" >&2
    exit "${2:-1}"
}

# Runs a command quietly; shows the end of what it said if it fails.
quietly() {
    "$@" >"$log" 2>&1 && return 0
    tail -n 30 "$log" >&2
    fail "this failed: $* (all of it: $log)" 70
}

# The same, but what ninja says while it builds is one line of a terminal.
compile() {
    if [ -t 1 ]; then
        cmake --build "$1" --target dicot || fail "dicot does not build; the reason is above" 70
    else
        quietly cmake --build "$1" --target dicot
    fi
}

download() { (cd "$1" && apt-get -q download opencv-doc); }

boards() { # left or right: pair 10 is not in the package
    for number in 01 02 03 04 05 06 07 08 09 11 12 13 14; do
        echo "$1$number.jpg"
    done
}

take_out() { # folder
    data=./usr/share/doc/opencv-doc/examples/data
    download "$1" || { [ "$(id -u)" = 0 ] && apt-get -q update && download "$1"; } || return
    # shellcheck disable=SC2046 # names without blanks
    dpkg-deb --fsys-tarfile "$1"/opencv-doc_*.deb |
        tar -x -C "$1" --strip-components=7 -f - \
            $(for name in aloeL.jpg aloeR.jpg aloeGT.png $(boards left) $(boards right); do echo "$data/$name"; done) || return
    rm -f "$1"/opencv-doc_*.deb
    mkdir "$1/boards"
    for name in $(boards left) $(boards right); do
        mv "$1/$name" "$1/boards/" || return
    done
}

have_pictures() { # folder
    for name in aloeL.jpg aloeR.jpg aloeGT.png $(boards boards/left) $(boards boards/right); do
        [ -s "$1/$name" ] || return 1
    done
}

# Pictures out of Debian's opencv-doc, without installing it.
fetch_pictures() {
    ! have_pictures "$pictures" || return 0
    folder=$(mktemp -d "$cache/opencv-doc.XXXXXX")
    trap 'rm -rf "$folder"' EXIT
    # As root, apt lets its own user download; the folder is open to it.
    [ "$(id -u)" != 0 ] || chmod 777 "$folder"
    if ! take_out "$folder" >"$log" 2>&1; then
        tail -n 10 "$log" >&2
        fail "cannot take the pictures out of Debian's package opencv-doc: check the network, run 'apt-get update'" 69
    fi
    have_pictures "$folder" || fail "Debian's package opencv-doc does not hold all pictures: $log" 69
    rm -rf "$pictures"
    chmod 755 "$folder"
    mv "$folder" "$pictures"
    trap - EXIT
}

# All lengths in pixels are half of those at full size.
write_rig() {
    cat >"$1" <<RIG
%YAML:1.0
---
# The Aloe pair of Middlebury 2006 at half of its size. Full size: focal length 3740 px, baseline 160 mm; the crop's
# disparity offset is 270 px as far as is known. The principal point is assumed in the middle.
id: "aloe-middlebury-2006-half"
unit: mm
image_width: 641
image_height: 555
near_mm: 1200
far_mm: 1950
P1: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 1870., 0., 320., 0., 0., 1870., 277., 0., 0., 0., 1., 0. ]
P2: !!opencv-matrix
   rows: 3
   cols: 4
   dt: d
   data: [ 1870., 0., 455., -299200., 0., 1870., 277., 0., 0., 0., 1., 0. ]
RIG
}

started=$(date +%s)
mkdir -p .build "$cache" "$out"

step 1 "Packages: the compiler, the libraries, djpeg"
dicot_install build quickstart || exit
packaged=$(date +%s)

step 2 "Building dicot on $(nproc) processors: about a minute on two"
quietly cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DDICOT_TESTS=OFF
compile "$build"
dicot=$build/platform/app/dicot
"$dicot" --version

step 3 "A real pair: the Aloe of Middlebury 2006, out of Debian's opencv-doc"
fetch_pictures
quietly djpeg -scale 1/2 -outfile "$out/left.ppm" "$pictures/aloeL.jpg"
quietly djpeg -scale 1/2 -outfile "$out/right.ppm" "$pictures/aloeR.jpg"
write_rig "$out/rig.yaml"
echo "scaled to 641 x 555 px, the size that a board works at"
echo "geometry (half of full size): focal length 1870 px, baseline 160 mm, disparity offset 135 px. The offset is what is"
echo "known of this crop, not a calibration: shapes are right, absolute distances are as good as that number"

step 4 "From the pair to a compressed cloud: dicot process"
"$dicot" process "$out/left.ppm" "$out/right.ppm" --rig "$out/rig.yaml" -o "$out/cloud.drc" --ply "$out/cloud.ply" \
    --disparity "$out/disparity.png" --preview "$out/preview.png"

step 5 "Against the ground truth: dicot match --dense, dicot evaluate"
"$dicot" match "$out/left.ppm" "$out/right.ppm" -o "$out/dense.pfm" --dense --disparities 118
"$dicot" evaluate "$out/dense.pfm" "$pictures/aloeGT.png"

step 6 "A rig of one's own: dicot calibrate, on 13 pairs of a chessboard out of the same package"
"$dicot" calibrate --images "$pictures/boards" --corners 9x6 --square-mm 30 --near-mm 250 --far-mm 550 \
    -o "$out/webcams.yaml" --report "$out/calibration"

step 7 "Done in $(($(date +%s) - packaged)) s (and $((packaged - started)) s for packages). In $PWD/$out:"
cat <<WHERE
  cloud.drc      the cloud, Draco-compressed: $(wc -c <"$out/cloud.drc") bytes; as PLY $(wc -c <"$out/cloud.ply")
  cloud.ply      the same for CloudCompare, MeshLab, Blender: open or import it there
  preview.png    the cloud from two viewpoints
  disparity.png  distances in colour: red is near, blue far, black has no match
  dense.pfm      every pixel's disparity, as the benchmarks want it
  rig.yaml       the geometry of that pair, which was rectified before it was published
  webcams.yaml   the geometry of two webcams, as calibrated from pictures of a chessboard
  calibration    how far to trust it: open calibration/index.html

Next, in $PWD:
  $dicot info $out/cloud.drc
  $dicot export $out/cloud.drc -o cloud.pcd
  $dicot calibrate --images DIR --corners 9x6 --square-mm 30 -o RIG.yaml
  $dicot process LEFT RIGHT --rig RIG.yaml -o CLOUD.drc
  $dicot --help
  sh toolchain/test.sh
WHERE
