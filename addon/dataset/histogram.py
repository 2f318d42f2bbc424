"""Histograms as SVG: stacked bars of groups, on a linear or logarithmic axis."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..html_text import quote

Values = Mapping[str, Sequence[float]]
Words = Mapping[str, Sequence[str]]
WIDTH, HEIGHT = 280, 96
_BINS = 20
_LOG_RATIO = 10.0  # least ratio of a logarithmic axis
_SKEWED = 0.35  # largest position of the median of such values, as a share of their span
_LEFT, _TOP, _FLOOR = 30, 6, 78  # pixels of the plot's left, upper and lower edge
_MOST_WORDS = 12


@dataclass(frozen=True)
class Bars:
    """Stacked bars.

    Attributes
    ----------
    names
        Content of each bar, for tooltips.
    ticks
        Position 0..1 along the axis and text of each tick.
    counts
        Height of each bar by group.
    """

    names: Sequence[str]
    ticks: Sequence[tuple[float, str]]
    counts: Mapping[str, Sequence[int]]


def numeric(groups: Values) -> Bars:
    """Count finite numbers in 20 bins of equal width, or of equal ratio if they are skewed."""
    values = {name: _finite(group) for name, group in groups.items()}
    all_values = np.concatenate([*values.values(), np.empty(0)])
    low, high = (float(all_values.min()), float(all_values.max())) if all_values.size else (0.0, 1.0)
    is_log = _is_log(all_values) if all_values.size else False
    if high <= low:
        edges = np.linspace(low - 0.5, low + 0.5, _BINS + 1)
    else:
        edges = (np.geomspace if is_log else np.linspace)(low, high, _BINS + 1)
        edges[[0, -1]] = low, high
    counts = {name: np.histogram(group, edges)[0].tolist() for name, group in values.items()}
    words = _numbers(edges)
    names = [f"{a} to {b}" for a, b in itertools.pairwise(words)]
    ticks = [(at / _BINS, words[at]) for at in (0, _BINS // 2, _BINS)]
    return Bars(names, ticks, counts)


def categorical(groups: Words) -> Bars:
    """Count words, most frequent first; the rarest are together if there are more than 12."""
    totals = Counter(word for group in groups.values() for word in group)
    words = [word for word, _ in sorted(totals.items(), key=lambda pair: (-pair[1], pair[0]))]
    rest = words[_MOST_WORDS:]
    shown = [*words[:_MOST_WORDS], *(["others"] if rest else [])]
    counts = {}
    for name, group in groups.items():
        number = Counter("others" if word in rest else word for word in group)
        counts[name] = [number[word] for word in shown]
    ticks = [((at + 0.5) / len(shown), word) for at, word in enumerate(shown)]
    return Bars(shown, ticks, counts)


def svg(bars: Bars, colours: Mapping[str, str], label: str) -> str:
    """Draw bars; `colours` of the groups, the first at the bottom."""
    totals = np.sum([list(found) for found in bars.counts.values()], axis=0)
    peak = max(1, int(totals.max(initial=1)))
    step = (WIDTH - _LEFT - 8) / max(1, len(bars.names))
    shapes = [f'<path d="M{_LEFT} {_FLOOR + 0.5}H{WIDTH - 8}" class="axis"/>']
    for at, name in enumerate(bars.names):
        shapes += _stack(bars, colours, at, name, (_LEFT + at * step, step), peak)
    for value in (0, peak):
        shapes.append(f'<text x="{_LEFT - 4}" y="{_y(value, peak) + 3:.1f}" class="end">{value:,}</text>')
    slanted = len(bars.ticks) > 3  # words
    for place, text in bars.ticks:
        x = _LEFT + place * (WIDTH - _LEFT - 8)
        turn = f' transform="rotate(-35 {x:.1f} {_FLOOR + 9})"' if slanted else ""
        kind = "end" if slanted or place == 1.0 else "start" if place == 0.0 else "middle"
        shapes.append(f'<text x="{x:.1f}" y="{_FLOOR + 12}" class="{kind}"{turn}>{quote(text)}</text>')
    height = HEIGHT + (50 if slanted else 0)
    return (
        f'<svg viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" role="img" '
        f'aria-label="{quote(label)}">{"".join(shapes)}</svg>'
    )


def _stack(
    bars: Bars, colours: Mapping[str, str], at: int, name: str, place: tuple[float, float], peak: int
) -> list[str]:
    """Draw the parts of one bar, from the bottom."""
    x, step = place
    rectangles, below = [], 0
    for group, colour in colours.items():
        if number := bars.counts.get(group, [0] * len(bars.names))[at]:
            top, bottom = _y(below + number, peak), _y(below, peak)
            rectangles.append(
                f'<rect x="{x + 0.5:.1f}" y="{top:.1f}" width="{max(step - 1.0, 1.0):.1f}" '
                f'height="{bottom - top:.1f}" fill="{colour}"><title>{quote(name)}: {number:,} '
                f"({quote(group)})</title></rect>"
            )
            below += number
    return rectangles


def _is_log(values: NDArray[np.float64]) -> bool:
    """Return whether values span a factor of 10, most of them near the low end."""
    low, high = values.min(), values.max()
    if low <= 0.0 or high / low < _LOG_RATIO:
        return False
    return bool((np.median(values) - low) / (high - low) < _SKEWED)


def _numbers(values: NDArray[np.float64]) -> list[str]:
    """Format numbers with as many digits as tell neighbours apart, at least three."""
    for digits in range(3, 12):
        words = [f"{value:,.0f}" if abs(value) >= 10.0**digits else f"{value:.{digits}g}" for value in values]
        if len(set(words)) == len(words):
            break
    return words


def _y(value: float, peak: int) -> float:
    return _FLOOR - (_FLOOR - _TOP) * value / peak


def _finite(values: Sequence[float]) -> NDArray[np.float64]:
    return np.array([value for value in values if math.isfinite(value)], np.float64)
