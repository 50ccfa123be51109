#!/usr/bin/env bash
# tests/portability/portability.sh aarch64|mingw: cross-compiles lrbscope for another platform and runs it under an emulator: aarch64 under QEMU
# (fingerprints, tests of the engine, goldens: an hour or more), Windows under Wine (engine and trace, by the fingerprints with each instruction
# set). Bodies, .lrb files, answers and traces must be those of this machine, byte for byte. Libraries are unpacked in ~/.cache, not installed.
# Exit codes: 1 if anything differs, 2 for another platform, 3 without packages of Debian, 77 without the cross compiler or emulator.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
name=${1:-}
# unpacked NAME: true for the packages that are needed to compile.
case "$name" in
  aarch64)
    architecture=arm64 tools=(aarch64-linux-gnu-g++ qemu-aarch64-static) source=.
    options=(-DLRB_HARDEN=ON -DLRB_BUILD_PROGRAM=ON -DLRB_BUILD_TESTS=ON -DLRB_PYTHON=OFF)
    # Libraries are those of packages.txt; the cross compiler has its own standard library.
    mapfile -t libraries < <(awk '/^\[/ { part = $1 } part ~ /\[(build|test)\]/ && $1 ~ /^(lib|fonts-)|-dev$/ { print $1 }' packages.txt)
    unpacked() { [[ "$1" =~ ^(lib|fonts-)|-dev$|-common$|^zlib1g$ ]] && [[ ! "$1" =~ ^(libc6-dev|linux-libc-dev|libgcc-.*-dev|libstdc.*-dev)$ ]]; }
    ;;
  mingw)
    architecture=$(dpkg --print-architecture) tools=(x86_64-w64-mingw32-g++-posix wine) source=tests/portability options=()
    libraries=(libeigen3-dev libboost-dev nlohmann-json3-dev)
    unpacked() { [[ "$1" =~ ^(libeigen3|libboost|nlohmann-json3).*-dev$ ]]; }
    ;;
  *) sed -n '2,/^set/s/^# //p' "${BASH_SOURCE[0]}" >&2 && exit 2 ;;
esac
for tool in "${tools[@]}"; do
  command -v "$tool" >/dev/null || { echo "portability.sh: skipped: needs $tool: bash cmake/packages.sh $name" && exit 77; }
done
cache=${XDG_CACHE_HOME:-$HOME/.cache}/lrbscope-$name
root=$cache/root native=build/release top=$PWD/build/portability
build=$top/$name
differ=0
mkdir -p "$top"

# Unpacks the libraries and all that they depend on, from the Debian sources of this machine. Again every month.
make_root() {
  local key state=$cache/apt apt package
  key=$({ echo "${libraries[@]}"; declare -f unpacked; date +%Y-%m; } | sha256sum)
  [ "$(cat "$cache/key" 2>/dev/null)" != "$key" ] || return 0
  rm -rf "$cache"
  mkdir -p "$state/lists/partial" "$state/archives/partial" "$root"
  apt=(apt-get -q -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" -o Dir::State::status=/dev/null
    -o Dir::State::Lists="$state/lists" -o Dir::Cache="$state" -o APT::Sandbox::User=root -o APT::Install-Recommends=0)
  if ! { "${apt[@]}" update && "${apt[@]}" install -y --download-only "${libraries[@]}"; } >"$build-packages.log" 2>&1; then
    tail -5 "$build-packages.log" >&2
    echo "portability.sh: cannot download packages: is the network up?" >&2
    exit 3
  fi
  for package in "$state"/archives/*.deb; do
    if unpacked "$(basename "${package%%_*}")"; then dpkg-deb -x "$package" "$root"; fi
  done
  [ -e "$root/lib" ] || ln -s usr/lib "$root/lib" # since Debian 13
  rm -rf "$state"
  echo "$key" >"$cache/key"
}
# build TARGET...: with the options of the preset release, but for hardening.
build() {
  { cmake -S $source -B "$build" -G Ninja --toolchain "$PWD/tests/portability/$name.cmake" -DLRB_ROOT="$root" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_FLAGS_RELEASE=-O3 "${options[@]}" && cmake --build "$build" --target "$@"; } >"$build.log" 2>&1 ||
    { grep -A5 -m3 -E 'error|FAILED' "$build.log" >&2 || tail -20 "$build.log" >&2; exit 1; }
}
# compare WHAT COMMAND...: fingerprints of the other platform with those of this machine.
compare() {
  "${@:2}" | tr -d '\r' >"$top/$name.txt"
  echo "$1: $(comm -12 <(sort "$top/native.txt") <(sort "$top/$name.txt") | wc -l) of $(wc -l <"$top/native.txt") lines are equal"
  diff "$top/native.txt" "$top/$name.txt" | head -20 || true
  cmp -s "$top/native.txt" "$top/$name.txt" && [ -s "$top/native.txt" ] || differ=1
}
# passes WHAT COMMAND...: runs a test; prints its last line, or its output if it fails.
passes() {
  if "${@:2}" >"$build-$1.log" 2>&1; then echo "$1: $(tail -1 "$build-$1.log")"; else differ=1 && echo "$1: FAILED" && tail -20 "$build-$1.log"; fi
}

make_root
cmake --preset release -DLRB_BUILD_TESTS=ON >"$top/native.log"
cmake --build --preset release --target fingerprints >"$top/native.log"
"$native/tests/reproducibility/fingerprints" "$(nproc)" >"$top/native.txt"
if [ "$name" = aarch64 ]; then
  tests=(exact_tests mesh_tests lrb_tests library_tests trace_tests) run=(qemu-aarch64-static -L "$root")
  build lrbscope fingerprints "${tests[@]}"
  compare fingerprints "${run[@]}" "$build/tests/reproducibility/fingerprints" "$(nproc)"
  for test in "${tests[@]}"; do
    passes "$test" "${run[@]}" "$build/tests/$test" --test-suite-exclude="long,shared meshes" --no-path-filenames=true
  done
  passes goldens "${run[@]}" "$build/bin/lrbscope" golden test --goldens tests/golden -o "$top/$name-golden"
else
  build fingerprints
  export WINEPREFIX=$top/wine WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml="
  for vectors in best avx2 baseline; do
    compare "fingerprints, $vectors" env LRB_SIMD=$vectors wine "$build/reproducibility/fingerprints.exe" 2 # on two threads
  done
fi
exit $differ
