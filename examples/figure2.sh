#!/bin/sh
# figure2.sh FOLDER: makes the paper's figure 2 as FOLDER/figure2.pdf, and golden-tests its run.
# LRBSCOPE: the program, if it is not in PATH.
set -eu
folder=${1:?usage: figure2.sh FOLDER}
lrbscope=${LRBSCOPE:-lrbscope}
mkdir -p "$folder"

# figure2 is a shipped scenario (`lrbscope list`). The caption is written to figure2.caption.txt.
"$lrbscope" figure figure2 --width 160mm --title -o "$folder/figure2.pdf"

# First time: approve the run. Commit the golden, which has its events, counters and pictures.
[ -e "$folder/goldens/figure2" ] || "$lrbscope" golden approve --goldens "$folder/goldens" figure2

# Every time: run the scenario again and compare. Exit code 1: it differs, and golden/index.html shows the differences.
"$lrbscope" golden test --goldens "$folder/goldens" -o "$folder/golden"
