"""What to work on: a scene file, a run folder on its own, or a scene file with other folders or engine."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from . import project as projects

if TYPE_CHECKING:
    from firetwin_core.run import Run


@dataclass(frozen=True)
class Choice:
    """Plain text, so that it can be handed to another process; an empty one leaves the scene file's word.

    Attributes
    ----------
    scene
        Scene file. Without one every setting has its default, and two cameras show the whole fire.
    run, cache
        Folders in place of the scene file's.
    engine
        Render engine in place of the scene file's.
    """

    scene: str = ""
    run: str = ""
    cache: str = ""
    engine: str = ""

    def plain(self) -> dict[str, str]:
        """The choice as `Choice(**plain)` takes it."""
        return asdict(self)

    def project(self) -> projects.Project:
        """The scene file with what stands in for it; without one there are no cameras yet."""
        found = projects.load(self.scene) if self.scene else projects.Project(path=Path(self.run))
        folders = {name: Path(text) for name in ("run", "cache") if (text := getattr(self, name))}
        render = replace(found.render, engine=self.engine) if self.engine else found.render
        return replace(found, render=render, **folders)

    def load(self) -> tuple[projects.Project, Run]:
        """The project and its run, which fit each other.

        Raises
        ------
        InputError
            Names the file, line and column of what is wrong, and what to do.
        """
        from firetwin_core import run as runs

        from . import check, overview

        project = self.project()
        run = runs.open(project.run)
        if not self.scene:
            project = replace(project, cameras=overview.cameras(run))
        check.against_run(project, run)
        return project, run
