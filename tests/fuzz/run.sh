#!/usr/bin/env bash
# tests/fuzz/run.sh [RUNS] [FORMAT...]: builds the fuzzers (clang, address and undefined-behaviour sanitizers) and runs
# each: for about 20 seconds, or for RUNS inputs (1000000 is the full run). Formats: mesh lrb poses scenario trace.
# What a run learned stays in build/fuzz/corpus; an input that fails is left in build/fuzz/found and ends the script.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
runs=${1:-}
shift || true
formats=("$@")
[ ${#formats[@]} -gt 0 ] || formats=(mesh lrb poses scenario trace)
dir=build/fuzz
cmake -S . -B "$dir" -G Ninja -DCMAKE_CXX_COMPILER="${CXX:-clang++}" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -gline-tables-only" -DLRB_FUZZ=ON -DLRB_SANITIZE=address,undefined \
  -DLRB_BUILD_TESTS=ON >/dev/null
cmake --build "$dir" --target fuzz_seeds "${formats[@]/#/fuzz_}"
"$dir/tests/fuzz_seeds" "$dir/seeds"
mkdir -p "$dir/found"
for format in "${formats[@]}"; do
  mkdir -p "$dir/corpus/$format"
  if [ -n "$runs" ]; then bound=(-runs="$runs"); else bound=(-max_total_time=20); fi
  options=(-timeout=10 -rss_limit_mb=2048 -max_len=4096 -print_final_stats=1 -verbosity=0)
  [ "$format" = trace ] && options+=(-max_len=16384)
  [ -f "tests/fuzz/$format.dict" ] && options+=(-dict="tests/fuzz/$format.dict")
  echo "== $format"
  "$dir/tests/fuzz_$format" "${options[@]}" "${bound[@]}" -artifact_prefix="$dir/found/$format-" \
    "$dir/corpus/$format" "$dir/seeds/$format" 2>&1 |
    grep -v -e '^INFO' -e '^Dictionary' -e slowest_unit -e new_units
done
