"""AWS Deadline Cloud: a job bundle, which is an Open Job Description template and the files it needs."""

from __future__ import annotations

import json
from pathlib import Path

from ... import files
from ...errors import UsageError
from .. import entries
from ..plan import CACHE, FILE, place
from . import openjd
from ._engine import Batch, Engine, find_command

_TRIES = 3


class Deadline(Engine):
    """A bundle of template, parameter values and asset references for `deadline bundle submit`."""

    name = "deadline"
    help = "AWS Deadline Cloud: a job bundle"

    def write(self, batch: Batch) -> list[str]:
        """Write the bundle."""
        folder = self.folder(batch.out)
        program = "python" if find_command()[1] == "-m" else "blender"  # those of the workers
        values = openjd.paths(batch) | {"Program": program, "deadline:maxRetriesPerTask": _TRIES}
        texts = {
            "template.json": openjd.template(batch),
            "parameter_values.json": {
                "parameterValues": [{"name": name, "value": value} for name, value in values.items()]
            },
            "asset_references.json": {"assetReferences": _references(batch)},
        }
        for name, found in texts.items():
            files.write_text(folder / name, json.dumps(found, indent=1) + "\n")
        return ["deadline", "bundle", "submit", *batch.options, str(folder)]

    def cancel(self, out: Path) -> list[str]:
        """Deadline Cloud knows the job by the number that it gave it."""
        raise UsageError(f"{out}: deadline job cancel --job-id ID cancels it; the submission printed the ID")


def _references(batch: Batch) -> dict[str, object]:
    """Files that travel to the workers, and the folder that comes back."""
    job = [str(place(batch.out) / FILE)]
    return {
        "inputs": {"filenames": [*batch.job.assets, *job], "directories": _made_before(batch)},
        "outputs": {"directories": [str(batch.out)]},
        "referencedPaths": [],
    }


def _made_before(batch: Batch) -> list[str]:
    """Folders of entries, flows and pictures that there are: what is submitted again goes on from them."""
    own, out = place(batch.out), batch.out
    folders = [own / entries.FOLDER, own / CACHE, *(out / view for view in batch.job.passes)]
    return [str(folder) for folder in folders if folder.is_dir()]


ENGINE = Deadline
