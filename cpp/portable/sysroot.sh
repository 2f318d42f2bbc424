#!/usr/bin/env bash
# Unpacks build dependencies: Debian 11's glibc, the headers of both Pythons, nasm.
# usage: sysroot.sh SOURCES FOLDER, both absolute
set -euo pipefail
sources=${1:?usage: sysroot.sh SOURCES FOLDER} folder=${2:?usage: sysroot.sh SOURCES FOLDER}

unpack() { # folder package...
  local into=$1 package file
  shift
  rm -rf "$into"
  mkdir -p "$into"
  for package in "$@"; do
    for file in "$sources/${package}"_*.deb; do
      dpkg-deb --extract "$file" "$into"
    done
  done
}

# Absolute links inside the folder would point outside of it.
relative_links() {
  local link
  while read -r link; do
    ln -sfn --relative "$1$(readlink "$link")" "$link"
  done < <(find "$1" -type l -lname '/*')
}

unpack "$folder/sysroot" libc6 libc6-dev linux-libc-dev libcrypt1 libcrypt-dev libgcc-s1
relative_links "$folder/sysroot"
unpack "$folder/python3.11" libpython3.11-dev
unpack "$folder/python3.13" libpython3.13-dev
unpack "$folder/nasm" nasm
