#!/bin/sh
# Whether every source is as clang-format 14 lays it out; "sh tests/lint/format.sh --fix" lays it out.
set -u
cd "$(dirname "$0")/../.." || exit 70

sources() { find platform drivers algo storage tests -name '*.h' -print0 -o -name '*.cpp' -print0; }

if [ "${1:-}" = --fix ]; then
    sources | xargs -0 clang-format-14 -i
    exit
fi
faults=$(sources | xargs -0 clang-format-14 --dry-run 2>&1)
code=$?
if [ $code = 0 ] && [ -z "$faults" ]; then
    echo "ok      clang-format"
    exit 0
fi
echo "FAILED  clang-format: run 'sh tests/lint/format.sh --fix'"
echo "$faults" | grep -aE '^[^ ].*(warning|error):' | cut -d: -f1 | sort | uniq -c | sed 's/^/          /'
exit 1
