"""Content hashes of input files, by which baked and rendered files are matched to their inputs.

A run may hold gigabytes, so hashes are cached: in the run's folder if that is writable, else in the cache. A
file is hashed again when its size, timestamps or inode change.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import time
import uuid
from collections.abc import Callable, Collection, Iterable
from concurrent.futures import ThreadPoolExecutor, wait
from pathlib import Path
from typing import Any

from firetwin_core.run import Run

from ..errors import reading
from ..files import read_json
from ..progress import Progress, silent

REMEMBERED = ".firetwin-hashes.json"
IDENTITY = "film.json"
"""File of a run folder with a text that is equal for runs of other times of one film."""
_AXES = ("latitude", "longitude", "fuel_latitude", "fuel_longitude")
_STEP = 1 << 22  # bytes
_YOUNG = 2.0  # s; a file modified this recently may change again within the same timestamp

Stamp = tuple[int, ...]
_read: dict[tuple[Path, Stamp], str] = {}


def sha256(path: Path, step: Callable[[int], None] = lambda size: None) -> str:
    """Compute the SHA-256 of a file in hexadecimal; calls `step` with the number of bytes read."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(_STEP):
            digest.update(block)
            step(len(block))
    return digest.hexdigest()


def fingerprint(settings: dict[str, Any]) -> str:
    """Compute a short hash of settings, equal exactly if their JSON is equal."""
    text = json.dumps(settings, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def inputs(
    run: Run, cache: Path, leave_out: Collection[str] = (), progress: Progress = silent
) -> dict[str, str]:
    """Hash each field of a run (SHA-256); a field with a file per time has the hash of all their hashes.

    Only the run's own files count; other files in its folder are ignored.

    Parameters
    ----------
    cache
        Folder of the hash cache if the run's folder is read-only.
    leave_out
        Fields to skip.
    """
    folder = Path(run.path)
    fields = {path.name: _files(path) for path in _fields(run, leave_out)}
    places = folder / REMEMBERED, cache / f"run-{fingerprint({'run': str(folder.resolve())})}.json"
    hashes = _hashes(folder, [path for files in fields.values() for path in files], places, progress)
    result = {}
    for name, files in fields.items():
        lines = [f"{path.name} {hashes[path]}" for path in files]
        whole = (folder / name).is_dir()
        result[name] = hashlib.sha256("\n".join(lines).encode()).hexdigest() if whole else hashes[files[0]]
    return result


def identity(folder: Path) -> str:
    """Return the identity of a run folder, in place of hashes; "" for nearly all runs."""
    try:
        return str(read_json(folder / IDENTITY))
    except (OSError, ValueError):
        return ""


def field_names(run: Run) -> list[str]:
    """List the names of a run's description and fields, as `inputs` has them."""
    return [path.name for path in _fields(run, ())]


def of_file(path: Path, cache: Path, progress: Progress = silent) -> str:
    """Hash a file outside a run, with the hash cached in `cache`."""
    with reading(path):
        place = cache / f"file-{fingerprint({'file': str(path.resolve())})}.json"
        return _hashes(path.parent, [path], (place,), progress)[path]


def stamp(path: Path) -> Stamp:
    """Return the change stamp of a file: size, modification and change time, inode."""
    state = path.stat()
    return state.st_size, state.st_mtime_ns, state.st_ctime_ns, state.st_ino


def stamps(run: Run) -> dict[str, Stamp]:
    """Return change stamps of all files of a run, by name relative to its folder."""
    folder = Path(run.path)
    paths = (path for field in _fields(run, ()) for path in _files(field))
    return {path.relative_to(folder).as_posix(): stamp(path) for path in paths}


def settled(stamps: Iterable[Stamp]) -> bool:
    """Check that files are old enough for any further change to change their stamps."""
    return max(max(known[1:3]) for known in stamps) < time.time_ns() - int(_YOUNG * 1e9)


def _fields(run: Run, leave_out: Collection[str]) -> list[Path]:
    """List the description file of a run, and the file or folder of each field."""
    folder = Path(run.path)
    names = sorted({*_AXES, *run.fields} - {*leave_out})
    ends = (".npy", ".txt", "")
    present = (next((p for end in ends if (p := folder / f"{n}{end}").exists()), None) for n in names)
    return [folder / "run.toml", *(path for path in present if path is not None)]


def _files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    return sorted(file for file in path.iterdir() if file.suffix in (".npy", ".txt") and file.name[0] != ".")


def _hashes(folder: Path, paths: list[Path], places: tuple[Path, ...], progress: Progress) -> dict[Path, str]:
    stamps = {path: stamp(path) for path in paths}
    if any((path, stamps[path]) not in _read for path in paths):
        _load(folder, places)
        lacking = {path: stamps[path] for path in paths if (path, stamps[path]) not in _read}
        _read_all(lacking, progress)
        if lacking:
            _save(folder, places)
    return {path: _read[path, stamps[path]] for path in paths}


def _read_all(lacking: dict[Path, Stamp], progress: Progress) -> None:
    """Hash files in parallel and report the megabytes read."""
    total = sum(file_stamp[0] for file_stamp in lacking.values())
    sizes: list[int] = []
    with ThreadPoolExecutor() as pool:
        tasks = {path: pool.submit(sha256, path, sizes.append) for path in lacking}
        left = set(tasks.values())
        while left:
            left = wait(left, timeout=0.2).not_done
            if total > _STEP:
                progress(sum(sizes) // 10**6, max(total // 10**6, 1), "reading the run, MB")
    _read.update({(path, lacking[path]): task.result() for path, task in tasks.items()})


def _load(folder: Path, places: Iterable[Path]) -> None:
    """Load cached hashes; damaged cache files are ignored."""
    for place in places:
        with contextlib.suppress(OSError, ValueError, TypeError, AttributeError):
            for name, (digest, *found) in read_json(place).items():
                _read.setdefault((folder / name, tuple(found)), str(digest))


def _save(folder: Path, places: Iterable[Path]) -> None:
    """Save the hashes of a run's files in the first writable place."""
    record = {
        path.relative_to(folder).as_posix(): [digest, *found]
        for (path, found), digest in _read.items()
        if path.is_relative_to(folder) and settled([found]) and _unchanged(path, found)
    }
    for place in places:
        part = place.with_name(f"{place.name}.{uuid.uuid4().hex}")
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            part.write_text(json.dumps(record), encoding="utf-8", newline="\n")
            part.replace(place)
        except OSError:
            with contextlib.suppress(OSError):
                part.unlink(missing_ok=True)
        else:
            return


def _unchanged(path: Path, known: Stamp) -> bool:
    try:
        return stamp(path) == known
    except OSError:
        return False
