#!/bin/sh
# Proves the store on real file systems in the virtual machine: power cuts, a full disk, a disk that turns read-only.
#
#   sh tests/vm/store.sh [FOLDER] [SEED] [STATES]     FOLDER: for all that it makes; .build/vm-store
#
# Three disks are logged while a store is filled: through dicot's own medium, through one whose syncs do nothing, and through one
# that forgets the folders alone. Then store/crash_test.py replays the power cuts that the logs allow; the careless ones must
# be found out.
cd "$(dirname "$0")/../.." || exit 70
name=store
. tests/vm/machine.sh
seed=${2:-1}
states=${3:-400}
PATH=$PATH:/usr/sbin:/sbin
file_system=$((40 << 20))
disk_bytes=$((48 << 20))

build_all store_writer store_state
quietly cmake --build --preset release --target store_state
for program in mke2fs e2fsck debugfs; do
    command -v $program >/dev/null && continue
    echo "store.sh: $program is missing; install the package e2fsprogs" >&2
    exit 69
done

# An ext4 as Debian makes it, smaller than its disk: behind it stand the writer's marks.
empty_disk() { # file, bytes of the file system
    rm -f "$1"
    truncate -s $disk_bytes "$1"
    mke2fs -q -t ext4 -b 4096 -d "$work/empty" "$1" $(($2 / 1024))k 2>"$work/mke2fs.log" || { cat "$work/mke2fs.log" >&2; exit 70; }
}
rm -rf "$work/empty"
mkdir -p "$work/empty/store"
for disk in kept careless nameless; do
    empty_disk "$work/$disk.img" $file_system
    cp --sparse=always "$work/$disk.img" "$work/$disk.before"
done
empty_disk "$work/small.img" $((12 << 20))
rm -f "$work/fat.img"
truncate -s $((12 << 20)) "$work/fat.img"
printf 'seed=%s\nfirst_mark=%s\n' "$seed" $file_system >"$work/story"

sh tests/vm/image.sh -o "$work/store.cpio" --module ext4 --module nls_cp437 --module nls_ascii --module vfat \
    --program "$built/store/store_writer" --program "$built/store/store_state" --file "$work/story=/vm/story" \
    tests/vm/guest/store.sh
failed=0
sh tests/vm/run.sh "$work/store.cpio" --timeout 300 --out "$work/out" --logged-disk "$work/kept.img" \
    --logged-disk "$work/careless.img" --logged-disk "$work/nameless.img" --disk "$work/small.img" --disk "$work/fat.img" || failed=1

replay() { # disk, name, states, more words
    disk=$1 replayed=$2 count=$3
    shift 3
    python3 -B tests/vm/store/crash_test.py "$work/$disk.before" "$work/$disk.img.blocks" --file-system $file_system \
        --state .build/release/tests/vm/store/store_state --seed "$seed" --states "$count" --name "$replayed" "$@" || failed=1
}
python3 -B tests/vm/store/block_log_test.py || failed=1
replay kept store.acknowledged_outlives_the_power "$states"
replay careless store.without_syncs_it_does_not 40 --careless 50
replay nameless store.without_syncs_of_folders_it_does_not 60 --careless 5
exit $failed
