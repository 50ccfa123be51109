#!/usr/bin/env bash
# docs.sh TREE [LRBSCOPE]: checks all .md files of the tree.
# - Every relative link and anchor has a target.
# - docs/modules.svg shows the dependencies in tests/layers/modules.txt.
# - The recipes for vcpkg, Conan and conda parse, and name this version, options that there are, and files that are installed.
# - Every code block is run by a test (see runner()); a block below the line <!-- examples/FILE --> is a copy of that file.
# - With the program: every `lrbscope` line of a shell block, or of a template in examples/ci, has a command and options of its --help.
set -euo pipefail
cd "$1"
program=${2:-}
bad=0
complain() { echo "$1" && bad=1; }
pages=$(find . -name '*.md' -not -path './build*' -not -path './out/*' -not -path './.git/*' | sort)

# The anchors of each page, between line breaks, as GitHub makes them from headings.
declare -A anchors
for page in $pages; do
  anchors[$page]=$'\n'$(sed '/^```/,/^```/d' "$page" | sed -n 's/^##* *//p' | tr '[:upper:]' '[:lower:]' | sed 's/[^a-z0-9 _-]//g; s/ /-/g')$'\n'
done

links=0
for page in $pages; do
  while IFS= read -r link; do
    case "$link" in *://* | mailto:*) continue ;; esac
    links=$((links + 1))
    target=${page%/*}/${link%%#*}
    [ "${link%%#*}" != "" ] || target=$page
    [ -e "$target" ] || { complain "$page: no target for the link $link"; continue; }
    [[ "$link" == *#* ]] || continue
    [[ "$target" != *..* ]] || target=./$(realpath --relative-to=. "$target")
    [[ "${anchors[$target]:-}" == *$'\n'"${link#*#}"$'\n'* ]] || complain "$page: link $link: $target has no such heading"
  done < <(sed '/^```/,/^```/d' "$page" | grep -oE '\]\([^) ]+\)' | sed 's/^](//; s/)$//')
done
[ "$links" -gt 20 ] || complain "docs.sh: found only $links links"

grep -qxF -- "<!-- $(bash docs/modules.sh --sum) -->" docs/modules.svg || complain "docs/modules.svg differs from tests/layers/modules.txt; run docs/modules.sh >docs/modules.svg"

python3 - <<'END' || complain "cmake/recipes disagree with the tree"
import ast, glob, json, re
cmake, conan, port, manifest, conda = (open(f).read() for f in ["CMakeLists.txt"] + ["cmake/recipes/" + f for f in ("conanfile.py", "lrbscope/portfile.cmake", "lrbscope/vcpkg.json", "recipe.yaml")])
version = re.search(r"project\(lrbscope VERSION ([0-9.]+)", cmake)[1]
assert json.loads(manifest)["version-semver"] == version and 'version = "%s"' % version in conan and 'version: "%s"' % version in conda
for text in conan, port, conda:
    options = re.findall("LRB_[A-Z_]+", text)
    assert len(options) == 3 and all("set(%s " % option in cmake for option in options), options
copied = [ast.literal_eval(node.iter) for node in ast.walk(ast.parse(conan)) if isinstance(node, ast.For)]
for file in [*copied[0], "engine/" + re.search("include/[a-z/.]+", conda)[0]]:
    assert glob.glob(file), file
END

# Every block is run by a test that names its page, or that covers all pages.
runner() { # LANGUAGE: prints the file of the test
  case "$1" in
    cpp | cmake) echo tests/package/CMakeLists.txt ;;
    python) echo tests/python/test_docs.py ;;
    c) echo tests/trace/capture_header.sh ;;
    sh) echo tests/docs/commands.py ;;
    tex) echo tests/docs/figures.sh ;;
    text) echo tests/docs/goldens.sh ;; # output of commands
    *) return 1 ;;
  esac
}
for page in README.md docs/*.md; do
  for language in $(sed -n 's/^```\([a-z]\+\)$/\1/p' "$page" | sort -u); do
    test=$(runner "$language") || { complain "$page: no test runs $language blocks"; continue; }
    [ -e "$test" ] || complain "missing test of $language blocks: $test"
    case "$language" in c | cpp | cmake | python | text) grep -q "$page" "$test" || complain "$page: $test does not run its $language blocks" ;; esac
  done
done

# Every example is linked from a page; blocks that show an example are copies of it.
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
for file in examples/*.{cpp,py,sh} examples/capture/* examples/ci/*; do
  grep -qF "](../$file)" docs/*.md || complain "$file: no page in docs/ links to it"
done

commands=0
if [ -n "$program" ]; then
  declare -A helps # of each command, and of its subcommands, such as `golden test`; empty: there is none
  help_of() { # WORD...: sets `help`
    [ -n "${helps[$*]+known}" ] || helps[$*]=$("$program" "$@" --help 2>/dev/null) || helps[$*]=""
    help=${helps[$*]}
  }
  for page in $pages examples/ci/*.yml; do
    while IFS= read -r line; do
      commands=$((commands + 1))
      line=${line%%#*}
      read -ra words <<<"$line"
      command=${words[1]:-}
      case "$command" in "" | -*) continue ;; esac
      help_of "$command"
      [ -n "$help" ] || { complain "$page: lrbscope has no command $command"; continue; }
      if [[ "${words[2]:-}" =~ ^[a-z]+$ ]]; then
        all=$help
        help_of "$command" "${words[2]}"
        help=$all$help
      fi
      for word in "${words[@]:2}"; do
        [[ "$word" =~ ^--?[a-z] ]] || continue
        [[ $'\n'$help$'\n' =~ [\ ,!$'\n']"${word%%=*}"[\ ,=$'\n'] ]] || complain "$page: lrbscope $command has no option $word"
      done
    done < <({ case "$page" in *.yml) sed '/^#/d' "$page" ;; *) awk '/^```sh/ { on = 1; next } /^```/ { on = 0 } on' "$page" ;; esac; } | grep -oE '(^|[ /$])lrbscope [a-z][^|>'"'"']*' | sed 's/^[^l]*//')
  done
  [ "$commands" -gt 20 ] || complain "docs.sh: found only $commands commands"
fi
[ "$bad" = 0 ] && echo "$links links, $commands commands: all valid"
exit "$bad"
