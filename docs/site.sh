#!/usr/bin/env bash
# docs/site.sh OUT [API]: makes a site of these pages in OUT/html, with mkdocs and mkdocstrings (Debian's packages), which must not warn. Targets of links
# out of this folder are copied. API: the folder with Doxygen's HTML, if it exists. Then checks that every link and anchor in the site
# has a target, and that no page loads external resources.
set -euo pipefail
docs=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tree=$(dirname "$docs")
out=${1:?a folder}
api=${2:-}
needs="mkdocs mkdocstrings mkdocstrings-python-handlers black"
/usr/bin/python3 -c 'import mkdocs, mkdocstrings_handlers.python, black' 2>/dev/null ||
  { echo "site.sh: needs $needs (apt-get install $needs)" >&2 && exit 77; }
rm -rf "$out"
mkdir -p "$out/pages/source"
out=$(cd "$out" && pwd)

cp "$docs"/*.md "$docs"/*.png "$docs"/*.svg "$out/pages/"
mv "$out/pages/start.md" "$out/pages/index.md"
cp "$tree/CHANGELOG.md" "$out/pages/changelog.md"
cp "$tree/CONTRIBUTING.md" "$out/pages/contributing.md"
{
  echo "# C++ reference"
  echo
  if [ -n "$api" ]; then
    cp -r "$api" "$out/pages/api"
    echo "[The reference of all public headers](api/index.html), made by Doxygen."
  else
    echo "\`cmake --build --preset release --target api\` makes the reference of all public headers with Doxygen. The headers:"
  fi
  echo
  (cd "$tree" && find engine/include trace/include render/include -name '*.hpp' -not -path '*/core/*' | LC_ALL=C sort |
    sed 's|^[a-z]*/include/\(.*\)|- [`<\1>`](../&)|')
} >"$out/pages/reference.md"

# The Python reference, by mkdocstrings, of the sources and of the stub of the built module, which has its texts.
stub=$tree/build/release/python/lrbscope/_core.pyi
modules="_core _picture collision report many fcl capture"
mkdir -p "$out/package/lrbscope"
cp "$tree"/python/lrbscope/*.py "$out/package/lrbscope/"
if [ -f "$stub" ]; then cp "$stub" "$out/package/lrbscope/_core.py"; else
  echo "site.sh: the Python reference lacks the compiled classes: build the module first" >&2
  modules=${modules#_core }
fi
# Examples become blocks of code, up to an empty line or the end of the text.
for file in "$out"/package/lrbscope/*.py; do
  awk '/^ *>>> / && !inside { inside = 1; print "```python" }
    inside && (/^ *$/ || /"""$/) { inside = 0; ends = sub(/"""$/, ""); print; print ends ? "```\n\"\"\"" : "```\n"; next }
    { print }' "$file" >"$file.text" && mv "$file.text" "$file"
done
{
  printf '# Python reference\n\n## lrbscope\n'
  for module in $modules; do
    case $module in many | fcl | capture) printf '\n## lrbscope.%s\n' "$module" ;; esac
    printf '\n::: lrbscope.%s\n' "$module"
    # Of these, the package exports some names.
    case $module in
      _picture) printf '    options: {members: [Picture]}\n' ;;
      collision) printf '    options: {members: [CollisionManager, ContactData, DistanceData]}\n' ;;
      report) printf '    options: {members: [Interference, Report]}\n' ;;
    esac
  done
} >"$out/pages/python_reference.md"

# mkdocs, unlike GitHub, needs a blank line before lists. Targets of links out of the folder are copied.
python3 - "$tree" "$out/pages" <<'P'
import glob, os, re, shutil, sys

tree, pages = sys.argv[1:]
renamed = {"CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md", "README.md": "index.md"}


def target(page, link):
    path, _, anchor = link.partition("#")
    if "://" in link or link.startswith("mailto:") or not path:
        return link
    if page in ("changelog.md", "contributing.md"):  # links relative to the top of the tree
        path = path[len("docs/"):] if path.startswith("docs/") else "../" + path
    if path == "start.md":
        path = "index.md"
    if not path.startswith("../") and not os.path.exists(os.path.join(pages, path)):
        path = "../docs/" + path
    if not path.startswith("../"):
        return path + ("#" + anchor if anchor else "")
    name = os.path.normpath(path[len("../"):])
    if name in renamed:
        keep = anchor and name != "README.md"  # the index, which is not the README, has other headings
        return renamed[name] + ("#" + anchor if keep else "")
    copy = "source/" + name.replace("/", "_") + ".txt"
    source = os.path.join(tree, name)
    if os.path.isdir(source):
        with open(os.path.join(pages, copy), "w") as listing:
            listing.write("".join(os.path.join(name, f) + "\n" for f in sorted(os.listdir(source))))
    else:
        shutil.copyfile(source, os.path.join(pages, copy))
    return copy


for file in glob.glob(pages + "/*.md"):
    page = os.path.basename(file)
    lines, fenced = [], False
    for line in open(file):
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced:
            line = re.sub(r"\]\(([^) ]+)\)", lambda m: "](" + target(page, m.group(1)) + ")", line)
            starts = re.match(r"(- |\d+\. )", line)
            if starts and lines and lines[-1].strip() and not re.match(r"(- |\d+\. |  )", lines[-1]):
                lines.append("\n")
        lines.append(line)
    open(file, "w").writelines(lines)

main = pages + "/api/index.html"  # made from library.md, like one of the pages
if os.path.exists(main):
    text = re.sub(r'href="(\.\./(?:(?!\.html)[^"])+)"', lambda m: 'href="../' + target("library.md", m.group(1)) + '"', open(main).read())
    open(main, "w").write(text)
P

# Omits missing pages from the menu.
while IFS= read -r line; do
  page=$(sed -n 's/.*: \([a-z]*\.md\)$/\1/p' <<<"$line")
  [ -z "$page" ] || [ -f "$out/pages/$page" ] || { echo "site.sh: missing page: $page" >&2 && continue; }
  printf '%s\n' "$line"
done <"$docs/mkdocs.yml" >"$out/mkdocs.yml"
(cd "$out" && mkdocs build --strict --quiet)

python3 - "$out/html" <<'P'
import glob, os, re, sys, urllib.parse

site, bad, count = sys.argv[1], [], 0
texts = {f: open(f, encoding="utf-8").read() for f in glob.glob(site + "/*.html") + glob.glob(site + "/api/index.html")}
ids = {f: set(re.findall(r'\bid="([^"]+)"', t)) for f, t in texts.items()}
for file, text in texts.items():
    if file.endswith("/404.html"):
        continue  # its links are absolute
    for fetched in re.findall(r'<(?:script|img|link)[^>]+(?:src|href)="((?:https?:)?//[^"]+)"', text):
        bad.append("%s loads %s" % (os.path.relpath(file, site), fetched))
    for link in re.findall(r'(?:href|src)="([^"]+)"', text):
        if re.match(r"[a-z]+:|//|#$", link):
            continue
        path, _, anchor = urllib.parse.unquote(link).partition("#")
        at = os.path.normpath(os.path.join(os.path.dirname(file), path)) if path else file
        count += 1
        if not os.path.exists(at):
            bad.append("%s: no %s" % (os.path.relpath(file, site), link))
        elif anchor and at in ids and anchor not in ids[at]:
            bad.append("%s: no heading %s" % (os.path.relpath(file, site), link))
print("\n".join(sorted(set(bad))) or "%d pages, %d links: all have a target" % (len(texts), count))
sys.exit(bool(bad))
P
echo "$out/html/index.html"
