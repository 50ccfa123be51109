# Sourced by the scripts of this folder: finds Chromium, or exits with 77 (skipped); inserts scripts into pages.
# Expects `here`, this folder; sets `browser`, the program, and `work`, a folder removed on exit.
browser=""
for name in chromium chromium-browser google-chrome; do
  if command -v "$name" >/dev/null; then browser=$name && break; fi
done
if [ -z "$browser" ]; then
  echo "$(basename "$0"): skipped: needs Chromium (Debian's package chromium)"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
webgl=(--use-angle=swiftshader --enable-unsafe-swiftshader --ignore-gpu-blocklist)

script() { printf '<script>%s\n</script>\n' "$(cat "$here/$1")"; } # FILE

# with_scripts PAGE SCRIPT: prints the page with watch.js before all its scripts, and another one after them.
with_scripts() {
  sed '/^<head>$/q' "$1"
  script watch.js
  sed -e '1,/^<head>$/d' -e '/^<\/body>$/,$d' "$1"
  script "$2"
  echo '</body></html>'
}

# unmarked: decodes the HTML entities of a text without tags.
unmarked() { sed -e 's/&lt;/</g' -e 's/&gt;/>/g' -e 's/&quot;/"/g' -e 's/&amp;/\&/g'; }

# browse OPTION... PAGE: opens a page in headless Chromium and prints its final document.
browse() {
  HOME=$work command "$browser" --headless --no-sandbox --disable-dev-shm-usage --user-data-dir="$(mktemp -d -p "$work")" \
    --hide-scrollbars "$@" --dump-dom 2>>"$work/browser.log"
}
