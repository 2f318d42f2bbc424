#!/usr/bin/env bash
# Opens pages of `firetwin score --report` in a real browser, Debian's Chromium without a display or a network.
#
#   tests/system/browser.sh X.html ...
#
# The browser is in build/debian/browser, or in $FIRETWIN_DEBIAN/browser (tests/system/in_debian.sh); the first call
# installs it there (about 4 minutes). build/shared/browser has a picture of each page, X.png, and its document, X.dom.
# Exit status 1: a picture in a page did not load, or the page requests a file from elsewhere; 77: there is no such
# browser.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folder=${FIRETWIN_DEBIAN:-build/debian}/browser
out=build/shared/browser

rm -rf "$out"
mkdir -p "$out"
for page in "$@"; do
  # A line at the end of the page with the widths of its pictures and the addresses that it fetched.
  {
    cat "$page"
    # shellcheck disable=SC2016
    echo '<script>addEventListener("load", () => { document.title = "loaded " + JSON.stringify({
      pictures: [...document.images].map(i => i.naturalWidth),
      fetched: performance.getEntriesByType("resource").map(r => r.name).filter(n => !n.startsWith("data:")),
      drawn: [...document.querySelectorAll("svg")].map(s => s.getBoundingClientRect().width),
      wide: document.documentElement.scrollWidth }) })</script>'
  } >"$out/$(basename "$page")"
done
# shellcheck disable=SC2016
tests/system/in_debian.sh bookworm "$folder" bash -c '
  set -euo pipefail
  if ! command -v chromium >/dev/null; then
    apt-get update -q
    DEBIAN_FRONTEND=noninteractive apt-get install -yq --no-install-recommends chromium fonts-dejavu-core
  fi >&2
  cd "$1"
  for page in *.html; do
    options=(--headless --no-sandbox --disable-gpu --hide-scrollbars --virtual-time-budget=20000
      --host-resolver-rules="MAP * ~NOTFOUND" --window-size=1200,5200)
    chromium "${options[@]}" --screenshot="${page%.html}.png" "file://$PWD/$page" 2>/dev/null
    chromium "${options[@]}" --dump-dom "file://$PWD/$page" >"${page%.html}.dom" 2>/dev/null
  done
' bash "$out"
for page in "$out"/*.dom; do
  python3 - "$page" <<'CHECK'
import json, re, sys

text = open(sys.argv[1], encoding="utf-8").read()
found = re.search(r"<title>loaded (.*?)</title>", text)
seen = json.loads(found[1].replace("&quot;", '"')) if found else sys.exit(f"{sys.argv[1]}: did not load")
print(sys.argv[1], seen)
if not seen["pictures"] or not all(seen["pictures"]) or not all(seen["drawn"]):
    sys.exit(f"{sys.argv[1]}: a picture is missing")
if seen["fetched"] or seen["wide"] > 1200:
    sys.exit(f"{sys.argv[1]}: it asks for {seen['fetched']} from elsewhere, or is {seen['wide']} pixels wide")
CHECK
done
