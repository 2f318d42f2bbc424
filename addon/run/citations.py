"""Citations of a run: software, algorithms, fire model, facts and observations."""

from __future__ import annotations

import json
from pathlib import Path

import firetwin_core
from firetwin_core.run import Run

from ..data import history
from ..escaped import escaped
from ..progress import result
from . import info, observations

PAPER = (
    "Raha, M. H., Tavakkoli, A. R., Webb, C., Habibpour, M., Coen, J., Rowell, E., Afghah, F.: FIRETWIN: "
    "Digital Twin Advancing Multi-Modal Sensing, Interactive Analytics for Tactical Wildfire Response"
)


def of_run(run: Run) -> list[dict[str, str]]:
    """List the sources of a run, as rows of `kind` and `text`."""
    return [*_software(), *_model(run), *_event(run), *_observations(Path(run.path))]


def of_model(name: str, made: str, synthetic: bool) -> list[dict[str, str]]:
    """List the sources of other output of a fire model, which `made` describes (see `of_run`)."""
    return [*_software(), {"kind": "fire model", "text": made}, *([_synthetic(name)] if synthetic else [])]


def show(rows: list[dict[str, str]], as_json: bool) -> None:
    """Print rows for people, or as JSON."""
    page = "\n".join(f"{escaped(row['kind']):<14}{escaped(row['text'])}" for row in rows)
    result(json.dumps(rows, indent=1) if as_json else page)


def _software() -> list[dict[str, str]]:
    version = firetwin_core.__version__
    return [
        {"kind": "software", "text": f"The Firetwin maintainers: Firetwin, version {version} (CITATION.cff)"},
        {"kind": "algorithms", "text": PAPER},
    ]


def model_name(run: Run) -> str:
    """Return the name of a run's fire model with its version; "" if run.toml has none."""
    source = info.source(Path(run.path))
    version = source.get("version", "")
    stated = "" if version in ("", "not said") else f", version {version}"
    return f"{name}{stated}" if (name := source.get("model")) else ""


def _model(run: Run) -> list[dict[str, str]]:
    if run.synthetic:
        return [_synthetic(run.name)]
    if not (name := model_name(run)):
        return [{"kind": "fire model", "text": "not named in run.toml; name the model and its version"}]
    return [{"kind": "fire model", "text": f"{name}; run: {run.name}"}]


def _synthetic(name: str) -> dict[str, str]:
    return {"kind": "fire model", "text": f"none: {name} is synthetic"}


def _event(run: Run) -> list[dict[str, str]]:
    """List sources of the facts about the depicted fire."""
    if run.event not in history.events():
        return []
    event = history.load(run.event)
    sources = dict.fromkeys([each.source for each in (*event.ignitions, *event.acreages)])
    return [{"kind": "facts", "text": f"{event.name}: {text}"} for text in sources]


def _observations(folder: Path) -> list[dict[str, str]]:
    files = [path.name for path in observations.beside(folder)]
    return [{"kind": "observations", "text": f"{name}; cite the source of this file"} for name in files]
