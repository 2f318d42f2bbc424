"""Check of a data set (`firetwin dataset check`): files, hashes, labels, formats, splits, copies, balance."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path

from ..errors import Error, InputError, input_error
from ..progress import Progress, silent
from . import about, check_formats, check_labels, sums, table, truth, twins
from .findings import RESUME, Finding, limited
from .formats import common
from .truth import Truth

_LEVELS = "place", "run", "camera"
_BALANCED = 20  # samples of a split, from which it should have each category and negatives


def check(folder: Path, progress: Progress = silent) -> Iterator[Finding]:
    """Yield the faults of a data set, and remarks.

    Parameters
    ----------
    progress
        Called with finished and all samples.

    Raises
    ------
    InputError
        The folder has no samples.
    """
    yield from limited(_check(folder, progress))


def _check(folder: Path, progress: Progress) -> Iterator[Finding]:
    facts = about.read(folder)
    samples: list[Truth] = []
    for index in truth.indices(folder):
        try:
            samples.append(truth.read(folder, index))
        except InputError as error:
            yield Finding("files", f"{error.reason}: {Path(error.path).relative_to(folder).as_posix()}")
    if not samples:
        raise input_error(folder, f"has no samples (no {truth.FOLDER}/*.json); name the folder of a data set")
    yield from _files(folder, facts, samples)
    yield from _hashes(folder, {path for sample in samples for path in sample.files.values()})
    prints = []
    for done, sample in enumerate(samples):
        progress(done, len(samples))
        found, mark = _pictures(folder, sample)
        yield from found
        if mark is not None:
            prints.append(mark)
        if not all((folder / path).is_file() for path in sample.files.values()):
            continue
        try:
            yield from check_labels.check(folder, sample)
        except Error as error:
            yield Finding("files", str(error))
    progress(len(samples), len(samples))
    yield from check_formats.check(folder, samples)
    yield from _splits(facts, samples)
    yield from _twins(prints)
    yield from _balance(samples)


def _files(folder: Path, facts: about.About, samples: Sequence[Truth]) -> Iterator[Finding]:
    """Find missing samples and files, and half-written ones."""
    for path in sums.leftovers(folder):
        yield Finding("files", f"{path}: was left half-written by a process that ended; delete it")
    if missing := sorted(set(range(1, facts.count + 1)) - {sample.index for sample in samples}):
        shown = ", ".join(map(str, missing[:5])) + (" and others" if len(missing) > 5 else "")
        text = f"{len(missing):,} of {facts.count:,} samples are missing ({shown})"
        yield Finding("files", f"{folder}: {text}; resume it: firetwin dataset PLAN.toml --out {folder}")
    for sample in samples:
        meta = truth.name(sample.index)
        for path in sample.files.values():
            file = folder / path
            if not file.is_file() or not file.stat().st_size:
                state = "is empty" if file.is_file() else "is missing"
                yield Finding("files", f"{path}: {state}; {RESUME.format(path=meta, folder=folder)}")


def _hashes(folder: Path, of_samples: set[str]) -> Iterator[Finding]:
    """Compare the files with SHA256SUMS, except missing ones of samples, which `_files` reports."""
    again = f"if the change is wanted, compute the hashes again: firetwin dataset formats {folder}"
    if not (folder / sums.NAME).is_file():
        yield Finding(
            "hashes", f"{sums.NAME}: is missing, so the data set is not complete; resume it, or {again}"
        )
        return
    listed, present = sums.read(folder), set(sums.paths(folder))
    for path in sorted(set(listed) - present - of_samples):
        yield Finding("hashes", f"{path}: is in {sums.NAME} and missing; restore it, or {again}")
    for path in sorted(present - set(listed)):
        yield Finding("hashes", f"{path}: is not in {sums.NAME}; remove it, or {again}")
    for path in sorted(present & set(listed)):
        if sums.digest(folder / path) != listed[path]:
            yield Finding("hashes", f"{path}: differs from {sums.NAME}; restore it, or {again}")


def _pictures(folder: Path, sample: Truth) -> tuple[list[Finding], twins.Fingerprint | None]:
    """Read the visible picture of a sample."""
    path = common.picture(sample)
    if not (folder / path).is_file():
        return [], None  # reported with the files
    try:
        grey = twins.grey(folder / path)
    except InputError as error:
        return [Finding("files", f"{path}: {error.reason}")], None
    except (OSError, SyntaxError, ValueError):
        meta = truth.name(sample.index)
        remedy = RESUME.format(path=meta, folder=folder)
        return [Finding("files", f"{path}: is damaged or half-written; {remedy}")], None
    return [], twins.Fingerprint(sample.index, sample.split or common.UNSPLIT, grey)


def _splits(facts: about.About, samples: Sequence[Truth]) -> Iterator[Finding]:
    """Find groups that are in two splits, by the kind of group that the plan keeps apart."""
    levels = _LEVELS[_LEVELS.index(facts.split_by) :] if facts.split_by in _LEVELS else _LEVELS[-1:]
    if len(common.by_split(samples)) < 2:
        return
    for level in levels:
        for group, splits in sorted(_groups(samples, level).items()):
            if len(splits) > 1:
                shown = " and ".join(sorted(splits))
                remedy = f'write the data set again with split_by = "{level}"'
                yield Finding("splits", f'{level} "{group}" is in {shown}, so scores are too high; {remedy}')


def _groups(samples: Sequence[Truth], level: str) -> dict[str, set[str]]:
    """Return the splits of each group; a camera belongs to its run, and a run to its place."""
    found: dict[str, set[str]] = defaultdict(set)
    for sample in samples:
        if level in sample.groups:
            names = [sample.groups.get(name, "") for name in _LEVELS[: _LEVELS.index(level) + 1]]
            found[" / ".join(names)].add(sample.split or common.UNSPLIT)
    return found


def _twins(prints: Sequence[twins.Fingerprint]) -> Iterator[Finding]:
    for a, b in twins.find(prints):
        text = f"samples {a.index} ({a.split}) and {b.index} ({b.split}) are near copies"
        yield Finding("copies", f"{text}; remove one of them, or draw more moments and sites in the plan")


def _balance(samples: Sequence[Truth]) -> Iterator[Finding]:
    """Find splits without a category or without negatives, and report the share of negatives."""
    for split, members in common.by_split(samples).items():
        labels = Counter(each.category for sample in members for each in sample.annotations)
        negatives = sum(sample.is_negative for sample in members)
        counts = ", ".join(f"{labels[each.id]:,} {each.name}" for each in common.THINGS)
        share = f"{negatives / len(members):.0%} without fire and smoke"
        text = f"{split}: {len(members):,} samples, {share}; labels: {counts}"
        yield Finding("balance", text, is_fault=False)
        burning = [sample for sample in members if table.kind(sample) == "fire"]
        if hidden := sum(not sample.annotations for sample in burning):
            part = f"{hidden:,} of {len(burning):,} samples with fire"
            text = f"{split}: {part} have no label (hidden, too small or too thin)"
            yield Finding("balance", text, is_fault=False)
        absent = [each.name for each in common.THINGS if not labels[each.id]]
        absent += [] if negatives else ["samples without fire and smoke"]
        if absent and len(members) >= _BALANCED:
            remedy = "draw more samples, or change positives and [splits] in the plan"
            yield Finding("balance", f"{split}: has no {' and no '.join(absent)}; {remedy}")
