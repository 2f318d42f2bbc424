"""Last step of a data set: formats, table, card, Croissant metadata, report, and hashes of all files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .. import output
from ..errors import input_error
from ..progress import MessageCallback, no_message
from . import about, card, croissant, formats, licences, report, sums, table, truth
from .truth import Truth


def read_samples(folder: Path) -> list[Truth]:
    """Read the metadata of all complete samples, ascending.

    Raises
    ------
    InputError
        The folder has no samples, or a file is damaged.
    """
    samples = [truth.read(folder, index) for index in truth.indices(folder)]
    if not samples:
        raise input_error(folder, f"has no samples (no {truth.FOLDER}/*.json); name the folder of a data set")
    return samples


def write(
    folder: Path, names: Sequence[str], say: MessageCallback = no_message, overwrite: bool = False
) -> list[Path]:
    """Write the formats and the files about a complete data set; earlier ones are replaced.

    Parameters
    ----------
    names
        Formats (see `formats.names`). Those written earlier stay, and are not updated.
    overwrite
        Replace files of others (see `output`).

    Returns
    -------
    Card, report and hashes.
    """
    samples, facts = read_samples(folder), about.read(folder)
    for each in (table, report, card, croissant, sums):
        output.check(folder / each.NAME, overwrite)
    for name in names:
        say(f"writing {name}")
        formats.write(folder, samples, [name], overwrite)
    sources = licences.of_samples(samples)
    table.write(folder, samples, overwrite)
    report.write(folder, facts, samples, overwrite)
    card.write(folder, facts, samples, overwrite)
    hashes = {table.NAME: sums.digest(folder / table.NAME)}
    croissant.write(folder, facts, hashes, sources, overwrite)
    say("computing hashes")
    sums.write(folder, overwrite)
    return [folder / name for name in (card.NAME, report.NAME, sums.NAME)]
