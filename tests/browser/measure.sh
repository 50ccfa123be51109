#!/usr/bin/env bash
# measure.sh LRBSCOPE [STABILITY_PAGE]: makes a page of each kind, opens it in Chromium at 400, 1,000, 1,280 and 3,000 pixels, and dark at
# 400 and 1,280, and measures it (measure.js): cut off or overlapping text, low contrast, a run's view that is small or covered, and
# messages in the console.
# STABILITY_PAGE: a program that writes a page from made-up results. Skipped (77) without Chromium.
# measure.sh --pages PAGE...: measures only these pages.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/chromium.sh"

# make_pages LRBSCOPE [STABILITY_PAGE]: writes a page of each kind, and stores their paths in `pages`.
make_pages() {
  local lrbscope=$1 out=$work/out
  cp "$here"/*.json "$here"/open.obj "$work"
  sed 's/0\.02,/0.021,/' "$work/meet.json" >"$work/later.json"
  for run in meet later build dent plane open near; do "$lrbscope" --quiet run "$work/$run.json" -o "$out/$run" >/dev/null; done
  "$lrbscope" --quiet compare "$out/meet" "$out/later" -o "$out/compare" >/dev/null || [ $? = 1 ] # the runs differ
  "$lrbscope" --quiet golden approve --goldens "$work/goldens" --size 320x240 "$work/meet.json" "$work/build.json" >/dev/null
  sed -i 's/0\.02,/0.021,/' "$work/meet.json"
  "$lrbscope" --quiet golden report --goldens "$work/goldens" -o "$out/golden" >/dev/null || true # the page shows a failure
  "$lrbscope" --quiet tree "$out/meet/a.lrb" -o "$out/tree" >/dev/null
  pages=()
  for name in meet build dent plane open near compare golden tree; do pages+=("$out/$name/index.html"); done
  if [ -n "${2:-}" ]; then
    "$2" "$out/stability" >/dev/null
    pages+=("$out/stability/index.html")
  fi
}

# measure light|dark: opens all pages at all widths, one after the other, and prints the findings.
measure() {
  local scheme=1 budget=2000000
  local sizes='[400, 800], [1000, 900], [1280, 800], [3000, 900]'
  [ "$1" = dark ] && scheme=0 sizes='[400, 800], [1280, 800]' # styles differ in colours alone
  sed "s/^const sizes.*/const sizes = [$sizes];/" "$work/measure.html" >"$work/$1.html"
  browse --window-size=3200,1000 --blink-settings="preferredColorScheme=$scheme" --virtual-time-budget=$budget \
    "${webgl[@]}" "file://$work/$1.html" | sed -n '/<pre id="measured">/,/<\/pre>/p' |
    sed -e 's/.*<pre id="measured">//' -e 's/<\/pre>.*//' -e "s/^/$1, /" | unmarked
}

if [ "$1" = --pages ]; then
  shift
  pages=("$@")
else
  make_pages "$@"
fi
urls=()
for page in "${pages[@]}"; do
  page=$(realpath "$page")
  with_scripts "$page" measure.js >"${page%.html}.measured.html"
  urls+=("\"file://${page%.html}.measured.html\"")
done
{
  echo '<!DOCTYPE html><body style="margin: 0"><pre id="measured"></pre><script>'
  echo "const pages = [$(IFS=,; echo "${urls[*]}")];"
  echo 'const sizes = [];'
  cat "$here/measure_all.js"
  echo '</script></body>'
} >"$work/measure.html"
for scheme in light dark; do measure $scheme >"$work/$scheme.txt" & done
wait
cat "$work"/light.txt "$work"/dark.txt
for scheme in light dark; do
  if grep -q 'FAIL' "$work/$scheme.txt" || ! grep -q "^$scheme, done" "$work/$scheme.txt"; then
    echo "measure.sh: pages fail, $scheme" >&2
    tail -3 "$work/browser.log" >&2
    failed=1
  fi
done
exit "${failed:-0}"
