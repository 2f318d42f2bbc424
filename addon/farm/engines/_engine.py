"""What an engine is, and what all engines share."""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from ..plan import Job, place


@dataclass(frozen=True)
class Batch:
    """What is to be submitted of a job: all of it, or what is missing.

    Attributes
    ----------
    out
        Output folder, absolute.
    numbers
        Of the tasks, ascending.
    options
        The engine's own, as the user wrote them.
    """

    job: Job
    out: Path
    numbers: tuple[int, ...]
    options: tuple[str, ...] = ()

    def stage(self, name: str) -> list[int]:
        """Its tasks of a stage."""
        wanted = set(self.numbers)
        return [number for number in self.job.numbers(name) if number in wanted]


class Engine(ABC):
    """Turns a job into an engine's own text.

    Attributes
    ----------
    name
        Of its module, and of its folder beside the job.
    help
        One line.
    """

    name: ClassVar[str]
    help: ClassVar[str]

    @abstractmethod
    def write(self, batch: Batch) -> list[str]:
        """Write the engine's text of a batch; the command that submits it."""

    @abstractmethod
    def cancel(self, out: Path) -> list[str]:
        """The command that cancels what was submitted.

        Raises
        ------
        UsageError
            This engine is told otherwise to do so; says how.
        """

    def folder(self, out: Path) -> Path:
        """Folder of its text."""
        return place(out) / self.name


def find_command() -> list[str]:
    """The command that runs this Firetwin: by Python, or by Blender's executable if it runs there.

    In Blender's executable Firetwin is an extension, a module of which no Python outside knows.
    """
    blender = sys.modules["bpy"].app.binary_path if "bpy" in sys.modules else ""
    if blender:
        return [blender, "--background", "--disable-autoexec", "--command", "firetwin"]
    return [sys.executable, "-m", __package__.removesuffix(".farm.engines")]
