"""Shot source: a scene file with command line overrides."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import UsageError
from . import schema
from .settings import Settings, output_presets, scene_file

if TYPE_CHECKING:
    from .shot import Shot


@dataclass(frozen=True)
class ShotSource:
    """Scene file and the settings that override it, as text; an empty value overrides nothing.

    Attributes
    ----------
    scene
        Scene file.
    run, cache
        Folders that override the scene file's.
    engine, device
        Render engine and Cycles device that override the scene file's.
    smoke
        Override of `smoke.method`.
    beside
        Name of a comparison run to show in place of the first run.
    preset
        Output preset to apply (see `settings.output_presets`).
    exposure
        Exposure in stops that overrides the scene file's.
    """

    scene: str = ""
    run: str = ""
    cache: str = ""
    engine: str = ""
    device: str = ""
    smoke: str = ""
    beside: str = ""
    preset: str = ""
    exposure: str = ""

    def settings(self) -> Settings:
        """Read the settings of the scene file and apply the overrides.

        Raises
        ------
        UsageError
            The scene cannot be rendered with the preset.
        """
        settings = scene_file.read(self.scene)
        if self.preset:
            settings = output_presets.apply(settings, self.preset)
            if mistake := schema.validate(settings):
                raise UsageError(f"--preset: {mistake[1]}")
        return replace(
            settings,
            run=Path(self.run) if self.run else settings.run,
            cache=Path(self.cache) if self.cache else settings.cache,
            render=replace(
                settings.render,
                engine=self.engine or settings.render.engine,
                device=self.device or settings.render.device,
            ),
            light=replace(
                settings.light, exposure=float(self.exposure) if self.exposure else settings.light.exposure
            ),
            smoke=replace(settings.smoke, method=self.smoke or settings.smoke.method),
        )

    def shot(self) -> Shot:
        """Resolve settings and run to a shot, with all checks.

        Raises
        ------
        InputError
            The error names the file, line and column, the fault and the remedy.
        UsageError
            The scene file has no comparison run with the name.
        """
        from ..run import readers
        from . import comparison, picture_credits, run_checks, scene_inputs
        from .runs import scene_runs
        from .shot import Shot

        settings = self.settings()
        run = readers.open(settings.run)
        run_checks.check(settings, run)
        shot = Shot(settings, run)
        scene_runs.check(settings, run, shot.others)
        scene_inputs.check_others(settings, shot.others)
        if self.beside and self.beside not in shot.others:
            names = ", ".join(shot.others) or "none"
            raise UsageError(f'--run: there is no "{self.beside}" in [[runs]]; the scene has {names}')
        picture_credits.check_room(shot, picture_credits.of_settings(settings))
        return comparison.for_run(shot, self.beside)
