"""Make the listing of the extension for Blender: ``index.py [--incomplete] OUT ADDRESS ZIP...``.

ZIPs are the extension in one or two versions, one zip per platform. Blender's `server-generate` describes
them. The newest version goes to OUT/index.json, the version before it to OUT/index-previous.json, so that
users can go back. There are two files because Blender (4.5 to 5.2) does not compare versions: of two
compatible archives in one file it shows the last and installs the first.

ADDRESS is the address of the archives without their names; `{version}` in it is replaced. Without
``--incomplete`` a version needs the zips of all platforms.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from extension import blender_ext

PLATFORMS = {"linux-x64", "macos-arm64", "windows-x64"}


def list_archives(zips: list[Path]) -> list[dict]:
    """Return Blender's description of each zip, in the order of platforms."""
    with tempfile.TemporaryDirectory() as folder:
        for zipped in zips:
            os.symlink(zipped.resolve(), Path(folder, zipped.name))
        command = [sys.executable, blender_ext(), "server-generate", "--repo-dir", folder]
        subprocess.run(command, check=True)
        entries = json.loads(Path(folder, "index.json").read_text(encoding="utf-8"))["data"]
    if len(entries) != len(zips):
        sys.exit(f"index: Blender accepted {len(entries)} of {len(zips)} zips; see its messages above")
    return sorted(entries, key=lambda entry: entry["platforms"])


def version_key(version: str) -> tuple[int, ...]:
    """Return MAJOR.MINOR.PATCH as numbers, for sorting."""
    return tuple(map(int, version.split(".")))


def write_index(path: Path, entries: list[dict], address: str, incomplete: bool) -> None:
    """Write a listing of one version, with absolute addresses of its archives."""
    version = entries[0]["version"]
    missing = PLATFORMS - {platform for entry in entries for platform in entry["platforms"]}
    if not incomplete and (missing or len(entries) != len(PLATFORMS)):
        sys.exit(f"index: version {version} needs one zip per platform; missing: {sorted(missing) or 'none'}")
    start = address.replace("{version}", version).rstrip("/")
    for entry in entries:
        entry["archive_url"] = f"{start}/{entry['archive_url'].removeprefix('./')}"
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps({"version": "v1", "blocklist": [], "data": entries}, indent=2)
    path.write_text(text + "\n", encoding="utf-8")
    print(f"index: {path}: version {version}, {len(entries)} archives")


def main(out: Path, address: str, zips: list[Path], incomplete: bool = False) -> None:
    """Write the listing of the newest version, and of the version before it if its zips are given."""
    entries = list_archives(zips)
    versions = sorted({entry["version"] for entry in entries}, key=version_key, reverse=True)
    for version, path in zip(versions, (out / "index.json", out / "index-previous.json"), strict=False):
        write_index(path, [entry for entry in entries if entry["version"] == version], address, incomplete)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Make the listing of the extension for Blender.")
    parser.add_argument("--incomplete", action="store_true", help="accept zips of some platforms")
    parser.add_argument("out", metavar="OUT", type=Path)
    parser.add_argument("address", metavar="ADDRESS")
    parser.add_argument("zips", metavar="ZIP", type=Path, nargs="+")
    main(**vars(parser.parse_args()))
