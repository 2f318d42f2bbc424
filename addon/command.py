"""Command: the declaration of a command of the command line, and arguments that several commands have.

A module ``command.py`` of a feature's folder, and each module of ``commands``, has one as `COMMAND`. A
feature can extend commands of others by `EXTENSIONS`. They are all imported for the help, and therefore
import no heavy module themselves.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from . import argument_types as types

RUNS, SCENES, FILMS, MACHINE = range(4)
"""Subjects of commands: the help lists them in this order, and the commands of a subject by name."""


def _none(parser: argparse.ArgumentParser) -> None:
    """Add no argument."""


def _as_given(words: list[str]) -> tuple[list[str], list[str]]:
    return words, []


@dataclass(frozen=True)
class Command:
    """A command.

    Attributes
    ----------
    name, summary
        Word of the command line, and one line of help.
    detail
        Further help, or a function that returns it.
    subject
        `RUNS`, `SCENES`, `FILMS` or `MACHINE`.
    run
        Runs the parsed command line; returns the exit status, None for 0.
    add
        Adds the arguments to a parser.
    prepare
        Completes the words after the command before they are parsed, and splits off `arguments.options`.
    former
        Former names, which work with a note.
    """

    name: str
    summary: str
    detail: str | Callable[[], str]
    subject: int
    run: Callable[[argparse.Namespace], int | None]
    add: Callable[[argparse.ArgumentParser], None] = _none
    prepare: Callable[[list[str]], tuple[list[str], list[str]]] = _as_given
    former: tuple[str, ...] = ()


def _run_nothing(arguments: argparse.Namespace) -> int | None:
    """Leave a call to the command."""
    return None


T = TypeVar("T")


def _amend_nothing(arguments: argparse.Namespace, value: T) -> T:
    return value


@dataclass(frozen=True)
class Extension:
    """An extension of another feature's command.

    Attributes
    ----------
    command
        Name of the command.
    add
        Adds arguments to its parser.
    run
        Runs a call in place of the command; returns its exit status, None to leave the call to the command.
    amend
        Completes a value of the command (see `amend`), and returns it.
    detail
        Further help.
    """

    command: str
    add: Callable[[argparse.ArgumentParser], None] = _none
    run: Callable[[argparse.Namespace], int | None] = _run_nothing
    amend: Callable = _amend_nothing
    detail: str = ""


def amend(arguments: argparse.Namespace, value: T) -> T:
    """Complete a value of a command by its extensions."""
    for each in getattr(arguments, "extensions", ()):
        value = each.amend(arguments, value)
    return value


def add_verb(verbs: argparse._SubParsersAction, name: str, summary: str) -> argparse.ArgumentParser:
    """Add a verb of a command; returns the parser of its arguments."""
    parser = verbs.add_parser(name, help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
    parser.add_argument("--debug", action="store_true", help="show a traceback when something fails")
    return parser


def add_scene(parser: argparse.ArgumentParser) -> None:
    """Add a scene file or a run folder, which `auto_framing.fitted_scene.find_source` reads."""
    help = "scene file, or run folder: settings are fitted to the run"
    parser.add_argument("scene", metavar="SCENE|RUN", type=types.path, help=help)


def add_overwrite(parser: argparse.ArgumentParser) -> None:
    """Add the option that replaces files of others (see `output`)."""
    help = "also replace files that changed or that Firetwin did not write"
    parser.add_argument("--overwrite", action="store_true", help=help)


def add_origin(parser: argparse.ArgumentParser) -> None:
    """Add options for the start time, place, name and time zone of a model's output."""
    parser.add_argument(
        "--start", metavar="TIME", default="", help="start time of the run, if the files do not give it"
    )
    parser.add_argument(
        "--at", metavar="LAT,LON", default="", help="centre of a grid without geographic coordinates"
    )
    parser.add_argument(
        "--projection",
        metavar="CRS",
        default="",
        help="coordinate reference system of grids in metres, such as EPSG:5070",
    )
    parser.add_argument("--name", default="", help="name of the run (name of the folder and model)")
    zone = "time zone of printed times, such as Europe/Paris (offset of --start, otherwise by longitude)"
    parser.add_argument("--zone", default="", help=zone)
