#!/usr/bin/env bash
# docs/modules.sh >docs/modules.svg: draws the allowed dependencies of modules (tests/layers/modules.txt) by Graphviz (Debian's graphviz).
# Each module is above all modules that it may include; arrows implied by others are omitted. Colours mark the top folders.
# docs/modules.sh --sum: prints a checksum of the dependencies. The picture ends with it, and the test `docs` compares them.
set -euo pipefail
modules=$(dirname "${BASH_SOURCE[0]}")/../tests/layers/modules.txt
graph=$(sed -nE '/^[^# ]+: +[0-9]/s/^([^:]+): +[0-9]+ */\1 /p' "$modules" | awk '
  BEGIN {
    print "digraph modules {\nnode [shape=box, style=\"rounded,filled\", fontname=\"DejaVu Sans\", fontsize=13, height=0.35]; edge [color=\"#55606c\", arrowsize=0.6];"
    split("engine #dbe9f6 trace #e3f1dc render #fbe8d0 scenarios #f1e3f3 bench #f8dcdc tools #f5f0c4", part, " ")
    for (i = 1; i in part; i += 2) colour[part[i]] = part[i + 1]
  }
  {
    label = $1; sub(/^(engine|render|scenarios|bench)\//, "", label)
    top = $1; sub(/\/.*/, "", top)
    printf "\"%s\" [label=\"%s\", fillcolor=\"%s\"];\n", $1, label, top in colour ? colour[top] : "#d9eeee"
    for (i = 2; i <= NF; i++) printf "\"%s\" -> \"%s\";\n", $1, $i
  }
  END { print "}" }')
sum=$(cksum <<<"$graph")
[ "${1:-}" != --sum ] || { echo "$sum" && exit; }
tred <<<"$graph" | dot -Tsvg
echo "<!-- $sum -->"
