#!/usr/bin/env bash
# docs/counterexamples.sh [LRBSCOPE]: makes counterexamples.md from the cases below, and the pictures counterexample_N.png. Needs FCL
# (libfcl-dev) and the workers; other versions of FCL may not fail on these cases.
set -euo pipefail
docs=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=${1:-$docs/../build/release/bin/lrbscope}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# METHOD FAMILY DIFFICULTY CASE
cases="fcl identical 8 8
fcl-float ratio 2 12
plain identical 3 0
fcl far 10 14
fcl-float dented 9 17
plain quadratic 10 0
fcl scale 9 7
fcl-float dirty 9 6
plain extreme 10 5
plain plane 3 3"

section() { # NAME: prints a section of report.md without its heading
  awk -v name="## $1" '$0 == name { on = 1; next } /^## / || /^Made by/ { on = 0 } on' small/report.md | sed -e '/./,$!d'
}
number() { sed -n "s/^.*\"$1\": \([0-9]*\),*$/\1/p" small/case.json | tail -1; }

n=0
: >sections.md
: >table.md
while read -r method family difficulty case; do
  n=$((n + 1))
  line="stability --family $family --method $method --difficulty $difficulty --only $case --minimise --save small"
  rm -rf small
  # shellcheck disable=SC2086
  "$program" -q $line >/dev/null || [ $? = 1 ]
  title=$(sed -n '1s/^# //p' small/report.md)
  grep -q "Both poses are the identity" small/report.md
  cp small/picture.png "$docs/counterexample_$n.png"
  if [ -e small/fcl.cpp ]; then
    g++ -w -std=c++17 -I/usr/include/eigen3 small/fcl.cpp -lfcl -lccd -o alone
    [ "$(./alone)" != "$(sed -n 's|^// Expected: \(.*\)\.$|\1|p' small/fcl.cpp)" ] || { echo "case $n: FCL alone is right" >&2; exit 1; }
  fi
  echo "| [$n](#counterexample-$n) | $title | $(number vertices) | $(number bits) |" >>table.md
  {
    printf '\n## Counterexample %s\n\n%s.\n\n![%s](counterexample_%s.png)\n\n' "$n" "$title" "$title" "$n"
    echo '```'
    section Meshes | awk '/^A:/ { print "# A" } /^B:/ { print "# B" } /^[vfl] /'
    echo '```'
    printf '\n%s\n' "$(section Expected)"
    printf '\nFound: %s\n\n' "$(section Found | head -1)"
    # shellcheck disable=SC2016
    printf '```sh\nlrbscope %s\n```\n' "$line"
  } >>sections.md
done <<<"$cases"

{
  cat <<'P'
# Ten counterexamples

The smallest failure of each kind that [`stability --minimise`](stability.md#minimise-a-case) found in two other methods: FCL 0.7.0 (Debian 12's
package, `BVHModel<OBBRSS>`, `collide()` for all pairs) in double and in float, and brute force with Moeller's triangle test in double, with its usual
epsilon of 1e-6. [counterexamples.sh](counterexamples.sh) writes this page, and compiles and runs a program without lrbscope for each case of FCL.

No triangle or segment is degenerate. Degenerate ones would give smaller cases, but many engines do not accept them.

**Which of these are faults?** Missing a pair that crosses (1 to 3) is wrong by any definition. Whether touching pairs intersect (4 to 6) is a
convention. FCL's documentation does not state one, but its triangle test (`project6()`) rejects only strictly disjoint intervals, and finds most
touching pairs. Moeller's test is meant to find them. Some returned pairs do not intersect (7 to 10). FCL's triangle test has no tolerance, so its
false pairs are due to rounding, even at large distances. Those of brute force are due to its epsilon, which is compared with areas and products, not
with distances. Neither FCL nor Moeller's test promises exact answers, and most of these cases are extreme: a needle thousands of times as long as
wide, or a gap near the resolution of the numbers. Cases 5 and 6 are not extreme.

| case | failure | vertices | bits |
| --- | --- | --- | --- |
P
  cat table.md
  printf '\nBits are the binary digits of all coordinates. Coordinates are exact, also where a decimal fraction is long.\n'
  cat sections.md
} >"$docs/counterexamples.md"
