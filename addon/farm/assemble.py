"""Last stage of a job: check every picture, enter it in the store, and make the films."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from ..jobs import render
from ..progress import MessageCallback, Progress, no_message, silent
from ..render import dataset, fingerprint
from ..render.fingerprint import Fingerprints
from ..render.picture import Picture
from ..render.store import Store
from ..run import content
from ..shot.schema.frame_list import FrameList
from ..shot.shot import Shot
from . import divided, entries, plan, task
from .entries import Entry
from .plan import Job
from .private import verified_entries

NOT_MADE, DAMAGED, OTHER = "not rendered", "damaged or replaced", "rendered with other settings"


def run(
    out: Path, scene: str = "", progress: Progress = silent, tell: MessageCallback = no_message
) -> dict[Picture, str]:
    """Enter all intact pictures in the store; make films and manifest if the film is complete.

    Returns
    -------
    Missing pictures, each with the reason.
    """
    job = plan.read(out)
    choice = task.job_source(job, out, scene)
    if job.feature:
        if not (unfinished := divided.missing(job, out)):
            divided.work(job).finish(Path(choice.scene), out)
        return unfinished
    shot = choice.shot()
    made_with = fingerprints(job, shot, progress)
    intact, missing = check_pictures(job, out, made_with)
    with Store(out, create=True) as store:
        add_to_store(store, intact, made_with)
        dataset.write(store)
        store.export()
    if not missing:
        render.run(choice, render.RenderRequest(out, resume=True), progress, tell, shot=shot)
    return missing


def fingerprints(job: Job, shot: Shot, progress: Progress = silent) -> Fingerprints:
    """Compute the settings that determine each picture of a job."""
    one = [Picture(view, 1, name) for view, names in job.passes.items() for name in names]
    return fingerprint.compute(shot, one, progress)


def check_pictures(
    job: Job, out: Path, made_with: Fingerprints
) -> tuple[list[list[Entry]], dict[Picture, str]]:
    """Compare every file of the film with its entries.

    Returns
    -------
    The entries of each intact picture, and the missing pictures with their reasons.
    """
    entries_of = entries.by_path(entries.attempts(out))
    every = (entry for made in entries_of.values() for entry in made)
    verified = {entry.path: entry for entry in verified_entries(every, out, made_with)}
    keys = {pair: content.fingerprint(values) for pair, values in made_with.items()}
    intact: list[list[Entry]] = []
    missing: dict[Picture, str] = {}
    for picture in (each for part in job.tasks for each in job.pictures(part)):
        paths = picture.files()
        if lacking := [path for path in paths if path not in verified]:
            missing[picture] = _why(entries_of.get(lacking[0], []), out, keys[picture.camera, picture.name])
        else:
            intact.append([verified[path] for path in paths])
    return intact, missing


def _why(found: list[Entry], out: Path, key: str) -> str:
    """Give the reason why a file with these entries is missing."""
    current = [each for each in found if each.fingerprint == key]
    if not current:
        return OTHER if found else NOT_MADE
    return DAMAGED if (out / current[0].path).exists() else NOT_MADE


def add_to_store(store: Store, intact: Iterable[list[Entry]], made_with: Fingerprints) -> None:
    """Add pictures to a store, except those that it has already."""
    new: dict[tuple[str, str], dict[str, dict[str, Any]]] = defaultdict(dict)
    for made in intact:
        if not store.is_intact(made[0].fingerprint, [each.path for each in made]):
            pair = made[0].camera, made[0].name
            new[pair] |= {each.path: each.as_row() for each in made}
    for pair, found in new.items():
        store.add(made_with[pair], found)


def format_missing(missing: dict[Picture, str]) -> Iterator[str]:
    """Yield a line per camera, pass and reason: ``drone rgb 3,7-9: not rendered``."""
    frames: dict[tuple[str, str, str], list[int]] = defaultdict(list)
    for picture, why in missing.items():
        frames[picture.camera, picture.name, why].append(picture.frame)
    for (camera, name, why), listed in frames.items():
        yield f"{camera} {name} {FrameList.of(sorted(listed))}: {why}"


def tasks_of_pictures(job: Job, missing: Iterable[Picture]) -> list[int]:
    """List the numbers of the tasks that render these pictures."""
    wanted = {(each.camera.partition("@")[0], each.frame) for each in missing}
    return [
        number
        for number in job.numbers("render")
        if any(
            (camera, frame) in wanted
            for camera in job.task(number).cameras
            for frame in job.frames(job.task(number), camera)
        )
    ]
