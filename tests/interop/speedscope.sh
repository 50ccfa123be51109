#!/usr/bin/env bash
# speedscope.sh TRACE TITLE: has speedscope (npm's package, in Chromium without a window) open a trace in the trace event
# format, as Perfetto's and Chrome's traces are; fails if it warns of anything, or if its page does not show TITLE. Skipped
# (77) where one of them is not here. LRB_NODE_MODULES: where speedscope is installed, if node does not find it.
set -euo pipefail
trace=$(realpath "$1")
title=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export NODE_PATH=${LRB_NODE_MODULES:-$(npm root -g 2>/dev/null || true)}
page=$(node -p 'require("path").join(require.resolve("speedscope/package.json"), "../dist/release/index.html")' 2>/dev/null || true)
[ -f "$page" ] || { echo "speedscope is not here (npm install speedscope): not asked" && exit 77; }
source "$here/../browser/chromium.sh"

# As speedscope's own program hands a file over: a script that calls it with the bytes.
{
  printf 'speedscope.loadFileFromBase64("trace.json", "'
  base64 --wrap=0 "$trace"
  printf '")\n'
} >"$work/load.js"
browse "${webgl[@]}" --allow-file-access-from-files --enable-logging=stderr --virtual-time-budget=60000 \
  "file://$page#localProfilePath=$work/load.js" >"$work/page.html"

# Chromium logs warnings as it does all else, so whatever is not one of the lines of a good import is one.
told=$(sed -n 's/.*:CONSOLE[^"]*"\(.*\)", source: .*/\1/p' "$work/browser.log")
good='^speedscope v|^WebGL initialized|GL Driver Message|^Importing as Trace Event Format profile$|^import: '
if grep -vE "$good" <<<"$told" || ! grep -q '^Importing as Trace Event' <<<"$told"; then
  echo "speedscope warns of $1, or does not take it for a trace" && exit 1
fi
grep -qF "$title" "$work/page.html" || { echo "speedscope's page of $1 does not show \"$title\"" && exit 1; }
echo "speedscope: opens $(basename "$trace") without a warning"
