#!/usr/bin/env bash
# docs/figures.sh [LRBSCOPE]: makes the pictures of README and docs that show bodies: figure2.png, collision.png, crowd.png,
# figure.png, distance.png, first_contact.png and clash.png. (chart.png and xray.png are measurements: docs/measurements.md, docs/profiling.md.)
set -euo pipefail
docs=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=${1:-$docs/../build/release/scenarios/lrbscope}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
run() { "$program" -q "$@" >/dev/null; }
run figure figure2 --width 160mm --title --no-legend --font-size 10 --line-width 0.6pt --dpi 200 -o "$work/figure2.png"
run run collision --size 1000x562 -o "$work/collision"
run crowd -o "$work/crowd"
run figure figure2_mesh --width 85mm --dpi 300 -o "$work/figure.png"
frames=("$work"/collision/frames/*.png)
cp "${frames[-1]}" "$docs/collision.png"
frames=("$work"/crowd/frames/*.png)
cp "${frames[$((${#frames[@]} / 2))]}" "$docs/crowd.png"
cp "$work/figure2.png" "$work/figure.png" "$docs/"
