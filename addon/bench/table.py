"""The report as text for a terminal and as Markdown."""

from __future__ import annotations

from collections.abc import Iterator

from .harness import OURS, Report, Row, Target

SHOWN = {
    "text": "720 x 720",
    "geodesy": "720 x 720",
    "forest": "720 x 720",
    "emitters": "144 x 144",
}
"""The one size of a subject that the Markdown table shows; all cases of the others."""


def number(value: float) -> str:
    """Three digits, no exponent where it can be read without: ``0.00312``, ``36.5``, ``1.2e-09``."""
    return f"{value:.3g}" if value == 0 or 1e-4 <= abs(value) < 1e6 else f"{value:.1e}"


def time(seconds: float | None) -> str:
    """``1.23 ms``."""
    if seconds is None:
        return ""
    for factor, unit in ((1.0, "s"), (1e-3, "ms"), (1e-6, "us")):
        if seconds >= factor:
            return f"{seconds / factor:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def size(count: int | None) -> str:
    """``2.76 MB``."""
    return "" if count is None else f"{number(count / 1e6)} MB"


def verdict(target: Target) -> str:
    """``met`` or ``MISSED``."""
    return "met" if target.met else "MISSED"


def _bound(target: Target) -> str:
    return f"{'<=' if target.most else '>='} {number(target.bound)} {target.unit}".rstrip()


def page(report: Report) -> str:
    """Everything, for a terminal."""
    machine = report.machine
    lines = [f"{machine['processor']}, {machine['cores']} cores, load {machine['load']}"]
    subject = ""
    for row in report.rows:
        if row.subject != subject:
            subject = row.subject
            lines += ["", subject]
        each = time(row.seconds / row.items) if row.seconds and row.items else ""
        error = f"{number(row.error)} {row.error_unit}" if row.error is not None else ""
        per = f"{each:>9}/{row.unit}" if each else ""
        lines.append(
            f"  {row.case:<36} {_tool(row):<34} {time(row.seconds):>9} {per:<26} "
            f"{size(row.bytes):>8}  {error}".rstrip()
        )
    lines += ["", "targets"]
    for target in report.targets:
        found = f"{number(target.value)} {target.unit}".rstrip()
        lines.append(
            f"  {target.subject:<14} {target.promise:<66} {found:>14}  {_bound(target):<16} {verdict(target)}"
        )
    lines += [""] if report.skipped else []
    lines += [f"left out: {reason}" for reason in report.skipped]
    return "\n".join(lines)


def markdown(report: Report) -> str:
    """Two tables: run time against error beside the rivals, and the targets."""
    lines = [
        "| step | case | tool | time | per item | beside firetwin | size | error |",
        "|---|---|---|--:|--:|--:|--:|--:|",
        *_rows(report.rows),
        "",
        "| step | target | measured | bound | |",
        "|---|---|--:|--:|---|",
    ]
    for target in report.targets:
        found = f"{number(target.value)} {target.unit}".rstrip()
        lines.append(
            f"| {target.subject} | {target.promise} | {found} | {_bound(target)} | {verdict(target)} |"
        )
    machine = report.machine
    lines += ["", f"Best times on {machine['processor']}, {machine['cores']} cores, one thread unless said."]
    lines += [f"Left out: {reason}." for reason in report.skipped]
    return "\n".join(lines)


def _tool(row: Row) -> str:
    return row.tool + (f", {row.threads} threads" if row.threads > 1 else "")


def _rows(rows: list[Row]) -> Iterator[str]:
    ours: dict[tuple[str, str], float] = {}
    for row in rows:
        if SHOWN.get(row.subject, row.case) != row.case or (row.threads > 1 and row.subject in SHOWN):
            continue
        key = row.subject, row.case
        if row.tool.startswith(OURS) and row.seconds:
            ours.setdefault(key, row.seconds)
        comparable = key in ours and row.seconds and row.subject not in ("particles", "plume")
        beside = f"{number(row.seconds / ours[key])}x" if comparable else ""
        each = f"{time(row.seconds / row.items)}/{row.unit}" if row.seconds and row.items else ""
        error = f"{number(row.error)} {row.error_unit}" if row.error is not None else ""
        yield (
            f"| {row.subject} | {row.case} | {_tool(row)} | {time(row.seconds)} | {each} | {beside} "
            f"| {size(row.bytes)} | {error} |"
        )
