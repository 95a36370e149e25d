# A store on file systems of the kernel: runs in the virtual machine. /dev/vdb to /dev/vdd are logged, vde is small, vdf blank.
#expect kept.writes careless.writes nameless.writes
#expect full.becomes_a_miss full.nothing_torn full.works_again
#expect readonly.from_the_start readonly.in_the_middle readonly.reads readonly.works_again
#expect fat.mounts fat.writes fat.full_is_a_miss fat.survives_a_remount
seed='' first_mark=''
. /vm/story
mkdir card
marks=@$first_mark

# Two runs, as of a program that is started again.
fill() { # disk, words
    disk=$1
    shift
    mount -t ext4 "$disk" card || return
    store_writer --seed "$seed" --count 40 --housekeeping --marks "$disk$marks" "$@" card/store &&
        store_writer --seed "$seed" --first 41 --count 20 --housekeeping --marks "$disk$marks" "$@" card/store
    result=$?
    umount card || return
    return $result
}
judge kept.writes fill /dev/vdb
judge careless.writes fill /dev/vdc --careless all
judge nameless.writes fill /dev/vdd --careless names

says() { # exit code, lines that have to be there, "--", command
    wanted=$1 lines=''
    shift
    while [ "$1" != -- ]; do
        lines="$lines$1
"
        shift
    done
    shift
    "$@" >said 2>&1
    code=$?
    cat said
    [ $code = "$wanted" ] || { echo "exit code $code and not $wanted"; return 1; }
    printf '%s' "$lines" | while read -r line; do
        grep -q -e "$line" said || { echo "is not there: $line"; exit 1; }
    done
}
whole() { says 0 'findings 0$' -- store_state card/store; }

# --- a disk that another file fills to its last block

mount -t ext4 /dev/vde card
full() {
    store_writer --seed 7 --count 6 --reserve 65536 card/store || return
    cat /dev/zero >card/greedy 2>/dev/null
    sync
    df -k card
    says 0 '^turned 7: ' '^missed 7 ' '^missed 8 ' -- store_writer --seed 7 --first 8 --count 2 --reserve 65536 card/store
}
judge full.becomes_a_miss full
judge full.nothing_torn whole
again() {
    rm card/greedy
    says 0 '^done ' -- store_writer --seed 7 --first 12 --count 4 --reserve 65536 card/store && whole
}
judge full.works_again again

# --- a disk that turns read-only

# The kernel's emergency remount asks no open file: as after an error of the disk.
turned() {
    store_writer --seed 7 --first 20 --count 400 --reserve 65536 card/store >writer.log 2>&1 &
    writer=$!
    await 60 grep -q '^done 2' writer.log
    echo u >/proc/sysrq-trigger
    wait $writer
    code=$?
    tail -n 3 writer.log
    [ $code = 74 ] && tail -n 1 writer.log | grep '^failed 74 .*read-only'
}
judge readonly.in_the_middle turned
# What was being written stands in incoming/ and is found, if the disk turned there.
reads() {
    says 0 '^row 1 ' '^row 20 ' '^verified' -- store_state --read card/store &&
        ! grep '^finding' said | grep -v ' left incoming/.*an interruption left it'
}
grep '^done' writer.log | tail -n 1 | cut -d' ' -f2-3 >newest
newest() { reads && read -r sequence sums <newest && grep "^row $sequence done here kept $sums" said; }
judge readonly.reads newest
umount card
mount -o ro /dev/vde card
refused() {
    says 74 '^failed 74 .*[Rr]ead-only' -- store_writer --seed 7 --first 500 card/store && newest
}
judge readonly.from_the_start refused
umount card
mount /dev/vde card
rw_again() {
    says 0 '^done ' -- store_writer --seed 7 --first 500 --count 4 --reserve 65536 card/store && whole
}
judge readonly.works_again rw_again
umount card

# --- vfat, which has no journal: no power is cut here

judge fat.mounts eval 'mkdosfs /dev/vdf && mount -t vfat /dev/vdf card && mkdir card/store'
judge fat.writes says 0 '^done 20 ' -- store_writer --seed 9 --count 20 --reserve 65536 card/store
fat_full() {
    cat /dev/zero >card/greedy 2>/dev/null
    says 0 '^missed 21 ' -- store_writer --seed 9 --first 21 --reserve 65536 card/store && rm card/greedy
}
judge fat.full_is_a_miss fat_full
umount card
judge fat.survives_a_remount eval 'mount -t vfat /dev/vdf card && whole'
umount card
