"""What to work on: a scene file, a run folder on its own, or a scene file with other folders or engine."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from .settings import scene_file
from .settings.settings import Settings

if TYPE_CHECKING:
    from .shot import Shot


@dataclass(frozen=True)
class ShotSource:
    """Plain text, so that it can be handed to another process; an empty one leaves the scene file's word.

    Attributes
    ----------
    scene
        Scene file. Without one settings are fitted to the run (see `auto_framing`).
    run, cache
        Folders in place of the scene file's.
    engine, device
        Render engine and what Cycles renders on, in place of the scene file's.
    smoke
        `smoke.method`, in place of the scene file's.
    beside
        Name of one of the scene file's other runs, which is shown in place of the first.
    """

    scene: str = ""
    run: str = ""
    cache: str = ""
    engine: str = ""
    device: str = ""
    smoke: str = ""
    beside: str = ""

    def plain(self) -> dict[str, str]:
        """The choice as `ShotSource(**plain)` takes it."""
        return asdict(self)

    def settings(self) -> Settings:
        """The scene file, or what fits the run, with what stands in for it."""
        from . import auto_framing

        if self.scene:
            found = scene_file.read(self.scene)
        else:
            found = auto_framing.fit_folder(Path(self.run), Path(self.run), Path("cache")).settings
        return replace(
            found,
            run=Path(self.run) if self.run else found.run,
            cache=Path(self.cache) if self.cache else found.cache,
            render=replace(
                found.render,
                engine=self.engine or found.render.engine,
                device=self.device or found.render.device,
            ),
            smoke=replace(found.smoke, method=self.smoke or found.smoke.method),
        )

    def shot(self) -> Shot:
        """The settings and their run, which fit each other.

        Raises
        ------
        InputError
            Names the file, line and column of what is wrong, and what to do.
        UsageError
            The scene file has no other run of the name.
        """
        from ..errors import UsageError
        from ..run import readers
        from . import comparison, run_checks, scene_runs
        from .shot import Shot

        settings = self.settings()
        run = readers.open(settings.run)
        run_checks.check(settings, run)
        shot = Shot(settings, run)
        scene_runs.check(settings, run, shot.others)
        if self.beside and self.beside not in shot.others:
            names = ", ".join(shot.others) or "none"
            raise UsageError(f'--run: there is no "{self.beside}" in [[runs]]; the scene has {names}')
        return comparison.for_run(shot, self.beside)
