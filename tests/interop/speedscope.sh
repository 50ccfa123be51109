#!/usr/bin/env bash
# speedscope.sh TRACE TITLE: opens a trace in Chrome's trace event format in speedscope (npm's package, in headless Chromium).
# Fails on any warning, or if the page does not show TITLE. Skipped (77) without speedscope or Chromium.
# LRB_NODE_MODULES: folder of speedscope, if node does not find it.
set -euo pipefail
trace=$(realpath "$1")
title=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export NODE_PATH=${LRB_NODE_MODULES:-$(npm root -g 2>/dev/null || true)}
page=$(node -p 'require("path").join(require.resolve("speedscope/package.json"), "../dist/release/index.html")' 2>/dev/null || true)
[ -f "$page" ] || { echo "skipped: speedscope is not installed (npm install speedscope)" && exit 77; }
source "$here/../browser/chromium.sh"

# Passes the file as speedscope's own program does: a script that calls it with the bytes.
{
  printf 'speedscope.loadFileFromBase64("trace.json", "'
  base64 --wrap=0 "$trace"
  printf '")\n'
} >"$work/load.js"
browse "${webgl[@]}" --allow-file-access-from-files --enable-logging=stderr --virtual-time-budget=60000 \
  "file://$page#localProfilePath=$work/load.js" >"$work/page.html"

# Chromium logs warnings like any other line, so every line that a good import does not print counts as one.
report=$(sed -n 's/.*:CONSOLE[^"]*"\(.*\)", source: .*/\1/p' "$work/browser.log")
good='^speedscope v|^WebGL initialized|GL Driver Message|^Importing as Trace Event Format profile$|^import: '
if grep -vE "$good" <<<"$report" || ! grep -q '^Importing as Trace Event' <<<"$report"; then
  echo "speedscope: $1: warning, or not recognised as a trace" && exit 1
fi
grep -qF "$title" "$work/page.html" || { echo "speedscope: the page of $1 does not show \"$title\"" && exit 1; }
echo "speedscope: opens $(basename "$trace") without a warning"
