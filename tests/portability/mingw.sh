#!/usr/bin/env bash
# tests/portability/mingw.sh: cross-compiles engine, trace, generated bodies and families of cases for Windows and runs the program of
# tests/reproducibility under Wine, with each instruction set. Bodies, .lrb files, answers and traces must be those of this machine.
# Exit codes: 1 if anything differs, 3 without packages of Debian, 77 without MinGW-w64 or Wine.

name=mingw
tools=(x86_64-w64-mingw32-g++-posix wine)
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

unpacked() { [[ "$1" =~ ^(libeigen3|libboost|nlohmann-json3).*-dev$ ]]; }
make_root "$(dpkg --print-architecture)" libeigen3-dev libboost-dev nlohmann-json3-dev
configure tests/portability
build fingerprints
build_native fingerprints

export WINEPREFIX=$top/wine WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml="
"$native/tests/reproducibility/fingerprints" "$(nproc)" >"$top/native.txt"
for vectors in best avx2 baseline; do
  LRB_SIMD=$vectors wine "$build/reproducibility/fingerprints.exe" 2 >"$top/$name.txt" # on two threads
  same_lines "fingerprints, $vectors" "$top/native.txt" "$top/$name.txt"
done
exit $differ
