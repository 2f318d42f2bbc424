"""Comparison pictures of several runs, such as split screens, composed of finished pictures."""

from __future__ import annotations

import itertools
from pathlib import Path

from ..errors import writing
from ..progress import MessageCallback, Progress
from ..shot import passes
from ..shot.comparison import for_view
from ..shot.shot import Shot
from . import credits, manifest
from .picture import Picture
from .pictures import publish
from .sharing import RenderSession


def make(
    shot: Shot, session: RenderSession, wanted: list[Picture], progress: Progress, tell: MessageCallback
) -> None:
    """Make the comparison pictures that no other render leases, once all their inputs are finished."""
    done = 0
    while free := session.free(wanted, tell):
        for camera, group in itertools.groupby(free, key=lambda picture: picture.camera):
            own = for_view(shot, camera)
            with session.leases.part_folder() as part, session.queue(list(group), tell) as queue:
                while queue.step():
                    progress(done, len(wanted), "comparing runs")
                    pictures = [Picture(camera, queue.frame, name) for name in queue.names]
                    for picture in pictures:
                        _finish(own, session, part, picture)
                    if queue.holds_lease():
                        seen = session.store.entry(Picture(camera, queue.frame, "rgb").file("png"))
                        publish(own, session, part, pictures, stops=seen.get(manifest.EXPOSURE))
                        done += len(pictures)


def _finish(shot: Shot, session: RenderSession, part: Path, picture: Picture) -> None:
    """Write the files of a comparison picture into the temporary folder."""
    comparing, out = passes.known()[picture.name], session.store.out
    assert isinstance(comparing, passes.ComparisonPass)
    labels = [run.name for run in shot.settings.runs]
    needed = {name: _files(picture, picture.camera, name, out) for name in comparing.made_from}
    for name, label in itertools.product(comparing.needs_of_all, labels):
        needed[passes.view_of(name, label)] = _files(
            picture, passes.view_of(picture.camera, label), name, out
        )
    mine = {Path(name).suffix[1:]: part / Path(name).name for name in picture.files()}
    with writing(mine[comparing.files[0]]):
        passes.finish(picture.name, mine, needed, shot, picture.camera, picture.frame)
    words = manifest.read_credits(session.made_with[picture.camera, picture.name])
    credits.burn(mine["png"], words, f"Firetwin: {shot.run.name}")


def _files(picture: Picture, view: str, name: str, out: Path) -> dict[str, Path]:
    """Return paths of finished files, by suffix, of the same frame in a pass of a view."""
    paths = Picture(view, picture.frame, name).files()
    return {Path(path).suffix[1:]: out / path for path in paths}
