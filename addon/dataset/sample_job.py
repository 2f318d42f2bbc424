"""Samples of a visit: rendered, labelled and written by a worker process with Blender."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from .. import files as firetwin_files
from ..jobs import worker
from ..progress import MessageCallback, Progress
from ..render import fingerprint
from ..run import content
from ..shot import picture_credits
from . import files, imagery, licences, plan_file, produce
from .draw import Draw
from .draws import Drawer
from .places import Visit
from .plan import Plan


def make(
    plan: Plan,
    visit: Visit,
    missing: Sequence[int],
    out: Path,
    progress: Progress,
    tell: MessageCallback,
) -> None:
    """Render, label and write the missing samples of a visit in a worker process (`produce.Maker`)."""
    task = {
        "plan": str(plan.path.absolute()),
        "members": [each.index for each in visit.draws],
        "missing": list(missing),
        "out": str(out.absolute()),
    }
    worker.run(f"{__name__}:in_blender", task, progress, tell=tell)


def in_blender(
    plan: str, members: list[int], missing: list[int], out: str, progress: Progress, tell: MessageCallback
) -> None:
    """Make samples; worker side."""
    from . import labels, render_samples, sensor, survey

    drawer, folder = Drawer(plan_file.read(plan)), Path(out)
    visit = Visit(tuple(drawer.draw(index) for index in members))
    scene = drawer.scene(visit.draws[0].run)
    source = _source(drawer, visit.draws[0], folder)
    progress(0, len(missing), produce.SAMPLES)
    for done, (drawn, rendered) in enumerate(render_samples.render(drawer.plan, visit, missing, tell), 1):
        labelled, masks = labels.label(rendered, survey.of_shot(scene.shot, drawn.time), drawn.index)
        settings = sensor.SensorSettings.of(drawn.values, rendered.risen)
        seeds = {name: drawn.random_seed(name) for name in ("noise", "thermal noise")}
        sensed = sensor.apply(rendered, settings, seeds)
        complete = replace(
            labelled,
            groups={"place": drawn.place, "run": drawn.run, "camera": f"{drawn.run}/{drawn.camera.site}"},
            split=drawn.split,
            draw=drawn.plain(),
            source=source,
            sensor=settings.visible(),
            thermal=settings.thermal(),
        )
        files.write(folder, complete, masks, rendered, sensed)
        cost = produce.cost_file(folder, drawn.index)
        firetwin_files.write_text(cost, json.dumps(rendered.facts) + "\n")
        progress(done, len(missing), produce.SAMPLES)


def _source(drawer: Drawer, drawn: Draw, out: Path) -> dict[str, Any]:
    """Describe the sources of a visit's samples for the metadata."""
    scene, planned = drawer.scene(drawn.run), drawer.plan.run(drawn.run)
    hashes = content.inputs(scene.run, out / produce.WORK)
    found: dict[str, Any] = {
        "run": {"name": scene.run.name, "sha256": content.fingerprint({"run": hashes})},
        "versions": fingerprint.versions(),
        "device": scene.settings.render.device,
        licences.LICENCES: {f"run {scene.run.name}": ""},
        licences.CREDITS: list(picture_credits.of_settings(scene.settings).data),
    }
    if imagery.has_imagery(scene.settings):
        found[licences.LICENCES][f"imagery of {planned.name}"] = planned.imagery_license
    return found
