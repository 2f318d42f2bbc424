"""Version folder of a delivery: complete or missing, never overwritten, with hashes of its files.

A version's number is taken when its copy begins, so two deliveries at the same time get different numbers.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
from collections.abc import Iterator
from pathlib import Path

from .. import files, output, unfinished
from ..errors import UsageError, input_error, writing
from ..progress import Progress, silent
from ..staging import new_folder
from .names import File, Selection

MANIFEST, SUMS, LATEST = "manifest.json", "SHA256SUMS", "latest"
_FORMAT = 1
_BLOCK = 1 << 22  # bytes
_VERSION = r"v(\d{3,})"


def write(
    out: Path,
    chosen: Selection,
    number: int | None = None,
    progress: Progress = silent,
    overwrite: bool = False,
) -> Path:
    """Copy files into a new version; return its folder.

    The files are copied into a hidden folder, which gets its name at the end. Copies, not links: a later
    render replaces finished files.

    Parameters
    ----------
    number
        Number of the version; None: the next.
    overwrite
        Replace a link or file ``latest`` of others.

    Raises
    ------
    UsageError
        The version exists.
    InputError
        A file changed since it was rendered, the disk is full, or the folder cannot be written.
    """
    out = out.absolute()
    _check_latest(out, overwrite)
    with _version(out, number) as (part, path):
        number, delivered = int(path.name[1:]), {}
        for done, each in enumerate(chosen.files):
            progress(done, len(chosen.files), "copying")
            delivered[_copy(each, part, path.name)] = each
        progress(len(chosen.files), len(chosen.files), "copying")
        _list(part, number, delivered)
    with writing(out / LATEST), unfinished.locked(out, wait=True):
        _point(out, _folder(max(_numbers(out))), overwrite)
    return path


@contextlib.contextmanager
def _version(out: Path, number: int | None) -> Iterator[tuple[Path, Path]]:
    """Take a number; returns a temporary folder, and the folder that it becomes."""
    with contextlib.ExitStack() as life:
        with writing(out):
            out.mkdir(parents=True, exist_ok=True)
        with unfinished.locked(out, wait=True):
            begun = unfinished.rests(out, _VERSION)
            if number is None:
                number = max([*_numbers(out), *(int(each[1:]) for each in begun)], default=0) + 1
            path = out / _folder(number)
            if os.path.lexists(path) or path.name in begun:
                text = "exists, and a delivered version is never overwritten; omit --version"
                raise UsageError(f"--version: {path} {text}")
            part = life.enter_context(new_folder(path))
        yield part, path


def _copy(each: File, part: Path, version: str) -> str:
    """Copy a file, compare its hash, and return its path in the version."""
    name = each.pattern.replace("{version}", version)
    path, digest = part / name, hashlib.sha256()
    path.parent.mkdir(parents=True, exist_ok=True)
    with each.source.open("rb") as source, path.open("xb") as copy:
        while block := source.read(_BLOCK):
            digest.update(block)
            copy.write(block)
        copy.flush()
        os.fsync(copy.fileno())
    if digest.hexdigest() != each.sha256:
        raise input_error(each.source, "changed since it was rendered; render it again with --resume")
    return name


def _list(part: Path, number: int, delivered: dict[str, File]) -> None:
    """Write the manifest and the list of hashes."""
    listed = {
        name: {"bytes": each.bytes, "sha256": each.sha256, **each.facts}
        for name, each in sorted(delivered.items())
    }
    content = {"format": _FORMAT, "version": number, "files": listed}
    files.write_text(part / MANIFEST, json.dumps(content, indent=1) + "\n")
    sums = "".join(f"{each.sha256}  {name}\n" for name, each in sorted(delivered.items()))
    files.write_text(part / SUMS, sums)


def _check_latest(out: Path, overwrite: bool) -> None:
    """Check that the link `latest`, or the file in its place, may be replaced.

    Raises
    ------
    InputError
        It is of others.
    """
    link = out / LATEST
    output.refuse_run_folders(link)
    if link.is_symlink():
        if not overwrite and not re.fullmatch(_VERSION, os.readlink(link)):
            raise input_error(link, f"is a link that firetwin deliver did not write; {output.REMEDY}")
    elif link.exists():
        output.check(out / f"{LATEST}.txt", overwrite)


def _point(out: Path, version: str, overwrite: bool) -> None:
    """Point the link `latest` to a version; a text file names it where links are not possible."""
    link = out / LATEST
    if link.is_symlink() or not link.exists():
        with unfinished.folder(link) as part, contextlib.suppress(OSError, NotImplementedError):
            (part / LATEST).symlink_to(version, target_is_directory=True)
            (part / LATEST).replace(link)
            return
    output.write_text(out / f"{LATEST}.txt", f"{version}\n", overwrite)


def _folder(number: int) -> str:
    return f"v{number:03d}"


def _numbers(out: Path) -> list[int]:
    """List the numbers of the versions in a folder."""
    found = (re.fullmatch(_VERSION, path.name) for path in (out.iterdir() if out.is_dir() else ()))
    return [int(match[1]) for match in found if match]
