#!/usr/bin/env bash
# examples.sh NAME TREE BINARIES LRBSCOPE PYTHON PACKAGE: runs the example NAME of TREE/examples and checks its output and files.
# BINARIES: the folder of the compiled examples. PYTHON, PACKAGE: for contact.py; exit code 77 (skipped) without the Python module.
set -euo pipefail
name=$1 tree=$2 binaries=$3 lrbscope=$4 python=$5 package=$6
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
gear=$tree/tests/data/gear.obj
block=$tree/tests/data/l_block.obj
fail() { echo "$name: $1" && { cat said 2>/dev/null || true; } && exit 1; }

# try ARGUMENT...: runs the example and expects success.
command=("$binaries/$name")
try() { "${command[@]}" "$@" >said 2>&1 || fail "exit code $?: $*"; }
# expect PATTERN...: extended regular expressions, each of which must match a line of the output.
expect() {
  local pattern
  for pattern in "$@"; do grep -qE -- "$pattern" said || fail "no line matches $pattern"; done
}
# refuse REASON ARGUMENT...: runs the example and expects exit code 1 and one line on stderr that contains REASON.
refuse() {
  local reason=$1 code=0
  shift
  "${command[@]}" "$@" >/dev/null 2>said || code=$?
  [ "$code" = 1 ] || fail "exit code $code, expected 1: $*"
  [ "$(wc -l <said)" = 1 ] || fail "expected one line: $*"
  grep -qF -- "$reason" said || fail "expected \"$reason\": $*"
}
# png FILE, pdf FILE: checks the first bytes.
png() { head -c 8 "$1" | grep -qaF PNG || fail "$1 is not a PNG"; }
pdf() { head -c 5 "$1" | grep -qaF %PDF- || fail "$1 is not a PDF"; }

source=$(echo "$tree/examples/$name".*)
limit=40
[ "$name" != resting ] || limit=150
[ "$(wc -l <"$source")" -le "$limit" ] || fail "expected at most $limit lines, found $(wc -l <"$source")"
case "$name" in
  collide)
    try "$gear" "$block" 0.7 0.1 -0.1
    expect '^crossing, 43 pairs' '^face 266 of A, face 3 of B$'
    try "$gear" "$block" 3 0 0
    expect '^separate, 0 pairs'
    refuse "missing.obj: no such file" "$gear" missing.obj 0 0 0
    refuse "finite numbers" "$gear" "$block" nan 0 0
    refuse "usage: " "$gear"
    ;;
  many_poses)
    try "$gear" "$block" 0.98
    expect '^800 of 1000 poses collide, 1000 results are equal$'
    refuse "missing.obj: no such file" missing.obj "$block" 0.98
    ;;
  build_and_validate)
    "$lrbscope" -q export tolerance --what body --of a -o rock.ply >/dev/null
    try rock.ply rock.lrb
    expect '^5120 real faces, .* 20 faces in the outermost wrapper$' '^proven: ' '^crossing: 92 pairs .* 275 exact pairs$'
    "$lrbscope" -q inspect rock.lrb >said || fail "lrbscope cannot read rock.lrb"
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >open.obj
    refuse "open.obj: an edge has only one face" open.obj open.lrb
    refuse "no/rock.lrb: cannot create the file" rock.ply no/rock.lrb
    ;;
  clearance)
    try "$gear" "$block" 3 0.1 0.05
    expect '^start: distance 2.01026, error <= .*e-1[0-9], from \(0.989745, 0.142845, 0.125\) to \(3, ' \
      '^motion: contact at t = 0.670085, error <= ' '^end: protrudes, depth 0.125, .* moved by \(0, 0, 0.125\)$'
    refuse "missing.obj: no such file" "$gear" missing.obj 3 0 0
    ;;
  inside)
    try "$gear" 20
    expect '^pairs of faces that intersect: 0; curves: 0$' '^inside: [1-9][0-9]* of 8000; smallest distance -0\.1'
    printf 'v %s\n' '0 0 0' '2 0 0' '0 2 0' '0.5 0.25 -1' '0.5 0.25 1' '0.5 -1 0' >crossing.obj
    printf 'f 1 2 3\nf 4 5 6\n' >>crossing.obj
    try crossing.obj 3
    expect '^pairs of faces that intersect: 1; curves: 1, of length 0\.25$' '^inside: 0 of 27; smallest distance [0-9]'
    refuse "missing.obj: no such file" missing.obj 3
    refuse "usage: " "$gear" 0
    ;;
  watch)
    try "$gear" "$block" 0.7 0.1 -0.1
    expect '^refine region 51 of A: 28 faces more$' '^test triangle 266 of A \(depth 8\) and 3 of B \(depth 0\): cross$' \
      '^crossing after 3 tests$'
    refuse "missing.obj: no such file" "$gear" missing.obj 0 0 0
    ;;
  resting)
    # at_most VALUE BOUND WHAT
    at_most() { awk -v x="$1" -v most="$2" 'BEGIN { exit !(x <= most && -x <= most) }' || fail "$3 $1, expected at most $2"; }
    number() { sed -nE "s/^$1 (-?[0-9.e+-]+).*/\1/p" said; }
    for scene in box ring; do
      try "$scene" 2000
      at_most "$(number 'depth at most')" 0.01 "$scene: depth"
      at_most "$(number drift)" 1e-6 "$scene: drift"
    done
    try gears 2000 .
    at_most "$(number 'depth at most')" 0.01 "gears: depth"
    at_most "$(awk -v x="$(number 'B turns at')" 'BEGIN { print x + 12 / 18 }')" 0.02 "gears: error of the ratio"
    [ "$(wc -l <poses.txt)" = 250 ] || fail "expected 250 poses"
    "$lrbscope" -q manifold a.obj b.obj --poses poses.txt --margin 0.02 | tail -n 1 | grep -q '"manifolds":\[{' || fail "gears: no manifold"
    refuse "usage: " ball 10
    refuse "no/a.obj" box 10 no
    ;;
  record_and_draw)
    try "$gear" "$block" 0.7 0.1 -0.1 found
    expect '^140 events$'
    png found.png
    head -c 100 found.json | grep -qF traceEvents || fail "found.json is not a trace"
    try "$gear" "$block" 3 0 0 separate
    png separate.png
    refuse "no/out.json: cannot create the file" "$gear" "$block" 0.7 0.1 -0.1 no/out
    ;;
  contact)
    if [ -z "$python" ] || [ ! -d "$package/lrbscope" ]; then echo "skipped: the Python module was not built" && exit 77; fi
    export PYTHONPATH=$package PYTHONDONTWRITEBYTECODE=1
    command=("$python" "$tree/examples/contact.py")
    try contact.png
    expect '^crossing 124 pairs' '^1 curves, length 1.856, ' '^depth 0.146 to 0.148 '
    png contact.png
    refuse "usage: "
    refuse "no/contact.png" no/contact.png
    ;;
  figure2)
    export LRBSCOPE=$lrbscope
    command=("$tree/examples/figure2.sh")
    try out
    expect '^ok +figure2: 70 events equal; images: 3 equal$'
    pdf out/figure2.pdf
    [ -s out/figure2.caption.txt ] || fail "out/figure2.caption.txt is missing or empty"
    try out
    if grep -q approved said; then fail "the second run approved again"; fi
    rm out/goldens/figure2/frame_1.png
    if "${command[@]}" out >said 2>&1; then fail "a golden without its picture passed"; fi
    ;;
  *) fail "no such example" ;;
esac
echo "$name: as expected"
