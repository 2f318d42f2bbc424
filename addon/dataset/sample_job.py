"""Samples of a visit: rendered, labelled and written by a worker process with Blender."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from .. import files as firetwin_files
from ..jobs import worker
from ..progress import MessageCallback, Progress
from ..render import fingerprint
from ..run import content
from ..shot import picture_credits
from . import files, imagery, licences, produce
from .places import Visit
from .plan import Plan, PlanRun
from .run_scene import RunScene


def make(
    plan: Plan,
    visit: Visit,
    missing: Sequence[int],
    out: Path,
    progress: Progress,
    tell: MessageCallback,
) -> None:
    """Render, label and write the missing samples of a visit in a worker process (`produce.Maker`).

    The worker gets the plan and the draws themselves: drawing them again takes time, and the file of the plan
    can have changed.
    """
    worker.run(partial(in_blender, plan, visit, missing, out.absolute()), progress, tell=tell)


def in_blender(
    plan: Plan, visit: Visit, missing: Sequence[int], folder: Path, progress: Progress, tell: MessageCallback
) -> None:
    """Make samples; worker side."""
    from . import labels, render_samples, sensor, survey

    planned = plan.run(visit.draws[0].run)
    scene = RunScene(planned)
    source = _source(scene, planned, folder)
    progress(0, len(missing), produce.SAMPLES)
    for done, (drawn, rendered) in enumerate(render_samples.render(plan, visit, missing, tell), 1):
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


def _source(scene: RunScene, planned: PlanRun, out: Path) -> dict[str, Any]:
    """Describe the sources of a visit's samples for the metadata."""
    hashes = content.inputs(scene.run, out / produce.WORK)
    sources: dict[str, Any] = {
        "run": {"name": scene.run.name, "sha256": content.fingerprint({"run": hashes})},
        "versions": fingerprint.versions(),
        "device": scene.settings.render.device,
        licences.LICENCES: {f"run {scene.run.name}": ""},
        licences.CREDITS: list(picture_credits.of_settings(scene.settings).data),
    }
    if imagery.has_imagery(scene.settings):
        sources[licences.LICENCES][f"imagery of {planned.name}"] = planned.imagery_license
    return sources
