"""Card of a data set: ``README.md`` with the YAML header that Hugging Face reads."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from .. import output
from ..progress import count
from . import licences, table
from .about import About
from .croissant import DESCRIPTION, LIMITS
from .files import CONTENT
from .formats import FORMATS, common
from .truth import CATEGORIES, Truth

NAME = "README.md"
_TASKS = "object-detection", "image-segmentation", "depth-estimation"
_SIZES = (1000, "n<1K"), (10_000, "1K<n<10K"), (100_000, "10K<n<100K")


def write(folder: Path, about: About, samples: Sequence[Truth], overwrite: bool = False) -> None:
    """Write the card."""
    output.write_text(folder / NAME, text(folder, about, samples), overwrite)


def text(folder: Path, about: About, samples: Sequence[Truth]) -> str:
    """Make the text of the card."""
    parts = [
        "\n".join(_header(folder, about, len(samples))),
        f"# {about.title}",
        f"{DESCRIPTION} {LIMITS}",
        _counts(about, samples),
        _categories(),
        _listed("Files", _file_lines(folder)),
        _CONVENTIONS,
        _draws(samples),
        _NOT_REAL,
        _licences(about, samples),
        _CHECKS,
    ]
    return "\n\n".join(parts) + "\n"


def _header(folder: Path, about: About, number: int) -> Iterator[str]:
    """Yield the lines of the YAML header."""
    yield "---"
    yield f"pretty_name: {_quoted(about.title)}"
    if about.licence:
        yield f"license: {about.licence.lower() if not about.licence.startswith('LicenseRef') else 'other'}"
    yield from ["task_categories:", *(f"- {task}" for task in _TASKS)]
    yield from ["tags:", *(f"- {tag}" for tag in ("wildfire", "smoke", "synthetic", "thermal"))]
    yield "size_categories:"
    yield f"- {next((name for limit, name in _SIZES if number < limit), '100K<n<1M')}"
    if configuration := _configuration(folder):
        yield from ["configs:", "- config_name: default", "  data_files:", *configuration]
    yield "---"


def _configuration(folder: Path) -> list[str]:
    """Return the data files of each split, for the library `datasets`."""
    found = sorted(path.parent.name for path in (folder / "imagefolder").glob("*/metadata.jsonl"))
    return [line for name in found for line in (f"  - split: {name}", f"    path: imagefolder/{name}/**")]


def _counts(about: About, samples: Sequence[Truth]) -> str:
    rows = []
    for split, members in common.by_split(samples).items():
        labels = Counter(each.category for truth in members for each in truth.annotations)
        places = {truth.groups.get("place", "") for truth in members}
        negatives = sum(truth.is_negative for truth in members)
        numbers = [labels[each.id] for each in common.THINGS]
        rows.append([split, len(members), negatives, *numbers, ", ".join(sorted(places))])
    head = ["split", "samples", "without fire and smoke", *(each.name for each in common.THINGS), "places"]
    parts = ["## Splits", _table(head, rows)]
    if about.split_by:
        parts.append(f"No {about.split_by} is in two splits.")
    return "\n\n".join(parts)


def _categories() -> str:
    rows = [
        [each.id, each.name, "boxes and masks" if each.has_instances else "pixels"] for each in CATEGORIES
    ]
    return f"## Categories\n\n{_table(['id', 'name', 'labels'], rows)}"


def _file_lines(folder: Path) -> Iterator[str]:
    """Yield the folders and formats that the data set has."""
    for name, content in CONTENT.items():
        if (folder / name).is_dir():
            yield f"`{name}/`: {content}"
    yield f"`{table.NAME}`: one row for each sample"
    if (folder / "plan.json").is_file():
        yield "`plan.json`: the plan, hashes of its runs, and versions that made the data set"
    for each in FORMATS.values():
        place, content = each.help.split(": ", 1)
        if (folder / place.split("/")[0]).is_dir():
            yield f"`{place.split('/')[0]}/`: {content}"


_CONVENTIONS = """\
## Conventions

- Pixels: (0, 0) is the corner of the first pixel, its centre is (0.5, 0.5). Boxes exclude x1 and y1.
- Cameras: x right, y up, looks along -z (OpenGL). Poses are camera-to-world, in metres east, north and up of
  the origin of the run. COLMAP is world-to-camera with x right, y down, z forwards; other formats have their
  conventions as well.
- Smoke is labelled where its opacity is at least 0.05 and it changes the picture visibly; `labelling` in the
  metadata has the thresholds, and `band` the spectral band of each label.
- Fire has a visible mask, and an amodal one without smoke in front. `below_size` has small instances."""

_NOT_REAL = """\
## What is not real

- Trees and shrubs are models placed by fuel maps; the ground has procedural colours unless a source below is
  a photograph.
- Smoke is a simulated flow with one optical model; its colour and texture are plausible, not measured.
- Noise, blur and compression are models of sensors, not of one camera.
- Detectors trained on such pictures alone do worse on real ones. Test on real pictures."""

_CHECKS = """\
## Checks

`sha256sum -c SHA256SUMS` checks that the files are intact; `firetwin dataset check .` also checks labels,
splits and copies. Each value of a draw has a separate seed, so one sample can be rendered alone.
`report.html` shows the distribution of each draw by split and kind."""


def _draws(samples: Sequence[Truth]) -> str:
    """Count the kinds of samples, and the rejected draws, which change the distributions."""
    kinds = Counter(table.kind(truth) for truth in samples)
    lines = [f"{name}: {number:,}" for name, number in sorted(kinds.items(), key=lambda pair: -pair[1])]
    rejected = Counter(reason for truth in samples for reason in truth.draw.get("rejects", ()))
    found = _listed("Samples by kind", lines)
    if rejected:
        reasons = ", ".join(f"{reason} ({number:,})" for reason, number in rejected.most_common())
        found += f"\n\nRejected and drawn again: {count(rejected.total(), 'draw')}: {reasons}."
    return found


def _licences(about: About, samples: Sequence[Truth]) -> str:
    lines = [f"{name}: {licence}" for name, licence in licences.of_samples(samples).items()]
    lines += [f"credit: {line}" for line in licences.credits_of(samples)]
    chosen = about.licence or "not chosen by its owner"
    return _listed(
        "Licences", [f"data set: {chosen}", *(lines or ["no photographs: the ground is procedural"])]
    )


def _listed(title: str, lines: Sequence[str] | Iterator[str]) -> str:
    return "\n".join([f"## {title}", "", *(f"- {line}" for line in lines)])


def _table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(_cell(value) for value in line) + " |" for line in lines)


def _cell(value: object) -> str:
    return f"{value:,}" if isinstance(value, int) else str(value).replace("|", "\\|")


def _quoted(text: str) -> str:
    """Quote a text for YAML."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
