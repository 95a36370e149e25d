#!/bin/sh
# Every test of dicot, from a bare Debian 12 on: installs what is missing, builds in each way that matters, runs, counts.
#
#   sh toolchain/test.sh             everything: three quarters of an hour on two processors
#   sh toolchain/test.sh --quick     the release build's tests and the rules of the house
#   sh toolchain/test.sh STAGE ...   some of: release house accuracy lint clang asan tsan fuzz cross vm
#
# The last line says "N passed, N failed"; the exit code is 0 only if none failed. A stage that does not build, or that
# runs no test at all, counts as a failure. Logs: .build/test-logs.
set -u

cd "$(dirname "$0")/.." || exit 70
. toolchain/packages.sh
logs=.build/test-logs
passed=0
failed=0
summary=
not_run=

all_stages="release house accuracy lint clang asan tsan fuzz cross vm"
case ${1:-} in
    '') stages=$all_stages ;;
    --quick) stages="release house" ;;
    *) stages=$* ;;
esac
for name in $stages; do
    case " $all_stages " in
        *" $name "*) ;;
        *)
            echo "test.sh: '$name' is no stage: choose among $all_stages, or --quick" >&2
            exit 64
            ;;
    esac
done

# Runs a stage: its function sets stage_passed, stage_failed and stage_skipped.
stage() { # name, function, its words
    stage_name=$1
    stage_passed=0 stage_failed=0 stage_skipped=0
    stage_log=$logs/$stage_name.log
    : >"$stage_log"
    shift
    stage_start=$(date +%s)
    echo "[$stage_name]"
    if ! "$@"; then
        echo "    FAILED: $stage_name did not get to its end; $stage_log says:"
        tail -n 25 "$stage_log" | sed 's/^/    /'
        stage_failed=$((stage_failed + 1))
    elif [ $((stage_passed + stage_failed)) = 0 ]; then
        echo "    FAILED: $stage_name ran no test"
        stage_failed=1
    fi
    passed=$((passed + stage_passed))
    failed=$((failed + stage_failed))
    line=$(printf '%-9s %5d passed, %2d failed, %2d skipped, %4d s' "$stage_name" $stage_passed $stage_failed \
        $stage_skipped $(($(date +%s) - stage_start)))
    echo "    $line"
    summary="$summary$line
"
}

# cmake --preset and its build; more words are targets.
build() { # preset, targets
    preset=$1
    shift
    cmake --preset "$preset" >>"$stage_log" 2>&1 || return
    [ $# = 0 ] || set -- --target "$@"
    cmake --build --preset "$preset" "$@" >>"$stage_log" 2>&1
}

# Runs CTest and adds up what it says; what a passing test reports as not run is kept for the end.
count_ctest() { # build folder, words for ctest
    folder=$1
    shift
    ctest_log=$logs/ctest.log
    ctest --test-dir "$folder" --no-tests=error --output-on-failure --timeout 900 "$@" >"$ctest_log" 2>&1
    cat "$ctest_log" >>"$stage_log"
    last=$(grep -E '^[0-9]+% tests passed, [0-9]+ tests? failed out of [0-9]+' "$ctest_log" | tail -n 1)
    [ -n "$last" ] || return 1
    all=$(echo "$last" | sed 's/.* out of \([0-9]*\).*/\1/')
    bad=$(echo "$last" | sed 's/.*passed, \([0-9]*\) test.*/\1/')
    skipped=$(grep -cE '\*\*\*Skipped' "$ctest_log")
    stage_passed=$((stage_passed + all - bad - skipped))
    stage_failed=$((stage_failed + bad))
    stage_skipped=$((stage_skipped + skipped))
    [ "$bad" = 0 ] || sed -n '/The following tests FAILED/,$p' "$ctest_log" | sed 's/^/    /'
    missed=$(
        grep -ha '^NOT RUN' "$folder/Testing/Temporary/LastTest.log" | sort -u
        sed -n 's/^.*Test *#[0-9]*: \([^ ]*\) .*\*\*\*Skipped.*/NOT RUN: \1 says that it was skipped/p' "$ctest_log"
    )
    [ -z "$missed" ] || not_run="$not_run$(echo "$missed" | sed "s/^/$stage_name: /")
"
    return 0
}

# Adds up lines that begin with "ok" or "FAILED", which the scripts of tests/lint and the cross test print.
count_lines() { # command
    lines=$logs/lines.log
    "$@" >"$lines" 2>&1
    code=$?
    cat "$lines" >>"$stage_log"
    good=$(grep -c '^ok ' "$lines")
    bad=$(grep -c '^FAILED ' "$lines")
    stage_passed=$((stage_passed + good))
    stage_failed=$((stage_failed + bad))
    [ "$bad" = 0 ] || grep -A 20 '^FAILED ' "$lines" | grep -v '^ok ' | head -n 60 | sed 's/^/    /'
    [ $code = 0 ] || [ "$bad" != 0 ]
}

release() {
    build release || return
    # What CMake leaves out is no test that could say so.
    without=$(sed -n 's/^-- Viewer: off: /release: NOT RUN: dicot view: /p' "$stage_log")
    [ -z "$without" ] || not_run="$not_run$without
"
    count_ctest .build/release -j "$(nproc)" -LE accuracy || return
}

# Alone, and with all that its tests print on the screen: what is left out are the words of CTest and GoogleTest.
accuracy() {
    build release || return
    count_ctest .build/release -L accuracy -V || return
    sed -nE 's/^[0-9]+: //p' "$ctest_log" |
        grep -avE '^(\[|Test command:|Working Directory:|Test timeout|Running main|Note: Google Test filter|NOT RUN|$)' |
        sed 's/^/    /'
    return 0
}

house() {
    count_lines sh tests/lint/house.sh || return
}

lint() {
    count_lines shellcheck_all || return
    count_lines sh tests/lint/format.sh || return
    cmake --preset clang >>"$stage_log" 2>&1 || return
    count_lines sh tests/lint/tidy.sh .build/clang || return
}

shellcheck_all() {
    # postinst, prerm, postrm: a package's scripts have no ending.
    if find toolchain tests \( -name '*.sh' -o -path toolchain/package/p\* \) -exec shellcheck -s sh -S warning -x -e SC1091 '{}' + &&
        shellcheck .ci/run; then
        echo "ok      shellcheck"
    else
        echo "FAILED  shellcheck"
    fi
}

# What must come out to the bit whoever compiles it, as clang optimises it; the stage asan has clang compile everything.
clang() {
    build clang exact_tests || return
    count_ctest .build/clang -j "$(nproc)" -L exact || return
}

# clang's sanitizers, and the tree whose fuzz targets the stage fuzz runs: one instrumented build for both.
asan() {
    build fuzz || return
    # Those that repeat for long what others do once.
    long='SpreadOfManyCalibrations|SpreadsAsItsCovarianceSays|KeptPairsGiveBeforeRealCameras|ThousandsTakeNoTime'
    long="$long|CalibrateLive.(CalibratesWithThePairsOfItsTime|GivesWhatItsKeptPairsGive)"
    long="$long|WritesTheSameBytesWithAnyNumberOfThreads"
    count_ctest .build/fuzz -j "$(nproc)" -LE fuzz -E "$long" || return
}

tsan() {
    build tsan threads_tests || return
    count_ctest .build/tsan -j "$(nproc)" -L threads || return
}

fuzz() {
    build fuzz fuzz_tests || return
    count_ctest .build/fuzz -j "$(nproc)" -L fuzz || return
}

cross() {
    build release dicot || return
    pair=../shared/data/plants/aloe-third
    if [ -f "$pair/left.png" ] && [ -f "$pair/right.png" ]; then
        set -- "$pair/left.png" "$pair/right.png"
    else
        set -- '' ''
        not_run="${not_run}cross: NOT RUN: the real pair: $pair is not there
"
    fi
    boards=../shared/data/calibration-opencv
    if [ -f "$boards/left01.jpg" ]; then
        set -- "$@" "$boards"
    else
        not_run="${not_run}cross: NOT RUN: calibration: $boards is not there
"
    fi
    count_lines sh tests/system/cross_test.sh .build/release/platform/app/dicot "$@" || return
}

# The cameras of tests/support before the kernel's own driver, then dicot's drivers, then a snapshot; the store on disks that lose
# their power; the board on a computer's cable; the package in a whole Debian. A machine that does not boot is a failure.
vm() {
    # Each machine keeps one processor busy; the longest first.
    printf '%s\n' months snap cable uvc mtp v4l2 store selfcheck | xargs -P "$(nproc)" -I '{}' \
        sh -c "sh tests/vm/{}.sh >$logs/vm-{}.log 2>&1; echo \$? >$logs/vm-{}.code"
    for machine in selfcheck v4l2 uvc snap store mtp cable months; do
        count_lines finished "$machine" || return
        missed=$(grep '^NOT RUN' "$logs/vm-$machine.log")
        [ -z "$missed" ] || not_run="${not_run}vm: $missed
"
    done
}

finished() { # machine
    cat "$logs/vm-$1.log"
    return "$(cat "$logs/vm-$1.code")"
}

purposes="build quickstart test"
for name in $stages; do
    case $name in
        release) purposes="$purposes viewer browser" ;;
        lint) purposes="$purposes clang lint" ;;
        asan | clang | fuzz) purposes="$purposes clang" ;;
        cross | vm) purposes="$purposes $name" ;;
    esac
done
mkdir -p "$logs"
# shellcheck disable=SC2086 # a list of words
dicot_install $purposes || exit
for name in $stages; do
    stage "$name" "$name"
done

echo
[ -z "$not_run" ] || printf '%s\n' "$not_run"
printf '%s' "$summary"
echo "$passed passed, $failed failed"
[ $failed = 0 ]
