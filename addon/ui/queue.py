"""Render queue: background renders in sequence, each of a copy of the file made when it was queued."""

from __future__ import annotations

import shutil
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import bpy

from ..jobs import worker
from ..jobs.render import RenderRequest
from ..progress import duration
from ..shot.source import ShotSource
from . import job

WAITING, RENDERING, PAUSED, DONE, FAILED = "waiting", "rendering", "paused", "done", "failed"
_TICK = 0.5  # s between two polls
_SHOWN = 6  # thumbnails

Run = Callable[..., int]
"""Render function: `render_blend.run`."""


@dataclass
class Item:
    """One queued .blend file.

    Attributes
    ----------
    folder
        Temporary folder with the copy of the file.
    resume
        True if some of it is already finished.
    finished
        Pictures to show, in order of completion.
    """

    title: str
    folder: Path
    scene: str
    choice: ShotSource
    asked: RenderRequest
    render: Run
    state: str = WAITING
    what: str = ""
    done: int = 0
    total: int = 0
    message: str = ""
    resume: bool = False
    finished: list[Path] = field(default_factory=list)
    stop: worker.Stop = field(default_factory=worker.Stop)
    began: float = 0.0
    _since: float = 0.0
    _thread: threading.Thread | None = None

    @property
    def blend(self) -> Path:
        """Copy of the file."""
        return self.folder / "scene.blend"

    @property
    def factor(self) -> float:
        """Completed fraction, 0 to 1."""
        return self.done / self.total if self.total else float(self.state == DONE)

    @property
    def text(self) -> str:
        """Status text: progress and remaining time."""
        if self.state != RENDERING:
            return f"{self.state.capitalize()}{f': {self.message}' if self.message else ''}"
        if not self.total:
            return "Starting Blender"
        words = f"{self.what.capitalize()} {self.done} of {self.total}"
        if not 0 < self.done < self.total:
            return words
        left = (time.monotonic() - self._since) / self.done * (self.total - self.done)
        return f"{words}, {duration(left)} left"

    def start(self) -> None:
        """Start rendering in a thread that waits for the worker process."""
        self.state, self.message, self.stop = RENDERING, "", worker.Stop()
        self.began = self.began or time.time()
        asked = RenderRequest(**{**vars(self.asked), "resume": self.resume})
        self.resume = True
        self._thread = threading.Thread(target=self._work, args=(asked, self.stop), daemon=True)
        self._thread.start()

    def _work(self, asked: RenderRequest, stop: worker.Stop) -> None:
        try:
            picture_count = self.render(
                self.choice,
                self.blend,
                self.scene,
                asked,
                progress=self._progress,
                tell=self._tell,
                stop=stop,
            )
        except worker.StoppedError:
            self.state, self.message = PAUSED, "finished pictures remain"
        except BaseException as error:
            self.state, self.message = FAILED, job.describe_error(error)
        else:
            self.state, self.message = DONE, f"{picture_count} pictures in {asked.out}"

    def _progress(self, done: int, total: int, what: str = "", note: str = "") -> None:
        if what != self.what or done == 0:
            self._since = time.monotonic()
        self.done, self.total, self.what = done, total, what or self.what

    def _tell(self, text: str) -> None:
        self.message = text

    def poll(self) -> None:
        """Poll for finished pictures."""
        known = set(self.finished)
        new = [
            path
            for path in self.asked.out.glob("*/*/*.png")
            if path not in known and path.stat().st_mtime >= self.began - 1.0
        ]
        self.finished += sorted(new, key=lambda path: path.stat().st_mtime)

    def drop(self) -> None:
        """Cancel the render, and remove the copy of the file."""
        self.stop.now()
        if self._thread is not None:
            self._thread.join(timeout=5.0)
        shutil.rmtree(self.folder, ignore_errors=True)


items: list[Item] = []
_pictures: dict[str, bpy.utils.previews.ImagePreviewCollection] = {}


def add(title: str, scene: bpy.types.Scene, choice: ShotSource, asked: RenderRequest, render: Run) -> Item:
    """Save a copy of the open file in its current state, and append it to the queue.

    Raises
    ------
    RuntimeError
        The copy cannot be saved.
    """
    folder = Path(tempfile.mkdtemp(prefix="firetwin-render-"))
    item = Item(title, folder, scene.name, choice, asked, render)
    try:
        if choice.scene:  # written for this session only
            kept = folder / "scene.toml"
            shutil.copyfile(choice.scene, kept)
            item.choice = replace(choice, scene=str(kept))
        bpy.ops.wm.save_as_mainfile(filepath=str(item.blend), copy=True, compress=False)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    items.append(item)
    start_timer()
    return item


def start_timer() -> None:
    """Restart the queue's timer."""
    if not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=0.0, persistent=True)


def current() -> Item | None:
    """Return the item being rendered."""
    return next((item for item in items if item.state == RENDERING), None)


def advance() -> None:
    """Start the next item if none is rendered."""
    if current() is None and (waiting := next((item for item in items if item.state == WAITING), None)):
        waiting.start()


def pause(item: Item) -> None:
    """Pause an item; finished pictures remain, and `go_on` renders the rest."""
    if item.state == RENDERING:
        item.stop.now()
    elif item.state == WAITING:
        item.state = PAUSED


def go_on(item: Item) -> None:
    """Resume an item by returning it to the queue."""
    if item.state in (PAUSED, FAILED):
        item.state = WAITING


def remove(item: Item) -> None:
    """Remove an item from the queue."""
    items.remove(item)
    item.drop()


def clear() -> None:
    """Cancel and remove all items."""
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    while items:
        remove(items[0])
    for picture in _pictures.values():
        bpy.utils.previews.remove(picture)
    _pictures.clear()


def thumbnails(item: Item) -> list[tuple[str, int]]:
    """Return names and icons of the last finished pictures."""
    from bpy.utils import previews

    if "" not in _pictures:
        _pictures[""] = previews.new()
    shown = []
    for path in item.finished[-_SHOWN:]:
        key = f"{path} {path.stat().st_mtime_ns}" if path.exists() else ""
        if key:
            icon = _pictures[""].get(key) or _pictures[""].load(key, str(path), "IMAGE")
            shown.append((path.stem, icon.icon_id))
    return shown


def _tick() -> float | None:
    from . import working

    advance()
    busy = current()
    if busy is not None:
        busy.poll()
    working.redraw()
    return _TICK if busy is not None or any(item.state == WAITING for item in items) else None
