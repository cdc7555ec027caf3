#!/bin/sh
# check_prefix.sh BUILD_DIR SOURCE_DIR - every function that leaves an object file begins with the
# name of its source file.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Meson calls the object of src/room/file.c `src_room_file.c.o`.  Objects of files that are gone
# are passed over.  `check_prefix.sh --self-test COMPILER` plants a violation and fails unless it is
# found; COMPILER may be several words, as where ccache stands before it.
check() {
    find "$2" -name '*.c' | sort | while read -r source; do
        path=${source#"$2"/}
        stem=$(basename "$path" .c)
        flat=src_$(echo "$path" | tr / _).o
        for object in $(find "$1" -path '*.p/*' -name "$flat"); do
            nm -g --defined-only "$object" | awk '$2 == "T" || $2 == "i" {print $3}' |
            while read -r symbol; do
                symbol=${symbol%%.*}            # clones for other processors: name.avx2
                case "$symbol" in
                "$stem"|"$stem"_*|main) ;;
                *) echo "$path exports '$symbol', which does not begin with '${stem}_'" ;;
                esac
            done
        done
    done
}

compile() {
    $compiler -c -o "$box/build/lib.a.p/src_room_$1.c.o" "$box/src/room/$1.c" || exit 1
}

if [ "$1" = --self-test ]; then
    shift
    compiler=$*
    box=$(mktemp -d)
    trap 'rm -rf "$box"' EXIT
    mkdir -p "$box/build/lib.a.p" "$box/src/room"
    echo 'static int hidden(void) { return 1; } int map_make(void) { return hidden(); }' \
        > "$box/src/room/map.c"
    compile map
    found=$(check "$box/build" "$box/src")
    [ -z "$found" ] || { echo "a clean file is blamed: $found"; exit 1; }
    echo 'int map_make(void) { return 1; } int make_map(void) { return 2; }' > "$box/src/room/map.c"
    compile map
    found=$(check "$box/build" "$box/src")
    case "$found" in
    *"room/map.c exports 'make_map'"*) echo "check_prefix.sh finds the planted violation" ;;
    *) echo "not noticed: make_map in map.c (said: $found)"; exit 1 ;;
    esac
    exit 0
fi

# Without objects nothing has been checked.
[ -n "$(find "$1" -name 'src_*.c.o' | head -n 1)" ] || { echo "$1 holds no objects"; exit 1; }
found=$(check "$1" "$2")
[ -z "$found" ] && exit 0
echo "$found"
exit 1
