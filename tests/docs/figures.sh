#!/usr/bin/env bash
# figures.sh TREE LRBSCOPE: runs the commands of docs/figures.md under "A figure of your own two meshes at 85 mm" with two cubes,
# checks that each figure has the requested width, and includes one in the page's LaTeX document if LaTeX is installed.
set -euo pipefail
page=$1/docs/figures.md
program=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cp "$1/examples/data/a.obj" .
awk '$1 == "v" { $2 += 5 } 1' a.obj >b.obj
block() { awk -v what="$1" '/^## A figure of your own/ { on = 1; next } /^## / { on = 0 } on && $0 == "```" what { inside = 1; next }
  /^```$/ { inside = 0 } on && inside' "$page"; }
commands=$(block sh)
[ "$(wc -l <<<"$commands")" -ge 3 ] || { echo "$page: found no commands"; exit 1; }
lrbscope() { "$program" -q "$@" >/dev/null; }
while IFS= read -r line; do
  echo "$line"
  eval "$line" || { echo "$page: failed: $line"; exit 1; }
done <<<"$commands"
for file in fig.pdf titled.pdf; do # the figure tests check the width of PDFs
  [ "$(head -c 5 "$file")" = %PDF- ] || { echo "$file: expected a PDF"; exit 1; }
done
grep -q 'width="85mm"' tests.svg || { echo "tests.svg: expected a width of 85 mm"; exit 1; }
[ -s fig.caption.txt ] || { echo "fig.caption.txt is empty"; exit 1; }
if command -v pdflatex >/dev/null; then
  block tex >paper.tex
  pdflatex -halt-on-error -interaction=batchmode paper.tex >/dev/null 2>&1 || { cat paper.log; exit 1; }
  [ -s paper.pdf ] || { echo "paper.pdf was not made"; exit 1; }
  echo "included by LaTeX"
else
  echo "skipped: including the figure; needs pdflatex"
fi
