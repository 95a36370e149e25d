#!/bin/sh
# A template or inline function that a vector file compiles for itself could become the copy that the whole program runs,
# also on processors without those instructions. Such copies are weak symbols: there must be none.
#
#   no_shared_code.sh NM OBJECT...      looks at the objects of avx2/ and neon/ among OBJECT
set -eu
nm=$1
shift
seen=0
for object in "$@"; do
    case $object in
        */avx2/* | */neon/*) ;;
        *) continue ;;
    esac
    seen=$((seen + 1))
    # What sanitized builds carry and is no code: a pointer to the exception handler of the C++ library (DW.ref), and the
    # types of functions that are called through pointers (_ZTI, _ZTS).
    if "$nm" "$object" | grep -E ' [WVuwv] ' | grep -vE ' (DW\.ref\.|_ZT[IS]F)'; then
        echo "$object holds the symbols above, which the linker may take for the whole program" >&2
        exit 1
    fi
    "$nm" "$object" | grep -qE ' ([DR] .*Kernels|T .*_path_step)' || { echo "$object holds no kernels" >&2; exit 1; }
done
[ "$seen" -gt 0 ] || { echo "no object of a vector file was named" >&2; exit 1; }
