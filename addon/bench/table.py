"""Benchmark report: rows of all tools as text, and the targets as a Markdown table."""

from __future__ import annotations

from collections.abc import Sequence

from .harness import Bench, Row, Target
from .timing import LEAST

_METHOD = (
    f"Medians of {LEAST} or more repetitions; the tools take turns. In brackets is the range of all "
    "repetitions. One thread unless noted."
)


def number(value: float) -> str:
    """Format a number with three digits, with an exponent if needed: ``0.00312``, ``36.5``, ``1.2e-09``."""
    if value == 0 or 1e-4 <= abs(value) < 1000:
        return f"{value:.3g}"
    return f"{value:,.0f}" if 1000 <= abs(value) < 1e6 else f"{value:.1e}"


def time(seconds: float) -> str:
    """Format seconds: ``1.23 ms``."""
    factor, unit = _scale(seconds)
    return f"{number(seconds / factor)} {unit}"


def _scale(seconds: float) -> tuple[float, str]:
    scales = ((1.0, "s"), (1e-3, "ms"), (1e-6, "us"))
    return next((scale for scale in scales if seconds >= scale[0]), (1e-9, "ns"))


def _with_range(value: float, values: Sequence[float], unit: str) -> str:
    text = f"{number(value)} {unit}".rstrip()
    low, high = number(min(values)), number(max(values))
    return text if low == high else f"{text} ({low} to {high})"


def page(bench: Bench) -> str:
    """Format all measurements."""
    machine = bench.machine
    load = "" if machine["load"] is None else f", load {machine['load']} at the start"
    lines = [f"{machine['processor']}, {machine['cores']} cores{load}", _METHOD]
    for subject, what in bench.subjects.items():
        lines += ["", f"{subject}: {what}"]
        lines += [_row(row) for row in bench.rows if row.subject == subject]
    lines += ["", "| step | quantity | measured | target | |", "|---|---|--:|--:|---|"]
    lines += [_target(target) for target in bench.targets]
    lines += [""] if bench.skipped else []
    lines += [f"skipped: {reason}" for reason in bench.skipped]
    return "\n".join(lines)


def _row(row: Row) -> str:
    """Format a row: median and range ``9.31 ms (9.02 to 11.4)``, time per item, and error."""
    total, each = "", ""
    if row.seconds is not None:
        factor, unit = _scale(row.seconds)
        total = _with_range(row.seconds / factor, [seconds / factor for seconds in row.times], unit)
        each = f"{time(row.seconds / row.items)}/{row.unit}" if row.items > 1 else ""
    error = f"{number(row.error)} {row.error_unit}" if row.error is not None else ""
    return f"  {row.case:<39} {row.label:<37} {total:<28} {each:<24} {error}".rstrip()


def _target(target: Target) -> str:
    """Format a target, such as ``at least 4 x``, or ``at most linear blending`` for a measured bound."""
    measured = _with_range(target.value, target.values, target.unit)
    limit = bound = f"{number(target.bound)} {target.unit}".rstrip()
    if target.rival:
        measured, limit = f"{measured}, {target.rival} {bound}", target.rival
    verdict = "MET" if target.met else "MISSED"
    limit = f"{'at most' if target.most else 'at least'} {limit}"
    return f"| {target.subject} | {target.quantity} | {measured} | {limit} | {verdict} |"
