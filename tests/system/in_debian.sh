#!/usr/bin/env bash
# Runs a command in a copy of the checkout inside a folder with another Debian release.
#
#   tests/system/in_debian.sh trixie build/debian/trixie tests/run.sh
#
# debootstrap makes the folder if it does not exist (about 2 minutes). Each call updates the copy in FOLDER/firetwin;
# builds in it stay. build/shared is the same folder inside and outside. Mirror, proxies, certificates and pip's
# configuration come from this machine. The exit status is the status of the command, or 77, after a line with the
# reason, if this machine cannot do it.
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

# The mirror of this machine if it is a Debian; else the default of debootstrap.
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
  # Downloaded packages are not needed later.
  rm -f "$part"/var/cache/apt/archives/*.deb
  mv "$part" "$folder"
}

# Network configuration of this machine.
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

# Files keep their times, so that only changed files are built again.
copy_checkout() {
  local copy=$folder/firetwin
  mkdir -p "$copy"
  find "$copy" -mindepth 1 -maxdepth 1 ! -name .venv ! -name build ! -name examples -exec rm -rf {} +
  # Files of the example stay too.
  if [[ -d $copy/examples ]]; then
    find "$copy/examples" -mindepth 1 -maxdepth 1 ! -name out -exec rm -rf {} +
  fi
  tar --exclude=./.venv --exclude=./build --exclude=./.git --exclude=./examples/out --exclude='*.pyc' -cf - . |
    tar -xf - -C "$copy"
}

# One at a time: wait for another command in this folder.
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

# Only this process has the mounts; they end with it.
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
