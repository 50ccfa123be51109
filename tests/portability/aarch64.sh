#!/usr/bin/env bash
# tests/portability/aarch64.sh: cross-compiles lrbscope for aarch64 and runs it under QEMU. LRB-reps, answers and traces must be those of
# this machine, byte for byte; golden runs with pictures, and tests of the engine, must pass. Takes an hour or more; CELLS=N asks only every
# Nth cell of the matrix.
# Exit codes: 1 if anything differs, 3 without packages of Debian for arm64, 77 without the cross compiler or QEMU.

name=aarch64
tools=(aarch64-linux-gnu-g++ qemu-aarch64-static)
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# Libraries are those of packages.txt; the cross compiler has its own standard library.
mapfile -t libraries < <(awk '/^\[/ { part = $1 } part ~ /\[(build|test)\]/ && $1 ~ /^(lib|fonts-)|-dev$/ { print $1 }' packages.txt)
unpacked() { [[ "$1" =~ ^(lib|fonts-)|-dev$|-common$|^zlib1g$ ]] && [[ ! "$1" =~ ^(libc6-dev|linux-libc-dev|libgcc-.*-dev|libstdc.*-dev)$ ]]; }
make_root arm64 "${libraries[@]}"

configure . -DLRB_HARDEN=ON -DLRB_BUILD_PROGRAM=ON -DLRB_BUILD_TESTS=ON -DLRB_PYTHON=OFF
tests=(exact_tests mesh_tests lrb_tests library_tests trace_tests)
build lrbscope fingerprints "${tests[@]}"
build_native lrbscope fingerprints matrix_bodies
run=(qemu-aarch64-static -L "$root")

rm -rf "$top/matrix" "$top/native-answers" "$top/$name-answers"
"$native/tests/matrix_bodies" "$top/matrix"
tests/portability/answers.py write "$top/matrix" "$top/native-answers" "${CELLS:-1}" "$PWD/$native/bin/lrbscope"
tests/portability/answers.py write "$top/matrix" "$top/$name-answers" "${CELLS:-1}" "${run[@]}" "$build/bin/lrbscope"
tests/portability/answers.py compare "$top/native-answers" "$top/$name-answers" || differ=1

"$native/tests/reproducibility/fingerprints" "$(nproc)" >"$top/native.txt"
"${run[@]}" "$build/tests/reproducibility/fingerprints" "$(nproc)" >"$top/$name.txt"
same_lines fingerprints "$top/native.txt" "$top/$name.txt"

for test in "${tests[@]}"; do
  passes "$test" "${run[@]}" "$build/tests/$test" --test-suite-exclude="long,shared meshes" --no-path-filenames=true
done
passes goldens "${run[@]}" "$build/bin/lrbscope" golden test --goldens tests/golden -o "$top/$name-golden"
exit $differ
