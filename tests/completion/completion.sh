#!/usr/bin/env bash
# completion.sh LRBSCOPE: checks manual pages and completions against --help. Every command must have a page with all its options, which
# man formats without a warning. bash, zsh and fish must load their scripts, and bash and fish must complete commands,
# options and values. Missing programs are reported as skipped.
set -euo pipefail
lrbscope=$(realpath "$1")
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
export PATH=$(dirname "$lrbscope"):$PATH # the scripts ask the program
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "completion.sh: $1" >&2 && exit 1; }
absent() { echo "skipped: $1 is not installed"; }

# ---- manual pages, made by help2man
if command -v help2man >/dev/null; then
  sh "$here/../../tools/manual.sh" "$lrbscope" pages
  commands=$("$lrbscope" --help | sed -n '/^Subcommands:/I,/^$/s/^  \([a-z]\{1,\}\) .*/\1/p')
  [ "$(wc -w <<<"$commands")" -gt 15 ] || fail "found only these commands: $commands"
  options=0
  for command in $commands; do
    for option in $("$lrbscope" "$command" --help | grep -oE '^  +(-[a-z], *)?--[a-z-]+' | grep -oE -- '--[a-z-]+'); do
      options=$((options + 1))
      grep -qF -- "${option//-/\\-}" "pages/lrbscope-$command.1" || fail "lrbscope-$command.1: missing option $option"
    done
  done
  [ "$options" -gt 150 ] || fail "compared only $options options"
  grep -q '^lrbscope-golden-approve ' pages/lrbscope-golden-approve.1 || fail "the page of golden approve has another name"
  echo "manual: $options options on $(ls pages | wc -l) pages"
  if command -v man >/dev/null; then
    for page in pages/*; do
      said=$(LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 >/dev/null)
      [ -z "$said" ] || fail "man: $page: $said"
    done
  else
    absent man
  fi
else
  absent help2man
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
  zsh -f -c 'autoload -U compinit && compinit -u -d "$PWD/dump" && . ./lrbscope.zsh && whence _lrbscope' >/dev/null ||
    fail "zsh: cannot load its script"
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
