#!/bin/sh
# check_arrows.sh SOURCE_DIR - rooms include only themselves and the rooms below them, and nothing
# outside a model's folder names a model (but the list in model/model.c).
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# SOURCE_DIR is the folder with base/, scene/, ...  `check_arrows.sh --self-test` plants each kind of
# violation in a folder of its own and fails unless it is found.
rooms="base scene model measure draw run bench figure live cli"

height() {
    level=0
    for room in $rooms; do
        [ "$room" = "$1" ] && { echo "$level"; return; }
        level=$((level + 1))
    done
    echo none
}

check() {
    source_dir=$1
    find "$source_dir" -name '*.[ch]' | sort | while read -r file; do
        path=${file#"$source_dir"/}
        from=$(height "${path%%/*}")
        [ "$from" = none ] && { echo "$path: '${path%%/*}' is none of the rooms ($rooms)"; continue; }
        folder=${path%/*}
        sed -n 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*"\([^"]*\)".*/\1/p' "$file" |
        while read -r included; do
            to=$(height "${included%%/*}")
            case "$included" in
            */*) ;;
            *) echo "$path includes \"$included\": write it from src/, as \"room/file.h\""; continue ;;
            esac
            if [ "$to" = none ]; then
                echo "$path includes \"$included\": there is no such room"
            elif [ "$to" -gt "$from" ]; then
                echo "$path includes \"$included\": an arrow that points up"
            fi
            case "$included" in
            model/*/*)
                owner=${included#model/}
                owner=model/${owner%%/*}
                case "$folder/" in
                "$owner"/*) ;;
                *) echo "$path includes \"$included\": only $owner/ may look into that model" ;;
                esac ;;
            esac
        done
        # `model_NAME` is a model's constant where NAME is a folder of model/.
        for model in "$source_dir"/model/*/; do
            [ -d "$model" ] || continue
            name=$(basename "$model")
            case "$folder/" in "model/$name"/*) continue ;; esac
            [ "$path" = model/model.c ] && continue
            if grep -qE "(^|[^A-Za-z0-9_])model_$name([^A-Za-z0-9_]|\$)" "$file"; then
                echo "$path names the model '$name' (model_$name)"
            fi
            if grep -qE "(model_find|strcmp)\(.*\"$name\"" "$file"; then
                echo "$path asks whether a model is called \"$name\""
            fi
        done
    done
}

plant() {
    rm -rf "$box"
    mkdir -p "$box/base" "$box/scene" "$box/model/md" "$box/model/lga" "$box/draw"
    echo '#include "base/b.h"' > "$box/scene/good.c"
    echo '#include "model/md/md.h"' > "$box/model/md/good.c"
    echo 'extern const struct model model_md;' > "$box/model/model.c"
    mkdir -p "$box/$(dirname "$1")"
    echo "$2" > "$box/$1"
}

expect() {
    found=$(check "$box")
    if [ "$1" = clean ] && [ -n "$found" ]; then
        echo "a clean tree is blamed: $found"
        exit 1
    fi
    if [ "$1" != clean ]; then
        case "$found" in *"$1"*) ;; *) echo "not noticed: $1 (said: $found)"; exit 1 ;; esac
    fi
}

if [ "$1" = --self-test ]; then
    box=$(mktemp -d)
    trap 'rm -rf "$box"' EXIT
    plant base/b.h 'int b;';                                 expect clean
    plant base/up.c '#include "scene/scene.h"';              expect 'base/up.c includes "scene/scene.h"'
    plant model/up.c ' # include "draw/ink.h"';              expect 'an arrow that points up'
    plant draw/peek.c '#include "model/md/md.h"';            expect 'only model/md/ may look'
    plant model/lga/peek.c '#include "model/md/md.h"';       expect 'only model/md/ may look'
    plant draw/ask.c 'if (model == &model_lga) return;';     expect "names the model 'lga'"
    plant draw/ask.c 'if (strcmp(m->name, "md") == 0) {}';   expect 'is called "md"'
    plant draw/bare.c '#include "ink.h"';                    expect 'write it from src/'
    plant draw/far.c '#include "utils/u.h"';                 expect 'there is no such room'
    plant odd/o.c 'int o;';                                  expect 'none of the rooms'
    echo "check_arrows.sh finds all planted violations"
    exit 0
fi

found=$(check "$1")
[ -z "$found" ] && exit 0
echo "$found"
exit 1
