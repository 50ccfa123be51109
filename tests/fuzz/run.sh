#!/usr/bin/env bash
# tests/fuzz/run.sh [--runs N | --seconds N] [FORMAT...]: builds the fuzzers (clang, address and undefined-behaviour
# sanitizers: the preset asan-ubsan) and runs each for 20 seconds, N seconds or N inputs; --runs 1000000 is the full run.
# Formats: mesh (OBJ, STL, PLY and OFF) lrb fields (an .lrb, damaged field by field) body (folded polygons, built)
# poses scenario crowd experiment trace capture motion. New inputs are kept in build/asan-ubsan/fuzz/corpus. An input that
# crashes, or takes over 10 s (motion, body and fields: 100 s), is left in .../found and ends the script; earlier findings are in
# tests/fuzz/corpus.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bound=-max_total_time=20
case "${1:-}" in
  --runs) bound=-runs=${2:?a number of inputs} && shift 2 ;;
  --seconds) bound=-max_total_time=${2:?a number of seconds} && shift 2 ;;
  -*) sed -n '2,7s/^# //p' "${BASH_SOURCE[0]}" >&2 && exit 2 ;;
esac
formats=("$@")
[ ${#formats[@]} -gt 0 ] || formats=(mesh lrb fields body poses scenario crowd experiment trace capture motion)
build=build/asan-ubsan
dir=$build/fuzz
cmake --preset asan-ubsan -DLRB_BUILD_TESTS=ON >/dev/null
cmake --build "$build" --target fuzz_seeds "${formats[@]/#/fuzz_}"
rm -rf "$dir/seeds"
"$build/tests/fuzz_seeds" "$dir/seeds"
mkdir -p "$dir/found"
# Two frames per allocation suffice to find a crash; deep stack traces are slow.
export ASAN_OPTIONS=malloc_context_size=2
for format in "${formats[@]}"; do
  mkdir -p "$dir/corpus/$format"
  # Longer inputs are truncated, which would make seeds useless.
  longest=$(find "$dir/seeds/$format" -type f -printf '%s\n' | sort -n | tail -1)
  length=$((longest > 1536 ? longest : 1536))
  # Arithmetic of Eigen's small vectors is up to 60 times slower under the sanitizers. Steps of a motion are limited by
  # feed_motion() itself.
  limit=10
  case "$format" in motion | body | fields) limit=100 ;; esac
  options=(-timeout=$limit -rss_limit_mb=2048 -max_len="$length" -print_final_stats=1 -verbosity=0 "$bound")
  dictionary=tests/fuzz/$format.dict
  case "$format" in crowd | experiment) dictionary=tests/fuzz/scenario.dict ;; esac
  [ -f "$dictionary" ] && options+=(-dict="$dictionary")
  folders=("$dir/corpus/$format" "$dir/seeds/$format")
  [ -d "tests/fuzz/corpus/$format" ] && folders+=("tests/fuzz/corpus/$format")
  begin=$SECONDS
  if ! "$build/tests/fuzz_$format" "${options[@]}" -artifact_prefix="$dir/found/$format-" "${folders[@]}" \
    >"$dir/$format.log" 2>&1; then
    cat "$dir/$format.log"
    exit 1
  fi
  inputs=$(awk '/number_of_executed_units/ { print $2 }' "$dir/$format.log")
  printf '%-11s %8d inputs in %d s: no crash, none over %d s\n' "$format" "$inputs" $((SECONDS - begin)) $limit
done
