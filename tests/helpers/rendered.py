"""Render a scene file in this process, as the worker does."""

from firetwin.jobs import render
from firetwin.progress import no_message, silent
from firetwin.render import plan
from firetwin.render.store import Store
from firetwin.shot.source import ShotSource


def everything(folder, text):
    """Render all files of a scene file of this text into folder/out: (its shot, that folder)."""
    (folder / "scene.toml").write_text(text)
    choice, out = ShotSource(scene=str(folder / "scene.toml")), folder / "out"
    pictures = plan.pictures(choice.shot())
    with Store(out, create=True):
        pass
    listed = [[picture.camera, picture.frame, picture.name] for picture in pictures]
    pairs = sorted({(picture.camera, picture.name) for picture in pictures})
    filmed, selection = [list(pair) for pair in pairs], [None, None, None]
    render.in_blender(choice.plain(), str(out), listed, filmed, "me", 0, True, selection, silent, no_message)
    return choice.shot(), out
