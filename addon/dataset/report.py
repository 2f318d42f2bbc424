"""Report of a data set: ``report.html``, one file with pictures and histograms of every draw and label."""

from __future__ import annotations

import io
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import output
from ..html_text import data_uri, quote
from ..progress import count
from . import draw_labels, files, histogram, licences, table
from .about import About
from .formats import common
from .truth import Annotation, Truth

if TYPE_CHECKING:
    from PIL import Image

NAME = "report.html"
SPLIT_COLOURS = {"train": "#0072b2", "val": "#e69f00", "test": "#009e73"}  # Okabe and Ito (2008)
KIND_COLOURS = {"fire": "#d55e00", "without fire": "#8a97a0"}
_SPARE = "#cc79a7"
_LEFT_OUT = {"index", "seed", "attempt", "split", "utc", "name", "moment"}
_VALUES = "values"  # of a draw: their names need no prefix
_PICTURES, _THUMBNAIL = 24, 240
_LABELS = {
    "distance_m": "distance, m",
    "visible_fraction": "visible fraction",
    "contrast": "contrast with the picture without smoke",
    "top_above_ground_m": "top above the ground, m",
    "ground_area_m2": "area on the ground, m2",
    "max_temperature_k": "highest temperature, K",
    "seconds_since_ignition": "time since ignition, s",
}


def write(folder: Path, about: About, samples: Sequence[Truth], overwrite: bool = False) -> None:
    """Write the report."""
    output.write_text(folder / NAME, page(folder, about, samples), overwrite)


def page(folder: Path, about: About, samples: Sequence[Truth]) -> str:
    """Make the page."""
    css = Path(__file__).with_name("report.css").read_text(encoding="utf-8")
    splits = {name: SPLIT_COLOURS.get(name, _SPARE) for name in common.by_split(samples)}
    body = [
        f"<h1>{quote(about.title)}</h1><p>{count(len(samples), 'sample')}, seed {about.seed}.</p>",
        *_summary(about, samples),
        "<h2>Samples</h2>",
        f'<div class="sheet">{"".join(_sheet(folder, samples))}</div>',
        f"<h2>Draws</h2>{_key(splits | KIND_COLOURS)}",
        f'<div class="panels">{"".join(_draws(about, samples, splits))}</div>',
        f"<h2>Labels</h2>{_key(splits)}",
        f'<div class="panels">{"".join(_labels(samples, splits))}</div>',
    ]
    head = '<meta charset="utf-8"><meta name="viewport" content="width=device-width">'
    title = f"<title>{quote(about.title)}: report</title>"
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head>{head}{title}<style>\n{css}</style></head>\n<body>\n'
        + "\n".join(body)
        + "\n</body></html>\n"
    )


def _summary(about: About, samples: Sequence[Truth]) -> Iterator[str]:
    """Yield tables of splits and kinds, rejected draws and licences."""
    kinds = sorted({table.kind(truth) for truth in samples})
    rows = []
    for split, members in common.by_split(samples).items():
        labels = Counter(each.category for truth in members for each in truth.annotations)
        places = len({truth.groups.get("place") for truth in members})
        by_kind = Counter(table.kind(truth) for truth in members)
        things = [labels[each.id] for each in common.THINGS]
        rows.append([split, places, len(members), *things, *(by_kind[kind] for kind in kinds)])
    named = [f"{each.name} labels" for each in common.THINGS]
    yield _table(["split", "places", "samples", *named, *(kind.replace("_", " ") for kind in kinds)], rows)
    if about.split_by:
        yield f'<p class="note">No {quote(about.split_by)} is in two splits.</p>'
    rejected = Counter(reason for truth in samples for reason in truth.draw.get("rejects", ()))
    if rejected:
        reasons = "; ".join(f"{reason}: {number:,}" for reason, number in rejected.most_common())
        text = f"{count(rejected.total(), 'draw')} rejected and drawn again ({reasons})"
        yield f'<p class="note">{quote(text)}.</p>'
    sources = "; ".join(f"{name}: {licence}" for name, licence in licences.of_samples(samples).items())
    yield f'<p class="note">Licences: {quote(sources or "no photographs; procedural ground")}.</p>'


def _table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    titles = "".join(
        f"<th{'' if at == 0 else ' class=number'}>{quote(text)}</th>" for at, text in enumerate(head)
    )
    lines = "".join(f"<tr>{''.join(_cell(value) for value in row)}</tr>" for row in rows)
    return f"<table><tr>{titles}</tr>{lines}</table>"


def _cell(value: object) -> str:
    return f'<td class="number">{value:,}</td>' if isinstance(value, int) else f"<td>{quote(value)}</td>"


def _sheet(folder: Path, samples: Sequence[Truth]) -> Iterator[str]:
    """Yield small pictures of evenly spaced samples, with their boxes."""
    step = max(1, len(samples) / _PICTURES)
    for at in range(min(_PICTURES, len(samples))):
        truth = samples[int(at * step)]
        content = io.BytesIO()
        thumbnail(folder, truth).save(content, "JPEG", quality=75)
        uri = data_uri("image/jpeg", content.getvalue())
        text = quote(
            f"{truth.index:06d}, {truth.split or common.UNSPLIT}, {table.kind(truth)}".replace("_", " ")
        )
        yield f'<figure><img src="{uri}" alt="{text}"><figcaption>{text}</figcaption></figure>'


def thumbnail(folder: Path, truth: Truth) -> Image.Image:
    """Draw a small picture of a sample with its boxes."""
    with files.open_picture(folder / common.picture(truth)) as opened:
        return draw_labels.draw_small(opened, truth, _THUMBNAIL)


def _draws(about: About, samples: Sequence[Truth], splits: Mapping[str, str]) -> Iterator[str]:
    """Yield a panel for each drawn value: by split, and with and without fire."""
    flat = [dict(_flat(truth.draw)) for truth in samples]
    names = sorted({name for found in flat for name in found})
    kinds = ["fire" if table.kind(truth) == "fire" else "without fire" for truth in samples]
    groups = [truth.split or common.UNSPLIT for truth in samples]
    for name in names:
        values = [found.get(name) for found in flat]
        if len({value for value in values if value is not None}) < 2:
            continue
        charts = [
            _chart(values, groups, splits, f"{name} by split"),
            _chart(values, kinds, KIND_COLOURS, f"{name} with and without fire"),
        ]
        unit = about.units.get(name, "")
        yield _panel(name.replace("_", " "), "" if unit == "1" else unit, charts)


def _labels(samples: Sequence[Truth], splits: Mapping[str, str]) -> Iterator[str]:
    """Yield a panel for each quantity of annotations, with a chart for each category."""
    for name, title in {"share": "share of the picture", **_LABELS}.items():
        charts = []
        for category in common.THINGS:
            pairs = [
                (truth.split or common.UNSPLIT, _quantity(truth, each, name))
                for truth in samples
                for each in truth.annotations
                if each.category == category.id
            ]
            found = [(split, value) for split, value in pairs if value is not None]
            if found:
                chart = _chart(
                    [value for _, value in found], [split for split, _ in found], splits, category.name
                )
                charts.append(f"<figure><figcaption>{category.name}</figcaption>{chart}</figure>")
        if charts:
            yield _panel(title, "", charts)


def _quantity(truth: Truth, annotation: Annotation, name: str) -> float | None:
    if name == "share":
        return annotation.pixels / (truth.camera.width * truth.camera.height)
    found: float | None = getattr(annotation, name)
    return found


def _chart(values: Sequence[Any], groups: Sequence[str], colours: Mapping[str, str], label: str) -> str:
    """Draw the values that are not None, by group: words if any of them is a word."""
    pairs = [(group, value) for group, value in zip(groups, values, strict=True) if value is not None]
    is_number = all(isinstance(value, int | float) and not isinstance(value, bool) for _, value in pairs)
    sorted_in: dict[str, list[Any]] = {name: [] for name in colours}
    for group, value in pairs:
        sorted_in[group].append(float(value) if is_number else str(value))
    bars = histogram.numeric(sorted_in) if is_number else histogram.categorical(sorted_in)
    return histogram.svg(bars, colours, label)


def _flat(draw: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield numbers and words of a draw by name; lists and numbers of the sample are left out."""
    for name, value in draw.items():
        if isinstance(value, Mapping):
            before = "" if name == _VALUES else f"{name} "
            yield from ((f"{before}{inner}", each) for inner, each in _flat(value))
        elif isinstance(value, int | float | str) and name not in _LEFT_OUT:
            yield name, value


def _panel(title: str, unit: str, charts: Sequence[str]) -> str:
    small = f" <small>{quote(unit)}</small>" if unit else ""
    return f'<div class="panel"><h3>{quote(title)}{small}</h3><div class="pair">{"".join(charts)}</div></div>'


def _key(colours: Mapping[str, str]) -> str:
    items = (
        f'<span><i style="background:{colour}"></i>{quote(name)}</span>' for name, colour in colours.items()
    )
    return f'<p class="key">{"".join(items)}</p>'
