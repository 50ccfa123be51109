#!/bin/sh
# Counts the instructions of a few queries and builds (callgrind) and compares them with tests/guard/guard.txt, to detect changes
# that add work, independently of the load of the machine. Counts depend on the compiler, its flags and AVX2;
# guard.txt has separate lines for each combination.
#   tests/guard/guard.sh [BUILD] [--tolerance PERCENT] [--approve]      BUILD: a build folder [build/release]
# Exit codes: 0 within the tolerance (or approved), 1 more, or no approved count, 2 bad usage, 3 cannot count.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
known=$here/guard.txt
build=$here/../../build/release tolerance=1 approve=
while [ $# -gt 0 ]; do
  case $1 in
    --tolerance) [ $# -gt 1 ] || { echo "guard: --tolerance: expected a percentage" >&2; exit 2; }
      tolerance=$2; shift ;;
    --approve) approve=yes ;;
    -*) echo "guard: unknown option $1" >&2; exit 2 ;;
    *) build=$1 ;;
  esac
  shift
done
program=$build/tests/guard/query_guard
[ -x "$program" ] || {
  echo "guard: missing $program: install valgrind, configure with -DLRB_BUILD_BENCHMARKS=ON, build query_guard" >&2
  exit 3
}
command -v valgrind > /dev/null || { echo "guard: install Debian's valgrind" >&2; exit 3; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file="$scratch/counts" "$program" \
  > "$scratch/said" 2> "$scratch/errors" || { tail -3 "$scratch/errors" >&2; exit 3; }
simd=$(grep -qw avx2 /proc/cpuinfo && echo avx2 || echo sse2)
key=$(sed -n 's/^compiler //p' "$scratch/said" | tr ' ' '_')_$simd
for f in "$scratch"/counts.*; do
  awk -v key="$key" '/^desc: Trigger: Client Request: / { name = $NF } /^(totals|summary):/ { n = $2 }
                     END { if (name != "" && n > 0) print key, name, n }' "$f"
done > "$scratch/now"
[ -s "$scratch/now" ] || { echo "guard: callgrind wrote no counts" >&2; exit 3; }
touch "$known"
if [ -n "$approve" ]; then
  grep -v "^$key " "$known" > "$scratch/new" || true
  cat "$scratch/now" >> "$scratch/new"
  sort "$scratch/new" > "$known"
  echo "guard: approved for $key"
  exit 0
fi
awk -v tolerance="$tolerance" -v compiler="$key" '
  FNR == NR { known[$1 " " $2] = $3; next }
  { key = $1 " " $2
    counted[$2] = $3
    if (!(key in known)) { printf "%-18s %12.0f  NO approved count for %s: use --approve\n", $2, $3, $1; bad = 1; next }
    change = 100 * ($3 / known[key] - 1)
    printf("%-18s %12.0f  %+.2f %%%s\n", $2, $3, change, (change > tolerance ? "  MORE than " tolerance " %" : ""))
    if (change > tolerance) bad = 1 }
  END {
    for (k in known)
      if (index(k, compiler " ") == 1 && !(substr(k, length(compiler) + 2) in counted)) { print k ": NOT counted: use --approve"; bad = 1 }
    if (counted["shallow"] > 0) {
      cost = 100 * (counted["shallow_watched"] / counted["shallow"] - 1)
      printf("overhead of events without a recorder: %+.2f %%, at most 1 %%%s\n", cost, (cost > 1 ? ": MORE" : ""))
      if (cost > 1) bad = 1
    }
    exit bad
  }' "$known" "$scratch/now"
