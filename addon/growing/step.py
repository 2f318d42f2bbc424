"""A step of a watch: reads a model's files once, and publishes the times that are complete.

It runs in a worker process, where HDF5 is loaded without file locks: a lock makes the next write of the model
fail. Files are closed at the end of the step.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path

from ..errors import Error, input_error
from ..run.models.model import Model, Options
from . import acceptance, revision, stamps, watched
from .acceptance import Listed
from .watched import Accepted

LOCKS = "HDF5_USE_FILE_LOCKING"
_MOST = 1 << 28  # bytes of the new times of one step


@dataclass
class Outcome:
    """Result of a step.

    Attributes
    ----------
    new
        Accepted times.
    pending
        Number of listed times that are not known to be complete.
    more
        Further times are complete; the next step reads them.
    restarted
        Reason why a new generation began; "".
    tried
        Hashes by time of values in files that changed while they were read; the next step compares them.
    message
        Reason why nothing could be read.
    """

    new: list[Accepted] = field(default_factory=list)
    pending: int = 0
    more: bool = False
    restarted: str = ""
    tried: dict[str, str] = field(default_factory=dict)
    message: str = ""


def run(
    source: Path,
    extra: list[Path],
    folder: Path,
    options: Options,
    logged: dict[str, int],
    stable: list[str],
    ended: bool,
    tried: dict[str, str],
) -> Outcome:
    """Read the files, and publish a revision if there are new complete times.

    Parameters
    ----------
    source, extra
        File, folder or store of the model, and further files, such as a mapping.
    folder
        Watched folder.
    logged, stable, ended
        As `acceptance.reasons`.
    tried
        From the outcome of the step before.
    """
    os.environ[LOCKS] = "FALSE"
    from ..run import readers

    before = watched.times(folder)
    paths = readers.gathered([source, *extra])
    options = replace(options, growing=True)
    stamped = stamps.scan(source)
    model = _open(paths, options)
    try:
        listed = [Listed(model.moment(k), *model.sources[k]) for k in range(len(model.times))]
        accepted = watched.last_generation(before) if before else []
        restarted = _restart(model, listed, accepted) if accepted else ""
        if restarted:
            accepted = []
        generation = 1 if not before else before[-1].generation + bool(restarted)
        outcome = Outcome(restarted=restarted)
        reasons = acceptance.reasons(listed, logged, stable, ended)
        after = accepted[-1].moment if accepted else None
        origin = accepted[0].origin if accepted else model.start
        values: list[revision.Fields] = []
        size = 0
        for k, (each, reason) in enumerate(zip(listed, reasons, strict=True)):
            if after is not None and each.moment <= after:
                continue
            outcome.more = size > _MOST
            if not reason or outcome.more:
                break
            try:
                fields = revision.read_time(model, k)
            except revision.UnwrittenError:
                break
            time, hashed = each.moment.isoformat(), revision.digest(fields)
            if stamps.scan(source).get(str(each.path)) != stamped.get(str(each.path)):
                outcome.tried[time] = hashed
                if tried.get(time) != hashed:
                    break
            outcome.new.append(
                Accepted(
                    generation=generation,
                    revision=0,
                    time=time,
                    seconds=(each.moment - origin).total_seconds(),
                    source=each.path.name,
                    index=each.index,
                    complete=reason,
                    sha256=hashed,
                    accepted=datetime.now(UTC).isoformat(timespec="seconds"),
                )
            )
            values.append(fields)
            size += sum(each.nbytes for each in fields.values())
        outcome.pending = sum(after is None or each.moment > after for each in listed) - len(outcome.new)
    finally:
        model.close()
    if outcome.new:
        count = len(accepted) + len(outcome.new)
        outcome.new = [replace(each, revision=count) for each in outcome.new]
        _publish(folder, paths, options, before, accepted, outcome.new, values)
    return outcome


def _open(paths: list[Path], options: Options) -> Model:
    from ..run import readers

    model = readers.reader(paths).read(paths, options)
    if len(model.sources) != len(model.times):
        model.close()
        reason = (
            "has no heat flux for each time, so that its times are computed at the end; "
            "use firetwin convert when the model has ended"
        )
        raise input_error(paths[0], reason)
    return model


def _publish(
    folder: Path,
    paths: list[Path],
    options: Options,
    before: list[Accepted],
    accepted: list[Accepted],
    new: list[Accepted],
    values: list[revision.Fields],
) -> None:
    """Publish the revision with times read up to the last accepted one, then list the times."""
    model = _open(paths, replace(options, until=new[-1].moment))
    try:
        origin = (accepted or new)[0].origin
        shift = (origin - model.start).total_seconds()
        model.name, model.zone = options.name or f"{folder.name} ({model.name})", options.zone
        get = model.still.get("fuel_arrival_time")
        if get is not None and shift:
            model.still["fuel_arrival_time"] = lambda: get() - shift
        model.start = origin
        revision.publish(folder, model, accepted, new, values, new[-1].sha256)
    finally:
        model.close()
    watched.append(folder, before, new)
    revision.remove_old(folder, new[-1].generation)


def _restart(model: Model, listed: list[Listed], accepted: list[Accepted]) -> str:
    """Return why the files are of another start of the model than the accepted times; "" if they are not."""
    by_moment = {each.moment: k for k, each in enumerate(listed)}
    if listed[-1].moment < accepted[-1].moment:
        return f"times go back from {accepted[-1].time} to {listed[-1].moment.isoformat()}"
    for each in {accepted[0].time: accepted[0], accepted[-1].time: accepted[-1]}.values():
        k = by_moment.get(each.moment)
        if k is None:
            continue
        try:
            same = revision.digest(revision.read_time(model, k)) == each.sha256
        except (revision.UnwrittenError, Error):
            continue
        if not same:
            return f"the values of {each.time} changed"
    return ""
