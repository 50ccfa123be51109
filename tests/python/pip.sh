#!/usr/bin/env bash
# pip.sh PYTHON TREE: checks that the wheel of pyproject.toml contains only the package; then runs `pip install TREE` in a new
# environment, and a query there. Exit code 77 (skipped) if the build requirements are not installed; pip may not download them.
set -euo pipefail
python=${1:-} tree=$2
[ -n "$python" ] || { echo "skipped: the Python module was not built: install the part [python] of packages.txt" && exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The configuration of scikit-build-core.
cmake -S "$tree" -B "$work/wheel" -G Ninja -DSKBUILD=2 "-DSKBUILD_SCRIPTS_DIR=$work/scripts" -DCMAKE_BUILD_TYPE=Release -DLRB_BUILD_TESTS=OFF \
  "-DPython3_EXECUTABLE=$python" >"$work/configure.log" 2>&1 || { cat "$work/configure.log" && exit 1; }
cmake --install "$work/wheel" --component python --prefix "$work/installed" >/dev/null
[ "$(ls "$work/installed")" = lrbscope ] || { echo "the wheel has more than the package:" && ls "$work/installed" && exit 1; }
[ -e "$work/installed/lrbscope/py.typed" ] || { echo "the wheel lacks files of the package" && exit 1; }
for module in scikit_build_core pybind11 numpy venv pip; do
  "$python" -c "import $module" 2>/dev/null || { echo "skipped: $python has no $module, which pip install . needs" && exit 77; }
done
"$python" -m venv --system-site-packages "$work/venv"
"$work/venv/bin/python" -m pip install --no-index --no-build-isolation --no-deps "$tree"
cd "$work"
"$work/venv/bin/lrbscope" --version
"$work/venv/bin/python" - <<'PYTHON'
import importlib.metadata
import lrbscope
print(lrbscope.__file__)
assert "venv" in lrbscope.__file__
assert importlib.metadata.version("lrbscope") == lrbscope.__version__
body = lrbscope.Body([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
assert lrbscope.collide(body, body).relation == "touching"
PYTHON
