#!/usr/bin/env bash
# tests/robustness/hardening.sh PROGRAM: checks that the program has the hardening of LRB_HARDEN.
set -u
failed=0
# want WHAT PATTERN TEXT: expects the pattern in the text
want() {
  grep -q "$2" <<<"$3" || { echo "FAILED: $1" && failed=1; }
}
dynamic=$(readelf -dW "$1") segments=$(readelf -lW "$1") symbols=$(readelf -sW --dyn-syms "$1")
want "position independent (-pie)" 'Flags:.*PIE' "$dynamic"
want "all symbols bound at the start (-z now)" 'BIND_NOW\|Flags:.*NOW' "$dynamic"
want "relocation tables read-only after loading (-z relro)" GNU_RELRO "$segments"
want "non-executable stack" 'GNU_STACK .* RW ' "$segments"
want "stack protector (-fstack-protector-strong)" __stack_chk_fail "$symbols"
want "checked copies (-D_FORTIFY_SOURCE)" '__[a-z]*_chk' "$symbols"
[ $failed = 0 ] && echo "hardened"
exit $failed
