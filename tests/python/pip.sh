#!/usr/bin/env bash
# pip.sh PYTHON TREE: `pip install TREE` into an environment of its own, which then asks a query. Exit code 77, skipped, where what
# pyproject.toml builds with is not installed: pip is not let to fetch it.
set -euo pipefail
python=${1:-} tree=$2
[ -n "$python" ] || { echo "no Python module is built here: install the part [python] of packages.txt" && exit 77; }
for module in scikit_build_core pybind11 numpy venv pip; do
  "$python" -c "import $module" 2>/dev/null || { echo "$python has no $module, which pip install . needs" && exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$python" -m venv --system-site-packages "$work/venv"
"$work/venv/bin/python" -m pip install --no-index --no-build-isolation --no-deps "$tree"
cd "$work"
"$work/venv/bin/python" - <<'PYTHON'
import importlib.metadata
import lrbscope
print(lrbscope.__file__)
assert "venv" in lrbscope.__file__
assert importlib.metadata.version("lrbscope") == lrbscope.__version__
body = lrbscope.Body([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
assert lrbscope.collide(body, body).relation == "touching"
PYTHON
