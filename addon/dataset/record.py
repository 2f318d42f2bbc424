"""Record of a data set: the plan and the versions that made it, so that no folder mixes two of them."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from .. import output
from ..errors import input_error, reading
from ..files import read_json
from ..render import fingerprint
from ..run import content
from .plan import Plan
from .run_scene import settings_of

NAME = "plan.json"
_FORMAT = "firetwin dataset 1"


def describe(plan: Plan, cache: Path) -> dict[str, Any]:
    """Describe a plan without the paths of this machine: values, hashes of scene files and runs, versions.

    Parameters
    ----------
    cache
        Folder that caches the hashes of runs.
    """
    from ..run import readers

    values = asdict(plan) | {"draws": {name: _drawn(each) for name, each in plan.draws.items()}}
    del values["path"]
    for run, planned in zip(values["runs"], plan.runs, strict=True):
        settings = settings_of(planned)
        hashes = content.inputs(readers.open(settings.run), cache)
        run["sha256"] = content.fingerprint({"run": hashes})
        run["scene_sha256"] = content.sha256(planned.run) if planned.run.is_file() else ""
        del run["run"], run["ensemble"]
        if not run["member"]:
            del run["member"]
    return {"format": _FORMAT, "versions": fingerprint.versions(), "plan": json.loads(json.dumps(values))}


def _drawn(distribution: Any) -> dict[str, Any]:
    return {"kind": type(distribution).__name__} | asdict(distribution)


def write(out: Path, record: dict[str, Any]) -> None:
    """Write the record of a data set, or check that its folder has the same one.

    Raises
    ------
    InputError
        The folder has samples of another plan, or of other versions.
    """
    path = out / NAME
    if not path.exists():
        output.write_text(path, json.dumps(record, indent=1) + "\n")
        return
    former = read(out)
    if former != record:
        changed = ", ".join(_changes(former, record)) or "format"
        reason = f"describes another data set (changed: {changed}); choose another folder for --out"
        raise input_error(path, reason)


def read(out: Path) -> dict[str, Any]:
    """Read the record of a data set.

    Raises
    ------
    InputError
        The folder has no data set, or the file is damaged.
    """
    path = out / NAME
    if not path.is_file():
        raise input_error(path, "the folder has no data set; make one with: firetwin dataset PLAN --out DIR")
    with reading(path):
        record = read_json(path)
    if not isinstance(record, dict):
        raise input_error(path, "is not the record of a data set; choose another folder for --out")
    return record


def _changes(former: dict[str, Any], record: dict[str, Any]) -> list[str]:
    """List the names of changed values."""
    before, after = former.get("plan", {}), record["plan"]
    names = [name for name in after if before.get(name) != after[name] and name != "draws"]
    drawn = [
        f"draws.{name}" for name, each in after["draws"].items() if before.get("draws", {}).get(name) != each
    ]
    versions = [
        f"version of {name}"
        for name, each in record["versions"].items()
        if former.get("versions", {}).get(name) != each
    ]
    return [*names, *drawn, *versions]
