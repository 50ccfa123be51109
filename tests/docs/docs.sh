#!/usr/bin/env bash
# docs.sh TREE [LRBSCOPE]: checks the pages of the tree: every relative link and anchor of every .md leads somewhere;
# docs/rooms.svg is what docs/rooms.sh draws; and, given the program, every `lrbscope` line of a shell block names a command
# and options that its --help has; each block of code is run by a test (runner() says which); and a block below the line <!-- examples/FILE --> is that file.
set -euo pipefail
cd "$1"
program=${2:-}
bad=0
complain() { echo "$1" && bad=1; }
pages=$(find . -name '*.md' -not -path './build*' -not -path './out/*' -not -path './.git/*' | sort)

# Prints the anchors of a page, as hosts make them of headings.
anchors() {
  sed '/^```/,/^```/d' "$1" | sed -n 's/^##* *//p' | tr '[:upper:]' '[:lower:]' | sed 's/[^a-z0-9 _-]//g; s/ /-/g'
}

links=0
for page in $pages; do
  while IFS= read -r link; do
    case "$link" in *://* | mailto:*) continue ;; esac
    links=$((links + 1))
    target=$(dirname "$page")/${link%%#*}
    [ "${link%%#*}" != "" ] || target=$page
    [ -e "$target" ] || { complain "$page: leads to $link, which is not there"; continue; }
    case "$link" in
      *#*) anchors "$target" | grep -qxF -- "${link#*#}" || complain "$page: leads to $link, but $target has no such heading" ;;
    esac
  done < <(sed '/^```/,/^```/d' "$page" | grep -oE '\]\([^) ]+\)' | sed 's/^](//; s/)$//')
done
[ "$links" -gt 20 ] || complain "docs.sh: found only $links links"

bash docs/rooms.sh | cmp -s - docs/rooms.svg || complain "docs/rooms.svg is not what tests/layers/rooms.txt says: docs/rooms.sh >docs/rooms.svg"

# Every block is run by a test that names its page, or runs those of all pages.
runner() { # LANGUAGE: prints the file of the test
  case "$1" in
    cpp | cmake) echo tests/package/CMakeLists.txt ;;
    python) echo tests/python/test_docs.py ;;
    sh) echo tests/docs/commands.py ;;
    tex) echo tests/docs/figures.sh ;;
    text) echo tests/docs/goldens.sh ;; # what commands print
    *) return 1 ;;
  esac
}
for page in README.md docs/*.md; do
  for language in $(sed -n 's/^```\([a-z]\+\)$/\1/p' "$page" | sort -u); do
    test=$(runner "$language") || { complain "$page: nobody runs blocks of $language"; continue; }
    [ -e "$test" ] || complain "$test is not there, which runs blocks of $language"
    case "$language" in cpp | cmake | python | text) grep -q "$page" "$test" || complain "$page: its blocks of $language are not run by $test" ;; esac
  done
done

# Every example is linked from a page; the blocks that show one are its text.
shown=0
for page in $pages; do
  while IFS= read -r file; do
    shown=$((shown + 1))
    [ -e "$file" ] || { complain "$page: shows $file, which does not exist"; continue; }
    block=$(awk -v mark="<!-- $file -->" '$0 == mark { on = 1; next } on && /^```/ { if (inside) exit; inside = 1; next } on && !inside { exit } inside' "$page")
    [ "$block" = "$(cat "$file")" ] || complain "$page: the block below <!-- $file --> differs from $file: copy the file"
  done < <(sed -n 's/^<!-- \(examples\/.*\) -->$/\1/p' "$page")
done
[ "$shown" -ge 4 ] || complain "docs.sh: found only $shown blocks that show examples"
for file in examples/*.{cpp,py,sh}; do
  grep -qF "](../$file)" docs/*.md || complain "$file: no page in docs/ links to it"
done

commands=0
if [ -n "$program" ]; then
  for page in $pages; do
    while IFS= read -r line; do
      commands=$((commands + 1))
      line=${line%%#*}
      read -ra words <<<"$line"
      command=${words[1]:-}
      case "$command" in "" | -*) continue ;; esac
      # Options of a subcommand, such as `golden test`, stand in its own help.
      help=$("$program" "$command" --help 2>/dev/null) || { complain "$page: lrbscope has no command $command"; continue; }
      sub=${words[2]:-}
      if [[ "$sub" =~ ^[a-z]+$ ]] && more=$("$program" "$command" "$sub" --help 2>/dev/null); then help+=$more; fi
      for word in "${words[@]:2}"; do
        [[ "$word" =~ ^--?[a-z] ]] || continue
        grep -qE -- "(^|[ ,!])${word%%=*}([ ,=]|$)" <<<"$help" || complain "$page: lrbscope $command has no option $word"
      done
    done < <(awk '/^```sh/ { on = 1; next } /^```/ { on = 0 } on' "$page" | grep -oE '(^|[ /$])lrbscope [a-z][^|>'"'"']*' | sed 's/^[^l]*//')
  done
  [ "$commands" -gt 20 ] || complain "docs.sh: found only $commands commands"
fi
[ "$bad" = 0 ] && echo "$links links, $commands commands: all lead somewhere"
exit "$bad"
