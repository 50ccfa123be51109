#!/usr/bin/env bash
# tests/reproducibility/reproducibility.sh: verifies that answers are bit-identical. Builds engine, traces and generators with gcc and
# clang at -O0, -O2 and -O3, runs tests/reproducibility/fingerprints.cpp with all instruction sets on 1 and 2 threads, and
# prints a table. Exits with 1 if a line of output differs from the first run. COMPILERS and LEVELS restrict the builds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
top=build/repeat
first=""
differ=0
printf '%-8s %-5s %-9s %-8s %-7s %s\n' compiler level vectors threads lines answer
for compiler in ${COMPILERS:-g++ clang++}; do
  for level in ${LEVELS:-0 2 3}; do
    build=$top/$compiler-O$level
    # The options of the release preset, except for the optimisation level.
    cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_CXX_FLAGS_RELEASE="-O$level" -DLRB_HARDEN=$([ "$level" = 0 ] && echo OFF || echo ON) \
      -DLRB_BUILD_TESTS=ON -DLRB_WARNINGS_AS_ERRORS=OFF >/dev/null
    cmake --build "$build" --target fingerprints >"$build.log" 2>&1 || { cat "$build.log"; exit 1; }
    for vectors in best avx2 baseline; do
      for threads in 1 2; do
        out=$build-$vectors-$threads.txt
        LRB_SIMD=$vectors "$build/tests/reproducibility/fingerprints" "$threads" >"$out"
        [ -n "$first" ] || first=$out
        answer=same
        cmp -s "$first" "$out" || { answer="DIFFERS from $first" && differ=1; }
        printf '%-8s %-5s %-9s %-8s %-7s %s\n' "$compiler" -O"$level" "$vectors" "$threads" "$(wc -l <"$out")" "$answer"
        [ "$answer" = same ] || diff "$first" "$out" | grep '^>' | head -5 || true
      done
    done
  done
done
exit $differ
