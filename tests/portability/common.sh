# Sourced by aarch64.sh and mingw.sh, which set `name` and `tools`. Builds native programs and writes their answers, which are the
# expected ones; compares those of the other platform.
set -euo pipefail
script=$(basename "$0")
[ $# = 0 ] || { sed -n '2,/^$/s/^# //p' "$0" >&2 && exit 2; }
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
for tool in "${tools[@]}"; do
  command -v "$tool" >/dev/null || { echo "$script: skipped: needs $tool: bash cmake/packages.sh $name" && exit 77; }
done
cache=${XDG_CACHE_HOME:-$HOME/.cache}/lrbscope-$name
root=$cache/root # libraries of the other platform
native=build/release
top=$PWD/build/portability
build=$top/$name
differ=0
mkdir -p "$top"

# make_root ARCHITECTURE PACKAGE...: unpacks packages into the folder `root`, from the Debian sources of this machine, and all that they
# depend on, if `unpacked NAME` is true. Nothing is installed. Again every month.
make_root() {
  local key architecture=$1 state=$cache/apt apt package
  key=$({ echo "$@"; declare -f unpacked; date +%Y-%m; } | sha256sum)
  [ "$(cat "$cache/key" 2>/dev/null)" != "$key" ] || return 0
  rm -rf "$cache"
  mkdir -p "$state/lists/partial" "$state/archives/partial" "$root"
  apt=(apt-get -q -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" -o Dir::State::status=/dev/null
    -o Dir::State::Lists="$state/lists" -o Dir::Cache="$state" -o APT::Sandbox::User=root -o APT::Install-Recommends=0)
  if ! { "${apt[@]}" update && "${apt[@]}" install -y --download-only "${@:2}"; } >"$build-packages.log" 2>&1; then
    tail -5 "$build-packages.log" >&2
    echo "$script: cannot download packages: is the network up?" >&2
    exit 3
  fi
  for package in "$state"/archives/*.deb; do
    if unpacked "$(basename "${package%%_*}")"; then dpkg-deb -x "$package" "$root"; fi
  done
  [ -e "$root/lib" ] || ln -s usr/lib "$root/lib" # since Debian 13
  rm -rf "$state"
  echo "$key" >"$cache/key"
}

# Options of the preset release, but for hardening.
configure() { # SOURCE OPTION...
  cmake -S "$1" -B "$build" -G Ninja --toolchain "$PWD/tests/portability/$name.cmake" -DLRB_ROOT="$root" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_FLAGS_RELEASE=-O3 "${@:2}" >"$build.log" 2>&1 ||
    { tail -20 "$build.log" >&2; exit 1; }
}
build() { # TARGET...
  cmake --build "$build" --target "$@" >"$build.log" 2>&1 || { grep -A5 -m3 -E 'error|FAILED' "$build.log" >&2; exit 1; }
}
build_native() { # TARGET...
  cmake --preset release -DLRB_BUILD_TESTS=ON >"$top/native.log"
  cmake --build --preset release --target "$@" >"$top/native.log"
}

# same_lines WHAT EXPECTED FOUND: compares two files of lines, and prints the number of equal lines and the first different ones.
same_lines() {
  local lines equal
  lines=$(wc -l <"$2")
  equal=$(comm -12 <(sort "$2") <(tr -d '\r' <"$3" | sort) | wc -l) # every line names what it is about
  echo "$1: $equal of $lines lines are equal"
  if [ "$lines" = 0 ] || ! cmp -s "$2" <(tr -d '\r' <"$3"); then
    differ=1
    diff "$2" <(tr -d '\r' <"$3") | head -20 || true
  fi
}
# passes WHAT COMMAND...: runs a test program; prints its last line, or its output if it fails.
passes() {
  local what=$1 log
  log=$top/$name-$1.log
  shift
  if "$@" >"$log" 2>&1; then echo "$what: $(tail -1 "$log")"; else differ=1 && echo "$what: FAILED" && tail -20 "$log"; fi
}
