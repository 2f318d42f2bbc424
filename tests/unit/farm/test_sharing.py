"""Renders that share a folder, with the store alone: equal fingerprints divide the frames, others stop."""

import contextlib
import threading

import pytest
from firetwin.errors import InputError
from firetwin.render import sharing, store
from firetwin.render.picture import Picture

WANTED = [Picture("drone", frame, "rgb") for frame in (1, 2, 3)]
ENDLESS = 20  # frames after which a render of three frames does not end


def opened(out, samples, owner, since=0, asked=WANTED):
    made_with = {("drone", "rgb"): {"camera": "drone", "pass": "rgb", "samples": samples}}
    return sharing.open_session(out, made_with, owner, since=since, asked=asked)


def make(session, picture):
    """Write the files of a picture and enter them."""
    for name in picture.files():
        path = session.store.out / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{session.made_with}")
    entries = {
        name: store.describe(session.store.out / name)
        | {"camera": picture.camera, "pass": picture.name, "frame": picture.frame}
        for name in picture.files()
    }
    session.enter(picture, entries)


def render(session, tell=lambda text: None):
    """Render as a job does; the frames that it made."""
    rendered = []
    while free := session.free(WANTED, tell):
        with session.queue(free, tell) as queue:
            while queue.step():
                assert len(rendered) < ENDLESS
                make(session, Picture(queue.camera, queue.frame, "rgb"))
                rendered.append(queue.frame)
    return rendered


def at_once(out, *samples):
    """Render in threads at once; the frames or the error of each."""
    results = {}
    start = threading.Barrier(len(samples))

    def work(number):
        with opened(out, samples[number], f"render {number}") as session:
            start.wait()
            try:
                results[number] = render(session)
            except (InputError, AssertionError) as error:
                results[number] = error

    threads = [threading.Thread(target=work, args=(number,)) for number in range(len(samples))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results


@pytest.fixture(autouse=True)
def _quick(monkeypatch):
    monkeypatch.setattr(sharing, "_POLL_INTERVAL", 0.001)


def test_renders_of_other_settings_end(tmp_path):
    results = at_once(tmp_path, 4, 8)
    stopped = [result for result in results.values() if isinstance(result, InputError)]
    assert stopped
    assert all("drone_rgb_00000" in error.path for error in stopped)
    assert all("other settings, or another Firetwin or Blender" in error.reason for error in stopped)
    assert all(sorted(result) == [1, 2, 3] for result in results.values() if result not in stopped)


def test_renders_of_the_same_settings_make_each_frame_once(tmp_path):
    results = at_once(tmp_path, 4, 4)
    assert sorted(results[0] + results[1]) == [1, 2, 3]


def test_what_a_render_finished_stays_finished_for_it(tmp_path):
    with opened(tmp_path, 4, "mine") as mine, opened(tmp_path, 8, "other") as other:
        make(mine, WANTED[0])
        make(other, WANTED[0])
        assert mine.missing(WANTED) == WANTED[1:]
        assert other.missing(WANTED) == WANTED[1:]


@pytest.mark.parametrize("meet", ["free", "step", "publish"])
def test_a_render_that_meets_pictures_of_other_settings_stops(tmp_path, meet):
    with opened(tmp_path, 4, "mine") as mine, opened(tmp_path, 8, "other") as other:
        with mine.queue(WANTED) as queue:
            assert queue.step()
            make(other, WANTED[2])
            met = {"free": lambda: mine.free(WANTED, print), "step": queue.step, "publish": mine.check_others}
            with pytest.raises(InputError, match=r"drone_rgb_000003\.png: another render makes this picture"):
                met[meet]()
        assert mine.leases.of_others() == other.leases.of_others() == set()


def test_pictures_made_earlier_or_not_asked_for_stop_nobody(tmp_path):
    with opened(tmp_path, 8, "earlier") as other:
        make(other, WANTED[0])
        with opened(tmp_path, 4, "mine", since=other.store.latest_number(), asked=WANTED[:2]) as mine:
            make(other, WANTED[2])
            assert mine.free(WANTED[:2], print) == WANTED[:2]
            make(other, WANTED[1])
            with pytest.raises(InputError):
                mine.check_others()


def test_frames_of_another_render_are_told_and_taken_over(tmp_path, monkeypatch):
    told = []
    with opened(tmp_path, 4, "mine") as mine, contextlib.ExitStack() as life:
        other = life.enter_context(opened(tmp_path, 4, "other"))
        assert sharing.FrameQueue(other, WANTED[1:], told.append).step()  # holds two frames
        make(mine, WANTED[0])
        monkeypatch.setattr(sharing.time, "sleep", lambda seconds: life.close())
        assert render(mine, told.append) == [2, 3]
    assert told == [
        "waiting for 2 frames of another render; taken over 16 s after its last heartbeat",
        "taking over drone frame 2, left unfinished by another render",
        "taking over drone frame 3, left unfinished by another render",
    ]


def test_the_queue_counts_frames_that_others_finished_and_not_those_that_they_lease(tmp_path):
    with opened(tmp_path, 4, "mine") as mine, opened(tmp_path, 4, "other") as other:
        assert other.leases.take("drone 000002")
        with mine.queue(WANTED) as queue:
            done = []
            while queue.step():
                done.append(queue.done)
                make(mine, Picture(queue.camera, queue.frame, "rgb"))
            assert (done, queue.done, queue.total) == ([0, 1], 2, 3)
        make(other, WANTED[1])
        other.leases.release("drone 000002")
        with mine.queue(WANTED) as queue:
            assert not queue.step()
            assert queue.done == 3
