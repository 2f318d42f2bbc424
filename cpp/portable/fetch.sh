#!/usr/bin/env bash
# Downloads the files of sources.txt into a folder, and checks their SHA-256: all, or those with the names given.
# They come from the Debian mirrors that apt is set up to use; FIRETWIN_MIRRORS lists others (URLs separated by blanks).
# pip downloads source packages of PyPI, and mvn (Debian's maven) packages of Maven Central. Exit status 77: a file is not
# available.
set -euo pipefail
folder=${1:?usage: fetch.sh FOLDER [NAME...]}
shift
here=$(dirname "${BASH_SOURCE[0]}")
mkdir -p "$folder"

mirrors() {
  if [[ -n ${FIRETWIN_MIRRORS:-} ]]; then
    tr ' ' '\n' <<<"$FIRETWIN_MIRRORS"
  elif command -v apt-get >/dev/null; then
    # shellcheck disable=SC2016 # expanded by apt-get
    apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | sort -u
  fi
}

matches() { # file sha256
  [[ -f $1 && $(sha256sum <"$1") == "$2  -" ]]
}

download() { # pool-path file sha256
  local mirror part=$2.part
  for mirror in "${urls[@]}"; do
    if curl --fail --silent --location --connect-timeout 20 --retry 2 --output "$part" "${mirror%/}/$1" && matches "$part" "$3"; then
      mv "$part" "$2"
      return
    fi
  done
  rm -f "$part"
  return 1
}

# pip itself checks the hash.
download_sdist() { # name version sha256
  python3 -m venv "$folder/venv" && "$folder/venv/bin/pip" download --quiet --disable-pip-version-check --no-deps --no-binary "$1" \
    --require-hashes --requirement <(echo "$1==$2 --hash=sha256:$3") --dest "$folder" >&2
  rm -rf "$folder/venv"
}

download_maven() { # group:artifact:version:jar:classifier
  mvn --quiet --batch-mode dependency:copy -Dartifact="$1" -DoutputDirectory="$folder" >&2
}

file_name() { # path in sources.txt
  case $1 in
    maven:*) awk -F: '{ print $3 "-" $4 "-" $6 "." $5 }' <<<"$1" ;;
    *) basename "${1#pypi:}" ;;
  esac
}

mapfile -t urls < <(mirrors)
missing=0
while read -r name version path sha256; do
  if [[ -z $name || $name == \#* ]]; then
    continue
  fi
  if (($#)) && [[ " $* " != *" $name "* ]]; then
    continue
  fi
  file=$folder/$(file_name "$path")
  if matches "$file" "$sha256"; then
    continue
  fi
  if [[ $path == pypi:* ]]; then
    download_sdist "$name" "$version" "$sha256" || true
  elif [[ $path == maven:* ]]; then
    download_maven "${path#maven:}" || true
  else
    download "$path" "$file" "$sha256" || true
  fi
  if ! matches "$file" "$sha256"; then
    echo "fetch: $name $version: $path with SHA-256 $sha256 is not available." >&2
    missing=1
  fi
done <"$here/sources.txt"
if ((missing)); then
  echo "fetch: tried: ${urls[*]:-no mirror}" >&2
  echo "fetch: set FIRETWIN_MIRRORS to a mirror with these files, or copy the files into $folder" >&2
  exit 77
fi
