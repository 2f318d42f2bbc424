"""Benchmark report as text for a terminal and as Markdown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .harness import OURS, Report, Row, Target
from .timing import LEAST


def number(value: float) -> str:
    """Format a number with three digits, with an exponent if needed: ``0.00312``, ``36.5``, ``1.2e-09``."""
    return f"{value:.3g}" if value == 0 or 1e-4 <= abs(value) < 1000 else _large(value)


def _large(value: float) -> str:
    return f"{value:,.0f}" if 1000 <= abs(value) < 1e6 else f"{value:.1e}"


def time(seconds: float | None) -> str:
    """Format seconds: ``1.23 ms``."""
    if seconds is None:
        return ""
    factor, unit = _scale(seconds)
    return f"{number(seconds / factor)} {unit}"


def _scale(seconds: float) -> tuple[float, str]:
    scales = ((1.0, "s"), (1e-3, "ms"), (1e-6, "us"))
    return next((scale for scale in scales if seconds >= scale[0]), (1e-9, "ns"))


def times(row: Row) -> str:
    """Format median and range of the repetitions: ``9.31 ms (9.02 to 11.4)``."""
    if row.seconds is None:
        return ""
    factor, unit = _scale(row.seconds)
    return _with_range(row.seconds / factor, [each / factor for each in row.times], unit)


def found(target: Target) -> str:
    """Format the measured value: ``4.6 x (4.2 to 5.1)``, or ``24 %, linear blending 47 %``."""
    text = _with_range(target.value, target.values, target.unit)
    return f"{text}, {target.rival} {number(target.bound)} {target.unit}" if target.rival else text


def _with_range(value: float, values: Sequence[float], unit: str) -> str:
    text = f"{number(value)} {unit}".rstrip()
    low, high = number(min(values)), number(max(values))
    return text if low == high else f"{text} ({low} to {high})"


def size(count: int | None) -> str:
    """Format a number of bytes: ``2.76 MB``."""
    return "" if count is None else f"{number(count / 1e6)} MB"


def verdict(target: Target) -> str:
    """Return ``MET`` or ``MISSED``."""
    return "MET" if target.met else "MISSED"


def bound(target: Target) -> str:
    """Format the bound of a target: ``at least 4 x``, ``at most linear blending``."""
    limit = target.rival or f"{number(target.bound)} {target.unit}".rstrip()
    return f"{'at most' if target.most else 'at least'} {limit}"


def _machine(report: Report) -> str:
    machine = report.machine
    load = "" if machine["load"] is None else f", load {machine['load']} at the start"
    return f"{machine['processor']}, {machine['cores']} cores{load}"


def _method(report: Report) -> str:
    runs = f"in each of {report.runs} runs" if report.runs > 1 else "in one run"
    return (
        f"Medians of {LEAST} or more repetitions {runs}; the tools take turns. In brackets is the range of "
        "all repetitions, then the CPU time over all cores. One thread unless noted."
    )


def page(report: Report) -> str:
    """Format the report for a terminal."""
    lines = [_machine(report), _method(report)]
    subject = ""
    for row in report.rows:
        if row.subject != subject:
            subject = row.subject
            lines += ["", f"{subject}: {report.subjects.get(subject, '')}".rstrip(": ")]
        error = f"{number(row.error)} {row.error_unit}" if row.error is not None else ""
        lines.append(
            f"  {row.case:<39} {row.label:<37} {times(row):<28} {time(row.processor_seconds):>8}  "
            f"{_each(row):<24} {size(row.bytes):>8}  {error}".rstrip()
        )
    lines += ["", "targets"]
    for target in report.targets:
        lines.append(
            f"  {verdict(target):<7} {target.subject}: {target.quantity}: {found(target)} "
            f"(target: {bound(target)})"
        )
    lines += [""] if report.skipped else []
    lines += [f"skipped: {reason}" for reason in report.skipped]
    return "\n".join(lines)


def markdown(report: Report) -> str:
    """Format two Markdown tables: the targets, and run time and error of all tools."""
    lines = [
        "| step | quantity | measured | target | |",
        "|---|---|--:|--:|---|",
    ]
    for target in report.targets:
        lines.append(
            f"| {target.subject} | {target.quantity} | {found(target)} | {bound(target)} "
            f"| {verdict(target)} |"
        )
    lines += [
        "",
        "| step | case | tool | time | CPU time | per item | time / firetwin's | size | error |",
        "|---|---|---|--:|--:|--:|--:|--:|--:|",
        *_rows(report.rows),
        "",
        *(f"- {subject}: {what}" for subject, what in report.subjects.items()),
        "",
        f"{_method(report)} On {_machine(report)}.",
    ]
    lines += [f"Skipped: {reason}." for reason in report.skipped]
    return "\n".join(lines)


def _each(row: Row) -> str:
    return f"{time(row.seconds / row.items)}/{row.unit}" if row.seconds and row.items > 1 else ""


def _rows(rows: list[Row]) -> Iterator[str]:
    ours: dict[tuple[str, str], float] = {}
    for row in rows:
        key = row.subject, row.case
        if row.tool.startswith(OURS) and row.seconds:
            ours.setdefault(key, row.seconds)
        ratio = f"{number(row.seconds / ours[key])}x" if key in ours and row.seconds else ""
        error = f"{number(row.error)} {row.error_unit}" if row.error is not None else ""
        yield (
            f"| {row.subject} | {row.case} | {row.label} | {times(row)} | {time(row.processor_seconds)} "
            f"| {_each(row)} | {ratio} | {size(row.bytes)} | {error} |"
        )
