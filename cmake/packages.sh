#!/usr/bin/env bash
# packages.sh PART...: installs the missing Debian packages of these parts of packages.txt, as root or through sudo. If sudo
# is missing, denied, or needs a password without a terminal, prints the packages to install and exits with 3.
# LRB_PACKAGES=skip: does nothing, for machines with the libraries from another source; CMake reports missing ones.
set -euo pipefail
[ "${LRB_PACKAGES:-}" != skip ] || exit 0
list="$(dirname "${BASH_SOURCE[0]}")/../packages.txt"

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "packages.sh: not a Debian system: install the equivalents of the packages in packages.txt yourself" >&2
  exit 0 # CMake reports missing packages
fi

# Another package may provide it: NodeSource's nodejs provides npm, and conflicts with Debian's.
installed=$(dpkg-query -W -f '${db:Status-Status} ${Package} ${Provides}\n' | sed -n 's/^installed //p' | sed 's/([^)]*)//g' | tr -s ', ' '\n')
missing=()
part=""
here=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
while read -r line releases; do
  case "$line" in
    "" | "#"*) ;;
    "["*"]") part="${line:1:-1}" ;;
    *)
      for wanted in "$@"; do
        if [ "$part" = "$wanted" ] && [[ " ${releases:-$here} " == *" $here "* ]] && ! grep -Fqx -- "$line" <<<"$installed"; then
          missing+=("$line")
        fi
      done
      ;;
  esac
done <"$list"
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || { [ -t 0 ] && sudo -v; }; }; then
    as_root=(sudo)
  else
    printf 'These Debian packages are missing:\n\n  apt-get install -y --no-install-recommends %s\n\nRun this command as root, then repeat. (LRB_PACKAGES=skip: build without installing.)\n' "${missing[*]}" >&2
    exit 3
  fi
fi

echo "Installing ${missing[*]}" >&2
install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}")
# Package lists may be missing or out of date: update once and retry.
if ! "${install[@]}" >/dev/null 2>&1; then
  "${as_root[@]}" apt-get update -q >&2 || { echo "packages.sh: apt-get update failed: is the network up?" >&2; exit 3; }
  "${install[@]}" >&2 || { echo "packages.sh: could not install ${missing[*]}" >&2; exit 3; }
fi
