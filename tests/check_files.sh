#!/bin/sh
# check_files.sh DIR... - source files are of a size that can be read, and say their licence.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# For each .c and .h: at most 600 lines, no tab, no line over 100 columns, an SPDX line.
# `check_files.sh --self-test` plants each violation and fails unless it is found.
lines_max=600
columns_max=100

check() {
    find "$@" -name '*.[ch]' | sort | while read -r file; do
        lines=$(wc -l < "$file")
        [ "$lines" -le $lines_max ] || echo "$file: $lines lines, more than $lines_max"
        # Columns are characters: the bytes of UTF-8 that continue one do not count.
        LC_ALL=C awk -v max=$columns_max -v file="$file" '
            /\t/ { printf "%s:%d: a tab\n", file, NR }
            { gsub(/[\200-\277]/, "") }
            length > max { printf "%s:%d: %d columns, more than %d\n", file, NR, length, max }' "$file"
        grep -q 'SPDX-License-Identifier: GPL-3\.0-or-later' "$file" ||
            echo "$file: no line 'SPDX-License-Identifier: GPL-3.0-or-later'"
    done
}

plant() {
    rm -f "$box"/*
    { echo '/* x.c - SPDX-License-Identifier: GPL-3.0-or-later */'; cat; } > "$box/x.c"
    found=$(check "$box")
    if [ "$1" = clean ]; then
        [ -z "$found" ] || { echo "a clean file is blamed: $found"; exit 1; }
    else
        case "$found" in *"$1"*) ;; *) echo "not noticed: $1 (said: $found)"; exit 1 ;; esac
    fi
}

if [ "$1" = --self-test ]; then
    box=$(mktemp -d)
    trap 'rm -rf "$box"' EXIT
    echo 'int x;' | plant clean
    yes 'int x;' | head -n 599 | plant clean
    yes 'int x;' | head -n 600 | plant '601 lines'
    printf 'int\tx;\n' | plant 'x.c:2: a tab'
    printf '%100s\n' x | plant clean
    printf '%101s\n' x | plant 'x.c:2: 101 columns'
    printf '%99s\303\251\n' x | plant clean
    echo 'int x;' > "$box/y.c"
    case "$(check "$box")" in *"y.c: no line"*) ;; *) echo "not noticed: no SPDX line"; exit 1 ;; esac
    echo "check_files.sh finds all planted violations"
    exit 0
fi

found=$(check "$@")
[ -z "$found" ] && exit 0
echo "$found"
exit 1
