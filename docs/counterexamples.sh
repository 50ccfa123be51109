#!/usr/bin/env bash
# docs/counterexamples.sh [LRBSCOPE]: makes the table and the sections of counterexamples.md from the cases below, and the pictures counterexample_N.png. Needs FCL
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
    printf '\n## Counterexample %s\n\n![%s](counterexample_%s.png)\n\n' "$n" "$title" "$n"
    echo '```'
    section Meshes | awk '/^[AB]:/ { printf "%s%s", (n++ ? "\n" : ""), substr($0, 1, 2); v = 0 }
      /^v / { printf "%s(%s %s %s)", (v++ ? ", " : " "), $2, $3, $4 } END { print "" }'
    echo '```'
    printf '\n%s Found: %s\n\n' "$(section Expected)" "$(section Found | head -1 | sed 's/^./\L&/')"
    # shellcheck disable=SC2016
    printf '```sh\nlrbscope %s\n```\n' "$line"
  } >>sections.md
done <<<"$cases"

{
  sed '/^| case /,$d' "$docs/counterexamples.md"  # the text above the table stays
  echo '| case | failure | vertices | bits |'
  echo '| --- | --- | --- | --- |'
  cat table.md
  printf '\nBits are the binary digits of all coordinates. Coordinates are exact, also where a decimal fraction is long. Each body is one triangle (10: one\nsegment), given by its corners.\n'
  cat sections.md
} >new.md
mv new.md "$docs/counterexamples.md"
