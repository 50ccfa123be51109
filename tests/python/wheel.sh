#!/usr/bin/env bash
# wheel.sh WHEEL PYTHON: checks that the programs of a wheel need no library but those of glibc and of gcc, of the versions that the
# wheel's tag allows; installs it in a new environment of PYTHON, without an index (which needs NumPy there), and runs the program
# and a query; then the tests of the package, if PYTHON has pytest and pictures can be drawn.
set -euo pipefail
wheel=$(readlink -f "${1:?a wheel}") python=${2:?a Python}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "wheel.sh: $1" >&2 && exit 1; }

"$python" -m zipfile -e "$wheel" "$work/files"
binaries=("$work"/files/*.data/scripts/lrbscope "$work"/files/lrbscope/_core.*.so)
if command -v objdump >/dev/null; then # binutils
  allowed='^(lib(c|m|dl|rt|pthread|gcc_s)\.so\.[0-9]+|libstdc\+\+\.so\.6|ld-linux-[a-z0-9_-]*\.so\.[0-9])$'
  declared=$(sed -n 's/^Tag: .*-manylinux_\([0-9]*\)_\([0-9]*\)_.*/\1.\2/p' "$work"/files/*.dist-info/WHEEL | head -n 1)
  for binary in "${binaries[@]}"; do
    other=$(objdump -p "$binary" | awk '$1 == "NEEDED" { print $2 }' | grep -vE "$allowed" || true)
    [ -z "$other" ] || fail "$(basename "$binary") needs $(tr '\n' ' ' <<<"$other")"
    newest=$(objdump -T "$binary" | grep -oE 'GLIBC_[0-9.]+' | sed 's/GLIBC_//' | sort -uV | tail -n 1)
    if [ -n "$declared" ] && [ "$(printf '%s\n' "$declared" "$newest" | sort -V | tail -n 1)" != "$declared" ]; then
      fail "$(basename "$binary") needs glibc $newest, but the tag says $declared"
    fi
    echo "$(basename "$binary"): $(objdump -p "$binary" | awk '$1 == "NEEDED" { print $2 }' | tr '\n' ' ')with glibc $newest or later"
  done
fi
for file in share/lrbscope/DejaVuSans.ttf share/lrbscope/DejaVuSans-Bold.ttf share/lrbscope/third_party_licences.txt; do
  [ -s "$work"/files/*.data/data/$file ] || fail "lacks $file"
done
for of in cairo freetype pixman libpng zlib tbb dejavu eigen; do
  grep -qi "^==== .*$of" "$work"/files/*.data/data/share/lrbscope/third_party_licences.txt || fail "lacks the licence of $of"
done

"$python" -m venv --system-site-packages "$work/venv"
"$work/venv/bin/python" -m pip --disable-pip-version-check install -q --no-index --no-deps "$wheel"
cd "$work"
PATH=$work/venv/bin:$PATH
[ "$(command -v lrbscope)" = "$work/venv/bin/lrbscope" ] || fail "the program is not in PATH"
version=$(lrbscope --version)
"$work/venv/bin/python" - "$version" <<'PYTHON'
import importlib.metadata, sys
import lrbscope, numpy
assert "venv" in lrbscope.__file__, lrbscope.__file__
assert importlib.metadata.version("lrbscope") == lrbscope.__version__ and lrbscope.__version__ in sys.argv[1], sys.argv[1]
body = lrbscope.Body([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
assert lrbscope.collide(body, body).relation == "touching"
print("Python %s, NumPy %s: %s" % (sys.version.split()[0], numpy.__version__, lrbscope.__file__.split("/venv/")[1]))
PYTHON
# Fonts are the wheel's. Pictures are drawn, or refused in one line, with or without Mesa.
lrbscope doctor >doctor.txt 2>&1 || true
grep -q "$work/venv/share/lrbscope/DejaVuSans.ttf" doctor.txt || { cat doctor.txt && fail "the program does not use the fonts of the wheel"; }
drawn=0
if lrbscope --quiet run collision -o run >run.txt 2>&1; then
  [ -s run/index.html ] && echo "lrbscope run: drawn" && drawn=1
else
  code=$?
  [ $code = 3 ] && [ "$(wc -l <run.txt)" = 1 ] || { cat run.txt && fail "lrbscope run ended with $code"; }
  echo "lrbscope run: refused: $(cat run.txt)"
  lrbscope --quiet run collision --frames none -o without || fail "a run without frames failed"
fi
if [ $drawn = 1 ] && "$python" -c 'import pytest' 2>/dev/null; then
  bash "$here/python.sh" "$work/venv/bin/python" "$("$work/venv/bin/python" -c 'import os, lrbscope; print(os.path.dirname(os.path.dirname(lrbscope.__file__)))')"
fi
