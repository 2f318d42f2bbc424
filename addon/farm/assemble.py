"""The last stage of a job: every picture is checked and entered, and the films are made."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from ..jobs import render
from ..progress import MessageCallback, Progress, no_message, silent
from ..render import dataset, fingerprint, manifest
from ..render.fingerprint import Fingerprints
from ..render.picture import Picture
from ..render.store import Store
from ..run import content
from ..shot.schema import frame_list
from ..shot.shot import Shot
from . import entries, plan, task
from .entries import Entry
from .plan import Job
from .private import verified_entries

NOT_MADE, DAMAGED, OTHER = "not rendered", "not what was rendered", "of other settings"


def run(
    out: Path, scene: str = "", progress: Progress = silent, tell: MessageCallback = no_message
) -> dict[Picture, str]:
    """Enter all pictures that are whole in the store; where none is missing, make films and manifest.

    Returns
    -------
    Why each missing picture is missing. Films are made once none is.
    """
    job = plan.read(out)
    choice = task.source(job, out, scene)
    shot = choice.shot()
    made_with = fingerprints(job, shot, progress)
    whole, lost = check(job, out, made_with)
    with Store(out, create=True) as store:
        enter(store, whole, made_with)
        dataset.write(store)
        store.export()
    if not lost:
        render.run(choice, render.RenderRequest(out, resume=True), progress, tell, shot=shot)
    return lost


def fingerprints(job: Job, shot: Shot, progress: Progress = silent) -> Fingerprints:
    """Those of all of a job's pictures."""
    one = [Picture(view, 1, name) for view, names in job.passes.items() for name in names]
    return fingerprint.of_pictures(shot, one, progress)


def check(job: Job, out: Path, made_with: Fingerprints) -> tuple[list[list[Entry]], dict[Picture, str]]:
    """Read every file of the film.

    Returns
    -------
    The entries of each whole picture, and why each other one is missing.
    """
    known = entries.by_path(entries.attempts(out))
    every = (entry for made in known.values() for entry in made)
    verified = {entry.path: entry for entry in verified_entries(every, out, made_with)}
    keys = {pair: content.fingerprint(values) for pair, values in made_with.items()}
    whole: list[list[Entry]] = []
    lost: dict[Picture, str] = {}
    for picture in (each for part in job.tasks for each in job.pictures(part)):
        paths = picture.files()
        if lacking := [path for path in paths if path not in verified]:
            lost[picture] = _why(known.get(lacking[0], []), out, keys[picture.camera, picture.name])
        else:
            whole.append([verified[path] for path in paths])
    return whole, lost


def _why(found: list[Entry], out: Path, key: str) -> str:
    """Why a file is missing that has these entries."""
    ours = [each for each in found if each.fingerprint == key]
    if not ours:
        return OTHER if found else NOT_MADE
    return DAMAGED if (out / ours[0].path).exists() else NOT_MADE


def enter(store: Store, whole: Iterable[list[Entry]], made_with: Fingerprints) -> None:
    """Enter pictures in a store that does not have them yet."""
    new: dict[tuple[str, str], dict[str, dict[str, Any]]] = defaultdict(dict)
    for made in whole:
        if not store.is_intact(made[0].fingerprint, [each.path for each in made]):
            pair = made[0].camera, made[0].name
            new[pair] |= {each.path: each.plain() | manifest.credit_entry(made_with[pair]) for each in made}
    for pair, found in new.items():
        store.add(made_with[pair], found)


def described(lost: dict[Picture, str]) -> Iterator[str]:
    """A line per camera, pass and reason: ``drone rgb 3,7-9: not rendered``."""
    frames: dict[tuple[str, str, str], list[int]] = defaultdict(list)
    for picture, why in lost.items():
        frames[picture.camera, picture.name, why].append(picture.frame)
    for (camera, name, why), listed in frames.items():
        yield f"{camera} {name} {frame_list.write(sorted(listed))}: {why}"


def tasks_of(job: Job, lost: Iterable[Picture]) -> list[int]:
    """Numbers of the tasks that make these pictures."""
    wanted = {(each.camera.partition("@")[0], each.frame) for each in lost}
    return [
        number
        for number in job.numbers("render")
        if any(
            (camera, frame) in wanted
            for camera in job.task(number).cameras
            for frame in job.frames(job.task(number), camera)
        )
    ]
