"""Render a scene file in this process, as the worker does."""

from firetwin.jobs import render
from firetwin.progress import no_message, silent
from firetwin.render import plan
from firetwin.render.store import Store
from firetwin.shot.source import ShotSource


def everything(folder, text, tell=no_message):
    """Render all files of a scene file of this text into folder/out: (its shot, that folder)."""
    (folder / "scene.toml").write_text(text)
    choice, out = ShotSource(scene=str(folder / "scene.toml")), folder / "out"
    pictures = plan.pictures(choice.shot())
    with Store(out, create=True):
        pass
    filmed = {(picture.camera, picture.name) for picture in pictures}
    asked = render.RenderRequest(out, resume=True)
    render.in_blender(choice, asked, filmed, 0, pictures, "me", silent, tell)
    return choice.shot(), out
