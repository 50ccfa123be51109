#!/usr/bin/env bash
# tests/spread/spread.sh LRBSCOPE [SECONDS]: the two lines of docs/paper.md for a sweep over machines, run as they stand there but for
# smaller numbers, with several numbers of local ranks: the report's data must be the same bytes as those of one process.
# Each run may take SECONDS (120). Exits 77 (skipped) without mpirun.
set -euo pipefail
program=$1
seconds=${2:-120}
page=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/docs/paper.md
if ! command -v mpirun >/dev/null; then
  echo "skipped: there is no mpirun (Debian: openmpi-bin)"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin"
ln -s "$program" "$folder/bin/lrbscope"
cd "$folder"
export PATH=$folder/bin:$PATH
# Tests may run as root, on fewer cores than there are ranks, and without a network.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 \
  OMPI_MCA_plm_rsh_agent=/bin/false

# A body with two resolutions, small enough for every rank to build.
awk 'BEGIN { n = 24; m = 24
  for (i = 0; i < n; i++) for (j = 0; j < m; j++) {
    u = 6.283185307179586 * i / n; v = 6.283185307179586 * j / m
    printf "v %.6f %.6f %.6f\n", (1 + 0.4 * cos(v)) * cos(u), (1 + 0.4 * cos(v)) * sin(u), 0.4 * sin(v) }
  for (i = 0; i < n; i++) for (j = 0; j < m; j++) {
    a = i * m + j + 1; b = (i + 1) % n * m + j + 1; c = (i + 1) % n * m + (j + 1) % m + 1; d = i * m + (j + 1) % m + 1
    printf "f %d %d %d\nf %d %d %d\n", a, b, c, a, c, d } }' >torus.obj

spread=$(grep '^mpirun .*lrbscope paper' "$page")
merge=$(grep '^lrbscope paper --merge' "$page" | sed 's/ *#.*//')
smaller() { sed "s/-np [0-9]*/-np $1/; s/--collisions [0-9]*/--collisions 3 --meshes torus.obj/" <<<"$spread"; }
[ "$(smaller 3)" != "$spread" ] || { echo "the page's line has other options than this test knows: $spread"; exit 1; }

lrbscope paper --collisions 3 --meshes torus.obj -o whole >/dev/null
[ "$(wc -l <whole/series.jsonl)" -gt 20 ] || { echo "no series to compare"; exit 1; }
for ranks in 1 3 4; do
  rm -rf out
  timeout "$seconds" bash -c "$(smaller $ranks)" >log 2>&1 || {
    echo "failed with $ranks ranks, or took over $seconds s:"
    cat log
    exit 1
  }
  [ "$(ls -d out/part* | wc -l)" = "$ranks" ] || { echo "$ranks ranks wrote $(ls out)"; exit 1; }
  bash -c "$merge --meshes torus.obj" >log 2>&1 || { echo "merging $ranks ranks failed:"; cat log; exit 1; }
  for file in records.jsonl tables.json series.jsonl series.json; do
    cmp "whole/$file" "out/paper/$file" || { echo "$file depends on the number of ranks: $ranks"; exit 1; }
  done
  echo "$ranks ranks: the same bytes as one process"
done
