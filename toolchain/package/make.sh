#!/bin/sh
# Makes the package. Its times are those of the changelog's newest entry: the same program gives the same package.
#
#   make.sh CPACK CONFIGURATION
set -eu
here=$(cd "$(dirname "$0")" && pwd)
SOURCE_DATE_EPOCH=$(date -d "$(sed -n 's/^ -- .*>  //p' "$here/changelog" | head -n 1)" +%s)
export SOURCE_DATE_EPOCH
umask 022
exec "$1" --config "$2"
