#!/usr/bin/env bash
# goldens.sh TREE LRBSCOPE: runs the commands of docs/golden.md under "A suite, from the first approval to a failure", makes the changes
# described there, and checks that the output is that of the page.
set -euo pipefail
page=$1/docs/golden.md
program=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
for name in bolt hinge lid valve; do
  cp "$1/examples/data/a.obj" $name.obj
  cat >$name.scenario.json <<END
{
  "name": "$name",
  "purpose": "A ball approaches a cube.",
  "bodies": { "a": { "file": "$name.obj" }, "b": { "generator": "ball", "parameters": { "frequency": 4 } } },
  "motion": { "kind": "sweep", "from": [3, 0.4, 0.6], "to": [1.6, 0.4, 0.6], "steps": 4 },
  "query": { "contacts": true },
  "frames": { "size": [480, 360], "views": [{ "from": [0.6, -0.7, 0.4] }] }
}
END
done
spoil() {
  rm bolt.obj
  sed -i 's/^v 1 1 1$/v 1 1 1.01/' hinge.obj
  sed -i 's/"from": \[0.6, -0.7/"from": [0.7, -0.6/' lid.scenario.json
  sed -i 's/\[1.6, 0.4/[2.1, 0.4/' valve.scenario.json
}
block() { awk -v what="$1" '/^## A suite/ { on = 1; next } /^## / { on = 0 } on && $0 == "```" what { inside = 1; next }
  /^```$/ { inside = 0 } on && inside' "$page"; }
commands=$(block sh)
[ "$(wc -l <<<"$commands")" -ge 7 ] || { echo "$page: found no commands"; exit 1; }
complain() { echo "$page: $1"; cat said; exit 1; }
# try CODE LINE: runs a line of the page and expects this exit code.
try() {
  local code=0
  lrbscope() { "$program" --quiet "$@" >said 2>&1; }
  echo "$2"
  eval "$2" || code=$?
  [ "$code" = "$1" ] || complain "exit code $code, expected $1: $2"
}
while IFS= read -r line; do
  case "$line" in
    *--junit*)
      spoil
      try 1 "$line"
      while IFS= read -r words; do
        grep -qF -- "$words" said || complain "missing output: \"$words\""
      done < <(block text | sed 's/^ *//')
      grep -q 'tests="4" failures="3" errors="1"' golden.xml || complain "golden.xml has other counts"
      [ "$(grep -c 'class="bad"\|FAIL' out/golden/index.html)" -ge 1 ] || complain "the page shows no failure"
      ;;
    *) try 0 "$line" ;;
  esac
  case "$line" in
    *list*) grep -qE '^4 goldens, [0-9]+ KiB$' said || complain "the list differs" ;;
    *--json*) [ "$(grep -c '"passed":true,"seconds":' said)" = 3 ] || complain "approved runs do not pass" ;;
  esac
done <<<"$commands"
echo "the output agrees with the page"
