#!/usr/bin/env bash
# bodies.sh TREE LRBSCOPE: runs the commands of docs/meshes.md under "Tuning a poor LRB-rep" with bodies that are poor in the ways described
# there, and checks that the program prints the note and the advice that the page quotes.
set -euo pipefail
page=$1/docs/meshes.md
program=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
plates() { # twelve flat ellipsoids side by side
  awk 'BEGIN {
    n = 16; m = 24; pi = atan2(0, -1)
    for (k = 0; k < 12; k++) {
      x = 3 * (k % 4); y = 3 * int(k / 4)
      for (i = 1; i < n; i++) for (j = 0; j < m; j++) {
        a = pi * i / n; b = 2 * pi * j / m
        printf "v %.9f %.9f %.9f\n", x + sin(a) * cos(b), y + sin(a) * sin(b), 0.01 * cos(a)
      }
      printf "v %d %d 0.01\nv %d %d -0.01\n", x, y, x, y
      first = k * ((n - 1) * m + 2) + 1; top = first + (n - 1) * m; bottom = top + 1; last = first + (n - 2) * m
      for (j = 0; j < m; j++) {
        e = (j + 1) % m
        print "f", top, first + j, first + e
        print "f", bottom, last + e, last + j
        for (i = 0; i < n - 2; i++) {
          p = first + i * m + j; q = first + i * m + e
          print "f", p, p + m, q + m
          print "f", p, q + m, q
        }
      }
    }
  }'
}
limbs() { # a tube along a knot
  awk 'BEGIN {
    n = 220; m = 12; pi = atan2(0, -1)
    for (i = 0; i < n; i++) {
      t = 2 * pi * i / n
      for (j = 0; j < m; j++) {
        # Frame: the tangent t, and u and v perpendicular to it.
        r = 1 + 0.4 * cos(3 * t); px = r * cos(2 * t); py = r * sin(2 * t); pz = 0.4 * sin(3 * t)
        dr = -1.2 * sin(3 * t)
        tx = dr * cos(2 * t) - 2 * r * sin(2 * t); ty = dr * sin(2 * t) + 2 * r * cos(2 * t); tz = 1.2 * cos(3 * t)
        l = sqrt(tx * tx + ty * ty + tz * tz); tx /= l; ty /= l; tz /= l
        ux = px - (px * tx + py * ty) * tx; uy = py - (px * tx + py * ty) * ty; uz = -(px * tx + py * ty) * tz
        l = sqrt(ux * ux + uy * uy + uz * uz); ux /= l; uy /= l; uz /= l
        vx = ty * uz - tz * uy; vy = tz * ux - tx * uz; vz = tx * uy - ty * ux
        c = 0.17 * cos(2 * pi * j / m); s = 0.17 * sin(2 * pi * j / m)
        printf "v %.9f %.9f %.9f\n", px + c * ux + s * vx, py + c * uy + s * vy, pz + c * uz + s * vz
      }
    }
    for (i = 0; i < n; i++) for (j = 0; j < m; j++) {
      a = i * m + j + 1; b = i * m + (j + 1) % m + 1; c = ((i + 1) % n) * m + (j + 1) % m + 1; d = ((i + 1) % n) * m + j + 1
      print "f", a, b, c
      print "f", a, c, d
    }
  }'
}
plates >twin.obj
limbs >cow.obj
commands=$(awk '/^## Tuning a poor LRB-rep/ { on = 1; next } /^## / { on = 0 } on && $0 == "```sh" { inside = 1; next }
  /^```$/ { inside = 0 } on && inside' "$page")
[ "$(wc -l <<<"$commands")" -ge 8 ] || { echo "$page: found no commands"; exit 1; }
complain() { echo "$page: $1"; cat said; exit 1; }
lrbscope() { "$program" "$@" >>said 2>&1; }
while IFS= read -r line; do
  echo "$line"
  : >said
  eval "$line" || complain "failed: $line"
  case "$line" in
    *"build twin.obj -o"*) grep -q 'twin.obj: low-quality LRB-rep: its outermost wrapper has 7.* times as long as it is thick' said || complain "no warning" ;;
    *"build cow.obj -o"*) grep -q 'low-quality' said && complain "a warning" ;;
    *"twin.lrb"*--try*) grep -q '^  --max-outer 80 has the closest outermost wrapper: 5' said || complain "other advice" ;;
    *"cow.lrb"*--try*) grep -q '^  --lean --patch 40 has the fewest faces: 1\.' said || complain "other advice" ;;
    *"--regions"*) grep -qE '^ *region +layer +lids +floor +volume +distance +parent +waste$' said || complain "no table" ;;
  esac
done <<<"$commands"
figure() { "$program" inspect "$1" --json | grep -oE "\"$2\":[0-9.e+-]+" | cut -d: -f2; }
awk -v a="$(figure twin.lrb volume_outer)" -v b="$(figure twin2.lrb volume_outer)" 'BEGIN { exit !(b < 0.8 * a) }' ||
  { echo "twin2.lrb: expected less than 0.8 times the outer volume of twin.lrb"; exit 1; }
awk -v a="$(figure cow.lrb total_per_real)" -v b="$(figure cow2.lrb total_per_real)" 'BEGIN { exit !(b < 0.8 * a) }' ||
  { echo "cow2.lrb: expected less than 0.8 times the faces of cow.lrb"; exit 1; }
[ "$(head -c 4 twin.png | tail -c 3)" = PNG ] || { echo "twin.png: is not a picture"; exit 1; }
echo "the output agrees with the page"
