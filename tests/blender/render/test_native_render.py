"""Equal pictures by F12, in the background, and by the command line."""

import time

from firetwin.ui import queue


def test_a_queue_pauses_goes_on_and_tells_what_failed(scene, tmp_path, monkeypatch):
    """One at a time, in their order; no process is needed to see that."""
    from firetwin.jobs.render import RenderRequest
    from firetwin.jobs.worker import StoppedError
    from firetwin.shot.source import ShotSource

    calls = []

    def render(choice, blend, name, asked, progress, tell, stop):
        calls.append((blend.parent.name, asked.resume))
        assert blend.is_file()
        progress(1, 4, "rendering", "last: out/a.png")
        for _ in range(400):
            if stop.asked:
                raise StoppedError
            if (tmp_path / "go").exists():
                return 4
            time.sleep(0.02)
        raise OSError("no space left")

    first, second = (
        queue.add(title, scene, ShotSource(), RenderRequest(tmp_path), render) for title in ("one", "two")
    )
    try:
        queue.advance()
        queue.advance()
        assert (first.state, second.state) == (queue.RENDERING, queue.WAITING)
        queue.pause(first)
        _wait(lambda: first.state == queue.PAUSED)
        queue.advance()
        assert second.state == queue.RENDERING
        _wait(lambda: "1 of 4" in second.text)
        queue.go_on(first)
        (tmp_path / "go").touch()
        _wait(lambda: second.state == queue.DONE)
        queue.advance()
        _wait(lambda: first.state == queue.DONE)
        assert calls == [(first.folder.name, False), (second.folder.name, False), (first.folder.name, True)]
    finally:
        queue.clear()
    assert not first.folder.exists()
    assert not second.folder.exists()


def _wait(condition):
    end = time.monotonic() + 20.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)
