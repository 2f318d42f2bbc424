"""AWS Deadline Cloud: a job bundle, that is an Open Job Description template with the files it needs."""

from __future__ import annotations

import json
from pathlib import Path

from ... import files
from ...errors import UsageError
from .. import entries
from ..plan import CACHE, FILE, job_dir
from . import openjd
from ._engine import Batch, Engine, firetwin_command

_TRIES = 3


class Deadline(Engine):
    """Bundle of template, parameter values and asset references for `deadline bundle submit`."""

    name = "deadline"
    help = "AWS Deadline Cloud: a job bundle"

    def write(self, batch: Batch) -> list[str]:
        """Write the bundle."""
        folder = self.folder(batch.out)
        program = "python" if firetwin_command()[1] == "-m" else "blender"  # on the PATH of the workers
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
        _, options = openjd.split_options(batch.options)
        return ["deadline", "bundle", "submit", *options, str(folder)]

    def cancel(self, out: Path) -> list[str]:
        """Refuse: Deadline Cloud needs the job ID that its submission printed."""
        raise UsageError(
            f"{out}: cancel it with deadline job cancel --job-id ID; the submission printed the ID"
        )


def _references(batch: Batch) -> dict[str, object]:
    """List the files that are uploaded to the workers, and the folder that is downloaded."""
    job = [str(job_dir(batch.out) / FILE)]
    return {
        "inputs": {"filenames": [*batch.job.assets, *job], "directories": _earlier_output(batch)},
        "outputs": {"directories": [str(batch.out)]},
        "referencedPaths": [],
    }


def _earlier_output(batch: Batch) -> list[str]:
    """List existing folders of entries, flows and pictures, from which a resubmitted job continues."""
    own, out = job_dir(batch.out), batch.out
    folders = [own / entries.FOLDER, own / CACHE, *(out / view for view in batch.job.passes)]
    return [str(folder) for folder in folders if folder.is_dir()]


ENGINE = Deadline
