"""Base class of schedulers, and the command that their tasks run."""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from ..plan import Job, job_dir


@dataclass(frozen=True)
class Batch:
    """Tasks of a job to submit: all, or those with missing pictures.

    Attributes
    ----------
    out
        Output folder, absolute.
    numbers
        Task numbers, ascending.
    options
        Options of the scheduler's command, as the user wrote them.
    """

    job: Job
    out: Path
    numbers: tuple[int, ...]
    options: tuple[str, ...] = ()

    def stage(self, name: str) -> list[int]:
        """List its tasks of a stage."""
        wanted = set(self.numbers)
        return [number for number in self.job.numbers(name) if number in wanted]


class Engine(ABC):
    """Translator of a job into the files of a scheduler.

    Attributes
    ----------
    name
        Name of its module, and of its folder next to the job.
    help
        Description in one line.
    """

    name: ClassVar[str]
    help: ClassVar[str]

    @abstractmethod
    def write(self, batch: Batch) -> list[str]:
        """Write the scheduler's files for a batch; returns the command that submits it."""

    @abstractmethod
    def cancel(self, out: Path) -> list[str]:
        """Return the command that cancels the submitted tasks.

        Raises
        ------
        UsageError
            The scheduler has no such command; the message explains how to cancel.
        """

    def folder(self, out: Path) -> Path:
        """Return the folder of the scheduler's files."""
        return job_dir(out) / self.name


def firetwin_command() -> list[str]:
    """Return the command that runs this Firetwin: Python, or Blender's executable for the extension.

    An extension can only be imported by Blender's own Python.
    """
    blender = sys.modules["bpy"].app.binary_path if "bpy" in sys.modules else ""
    if blender:
        return [blender, "--background", "--disable-autoexec", "--command", "firetwin"]
    return [sys.executable, "-m", __package__.removesuffix(".farm.engines")]
