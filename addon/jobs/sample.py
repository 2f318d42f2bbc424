"""Sample job: writes the sample run."""

from __future__ import annotations

import shutil
from functools import partial
from pathlib import Path

from ..progress import MessageCallback, Progress, no_message, silent
from . import worker


def run(
    out: Path,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
) -> None:
    """Write the sample run as the folder `out`, unless it exists; it is renamed into place when complete."""
    if (out / "run.toml").is_file():
        return
    part = out.with_name(f".{out.name}.part")
    shutil.rmtree(part, ignore_errors=True)
    try:
        worker.run(partial(in_blender, part), progress, stop=stop, tell=tell)
        part.rename(out)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def in_blender(out: Path, progress: Progress, tell: MessageCallback) -> None:
    """Write the sample run."""
    from ..data import sample

    sample.write(out, None, "npy", lambda done, total: progress(done, total, "writing the sample run"))
