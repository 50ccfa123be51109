#!/usr/bin/env bash
# python.sh PYTHON PACKAGE: runs the tests of the Python package in the folder PACKAGE. Exit code 77 (skipped) without it.
set -euo pipefail
python=${1:-} package=${2:-}
[ -n "$python" ] && [ -d "$package/lrbscope" ] || { echo "skipped: the Python module was not built: install the part [python] of packages.txt" && exit 77; }
for module in numpy pytest; do
  "$python" -c "import $module" 2>/dev/null || { echo "skipped: $python has no $module: install the part [python] of packages.txt" && exit 77; }
done
package=$(cd "$package" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")"
export PYTHONPATH=$package PYTHONDONTWRITEBYTECODE=1
# Ctrl-C, which tests send, is ignored in background jobs.
exec env --default-signal=INT "$python" -m pytest -q -p no:cacheprovider "${@:3}"
