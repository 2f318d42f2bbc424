"""Command line: finds the commands, runs one, and reports its error.

Results go to stdout, messages and progress to stderr. Exit status 0: done, 1: failed, 2: bad usage, 130:
Ctrl-C, 143: SIGTERM, 149: Ctrl-Break. Heavy modules are imported on demand, so that help and usage errors
answer at once.
"""

from __future__ import annotations

import argparse
import errno
import functools
import io
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from . import plugins
from .command import Command, Extension
from .escaped import escaped

_EPILOG = """\
a first film, from the sample run:
  firetwin sample sample                 writes the sample run (synthetic, King-like)
  firetwin info sample                   lists its content
  firetwin render examples/king_fire.toml --out film --resume

a film of your own run:
  firetwin render RUN --out film         fits cameras and times to the fire, and prints them
  firetwin new RUN -o my_scene.toml      writes them to a short scene file that you can edit
  firetwin render my_scene.toml --out film

`firetwin COMMAND --help` explains a command."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status."""
    arguments = parse(list(sys.argv[1:] if argv is None else argv))
    if sys.platform == "win32":
        for stream in (sys.stdout, sys.stderr):  # code pages do not have most letters of file names
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    elif isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="surrogateescape")  # print file names byte for byte
    try:
        for each in (*arguments.extensions, find_commands()[arguments.command]):
            if (status := each.run(arguments)) is not None:
                return status
        return 0
    except KeyboardInterrupt:
        print("\nfiretwin: stopped; finished files stay", file=sys.stderr)
        return 130
    except Exception as error:
        if _reader_has_gone(error):  # such as `firetwin info RUN | head`
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 1
        if arguments.debug:
            raise
        return _report(error)


def _reader_has_gone(error: Exception) -> bool:
    """Check for an error of a pipe that is no longer read; on Windows it is an invalid argument."""
    return isinstance(error, BrokenPipeError) or (
        sys.platform == "win32"
        and isinstance(error, OSError)
        and (error.errno, error.filename) == (errno.EINVAL, None)
    )


@functools.cache
def find_commands() -> dict[str, Command]:
    """Find the commands of this installation, by name: of `commands`, and of each feature's folder."""
    from . import commands

    own = [each.COMMAND for each in plugins.of_features("command") if hasattr(each, "COMMAND")]
    every = [*plugins.values(commands.__name__, "COMMAND").values(), *own]
    return {each.name: each for each in sorted(every, key=lambda each: (each.subject, each.name))}


@functools.cache
def find_extensions(command: str) -> tuple[Extension, ...]:
    """Find the extensions of a command, in each feature's folder."""
    every = (
        each for feature in plugins.of_features("command") for each in getattr(feature, "EXTENSIONS", ())
    )
    return tuple(each for each in every if each.command == command)


def parse(words: list[str]) -> argparse.Namespace:
    """Parse a command line."""
    commands = find_commands()
    options: list[str] = []
    former = {old: each.name for each in commands.values() for old in each.former}
    if words and words[0] in former:
        from .progress import say

        new = former[words[0]]
        say(f"`firetwin {words[0]}` is now `firetwin {new}`; the former name works until the next version")
        words = [new, *words[1:]]
    if words and words[0] in commands:
        rest, options = commands[words[0]].prepare(words[1:])
        words = [words[0], *rest]
    arguments = _parser(commands, words).parse_args(words)
    arguments.options, arguments.extensions = options, find_extensions(arguments.command)
    return arguments


def _report(error: Exception) -> int:
    """Print an error with its remedy in one line; returns the exit status."""
    from .errors import DISK_FULL, Error, UsageError, disk_is_full
    from .progress import say

    if isinstance(error, UsageError):
        say(str(error))
        return 2
    if isinstance(error, Error):
        text = str(error)
    elif isinstance(error, OSError) and disk_is_full(error):
        text = f"{error.filename2 or error.filename or 'output or temporary files'}: {DISK_FULL}"
    elif isinstance(error, OSError) and error.filename:
        text = f"{error.filename}: {error.strerror}"
    elif isinstance(error, ModuleNotFoundError) and error.name == "bpy":
        text = "Blender's Python module (bpy) is missing; install it with: pip install 'firetwin[blender]'"
    elif isinstance(error, ModuleNotFoundError) and error.name in ("matplotlib", "PIL"):  # not in Blender
        from . import extras

        pip = extras.install_packages("matplotlib")  # it brings Pillow
        text = f"maps and plots need matplotlib; install it with: {pip}"
    else:
        text = f"unexpected {type(error).__name__}: {error} (run again with --debug for the details)"
    say(text)
    return 1


def _parser(commands: dict[str, Command], words: Sequence[str] | None = None) -> argparse.ArgumentParser:
    """Define the command line; commands that are not among its words have only a name and a summary."""
    parser = _Parser(
        prog="firetwin",
        description="Turn the output of a fire-atmosphere model into a Blender scene, pictures and films.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="show the versions and exit")
    common = _Parser(add_help=False)
    common.add_argument("--debug", action="store_true", help="show a traceback when something fails")
    parsers = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for each in commands.values():
        if words is None or each.name in words:
            _add_command(parsers, each, common)
        else:
            parsers.add_parser(each.name, help=each.summary, add_help=False)
    return parser


def _add_command(parsers: argparse._SubParsersAction, command: Command, common: _Parser) -> None:
    """Add a command with its arguments and its help."""
    detail = command.detail if isinstance(command.detail, str) else command.detail()
    extensions = find_extensions(command.name)
    details = [
        f"{command.summary[0].upper()}{command.summary[1:]}.",
        detail,
        *(one.detail for one in extensions),
    ]
    parser = parsers.add_parser(
        command.name,
        help=command.summary,
        description="\n\n".join(filter(None, details)),
        parents=[common],
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    command.add(parser)
    for extension in extensions:
        extension.add(parser)


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        super().error(escaped(message))


class _Version(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        import firetwin_core

        libraries = ", ".join(f"{name} {version}" for name, version in firetwin_core.build_info().items())
        print(f"firetwin {firetwin_core.__version__} ({libraries})")
        parser.exit()
