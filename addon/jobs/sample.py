"""Sample job: writes the sample run."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path

from ..errors import input_error
from ..progress import MessageCallback, Progress, no_message, silent
from ..staging import new_folder
from . import worker


def run(
    out: Path,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
) -> None:
    """Write the sample run as the folder `out`, unless it exists; it is renamed into place when complete.

    Raises
    ------
    InputError
        Another file or folder is there, or it cannot be written.
    """
    if (out / "run.toml").is_file():
        return
    if os.path.lexists(out) and (out.is_symlink() or not out.is_dir() or any(out.iterdir())):
        raise input_error(out, "exists already and is not the sample run; choose another folder")
    with new_folder(out) as part:
        worker.run(partial(in_blender, part), progress, stop=stop, tell=tell)


def in_blender(out: Path, progress: Progress, tell: MessageCallback) -> None:
    """Write the sample run."""
    from ..data import sample

    sample.write(out, None, "npy", lambda done, total: progress(done, total, "writing the sample run"))
