#!/usr/bin/env bash
# needs.sh TREE GENERATOR COMPILER: tests configuring without a preset. Hides each package in turn: the part that needs it must be
# left out, and the table must name both. If that part is requested, one line must name the package and the option.
set -euo pipefail
tree=$(cd "$1" && pwd)
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
bad() { echo "needs.sh: $1" && cat "$build/log" && exit 1; }

# Configures with these options; the log has the output, and one line for the exit code.
configure() {
  local code=0
  cmake -S "$tree" -B "$build" "$@" >"$build/log" 2>&1 || code=$?
  echo "exit code $code" >>"$build/log"
}
built() { grep -qE -- "^--   $1 +yes$" "$build/log"; }
listed() { grep -qE -- "^$1( |$)" "$tree/packages.txt" || bad "packages.txt does not have $1"; }

configure -G "$2" "-DCMAKE_CXX_COMPILER=$3"
grep -qx 'exit code 0' "$build/log" && ! grep -q 'CMake [EW]' "$build/log" || bad "a plain configure is not clean"
for part in engine trace render program tests; do built $part || bad "a plain configure does not build $part"; done
grep -qx 'LRB_WARNINGS_AS_ERRORS:STRING=OFF' "$build/CMakeCache.txt" || bad "warnings are errors without a preset"

count=0
# hide OPTION VISIBLE PACKAGE PART ASKED INSTEAD: the options that hide PACKAGE and show it again, the first part that needs it,
# the option that requests this part, and the option that the error message offers.
hide() {
  listed "$3"
  configure "$1"
  if [ "$4" = engine ]; then
    grep -qx 'exit code 1' "$build/log" || bad "configuring succeeds without $3"
  else
    grep -qx 'exit code 0' "$build/log" || bad "configuring fails without $3"
    grep -qE -- "^--   $4 +no .*\b$3( |,|$)" "$build/log" || bad "the table does not show that $4 is not built because of $3"
    ! built "$4" || bad "$4 is built without $3"
    if [ -n "$5" ]; then configure "$1" "$5"; fi
  fi
  if [ -n "$5" ]; then
    grep -qx 'exit code 1' "$build/log" || bad "$5 without $3 was not rejected"
    [ "$(grep -c "^ *lrbscope: $4 needs Debian's.* $3\b.* configure with $6" "$build/log")" = 1 ] || bad "no line names $3 and $6"
  fi
  configure "$2" -ULRB_BUILD_TESTS -ULRB_BUILD_PROGRAM -ULRB_COMPONENTS
  grep -qx 'exit code 0' "$build/log" || bad "configuring fails with $3 visible again"
  count=$((count + 1))
}
package() { hide "-DCMAKE_DISABLE_FIND_PACKAGE_$1=ON" "-DCMAKE_DISABLE_FIND_PACKAGE_$1=OFF" "${@:2}"; }
package Eigen3 libeigen3-dev engine always -DLRB_THREADS=std
package Boost libboost-dev engine always -DLRB_THREADS=std
package TBB libtbb-dev engine always -DLRB_THREADS=std
package nlohmann_json nlohmann-json3-dev trace "-DLRB_COMPONENTS=engine;trace" -DLRB_COMPONENTS=engine
package ZLIB zlib1g-dev trace -DLRB_COMPONENTS=trace -DLRB_COMPONENTS=engine
package PNG libpng-dev render -DLRB_COMPONENTS=render -DLRB_COMPONENTS=
package glm libglm-dev render -DLRB_COMPONENTS=render -DLRB_COMPONENTS=
package PkgConfig pkg-config render -DLRB_COMPONENTS=render -DLRB_COMPONENTS=
hide -DLRB_EGL_INCLUDE= -ULRB_EGL_INCLUDE libegl-dev render -DLRB_COMPONENTS=render -DLRB_COMPONENTS=
hide -DLRB_STB_INCLUDE= -ULRB_STB_INCLUDE libstb-dev render -DLRB_COMPONENTS=render -DLRB_COMPONENTS=
package CLI11 libcli11-dev program -DLRB_BUILD_PROGRAM=ON -DLRB_BUILD_PROGRAM=OFF
hide -DLRB_CHART_JS= -ULRB_CHART_JS libjs-chart.js program -DLRB_BUILD_PROGRAM=ON -DLRB_BUILD_PROGRAM=OFF
hide -DLRB_THREE_JS= -ULRB_THREE_JS libjs-three program -DLRB_BUILD_PROGRAM=ON -DLRB_BUILD_PROGRAM=OFF
package doctest doctest-dev tests -DLRB_BUILD_TESTS=ON -DLRB_BUILD_TESTS=OFF
package valijson libvalijson-dev tests -DLRB_BUILD_TESTS=ON -DLRB_BUILD_TESTS=OFF
package pybind11 pybind11-dev "Python module" "" ""

# The engine alone does not need other parts.
configure -DLRB_BUILD_PROGRAM=OFF -DLRB_COMPONENTS=engine
for part in trace render program tests; do ! built $part || bad "-DLRB_BUILD_PROGRAM=OFF -DLRB_COMPONENTS=engine builds $part"; done
echo "$count packages hidden, one at a time"
