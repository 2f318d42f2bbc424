#!/usr/bin/env bash
# Runs a command in the checkout's copy inside a Debian of another release, kept in a folder.
#
#   tests/system/in_debian.sh trixie build/debian/trixie tests/run.sh
#
# The folder is made by debootstrap when it is not there (about 2 minutes). Each call brings the copy in
# FOLDER/firetwin up to date, what was built there stays; build/shared is the same folder inside and outside.
# Mirror, proxies, certificates and pip's configuration are this machine's. Exit status 77, after a line that
# says why: this machine cannot do it. Otherwise the command's.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

if (($# < 3)); then
  echo "usage: tests/system/in_debian.sh SUITE FOLDER COMMAND [ARGUMENT ...]" >&2
  exit 2
fi
suite=$1 folder=$2
shift 2

cannot() {
  echo "in_debian: no $suite folder: $*" >&2
  exit 77
}

((EUID == 0)) || cannot "debootstrap and chroot need root"
command -v unshare >/dev/null || cannot "unshare is missing (Debian: apt-get install util-linux)"
unshare --mount true 2>/dev/null || cannot "this machine does not let root mount anything"

# The mirror this machine uses, where it is a Debian; else debootstrap's own.
mirror() {
  if grep -qs '^ID=debian$' /etc/os-release && command -v apt-get >/dev/null; then
    # shellcheck disable=SC2016
    apt-get indextargets --format '$(REPO_URI) $(SUITE)' 'Created-By: Packages' 2>/dev/null |
      awk '$2 !~ /security|updates|backports/ && $1 ~ /debian\/?$/ {print $1; exit}'
  fi
}

make_folder() {
  command -v debootstrap >/dev/null || cannot "debootstrap is missing (apt-get install debootstrap)"
  local part=$folder.part log=$folder.log from
  echo "in_debian: making $folder with debootstrap ($suite)" >&2
  rm -rf --one-file-system "$part"
  from=$(mirror)
  if ! debootstrap --variant=minbase --include=ca-certificates "$suite" "$part" ${from:+"$from"} >"$log" 2>&1; then
    tail -n 5 "$log" >&2
    cannot "debootstrap failed (no network?); its output is in $log"
  fi
  # Downloaded packages are of no use later.
  rm -f "$part"/var/cache/apt/archives/*.deb
  mv "$part" "$folder"
}

# How this machine reaches the network.
configure() {
  local file
  for file in /etc/resolv.conf /etc/hosts /etc/pip.conf /etc/ssl/certs/ca-certificates.crt; do
    if [[ -f $file ]]; then
      cp --dereference "$file" "$folder$file"
    fi
  done
  for file in "${XDG_CONFIG_HOME:-$HOME/.config}/pip/pip.conf" "$HOME/.pip/pip.conf"; do
    if [[ -f $file ]]; then
      mkdir -p "$folder/root/.config/pip"
      cp --dereference "$file" "$folder/root/.config/pip/pip.conf"
    fi
  done
  for file in /etc/apt/apt.conf.d/*; do
    if grep -qsE '^ *Acquire::' "$file"; then
      cp "$file" "$folder/etc/apt/apt.conf.d/"
    fi
  done
}

# Files keep their times, so that only what changed is built again.
copy_checkout() {
  local copy=$folder/firetwin
  mkdir -p "$copy"
  find "$copy" -mindepth 1 -maxdepth 1 ! -name .venv ! -name build ! -name examples -exec rm -rf {} +
  # What the example has made stays too.
  if [[ -d $copy/examples ]]; then
    find "$copy/examples" -mindepth 1 -maxdepth 1 ! -name out -exec rm -rf {} +
  fi
  tar --exclude=./.venv --exclude=./build --exclude=./.git --exclude=./examples/out --exclude='*.pyc' -cf - . |
    tar -xf - -C "$copy"
}

# One at a time: another command in this folder is waited for.
mkdir -p "$(dirname "$folder")"
exec 9>"$folder.lock"
flock 9
if [[ ! -d $folder ]]; then
  make_folder
fi
configure
copy_checkout
mkdir -p build/shared "$folder/firetwin/build/shared"

environment=(PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 TERM=dumb)
while read -r name; do
  environment+=("$name=${!name}")
done < <(compgen -e | grep -iE '^((https?|ftp|no|all)_proxy|PIP_(INDEX_URL|EXTRA_INDEX_URL|TRUSTED_HOST|CERT|PROXY|DEFAULT_TIMEOUT)|SSL_CERT_FILE|REQUESTS_CA_BUNDLE)$')

# The mounts are seen by this one process and end with it.
# shellcheck disable=SC2016
exec unshare --mount --propagation private bash -c '
  set -euo pipefail
  folder=$1
  shift
  mount --bind /proc "$folder/proc"
  mount --rbind /dev "$folder/dev"
  mount --bind build/shared "$folder/firetwin/build/shared"
  exec env -i "$@"
' bash "$folder" "${environment[@]}" chroot "$folder" bash -c 'cd /firetwin && exec "$@"' bash "$@"
