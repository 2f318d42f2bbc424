"""Descriptions of an ensemble: its sources, and a sentence on methods."""

from __future__ import annotations

from ...run import citations
from .ensemble import Ensemble
from .manifest import Manifest


def sources(ensemble: Ensemble) -> list[dict[str, str]]:
    """List the sources of an ensemble as rows of `kind` and `text`."""
    told = ensemble.manifest
    text = f"{told.model or 'not named in ensemble.toml'}; {told.source or 'source not given'}"
    return citations.of_model(told.name, text, told.synthetic)


def sentence(told: Manifest) -> str:
    """Describe an ensemble for the paragraph on methods."""
    total = len(told.members) + len(told.left_out)
    invented = "synthetic " if told.synthetic else ""
    issued = f", issued {told.issued:%Y-%m-%d %H:%M %Z}" if told.issued else ""
    differ = f"; members differ in {told.perturbed}" if told.perturbed else ""
    model = told.model or "model not named"
    return (
        f"The {invented}forecast {told.name} ({model}) has {len(told.members)} of {total} members"
        f"{issued}{differ}."
    )
