#!/usr/bin/env bash
# tests/shards/shards.sh LRBSCOPE [SECONDS]: runs the two lines of docs/paper.md for a sharded sweep, with fewer collisions and
# several numbers of parts. The data of the report must be the same bytes as that of one process.
# Each run may take SECONDS (120).
set -euo pipefail
program=$1
seconds=${2:-120}
page=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/docs/paper.md
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin"
ln -s "$program" "$folder/bin/lrbscope"
cd "$folder"
export PATH=$folder/bin:$PATH

# A body with two resolutions, small enough for every part to build.
awk 'BEGIN { n = 24; m = 24
  for (i = 0; i < n; i++) for (j = 0; j < m; j++) {
    u = 6.283185307179586 * i / n; v = 6.283185307179586 * j / m
    printf "v %.6f %.6f %.6f\n", (1 + 0.4 * cos(v)) * cos(u), (1 + 0.4 * cos(v)) * sin(u), 0.4 * sin(v) }
  for (i = 0; i < n; i++) for (j = 0; j < m; j++) {
    a = i * m + j + 1; b = (i + 1) % n * m + j + 1; c = (i + 1) % n * m + (j + 1) % m + 1; d = i * m + (j + 1) % m + 1
    printf "f %d %d %d\nf %d %d %d\n", a, b, c, a, c, d } }' >torus.obj

sweep=$(grep '^seq .*lrbscope paper' "$page" | sed 's/ *#.*//')
merge=$(grep '^lrbscope paper --merge' "$page")
smaller() { sed "s/^seq 0 3/seq 0 $(($1 - 1))/; s,{}/4,{}/$1,; s/--collisions [0-9]*/--collisions 3 --meshes torus.obj/" <<<"$sweep"; }
grep -q '^seq 0 2 .*--collisions 3 .*{}/3 ' <<<"$(smaller 3)" || { echo "unexpected options in the line of the page: $sweep"; exit 1; }

lrbscope paper --collisions 3 --meshes torus.obj -o whole >/dev/null
[ "$(wc -l <whole/series.jsonl)" -gt 20 ] || { echo "no series to compare"; exit 1; }
for parts in 1 3 4; do
  rm -rf out
  timeout "$seconds" bash -c "$(smaller $parts)" >log 2>&1 || {
    echo "failed with $parts parts, or took over $seconds s:"
    cat log
    exit 1
  }
  [ "$(ls -d out/part* | wc -l)" = "$parts" ] || { echo "$parts parts wrote $(ls out)"; exit 1; }
  bash -c "$merge --meshes torus.obj" >log 2>&1 || { echo "merging $parts parts failed:"; cat log; exit 1; }
  for file in records.jsonl tables.json series.jsonl series.json; do
    cmp "whole/$file" "out/paper/$file" || { echo "$file depends on the number of parts: $parts"; exit 1; }
  done
  echo "$parts parts: the same bytes as one process"
done
