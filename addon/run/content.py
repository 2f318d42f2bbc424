"""What is in files: hashes by which baked and rendered files know their inputs again.

A run may hold gigabytes, so the hashes of its files are remembered: in the run's folder where that can be
written, else in the cache. A file is read again when its size, times or place on the disk are others.
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

from ..progress import Progress, silent

REMEMBERED = ".firetwin-hashes.json"
_AXES = ("latitude", "longitude", "fuel_latitude", "fuel_longitude")
_STEP = 1 << 22  # bytes
_YOUNG = 2.0  # s; a file changed just now may change once more without another time of change

Stamp = tuple[int, ...]
_read: dict[tuple[Path, Stamp], str] = {}


def sha256(path: Path, step: Callable[[int], None] = lambda size: None) -> str:
    """SHA-256 of a file, in hexadecimal; `step` is told how many bytes more were read."""
    found = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(_STEP):
            found.update(block)
            step(len(block))
    return found.hexdigest()


def fingerprint(settings: dict[str, Any]) -> str:
    """Short hash of settings: equal exactly where their JSON is."""
    text = json.dumps(settings, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def inputs(
    run: Run, cache: Path, leave_out: Collection[str] = (), progress: Progress = silent
) -> dict[str, str]:
    """SHA-256 of each field of a run; of a field with one file per time, that of all their hashes.

    Only the run's own files count, whatever else lies in its folder.

    Parameters
    ----------
    cache
        Folder where hashes are remembered if not in the run's own.
    leave_out
        Fields that do not matter.
    """
    folder = Path(run.path)
    fields = {path.name: _files(path) for path in _fields(run, leave_out)}
    places = folder / REMEMBERED, cache / f"run-{fingerprint({'run': str(folder.resolve())})}.json"
    hashes = _hashes(folder, [path for files in fields.values() for path in files], places, progress)
    found = {}
    for name, files in fields.items():
        lines = [f"{path.name} {hashes[path]}" for path in files]
        whole = (folder / name).is_dir()
        found[name] = hashlib.sha256("\n".join(lines).encode()).hexdigest() if whole else hashes[files[0]]
    return found


def of_file(path: Path, cache: Path, progress: Progress = silent) -> str:
    """SHA-256 of a file that is no part of a run; remembered in the cache, as its folder is not ours."""
    place = cache / f"file-{fingerprint({'file': str(path.resolve())})}.json"
    return _hashes(path.parent, [path], (place,), progress)[path]


def stamp(path: Path) -> Stamp:
    """What changes when a file does: size, time of change of content and of anything, place on the disk."""
    state = path.stat()
    return state.st_size, state.st_mtime_ns, state.st_ctime_ns, state.st_ino


def stamps(run: Run) -> dict[str, Stamp]:
    """The stamps of all files of a run, by their names in its folder."""
    folder = Path(run.path)
    found = (path for field in _fields(run, ()) for path in _files(field))
    return {path.relative_to(folder).as_posix(): stamp(path) for path in found}


def settled(found: Iterable[Stamp]) -> bool:
    """Whether files have not changed so lately that they could change again without another stamp."""
    return max(max(each[1:3]) for each in found) < time.time_ns() - int(_YOUNG * 1e9)


def _fields(run: Run, leave_out: Collection[str]) -> list[Path]:
    """The description of a run, and the file or folder of each field."""
    folder = Path(run.path)
    names = sorted({*_AXES, *run.fields} - {*leave_out})
    ends = (".npy", ".txt", "")
    found = (next((p for end in ends if (p := folder / f"{n}{end}").exists()), None) for n in names)
    return [folder / "run.toml", *(path for path in found if path is not None)]


def _files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    return sorted(each for each in path.iterdir() if each.suffix in (".npy", ".txt") and each.name[0] != ".")


def _hashes(folder: Path, paths: list[Path], places: tuple[Path, ...], progress: Progress) -> dict[Path, str]:
    stamps = {path: stamp(path) for path in paths}
    if any((path, stamps[path]) not in _read for path in paths):
        _remember(folder, places)
        lacking = {path: stamps[path] for path in paths if (path, stamps[path]) not in _read}
        _read_all(lacking, progress)
        if lacking:
            _keep(folder, places)
    return {path: _read[path, stamps[path]] for path in paths}


def _read_all(lacking: dict[Path, Stamp], progress: Progress) -> None:
    """Read these files, several at once, and tell how many megabytes were read."""
    total = sum(found[0] for found in lacking.values())
    sizes: list[int] = []
    with ThreadPoolExecutor() as pool:
        tasks = {path: pool.submit(sha256, path, sizes.append) for path in lacking}
        left = set(tasks.values())
        while left:
            left = wait(left, timeout=0.2).not_done
            if total > _STEP:
                progress(sum(sizes) // 10**6, max(total // 10**6, 1), "reading the run, MB")
    _read.update({(path, lacking[path]): task.result() for path, task in tasks.items()})


def _remember(folder: Path, places: Iterable[Path]) -> None:
    """Take over what was written down; a damaged file counts for nothing."""
    for place in places:
        with contextlib.suppress(OSError, ValueError, TypeError, AttributeError):
            for name, (digest, *found) in json.loads(place.read_text(encoding="utf-8")).items():
                _read.setdefault((folder / name, tuple(found)), str(digest))


def _keep(folder: Path, places: Iterable[Path]) -> None:
    """Write down what is known of a run's files, in the first of these places that can be written."""
    known = {
        path.relative_to(folder).as_posix(): [digest, *found]
        for (path, found), digest in _read.items()
        if path.is_relative_to(folder) and settled([found]) and _still(path, found)
    }
    for place in places:
        part = place.with_name(f"{place.name}.{uuid.uuid4().hex}")
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            part.write_text(json.dumps(known), encoding="utf-8")
            part.replace(place)
        except OSError:
            with contextlib.suppress(OSError):
                part.unlink(missing_ok=True)
        else:
            return


def _still(path: Path, found: Stamp) -> bool:
    try:
        return stamp(path) == found
    except OSError:
        return False
