"""Log-log plots of a report: run time against error, and run time against size."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from firetwin import files
from firetwin.bench.harness import OURS, Report, Row

COLOURS = {OURS: "#d1410c", "rival": ("#31688e", "#35b779", "#440154", "#8c6d31", "#666666")}


def draw(report: Report, out: Path) -> list[Path]:
    """Write work_precision.png and scaling.png into `out`."""
    import matplotlib

    matplotlib.use("Agg")
    return [
        _figure(
            out / "work_precision.png", "Run time against error", _with_error(report.rows), _work_precision
        ),
        _figure(out / "scaling.png", "Run time against size", _with_size(report.rows), _scaling),
    ]


def _with_error(rows: Iterable[Row]) -> list[Row]:
    return [row for row in rows if row.error is not None and row.seconds and "F^1.5" not in row.tool]


def _with_size(rows: Iterable[Row]) -> list[Row]:
    """Select rows whose case is a size, such as "720 x 720"."""
    return [row for row in rows if row.seconds and " x " in row.case]


def _figure(path: Path, title: str, rows: list[Row], panel: Callable[[Any, list[Row]], None]) -> Path:
    from matplotlib import pyplot

    subjects: dict[str, list[Row]] = defaultdict(list)
    for row in rows:
        subjects[row.subject].append(row)
    columns = 2 if len(subjects) > 1 else 1
    height = -(-len(subjects) // columns)
    figure, axes = pyplot.subplots(
        height, columns, figsize=(5.5 * columns, 3.8 * height), squeeze=False, layout="constrained"
    )
    for axis in axes.ravel()[len(subjects) :]:
        axis.remove()
    for axis, (name, found) in zip(axes.ravel(), subjects.items(), strict=False):
        axis.set(title=name, xscale="log", yscale="log")
        axis.grid(alpha=0.3, which="both", linewidth=0.5)
        panel(axis, found)
        axis.legend(fontsize=7, framealpha=0.6)
    figure.suptitle(title)
    files.write(path, lambda part: figure.savefig(part, dpi=110))
    pyplot.close(figure)
    return path


def _tools(rows: list[Row]) -> Iterable[tuple[str, Any, list[Row]]]:
    """Yield each tool with its threads, colour, and rows in order of size."""
    groups: dict[str, list[Row]] = defaultdict(list)
    for row in rows:
        groups[row.label].append(row)
    rivals = iter(COLOURS["rival"] * 9)
    for name, found in groups.items():
        yield name, COLOURS[OURS] if name.startswith(OURS) else next(rivals), found


def _work_precision(axis: Any, rows: list[Row]) -> None:
    """Replace zero errors, which a logarithmic axis cannot show, by a tenth of the smallest error."""
    errors = [row.error for row in rows if row.error]
    none = 10.0 ** (math.floor(math.log10(min(errors))) - 1) if errors else 0.1
    least = none if any(not row.error for row in rows) else none * 10
    for name, colour, found in _tools(rows):
        error = [row.error or none for row in found]
        each = [row.seconds / row.items for row in found if row.seconds]
        axis.plot(error, each, **_style(name) | {"linestyle": ""}, color=colour, label=name)
    axis.xaxis.set_minor_formatter(lambda *_: "")
    axis.set_xlim(least / 1.6, 10.0 ** math.ceil(math.log10(max(errors, default=none) * 1.2)))
    if least == none:
        axis.axvline(none, color="0.6", linewidth=0.8)
        axis.xaxis.set_major_formatter(lambda value, _: "0" if value <= none else f"{value:g}")
    axis.set_xlabel(f"error, {rows[0].error_unit}")
    axis.set_ylabel(f"seconds per {rows[0].unit}")
    _whole_decades(axis)


def _scaling(axis: Any, rows: list[Row]) -> None:
    for name, colour, found in _tools(rows):
        found = sorted(found, key=lambda row: row.items)
        size, seconds = [row.items for row in found], [row.seconds for row in found]
        axis.plot(size, seconds, **_style(name), color=colour, label=name)
    axis.set_xlabel(f"{rows[0].unit}s")
    axis.set_ylabel("seconds")
    _whole_decades(axis)


def _whole_decades(axis: Any) -> None:
    """Label a vertical axis at powers of ten only, and at two of them at least."""
    low, high = (math.log10(limit) for limit in axis.get_ylim())
    axis.set_ylim(10.0 ** math.floor(low), 10.0 ** math.ceil(high))
    axis.yaxis.set_minor_formatter(lambda *_: "")


def _style(name: str) -> dict[str, Any]:
    scattered = "scattered" in name
    threaded = "threads" in name
    return {
        "marker": "s" if scattered else "o",
        "markersize": 5,
        "linestyle": ":" if threaded else "--" if scattered else "-",
        "fillstyle": "none" if threaded else "full",
        "linewidth": 1.2,
    }
