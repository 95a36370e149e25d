#!/bin/sh
# The rules of the house that no compiler sees. One line a rule: "ok" or "FAILED" with the places.
#
#   sh tests/lint/house.sh
set -u
cd "$(dirname "$0")/../.." || exit 70
LC_ALL=C
export LC_ALL
failed=0

# What belongs to the checkout: files that git knows, or will know. An unpacked archive has no git: then all of them.
if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    files=$(git ls-files --cached --others --exclude-standard)
else
    files=$(find . -path ./.build -prune -o -path ./.cache -prune -o -type f -print | sed 's,^\./,,')
fi

listed() { # files whose name matches, and which are still there
    echo "$files" | grep -E "$1" | while read -r file; do [ ! -f "$file" ] || echo "$file"; done
}

judge() { # rule, places that break it
    if [ -z "$2" ]; then
        echo "ok      $1"
    else
        echo "FAILED  $1"
        echo "$2" | sed 's/^/          /'
        failed=1
    fi
}

# Where a pattern stands in files whose names match $2 and do not match $3.
places() {
    listed "$2" | grep -vE "$3" | while read -r file; do grep -nHE -e "$1" "$file"; done
}

# An include of <header> outside of its room; tests may look at files with the eyes of others.
door() { # pattern of the header, room
    judge "$1 is included in $2 alone" "$(places "^ *# *include *[<\"]$1" '\.(h|cpp)$' "^($2|tests)/")"
}

code='\.(h|cpp)$'
text='(\.(h|cpp|c|sh|md|cmake|txt|json|yaml|yml)$|^\.ci/)'

judge "the top level holds the rooms and nothing else" "$(echo "$files" | cut -d/ -f1 | sort -u |
    grep -vE '^(\..*|CMakeLists\.txt|CMakePresets\.json|LICENSE|README\.md|platform|drivers|algo|storage|tests|toolchain)$')"

judge "every room has a README" "$(
    for room in . platform drivers algo algo/*/ storage tests tests/fuzz toolchain; do
        [ "$(find "$room" -maxdepth 3 -name '*.cpp' | head -n 1)" ] || [ "$room" = drivers ] || [ "$room" = toolchain ] || continue
        [ -s "$room/README.md" ] || echo "${room%/}/README.md"
    done
)"

judge "links between the READMEs lead somewhere" "$(
    listed '\.md$' | while read -r file; do
        grep -oE '\]\([^)#]+' "$file" | cut -c3- | grep -vE '^[a-z]+:' | while read -r link; do
            [ -e "$(dirname "$file")/$link" ] || echo "$file: $link"
        done
    done
)"

judge "no file is longer than 500 lines" "$(
    listed "$text" | while read -r file; do
        [ "$(wc -l <"$file")" -le 500 ] || echo "$file: $(wc -l <"$file") lines"
    done
)"

judge "no path of one machine" "$(places '(^|[^A-Za-z0-9_.$}*-])/(home|root|work|Users|tmp)/[A-Za-z0-9]' "$text" '^tests/lint/')"

judge "headers are included once" "$(listed '\.h$' | while read -r file; do
    grep -q '^#pragma once' "$file" || echo "$file"
done)"

door 'Eigen/' algo/calibration
door 'draco/' storage/codec
door 'yaml\.h' storage/rig
door 'sqlite3\.h' storage/catalogue
door 'sha2\.h' platform/os
door 'png\.h' platform/picture
door 'zlib\.h' platform/app/diag/archive
door 'j(peglib|error)\.h' platform/picture
door 'CLI/' platform/app
door 'nlohmann/' '(platform/app|storage/record)'
door 'toml\+\+/' platform/app/config
door 'httplib\.h' platform/app/view
door 'linux/videodev2\.h' drivers/camera/v4l2
door 'libusb' '(drivers/camera/uvc|drivers/usb)'
door 'opencv2/' tests

judge "no exception of our own: throw stands at the heap gate alone" \
    "$(places '^[^/]*\bthrow\b' '^(platform|algo|storage|drivers)/.*\.(h|cpp)$' '^platform/os/gate/')"

judge "vector files include the kernels' contract and the intrinsics alone" \
    "$(places '^ *# *include' '^algo/kernels/(avx2|neon)/.*\.cpp$' '^$' | grep -vE '"dicot/kernels/[a-z_]+\.h"|<(immintrin|arm_neon)\.h>')"

judge "every source ends with a line end and has no tabs or blanks at line ends" "$(
    places "$(printf '\t')|[ $(printf '\t')]+\$" "$code|\\.sh$" '^$'
    listed "$text" | while read -r file; do
        [ -z "$(tail -c 1 "$file")" ] || echo "$file: the last line has no end"
    done
)"
exit $failed
