#!/usr/bin/env bash
# tests/fresh_install/fresh_install.sh [--suite S] [--commit C] [--wheel FILE] [--no-cache] [--keep] [STEP...]: tests the README's two
# commands on a minimal Debian: bookworm (12, the default of S), trixie (13) or forky (testing). Makes a root file system with debootstrap, from the
# package sources of this machine, clones commit C (HEAD) into it, and takes the steps there in a clean environment, as root.
# STEP: stranger (a user without root and packages: both commands name the packages), run (./run), check (./check), user (both commands
# of a user without root, after these), debs (makes the Debian packages, and installs them in another minimal root, which runs the program
# and builds an external project), or a part of ./check. Without STEP: stranger run check user. Prints the time of every step.
# --wheel: instead of all this, installs a wheel for the Python of S in the root, in which there is no compiler and no library but those of
# Python and NumPy, and runs the program and the tests of the package; then again with Mesa (steps: root clone wheel drawn).
# Cached in ${XDG_CACHE_HOME:-~/.cache}/lrbscope-bare/S: the minimal root and downloaded packages; this machine's compiler cache is
# used as well. --no-cache disables all three, to measure times. --keep keeps the root for inspection.
# Exit codes: 1 if a step failed, 2 for unknown arguments, 3 if it may not run or cannot make a root.
# Needs root and debootstrap. Runs in its own mount namespace, so that no mount remains.
set -euo pipefail
script=$(readlink -f "${BASH_SOURCE[0]}")
here=$(dirname "$script")
repository=$(cd "$here/../.." && pwd)
home=/root/lrbscope # the clone, inside the root

usage() { sed -n '2,14s/^# //p' "$script" >&2 && exit 2; }
refuse() { echo "fresh_install.sh: $1" >&2 && exit 3; }

# ---- the package sources of this machine

# Prints this machine's sources of Debian's own packages, one "URI RELEASE" per line; by default Debian's servers. On a
# machine with another release of Debian, the sources of the suite have the same addresses.
debian_sources() {
  local release found
  for release in "$suite" "$(. /etc/os-release && echo "${VERSION_CODENAME:-none}")"; do
    found=$(apt-get indextargets --format '$(REPO_URI)|$(RELEASE)|$(COMPONENT)|$(ORIGIN)' 'Created-By: Packages' 2>/dev/null |
      awk -F'|' -v r="$release" -v s="$suite" '($2 == r || $2 == r "-updates" || $2 == r "-security") && $3 == "main" &&
                               ($4 == "" || $4 == "Debian" || $4 ~ /^\$/) { sub(r, s, $2); print $1, $2 }' | sort -u || true)
    ! grep -q " $suite$" <<<"$found" || break
    found="http://deb.debian.org/debian $suite
http://deb.debian.org/debian $suite-updates
http://deb.debian.org/debian-security $suite-security"
  done
  echo "$found"
}

# Prints apt's settings of this machine for proxies, certificates and retries.
apt_transport() {
  apt-config dump 2>/dev/null | grep -iE '^Acquire::(https?|Retries)\b' || true
  if [ -n "${http_proxy:-}" ]; then echo "Acquire::http::Proxy \"$http_proxy\";"; fi
  if [ -n "${https_proxy:-}" ]; then echo "Acquire::https::Proxy \"$https_proxy\";"; fi
}

# ---- the root file system

# Makes the minimal root $1, from the cache or with debootstrap.
make_root() {
  local root=$1 sources key tar mirror script="" keep=()
  sources=$(debian_sources)
  mirror=$(awk -v s="$suite" '$2 == s { print $1; exit }' <<<"$sources")
  key=$({ echo "$sources"; declare -f make_root; date +%Y-%m; } | sha256sum | cut -c1-16)
  tar=$cache/root-$key.tar
  mkdir -p "$root"
  if [ "$cached" = 1 ] && [ -f "$tar" ]; then
    tar -C "$root" --numeric-owner -xpf "$tar"
  else
    mkdir -p "$cache/debs"
    [ "$cached" = 0 ] || keep+=(--cache-dir="$cache/debs")
    # A release newer than debootstrap is made as the unstable one.
    [ -e "/usr/share/debootstrap/scripts/$suite" ] || script=/usr/share/debootstrap/scripts/sid
    debootstrap --variant=minbase --include=ca-certificates,git "${keep[@]}" "$suite" "$root" "$mirror" $script >"$work/debootstrap.log" 2>&1 ||
      { tail -20 "$work/debootstrap.log"; return 1; }
    # As in Debian's images: no package lists, no downloaded packages.
    rm -rf "$root"/var/lib/apt/lists/* "$root"/var/cache/apt/archives/*.deb "$root/etc/apt/sources.list"
    awk '{ print "deb", $1, $2, "main" }' <<<"$sources" >"$root/etc/apt/sources.list.d/debian.list"
    rm -f "$root/etc/resolv.conf" "$root/etc/hosts" # debootstrap copies this machine's
    if [ "$cached" = 1 ]; then
      rm -f "$cache"/root-*.tar
      tar -C "$root" --numeric-owner --one-file-system -cpf "$tar.$$" . && mv "$tar.$$" "$tar"
    fi
  fi
  # Settings of this machine, which the cached root must not have.
  cp -L /etc/resolv.conf /etc/hosts "$root/etc/" 2>/dev/null || true
  apt_transport >"$root/etc/apt/apt.conf.d/90machine"
  # The lists of testing are valid for a week; a mirror may have older ones.
  [ "$suite" != forky ] || echo 'Acquire::Check-Valid-Until "false";' >"$root/etc/apt/apt.conf.d/92testing"
  if [ "$cached" = 1 ]; then
    echo 'Binary::apt::APT::Keep-Downloaded-Packages "true"; APT::Keep-Downloaded-Packages "true";' >"$root/etc/apt/apt.conf.d/91keep"
  fi
}

# Mounts processes, shared memory and the caches. Reports missing mounts.
mount_parts() {
  local root=$1 device
  if [ "$mounts" = 0 ]; then
    echo "fresh_install.sh: mounting is not allowed here: the root has no /proc, and only packages are cached"
  fi
  try mount -t proc proc "$root/proc" || true
  try mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm" || true
  for device in null zero full random urandom tty; do # if debootstrap may not make devices
    [ -c "$root/dev/$device" ] || { touch "$root/dev/$device" && try mount --bind "/dev/$device" "$root/dev/$device"; }
  done
  [ -c "$root/dev/null" ] || { echo "fresh_install.sh: cannot make /dev/null in the root" >&2 && return 1; }
  if [ "$cached" = 1 ]; then
    mkdir -p "$cache/debs" "$objects" "$root/var/cache/ccache" "$cache/tidy" "$root/root/.cache/lrbscope-tidy"
    try mount --bind "$cache/tidy" "$root/root/.cache/lrbscope-tidy" || true
    try mount --bind "$cache/debs" "$root/var/cache/apt/archives" || cp "$cache"/debs/*.deb "$root/var/cache/apt/archives/" 2>/dev/null || true
    try mount --bind "$objects" "$root/var/cache/ccache" || true
  fi
}
try() { [ "$mounts" = 1 ] && "$@"; }

# Runs a command in the root, as root in a clean environment, with the compiler cache if available.
inside() { as root /root "$@"; }
# as USER HOME WORD...
as() {
  local user=$1 home_of=$2 clean=(TERM=dumb PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin)
  shift 2
  if [ "$user" = root ] && [ -x "$root/usr/bin/ccache" ]; then
    clean+=(CCACHE_DIR=/var/cache/ccache "CCACHE_BASEDIR=$home")
  fi
  env -i HOME="$home_of" USER="$user" LOGNAME="$user" "${clean[@]}" chroot --userspec="$user" "$root" \
    /bin/bash -c 'cd "$1" && shift && exec "$@"' bash "$home" "$@" </dev/null
}

# ---- steps

names=() seconds=() busy=() failed=()
# step NAME FUNCTION WORD...: runs it, prints its output, and records its time and whether it failed.
step() {
  local name=$1 code TIMEFORMAT='%R %U %S'
  echo "== fresh_install: $name"
  set +e # in a condition, a function would not stop at its first failure
  { time { (set -e && "${@:2}") 2>&1 | tee "$work/$name.log"; code=${PIPESTATUS[0]}; }; } 2>"$work/$name.time"
  set -e
  names+=("$name")
  seconds+=("$(awk '{ printf "%.0f", $1 }' "$work/$name.time")")
  busy+=("$(awk '{ printf "%.0f", $2 + $3 }' "$work/$name.time")")
  if [ "$code" != 0 ]; then
    echo "fresh_install.sh: $name FAILED"
    failed+=("$name")
    case $name in root | clone | stranger | run | check) finish ;; esac # the others are independent
  fi
}
table() {
  local i all=0 all_busy=0
  printf '\n%-12s %8s %18s\n' step seconds 'processor seconds'
  for i in "${!names[@]}"; do
    printf '%-12s %8d %18d\n' "${names[i]}" "${seconds[i]}" "${busy[i]}"
    all=$((all + seconds[i])) all_busy=$((all_busy + busy[i]))
  done
  printf '%-12s %8d %18d\n' all $all $all_busy
  echo "$suite, on $(nproc) processors, load $(cut -d' ' -f1-3 /proc/loadavg), caches $([ "$cached" = 1 ] && echo kept || echo off)"
}
finish() {
  table
  if [ "$cached" = 1 ] && [ "$mounts" = 0 ]; then cp -n "$root"/var/cache/apt/archives/*.deb "$cache/debs/" 2>/dev/null || true; fi
  # The summary lines of every ctest, and skipped tests; the main one last.
  local name
  for name in "${names[@]}" check; do
    if [ -f "$work/$name.log" ] && grep -q 'tests passed' "$work/$name.log"; then
      printf '\n%s:\n' "$name"
      grep -E '^skipped: |% tests passed|^Total Test time' "$work/$name.log"
    fi
  done
  if [ ${#failed[@]} -gt 0 ]; then
    echo "fresh_install.sh: ${failed[*]} FAILED at $(git -C "$repository" log -1 --format='%h %s' "$commit")"
    [ "${failed[0]}" != root ] || exit 3
    exit 1
  fi
  exit 0
}

step_root() { make_root "$root" && mount_parts "$root"; }
step_clone() {
  # Pushes into the root, so that the clone comes from an ordinary repository, not from this one.
  git init -q --bare "$root/srv/lrbscope.git"
  git -C "$root/srv/lrbscope.git" config receive.shallowUpdate true
  git -C "$repository" push -q "$root/srv/lrbscope.git" "$commit:refs/heads/main"
  git -C "$root/srv/lrbscope.git" symbolic-ref HEAD refs/heads/main
  chown -R root: "$root/srv/lrbscope.git"
  home=/root inside git clone -q /srv/lrbscope.git lrbscope
  mkdir -p "$root/home/stranger"
  cp -a "$root$home" "$root/home/stranger/lrbscope"
  chown -R 1000:1000 "$root/home/stranger"
  [ "$cached" = 0 ] || [ -n "$wheel" ] || add_compiler_cache
}
# Without root and without packages: the commands must print the packages for root to install.
step_stranger() {
  local command code said
  for command in ./run ./check; do
    code=0
    said=$(home=/home/stranger/lrbscope as 1000:1000 /home/stranger "$command" 2>&1) || code=$?
    echo "$said"
    [ $code = 3 ] && grep -q 'apt-get install .*libeigen3-dev' <<<"$said" ||
      { echo "$command of a user without packages: exit code $code, expected 3 and the packages to install"; return 1; }
  done
}
step_run() {
  inside ./run
  local picture
  for picture in out/collision/index.html out/figure2/montage.png; do
    [ -s "$root$home/$picture" ] || { echo "./run did not write $picture"; return 1; }
  done
}
add_compiler_cache() {
  [ "$mounts" = 1 ] || return 0
  inside bash -c 'apt-get update -q && apt-get install -y -q --no-install-recommends ccache' >"$work/ccache.log" 2>&1 ||
    { cat "$work/ccache.log"; return 1; }
  rm -rf "$root"/var/lib/apt/lists/* # a minimal machine has none
}
step_check() {
  inside ./check
  # The format part may not be skipped if the formatter is available.
  [ "$suite" != bookworm ] || inside bash -c 'command -v clang-format-14'
}
# Without root, with the packages: the same clone with another owner, so that only steps and tests that depend on the user are repeated.
step_user() {
  chmod a+x "$root/root"
  chown -R 1000:1000 "$root$home"
  local code=0
  { as 1000:1000 /home/stranger ./run && as 1000:1000 /home/stranger ./check format &&
    as 1000:1000 /home/stranger ctest --preset release -R '^robustness$' &&
    as 1000:1000 /home/stranger build/release/tests/library_tests --test-case='cache: without a usable folder*' |
      grep -E 'test cases: +1 .* 1 passed'; } || code=$?
  chown -R 0:0 "$root$home"
  return $code
}
# Installs the packages of the clone in a new root.
step_debs() {
  inside ./check debs
  local made=$root$home/build/debs-shared-OFF/debs root=$work/fresh home=/root
  make_root "$root" && mount_parts "$root"
  cp "$made"/*.deb "$root/root/"
  inside bash -c 'apt-get update -q && apt-get install -y -q --no-install-recommends ./lrbscope_*.deb'
  inside lrbscope --version
  inside lrbscope --quiet run collision -o out
  [ -s "$root/root/out/index.html" ] || { echo "the installed program wrote no page" && return 1; }
  [ -s "$root/usr/share/man/man1/lrbscope-run.1.gz" ] || { echo "found no manual page" && return 1; }
  cp -r "$(dirname "$script")/stranger" "$root/root/stranger"
  inside bash -c 'apt-get install -y -q --no-install-recommends cmake make g++ ./liblrbscope*.deb'
  inside bash -c 'lrbscope --quiet export collision --what body --of a -o a.ply'
  inside bash -c 'lrbscope --quiet export collision --what body --of b -o b.ply'
  inside bash -c 'cmake -S stranger -B built && cmake --build built && built/stranger a.ply b.ply'
  if compgen -G "$made/python3-lrbscope_*.deb" >/dev/null; then
    inside bash -c 'apt-get install -y -q --no-install-recommends ./python3-lrbscope_*.deb'
    inside python3 stranger/contact.py a.ply b.ply contact.png
    [ -s "$root/root/contact.png" ] || { echo "Python drew no picture" && return 1; }
  fi
}

# Only Python, NumPy and pytest: the rest is in the wheel.
step_wheel() {
  cp "$wheel" "$root/root/"
  inside bash -c 'apt-get update -q && apt-get install -y -q --no-install-recommends python3 python3-venv python3-numpy python3-pytest'
  if inside bash -c 'command -v c++ || dpkg-query -W -f "\${Package}\n" | grep -E -- "^lib(tbb|cairo|freetype|png|osmesa|egl1|eigen3)"'; then
    echo "the root has a compiler, or libraries that the wheel contains" && return 1
  fi
  inside bash tests/python/wheel.sh "/root/$(basename "$wheel")" /usr/bin/python3
  grep -q "lrbscope run: refused: .*libosmesa6" "$work/wheel.log" || { echo "expected pictures to be refused without Mesa" && return 1; }
}
step_drawn() {
  inside bash -c 'apt-get install -y -q --no-install-recommends libosmesa6'
  inside bash tests/python/wheel.sh "/root/$(basename "$wheel")" /usr/bin/python3
  grep -q "lrbscope run: drawn" "$work/drawn.log" || { echo "expected pictures with Mesa" && return 1; }
}

all_steps() {
  local name
  for name in root clone "${steps[@]}"; do
    if declare -F "step_$name" >/dev/null; then step "$name" "step_$name"; else step "$name" inside ./check "$name"; fi
  done
  finish
}

# ---- from here on: this machine

suite=bookworm commit=HEAD cached=1 keep=0 wheel= steps=()
if [ "${1:-}" != --inside ]; then
  while [ $# -gt 0 ]; do
    case "$1" in
      --suite) suite=${2:?bookworm, trixie or forky} && shift ;;
      --commit) commit=${2:?a commit} && shift ;;
      --wheel) wheel=$(readlink -f "${2:?a file}") && [ -f "$wheel" ] && steps=(wheel drawn) && shift || usage ;;
      --no-cache) cached=0 ;;
      --keep) keep=1 ;;
      -*) usage ;;
      *) steps+=("$1") ;;
    esac
    shift
  done
  [ ${#steps[@]} -gt 0 ] || steps=(stranger run check user)
  case $suite in bookworm | trixie | forky) ;; *) usage ;; esac
  [ "$(id -u)" = 0 ] || refuse "needs root, to make a root file system"
  command -v debootstrap >/dev/null || refuse "needs debootstrap (apt-get install debootstrap)"
  commit=$(git -C "$repository" rev-parse --verify -q "$commit^{commit}") || { echo "fresh_install.sh: no such commit" >&2 && exit 2; }
  cache=${XDG_CACHE_HOME:-$HOME/.cache}/lrbscope-bare/$suite
  mkdir -p "$cache"
  for old in "$cache"/work-*; do # of killed runs
    [ ! -d "$old" ] || [ -d "/proc/${old##*-}" ] || rm -rf --one-file-system "$old"
  done
  work=$cache/work-$$
  mkdir "$work"
  child=""
  clean_up() {
    if [ -n "$child" ]; then kill -KILL "$child" 2>/dev/null || true; wait "$child" 2>/dev/null || true; fi
    if [ "$keep" = 1 ]; then echo "kept: $work/root"; else rm -rf --one-file-system "$work"; fi
  }
  trap clean_up EXIT
  trap 'exit 130' INT TERM HUP
  # Mounts and processes end with the namespace, even if this script is killed.
  apart=(unshare --mount --propagation private --pid --fork --kill-child)
  mounts=1
  chroot / true 2>/dev/null || refuse "may not change the root here"
  if ! "${apart[@]}" sh -c 'mount -t tmpfs tmpfs "$1"' sh "$work" 2>/dev/null; then apart=() mounts=0; fi
  if [ $mounts = 0 ]; then
    mknod "$work/null" c 1 3 2>/dev/null && : >"$work/null" || refuse "may neither mount nor make devices here"
  fi
  "${apart[@]}" bash "$script" --inside "$commit" "$cached" "$mounts" "$cache" "$work" "$suite" "$wheel" "${steps[@]}" &
  child=$!
  code=0
  wait "$child" || code=$?
  child=""
  exit $code
fi
commit=$2 cached=$3 mounts=$4 cache=$5 work=$6 suite=$7 wheel=$8 steps=("${@:9}")
objects=${CCACHE_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/ccache} # this machine's cache: objects do not depend on the root
root=$work/root
all_steps
