#!/usr/bin/env bash
# Builds the static libraries of firetwin_core, or unpacks them. Each library is packed once in PORTABLE/archives, under a key:
# a hash of its source, its recipe, the compiler and the keys of the libraries that it needs. A new version of a library
# rebuilds that library and those that need it. Libraries that do not need each other are built at the same time.
#
#   libraries.sh PORTABLE              make PORTABLE/libraries and PORTABLE/licenses
#   libraries.sh PORTABLE --keys       list each library and its key
#   libraries.sh PORTABLE --missing    list the entries of sources.txt to download: libraries without archive, and tools
#
# PORTABLE is the absolute folder with sources/ and sysroot/. FIRETWIN_JOBS is the number of parallel compilers, and
# FIRETWIN_SYSTEM=windows builds for Windows.
set -euo pipefail
usage="usage: libraries.sh PORTABLE [--keys | --missing]"
portable=${1:?$usage}
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
prefix=$portable/libraries
export FIRETWIN_PORTABLE=$portable
jobs=${FIRETWIN_JOBS:-$(nproc)}
# Instead of $prefix and $portable/sysroot in the text files of archives.
anywhere=@FIRETWIN_LIBRARIES@ any_sysroot=@FIRETWIN_SYSROOT@

# shellcheck source=cpp/portable/logged.sh
source "$scripts/logged.sh"
# shellcheck source=cpp/portable/recipes.sh
source "$scripts/recipes.sh"
case ${FIRETWIN_SYSTEM:-linux} in
  linux) here=$scripts compiler=gcc-12 own=("$scripts/old_glibc.c") ;;
  windows)
    here=$scripts/windows compiler=x86_64-w64-mingw32-gcc-posix own=()
    # shellcheck source=cpp/portable/windows/recipes.sh
    source "$here/recipes.sh"
    ;;
esac

# Whether a line of sources.txt is a tool of this system.
is_tool() { # name
  case ${FIRETWIN_SYSTEM:-linux}:$1 in
    *:\#* | linux:windows-*) return 1 ;;
    linux:* | windows:windows-* | windows:nasm) ;;
    *) return 1 ;;
  esac
}

unpack() { # archive
  case $1 in
    *.deb) dpkg-deb --extract "$1" . ;;
    *boost*) tar --extract --file "$1" --strip-components=1 --wildcards 'boost/LICENSE*' \
      'boost/libs/*/include' 'boost/libs/thread/src' 'boost/libs/chrono/src' ;;
    *) tar --extract --file "$1" --strip-components=1 --exclude '*/testdata' ;;
  esac
}

declare -A file sha256 key
libraries=() others=()
while read -r name _ path sum; do
  if declare -F "build_$name" >/dev/null; then
    libraries+=("$name")
    file[$name]=$portable/sources/$(basename "${path#pypi:}") sha256[$name]=$sum
  elif [[ -n $name ]] && is_tool "$name"; then
    others+=("$name $sum")
  fi
done <"$scripts/sources.txt"

tools=$({
  "$compiler" --version
  cat "$here/toolchain.cmake" "${own[@]}"
  printf '%s\n' "${others[@]}"
  declare -f with_cmake with_configure with_sources copy_headers unpack
} | sha256sum)

make_key() { # name
  local need keys=()
  for need in ${needs[$1]:-}; do
    [[ -n ${key[$need]:-} ]] || make_key "$need"
    keys+=("${key[$need]}")
  done
  key[$1]=$(echo "$tools ${sha256[$1]} $(declare -f "build_$1") ${keys[*]}" | sha256sum | cut -c 1-16)
}

archive_of() { echo "$portable/archives/$1-${key[$1]}.tar.gz"; }

# The wheel contains the licence of each library.
keep_license() { # name work-folder into
  local into=$3
  mkdir -p "$into"
  find "$2" -maxdepth 1 -type f \( -iname 'licen[cs]e*' -o -iname 'copying*' -o -iname 'copyright*' -o -name 'README.ijg' \) \
    -exec cp -t "$into" {} +
  find "$2/LICENSES" "$2/usr/share/doc" -type f \( -name '*.txt' -o -name copyright \) -exec cp -t "$into" {} + 2>/dev/null || true
  if [[ -z $(ls "$into") ]]; then
    echo "libraries: the licence of $1 was not found" >&2
    exit 1
  fi
}

in_folder() { # work-folder name
  cd "$1/source"
  unpack "${file[$2]}"
  "build_$2"
}

build() { # name archive
  local work=$portable/work/$1 TIMEFORMAT="libraries: $1 built in %0R s, processor %0U + %0S s"
  rm -rf "$work"
  mkdir -p "$work/source" "$work/pack" "$portable/archives"
  export DESTDIR=$work/installed
  time logged "libraries: $1" "$portable/logs/$1.log" in_folder "$work" "$1"
  mv "$DESTDIR$prefix" "$work/pack/libraries"
  keep_license "$1" "$work/source" "$work/pack/licenses/$1"
  move_prefix "$work/pack/libraries" "$prefix" "$anywhere"
  move_prefix "$work/pack/libraries" "$portable/sysroot" "$any_sysroot"
  tar --create --directory "$work/pack" . | gzip -1 >"$2.part"
  rm -rf "$work" "$portable/archives/$1"-????????????????.tar.gz
  mv "$2.part" "$2"
}

move_prefix() { # folder from to
  local found
  if [[ -d $1/lib ]]; then
    found=$(grep --recursive --files-with-matches -I "$2" "$1/lib") || return 0
    # shellcheck disable=SC2086 # one name a word
    sed -i "s#$2#$3#g" $found
  fi
}

# Through a separate folder, as others are unpacked at the same time.
restore() { # name archive
  local work=$portable/work/$1
  rm -rf "$work"
  mkdir -p "$work" "$portable/licenses" "$prefix"
  tar --extract --directory "$work" --file "$2"
  move_prefix "$work/libraries" "$anywhere" "$prefix"
  move_prefix "$work/libraries" "$any_sysroot" "$portable/sysroot"
  cp -r --link "$work/libraries/." "$prefix/"
  cp -r "$work/licenses/." "$portable/licenses/"
  rm -rf "$work"
}

# The libraries as targets of make, which keeps their order and stops at the first error.
targets() {
  local name
  echo ".PHONY: ${libraries[*]}"
  echo "all: ${libraries[*]}"
  for name in "${libraries[@]}"; do
    printf '%s: %s\n\t@"%s" "%s" --one %s\n' "$name" "${needs[$name]:-}" "$scripts/libraries.sh" "$portable" "$name"
  done
}

for name in "${libraries[@]}"; do
  make_key "$name"
done
case ${2:-} in
  --keys) for name in "${libraries[@]}"; do echo "$name ${key[$name]}"; done ;;
  --missing)
    for name in "${libraries[@]}"; do [[ -f $(archive_of "$name") ]] || echo "$name"; done
    printf '%s\n' "${others[@]%% *}"
    ;;
  --one)
    unset MAKEFLAGS
    archive=$(archive_of "$3")
    [[ -f $archive ]] || build "$3" "$archive"
    restore "$3" "$archive"
    ;;
  "")
    stamp=$portable/stamps/libraries want=$(printf '%s\n' "${key[@]}" | sort)
    if [[ ! -f $stamp || $(<"$stamp") != "$want" ]]; then
      rm -rf "$prefix" "$portable/licenses" "$stamp"
      mkdir -p "$portable/stamps"
      if [[ $compiler == gcc-12 ]]; then
        gcc-12 --sysroot="$portable/sysroot" -O2 -fPIC -ffunction-sections -Wall -Wextra -c \
          "$here/old_glibc.c" -o "$portable/old_glibc.o"
      fi
      make --no-print-directory --jobs "$jobs" --file <(targets) all
      echo "$want" >"$stamp"
    fi
    ;;
  *)
    echo "$usage" >&2
    exit 2
    ;;
esac
