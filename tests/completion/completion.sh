#!/usr/bin/env bash
# completion.sh LRBSCOPE: checks manual pages and completions against --help. Every command must have a page with all its options, which
# man and mandoc format without a warning. bash, zsh and fish must load their scripts, and bash and fish must complete commands,
# options and values. Missing programs are reported as skipped.
set -euo pipefail
lrbscope=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "completion.sh: $1" >&2 && exit 1; }
absent() { echo "skipped: $1 is not installed"; }

# ---- manual pages
"$lrbscope" --quiet manual -o pages >/dev/null
commands=$("$lrbscope" --help | sed -n '/^Subcommands:/I,/^$/s/^  \([a-z]\{1,\}\) .*/\1/p')
[ "$(wc -w <<<"$commands")" -gt 15 ] || fail "found only these commands: $commands"
options=0
has_options() { # PAGE HELP...: every long option of the help is in the page
  local option page=$1
  shift
  for option in $("$lrbscope" "$@" --help | grep -oE '^  +(-[a-z], *)?--[a-z-]+' | grep -oE -- '--[a-z-]+'); do
    options=$((options + 1))
    grep -qF -- "\\fB${option//-/\\-}\\fR" "$page" || fail "$page: missing option $option of lrbscope $*"
  done
}
for command in $commands; do
  page=pages/lrbscope-$command.1
  [ -s "$page" ] || fail "no page for $command"
  has_options "$page" "$command"
  for sub in $("$lrbscope" "$command" --help | sed -n '/^Subcommands:/I,/^$/s/^  \([a-z]\{1,\}\) .*/\1/p'); do
    has_options "$page" "$command" "$sub"
  done
  grep -qxF ".B $command" pages/lrbscope.1 || fail "lrbscope.1 does not list $command"
done
[ "$options" -gt 150 ] || fail "compared only $options options"
[ "$(ls pages | wc -l)" = $(($(wc -w <<<"$commands") + 1)) ] || fail "found pages of unknown commands"
cmp -s <("$lrbscope" manual query) pages/lrbscope-query.1 || fail "manual query prints another page"
echo "manual: $options options on $(ls pages | wc -l) pages"
if command -v man >/dev/null; then
  for page in pages/*; do
    said=$(LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 >/dev/null)
    [ -z "$said" ] || fail "man: $page: $said"
  done
else
  absent man
fi
if command -v mandoc >/dev/null; then
  said=$(mandoc -T lint -W warning pages/* | grep -v 'missing date' || true)
  [ -z "$said" ] || fail "mandoc: $said"
else
  absent mandoc
fi

# ---- completions
for shell in bash zsh fish; do "$lrbscope" --quiet completion $shell >"lrbscope.$shell"; done
bash -n lrbscope.bash
touch one.obj two.json
mkdir folder
complete_words() { # WORD...: prints the completions of the last word, sorted, on one line
  bash -c '. ./lrbscope.bash
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    _lrbscope 2>/dev/null
    printf "%s\n" "${COMPREPLY[@]}"' bash "$@" | sort -u | paste -sd' '
}
offers() { # EXPECTED WORD...
  local expected=$1 found
  shift
  found=$(complete_words "$@")
  [ "$found" = "$expected" ] || fail "bash: '$*': expected '$expected', found '$found'"
}
offers "query" lrbscope que
offers "paper" lrbscope pap
offers "query" lrbscope --quiet que
offers "approve" lrbscope golden app
offers "--poses" lrbscope query --po
offers "--quiet" lrbscope query --qui
offers "--picture-tolerance" lrbscope golden test --picture-t
offers "all any first" lrbscope query --mode ''
offers "any" lrbscope query a.obj b.obj --mode an
offers "any" lrbscope query --mode = an
offers "body,wrapper" lrbscope export x.obj --what body,wr
offers "stick_through_wall" lrbscope run sti
offers "one.obj" lrbscope collide one
offers "two.json" lrbscope query one.obj one.obj --poses tw
offers "folder" lrbscope run collision -o fo
offers "" lrbscope query --repeat ''
offers "--cases" lrbscope stability --cas
echo "bash: completes"
if command -v zsh >/dev/null; then
  zsh -n lrbscope.zsh
  zsh -f -c 'autoload -U compinit && compinit -u -d "$PWD/dump" && . ./lrbscope.zsh && whence -f _lrbscope_query' >zsh.out
  grep -q -- --poses zsh.out || fail "zsh: no function for query"
  echo "zsh: loads its script"
else
  absent zsh
fi
if command -v fish >/dev/null; then
  export HOME=$work # folder of fish's own files
  fish -n lrbscope.fish
  fish_offers() { # EXPECTED LINE
    local found
    found=$(fish -c "source lrbscope.fish; complete -C '$2'" | cut -f1 | sort -u | paste -sd' ')
    [ "$found" = "$1" ] || fail "fish: '$2': expected '$1', found '$found'"
  }
  fish_offers "query" "lrbscope que"
  fish_offers "approve" "lrbscope golden app"
  fish_offers "--poses" "lrbscope query --po"
  fish_offers "all any first" "lrbscope query --mode "
  fish_offers "stick_through_wall" "lrbscope run sti"
  echo "fish: completes"
else
  absent fish
fi
