#!/usr/bin/env bash
# Unpacks build dependencies: Debian 11's glibc, the headers of both Pythons, nasm; for Windows, both Pythons.
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

if [[ ${FIRETWIN_SYSTEM:-} == windows ]]; then
  for python in 3.11 3.13; do
    rm -rf "$folder/python$python"
    mkdir -p "$folder/python$python"
    python3 -m zipfile --extract "$(echo "$sources/cpython-$python".*-windows-x86_64.jar)" "$folder/python$python"
  done
  unpack "$folder/nasm" nasm
  exit
fi
unpack "$folder/sysroot" libc6 libc6-dev linux-libc-dev libcrypt1 libcrypt-dev libgcc-s1
relative_links "$folder/sysroot"
unpack "$folder/python3.11" libpython3.11-dev
unpack "$folder/python3.13" libpython3.13-dev
unpack "$folder/nasm" nasm
