#!/usr/bin/env bash
# cmake/format.sh [--fix]: fails if clang-format would change a C++ file; --fix: formats all of them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
how=(--dry-run --Werror)
case "${1:-}" in
  "") ;;
  --fix) how=(-i) ;;
  *) sed -n '2s/^# //p' "${BASH_SOURCE[0]}" >&2 && exit 2 ;;
esac
# Versions format differently; Debian 12 has this one.
program=$(command -v clang-format-14) || { echo "format.sh: clang-format-14 is missing: apt-get install clang-format-14" >&2 && exit 3; }
find engine trace render scenarios bench tools python examples tests '(' -name '*.cpp' -o -name '*.hpp' -o -name '*.inl' ')' -print0 |
  xargs -0 -P "$(nproc)" -n 40 "$program" --style=file "${how[@]}" ||
  { echo "format.sh: run cmake/format.sh --fix" >&2 && exit 1; }
