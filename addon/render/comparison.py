"""Pictures that compare runs, made of finished ones: nothing is rendered for them."""

from __future__ import annotations

import itertools
from pathlib import Path

from ..errors import writing
from ..progress import MessageCallback, Progress
from ..shot import passes
from ..shot.comparison import for_view
from ..shot.shot import Shot
from .picture import Picture
from .pictures import publish
from .sharing import RenderSession


def make(
    shot: Shot, making: RenderSession, wanted: list[Picture], progress: Progress, tell: MessageCallback
) -> None:
    """Make those of these pictures that nobody else does, when all that they are made of is finished."""
    done = 0
    while free := making.free(wanted, tell):
        for camera, group in itertools.groupby(free, key=lambda picture: picture.camera):
            own = for_view(shot, camera)
            with making.claims.part_folder() as part, making.line(list(group)) as line:
                while line.step():
                    progress(done, len(wanted), "comparing runs")
                    pictures = [Picture(camera, line.frame, name) for name in line.names]
                    for picture in pictures:
                        _finish(own, making, part, picture)
                    if line.held():
                        publish(own, making, part, pictures)
                        done += len(pictures)


def _finish(shot: Shot, making: RenderSession, part: Path, picture: Picture) -> None:
    """Make the files of a picture in the temporary folder."""
    each, out = passes.known()[picture.name], making.store.out
    labels = [run.name for run in shot.settings.runs]
    needed = {name: _files(picture, picture.camera, name, out) for name in each.made_from}
    for name, label in itertools.product(each.needs_of_all, labels):
        needed[passes.view_of(name, label)] = _files(
            picture, passes.view_of(picture.camera, label), name, out
        )
    mine = {Path(name).suffix[1:]: part / Path(name).name for name in picture.files()}
    with writing(mine[each.files[0]]):
        each.finish(mine, needed, shot, picture.camera, picture.frame)


def _files(picture: Picture, view: str, name: str, out: Path) -> dict[str, Path]:
    """Finished files, by suffix, of the same frame in a pass of a view."""
    paths = Picture(view, picture.frame, name).files()
    return {Path(path).suffix[1:]: out / path for path in paths}
