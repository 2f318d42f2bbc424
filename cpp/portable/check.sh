#!/usr/bin/env bash
# Checks the portable wheels: their dependencies, and the symbols that they export to other programs in the same process.
# usage: check.sh PORTABLE, the folder with wheels/ and tools/
set -euo pipefail
portable=${1:?usage: check.sh PORTABLE}
newest_glibc=2.28
# Libraries of every Linux with that glibc; libstdc++ and all others are linked statically.
allowed='^(libc|libm|libpthread|libdl|librt|libgcc_s|ld-linux-x86-64)\.so\.[0-9]+$'

fail() {
  echo "check: $wheel: $*" >&2
  exit 1
}

check_libraries() {
  local others
  others=$(readelf --dynamic --wide "$module" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | grep -Ev "$allowed" || true)
  [[ -z $others ]] || fail "depends on libraries that a system may not have: $others"
}

check_glibc() {
  local newest
  newest=$(nm --dynamic --undefined-only --with-symbol-versions "$module" | grep -oE 'GLIBC_[0-9.]+' | sort -Vu | tail -n 1)
  [[ $(printf '%s\n' "GLIBC_$newest_glibc" "$newest" | sort -V | tail -n 1) == "GLIBC_$newest_glibc" ]] ||
    fail "needs $newest; GLIBC_$newest_glibc is the limit"
  echo "newest symbol: $newest"
}

check_exports() {
  local exports
  exports=$(nm --dynamic --defined-only --format=just-symbols "$module")
  [[ $exports == PyInit_firetwin_core ]] || fail "exports more than PyInit_firetwin_core: ${exports//$'\n'/ }"
}

# Only Python's symbols may be undefined.
check_open() {
  local open
  open=$(nm --dynamic --undefined-only "$module" | awk '$(NF-1) == "U" && $NF !~ /@/ && $NF !~ /^_?Py/ { print $NF }')
  [[ -z $open ]] || fail "undefined symbols: ${open//$'\n'/ }"
}

# An undefined weak symbol is 0 at run time, unless another library in the process defines it, which would then be called.
check_weak() {
  local weak
  weak=$(nm --dynamic --undefined-only "$module" | awk '$(NF-1) == "w" { print $NF }' |
    grep -Ev '^(__cxa_finalize|__gmon_start__|_ITM_(de)?registerTMCloneTable|__pthread_key_create|pthread_.*)(@.*)?$' || true)
  [[ -z $weak ]] || fail "undefined weak symbols, which another library could define: ${weak//$'\n'/ }"
}

# The list of libraries is in the wheel and in its RECORD, and names every library that has a licence there.
check_sbom() {
  local info named licensed
  info=$(echo "$unpacked"/firetwin_core-*.dist-info)
  grep -q "sboms/libraries.cdx.json,sha256=" "$info/RECORD" || fail "RECORD does not contain the list of libraries"
  named=$(python3 -c 'import json, sys; print(*(item["name"] for item in json.load(sys.stdin)["components"]), sep="\n")' \
    <"$info/sboms/libraries.cdx.json" | grep -Ev '^(libstdc\+\+|pybind11)$' | sort)
  licensed=$(ls "$info/licenses/libraries")
  [[ $named == "$licensed" ]] || fail "the list of libraries differs from the licences: $(diff <(echo "$named") <(echo "$licensed"))"
}

check_windows() {
  local list others
  list=$(x86_64-w64-mingw32-objdump -p "$module")
  # Windows' own libraries and Python's.
  others=$(sed -n 's/.*DLL Name: //p' <<<"$list" | grep -Eiv '^(kernel32|msvcrt|user32|advapi32|shell32|ws2_32|ole32|bcrypt|python3[0-9]+)\.dll$' || true)
  [[ -z $others ]] || fail "depends on libraries that a system may not have: $others"
  echo "libraries: $(sed -n 's/.*DLL Name: //p' <<<"$list" | tr '\n' ' ')"
  others=$(sed -n '/Ordinal\/Name Pointer/,/^$/s/^.*\] //p' <<<"$list" | sed 1d)
  [[ $others == PyInit_firetwin_core ]] || fail "exports more than PyInit_firetwin_core: ${others//$'\n'/ }"
  check_sbom
}

for wheel in "$portable"/wheels/firetwin_core-*.whl; do
  echo "== $(basename "$wheel"), $(stat --format=%s "$wheel") bytes"
  unpacked=$(mktemp -d)
  trap 'rm -rf "$unpacked"' EXIT
  python3 -m zipfile --extract "$wheel" "$unpacked"
  if [[ $wheel == *-win_amd64.whl ]]; then
    module=$(echo "$unpacked"/firetwin_core.*.pyd)
    check_windows
    rm -rf "$unpacked"
    continue
  fi
  show=$("$portable/tools/bin/auditwheel" show "$wheel")
  echo "$show"
  tr '\n' ' ' <<<"$show" | grep -qE 'consistent with the following platform tag: +"manylinux_2_(1[0-9]|2[0-8])_x86_64"' ||
    fail "auditwheel does not call it manylinux_2_28 or older"
  module=$(echo "$unpacked"/firetwin_core.*.so)
  check_libraries
  check_glibc
  check_exports
  check_open
  check_weak
  check_sbom
  rm -rf "$unpacked"
done
