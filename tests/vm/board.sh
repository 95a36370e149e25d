# What the tests of the cable have in common; to be sourced behind machine.sh.

# Three snapshots of 1.2 MiB with pictures and cloud in $work/store/board, as slots of a rehearsal made them.
make_store() {
    (
        flock 9
        quietly cmake --build --preset release --target dicot
    ) 9>.build/vm.lock
    rm -rf "${work:?}/store" "$work/pictures" "$work/drawn"
    mkdir -p "$work/store" "$work/pictures/left" "$work/pictures/right"
    pair=${DICOT_DATA_DIR:-../shared/data}/plants/aloe-third
    size='427 370' rig=aloe-third
    if [ ! -f "$pair/left.png" ]; then
        echo "NOT RUN: the Aloe pair: $pair is not there; a drawn pair is used"
        size='320 240' rig=drawn-pair pair=$work/drawn/pair
        quietly "${dicot:?}" snap --raw -o "$work/drawn"
        mkdir "$pair"
        mv "$work"/drawn/*/*/0*/raw_left.png "$pair/left.png"
        mv "$work"/drawn/*/*/0*/raw_right.png "$pair/right.png"
    fi
    for side in left right; do cp "$pair/$side.png" "$work/pictures/$side/000000.png"; done
    cat >"$work/store.toml" <<END_OF_FILE
[cameras]
left = "replay:$PWD/$work/pictures"
right = "replay:$PWD/$work/pictures"
width = ${size% *}
height = ${size#* }
[matching]
window = 11
[output]
device = "board"
keep_raw = true
[rig]
file = "$PWD/tests/support/data/$rig.yaml"
[schedule]
timezone = "UTC0"
every = "10m"
from = "00:00"
until = "24:00"
END_OF_FILE
    # Two days, so that there are two folders of days.
    quietly "$dicot" run --rehearse 3 --from 2026-06-01T23:40:00Z --config "$work/store.toml" -o "$work/store"
    rm -f "$work/store/board/ballast"
}

# Boots a computer of clients.sh and has it tell tests/vm/guest/$name.sh.
run_board() { # seconds, words for image.sh, "--", words for run.sh
    seconds=$1 image_words=''
    shift
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        image_words="$image_words $1"
        shift
    done
    [ $# = 0 ] || shift
    cp --sparse=always "$(sh tests/vm/clients.sh)" "$work/disk.img"
    # shellcheck disable=SC2086 # $image_words is a list of words
    sh tests/vm/image.sh -o "$work/${name:?}.cpio" --module ext4 --module dummy_hcd --module libcomposite --module usb_f_fs \
        $image_words --file "$work/store=/vm/store" --file .build/arm64/platform/app/dicot=/vm/bin/dicot \
        --file "${built:?}/mtp/trial_host=/vm/bin/trial_host" --file tests/vm/guest/board.sh=/vm/board.sh \
        --file "tests/vm/guest/$name.sh=/vm/story" tests/vm/guest/clients.sh
    sed -n 's/^#expect *//p' "tests/vm/guest/$name.sh" | tr -s ' ' '\n' >"$work/$name.cpio.expect"
    # Next year: a clock that shows a time before the program was built is held to be not set.
    exec sh tests/vm/run.sh "$work/$name.cpio" --timeout "$seconds" --out "$work/out" --disk "$work/disk.img" \
        --own-clock "$(($(date +%Y) + 1))-06-02T10:00:00" "$@"
}
