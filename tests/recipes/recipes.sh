#!/usr/bin/env bash
# recipes.sh TREE: the recipes of vcpkg, Conan and conda in cmake/recipes, as far as they can be checked without these: they name
# this version, options that CMakeLists.txt has, and files that there are; vcpkg's port and Conan's recipe are run with their tools'
# functions replaced by recorders (recipes.py, vcpkg.cmake); and what all of them ask CMake for configures, and installs what
# they say it does.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tree=$(cd "$1" && pwd)
python=/usr/bin/python3
[ -x "$python" ] || python=$(command -v python3 || true)
[ -n "$python" ] || { echo "recipes.sh: skipped: no python3 here" && exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake -DPORT_FOLDER="$tree/cmake/recipes/vcpkg/lrbscope" -DOUT="$work/vcpkg" -P "$here/vcpkg.cmake" >"$work/vcpkg.log" 2>&1 ||
  { cat "$work/vcpkg.log" && exit 1; }
PYTHONPYCACHEPREFIX=$work "$python" -m py_compile "$tree/cmake/recipes/conan/conanfile.py"
PYTHONDONTWRITEBYTECODE=1 "$python" "$here/recipes.py" "$tree" "$work/vcpkg/options"

# What they ask for needs nothing that they do not name.
cmake -S "$tree" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_PNG=ON -DCMAKE_DISABLE_FIND_PACKAGE_ZLIB=ON -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON $(cat "$work/vcpkg/options") >"$work/configure.log" 2>&1 ||
  { cat "$work/configure.log" && exit 1; }
grep -q 'lrbscopeConfig\.cmake' "$work/build/cmake_install.cmake" || { echo "recipes.sh: no lrbscopeConfig.cmake would be installed" && exit 1; }
grep -q 'liblrb_engine\.a' "$work/build/cmake_install.cmake" || { echo "recipes.sh: no liblrb_engine.a would be installed" && exit 1; }
echo "configures with what the recipes name"
