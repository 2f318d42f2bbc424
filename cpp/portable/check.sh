#!/usr/bin/env bash
# Checks the portable wheels: what they ask of the system, and what they show to other programs in the same process.
# usage: check.sh PORTABLE, the folder with wheels/ and tools/
set -euo pipefail
portable=${1:?usage: check.sh PORTABLE}
newest_glibc=2.28
# What every Linux with that glibc has; libstdc++ and everything else is inside.
allowed='^(libc|libm|libpthread|libdl|librt|libgcc_s|ld-linux-x86-64)\.so\.[0-9]+$'

fail() {
  echo "check: $wheel: $*" >&2
  exit 1
}

check_libraries() {
  local others
  others=$(readelf --dynamic --wide "$module" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | grep -Ev "$allowed" || true)
  [[ -z $others ]] || fail "needs libraries that a system need not have: $others"
}

check_glibc() {
  local newest
  newest=$(nm --dynamic --undefined-only --with-symbol-versions "$module" | grep -oE 'GLIBC_[0-9.]+' | sort -Vu | tail -n 1)
  [[ $(printf '%s\n' "GLIBC_$newest_glibc" "$newest" | sort -V | tail -n 1) == "GLIBC_$newest_glibc" ]] ||
    fail "needs $newest, and no more than GLIBC_$newest_glibc may be asked for"
  echo "newest symbol: $newest"
}

check_exports() {
  local exports
  exports=$(nm --dynamic --defined-only --format=just-symbols "$module")
  [[ $exports == PyInit_firetwin_core ]] || fail "shows more than PyInit_firetwin_core: ${exports//$'\n'/ }"
}

# Nothing but Python itself may be expected from elsewhere.
check_open() {
  local open
  open=$(nm --dynamic --undefined-only "$module" | awk '$(NF-1) == "U" && $NF !~ /@/ && $NF !~ /^_?Py/ { print $NF }')
  [[ -z $open ]] || fail "nothing provides ${open//$'\n'/ }"
}

# What nothing provides is 0 at run time; another library in the process could provide it and be called.
check_weak() {
  local weak
  weak=$(nm --dynamic --undefined-only "$module" | awk '$(NF-1) == "w" { print $NF }' |
    grep -Ev '^(__cxa_finalize|__gmon_start__|_ITM_(de)?registerTMCloneTable|__pthread_key_create|pthread_.*)(@.*)?$' || true)
  [[ -z $weak ]] || fail "leaves symbols open that another library could fill: ${weak//$'\n'/ }"
}

for wheel in "$portable"/wheels/firetwin_core-*.whl; do
  echo "== $(basename "$wheel"), $(stat --format=%s "$wheel") bytes"
  show=$("$portable/tools/bin/auditwheel" show "$wheel")
  echo "$show"
  tr '\n' ' ' <<<"$show" | grep -qE 'consistent with the following platform tag: +"manylinux_2_(1[0-9]|2[0-8])_x86_64"' ||
    fail "auditwheel does not call it manylinux_2_28 or older"
  unpacked=$(mktemp -d)
  trap 'rm -rf "$unpacked"' EXIT
  python3 -m zipfile --extract "$wheel" "$unpacked"
  module=$(echo "$unpacked"/firetwin_core.*.so)
  check_libraries
  check_glibc
  check_exports
  check_open
  check_weak
  rm -rf "$unpacked"
done
