"""The command `firetwin brief`."""

from __future__ import annotations

import argparse

from .. import files
from ..errors import UsageError
from ..progress import READING, notify_if_slow, result, say


def run(arguments: argparse.Namespace) -> None:
    """Write the briefing page of a run.

    Raises
    ------
    UsageError
        The name of the page does not end in .html, or its limit is too small for any content.
    """
    if arguments.out.suffix.lower() != ".html":
        raise UsageError(f"--out: {arguments.out} does not end in .html; name an .html file")
    from .. import html_text  # imported after the quick check
    from . import briefing, context, map_sheet, page, pdf, sheet_options

    page.check_limit(arguments.limit)
    pdf.check(arguments.pdf, arguments.geopdf)
    if arguments.period and arguments.period[0] >= arguments.period[1]:
        raise UsageError("--period: its first time is not before its last; give the first time first")
    request = briefing.Request(
        arguments.scene,
        arguments.stations,
        arguments.film,
        arguments.against,
        arguments.limit,
        [context.parse(each) for each in arguments.context],
        sheet_options.of_arguments(arguments),
        arguments.ensemble,
    )
    with notify_if_slow(READING):
        found = briefing.gather(request)
    for note in page.notes(found):
        say(note)
    made = page.html(found, arguments.limit)
    files.write_text(arguments.out, made, newline="\n")
    say(f"wrote one file of {html_text.size(len(made.encode()))}, which loads no other files")
    result(arguments.out)
    if arguments.pdf:
        pdf.write(arguments.out, arguments.pdf)
        result(arguments.pdf)
    if arguments.geopdf:
        titles = sheet_options.Titles.of(found.run, found.sheet, found.zone)
        sheet = map_sheet.draw(found, found.sheet, titles)
        pdf.write_geopdf(sheet, titles.incident, titles.author, arguments.geopdf)
        result(arguments.geopdf)
