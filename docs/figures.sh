#!/usr/bin/env bash
# docs/figures.sh [LRBSCOPE]: makes the pictures of bodies in README and docs: figure2.png, construction.png,
# collision.png, proof_map.png, accelerator.png, figure.png, inset.png, distance.png, near.png, points.png, manifold.png,
# first_contact.png and clash.png.
# docs/figures.sh chart [LRBSCOPE [OPTION...]]: measures and makes only chart.png, with these options of lrbscope chart.
set -euo pipefail
docs=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
chart=
if [ "${1:-}" = chart ]; then chart=1 && shift; fi
program=${1:-$docs/../build/release/bin/lrbscope}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ -n "$chart" ]; then
  "$program" chart --no-scenes "${@:2}" -o "$work/chart" >/dev/null
  cp "$work/chart/chart.png" "$docs/"
  exit
fi
run() { "$program" -q "$@" >/dev/null; }
run figure figure2 --width 160mm --title --no-legend --font-size 10 --line-width 0.6pt --dpi 200 -o "$work/figure2.png"
run run collision --size 1000x562 -o "$work/collision"
run figure construction --panels 6 --title --width 160mm --dpi 140 -o "$work/construction.png"
run figure figure2_mesh --width 85mm --dpi 300 -o "$work/figure.png"
run figure collision --proof-map --width 85mm --dpi 220 -o "$work/proof_map.png"
run run collision --recursion paper_boxes --frames none -o "$work/boxes"
run figure "$work/boxes" --steps 0,12,16 --wrappers --columns 3 --width 160mm --dpi 140 -o "$work/accelerator.png"
run figure figure2_mesh --panels 3 --inset b:region:40 --inset c:face:2197:6 --dpi 300 -o "$work/inset.png"
answer() { # NAME COMMAND POSES-OPTION NUMBERS SIZE OPTION...: a picture of one answer, for the bodies of `collision`
  echo "$4" >"$work/poses.txt"
  run "$2" "$work/collision/a.lrb" "$work/collision/b.lrb" "$3" "$work/poses.txt" --draw "$docs/$1.png" --size "$5" "${@:6}"
}
answer distance distance --poses "0.8 0 0.6 3.1  0 1 0 0.9  -0.6 0 0.8 0.5" 640x400
answer near near --poses "0.8 0 0.6 2.2  0 1 0 0.6  -0.6 0 0.8 0.25" 640x400 --within 0.25
awk 'BEGIN { for (i = -4; i <= 4; i++) for (j = -4; j <= 4; j++) print 0.4 * i, 0.4 * j, 0 }' >"$work/points.txt"
run points "$work/collision/b.lrb" "$work/points.txt" --draw "$docs/points.png" --size 640x400
answer clash clash --poses "0.8 0 0.6 1.5  0 1 0 0.2  -0.6 0 0.8 0.3" 760x475
answer first_contact sweep --motions "1 0 0 7  0 1 0 0.6  0 0 1 0.5   0 0 1 -3  0 1 0 -0.3  -1 0 0 0.1" 760x475
mkdir "$work/rest"
"${program%/bin/*}/examples/resting" ring 1000 "$work/rest" >/dev/null
tail -n 1 "$work/rest/poses.txt" >"$work/poses.txt"
mv "$work/rest/a.obj" "$work/rest/peg.obj" && mv "$work/rest/b.obj" "$work/rest/ring.obj"
run manifold "$work/rest/peg.obj" "$work/rest/ring.obj" --poses "$work/poses.txt" --margin 0.02 --draw "$docs/manifold.png" --size 760x475
frames=("$work"/collision/frames/*.png)
cp "${frames[-1]}" "$docs/collision.png"
cp "$work/figure2.png" "$work/construction.png" "$work/figure.png" "$work/inset.png" "$work/proof_map.png" "$work/accelerator.png" \
  "$docs/"
