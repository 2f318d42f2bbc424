"""Processes that share work: one at a time, or each its own part of it."""

import contextlib
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import pytest
from firetwin import leases
from firetwin.database import Database
from firetwin.leases import Leases
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

HOLD = """
import sys, time
from pathlib import Path
from firetwin import leases
with leases.lock(Path(sys.argv[1]), lambda: False, lambda: None) as mine:
    print(mine, flush=True)
    time.sleep(600)
"""


def opened(folder):
    return contextlib.closing(Database(folder / "work.sqlite", leases.TABLES, create=True))


@pytest.fixture
def holder(tmp_path):
    """A process that works alone, with its lease."""
    with subprocess.Popen([sys.executable, "-c", HOLD, tmp_path / "lock"], stdout=subprocess.PIPE) as process:
        assert process.stdout.readline().strip() == b"True"
        yield process, tmp_path / "lock"
        process.kill()


def test_what_a_killed_process_held_is_free(holder, monkeypatch):
    monkeypatch.setattr(leases, "_POLL_INTERVAL", 0.01)
    process, path = holder
    looks = []

    def wait():
        looks.append(process.poll())
        process.kill()
        process.wait()

    with leases.lock(path, lambda: False, wait) as mine:
        assert mine
    assert looks[0] is None


def test_who_waits_ends_when_the_work_is_done_or_it_was_stopped(holder, monkeypatch):
    monkeypatch.setattr(leases, "_POLL_INTERVAL", 0.01)
    _, path = holder
    done = iter([False, False, True])
    with leases.lock(path, lambda: next(done), lambda: None) as mine:
        assert not mine

    def stop():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), leases.lock(path, lambda: False, stop):
        pass


def test_threads_of_one_process_are_alone_too(tmp_path, monkeypatch):
    monkeypatch.setattr(leases, "_POLL_INTERVAL", 0.001)
    inside, most = [], []

    def work():
        with leases.lock(tmp_path / "lock", lambda: False, lambda: None):
            inside.append(1)
            most.append(len(inside))
            time.sleep(0.01)
            inside.pop()

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == [1, 1, 1, 1]


def test_where_nothing_can_be_locked_everybody_works(tmp_path):
    (tmp_path / "lock").write_bytes(b"no database" * 100)
    with leases.lock(tmp_path / "lock", lambda: False, lambda: None) as mine:
        assert mine


def test_without_a_lock_server_everybody_works(tmp_path, monkeypatch):
    monkeypatch.setattr(leases, "_lock", lambda database: False)  # ENOLCK is SQLITE_BUSY, of any file

    def wait():
        raise AssertionError("waits for a lock that nobody holds")

    with leases.lock(tmp_path / "lock", lambda: False, wait) as mine:
        assert mine
    assert [path.name for path in tmp_path.iterdir()] == ["lock"]


def test_a_sign_that_fails_is_followed_by_others():
    given, enough = [], threading.Event()

    def give():
        given.append(1)
        if len(given) == 3:
            enough.set()
        raise OSError("the folder is gone")

    with leases.heartbeats(0.001, give):
        assert enough.wait(10.0)
    after = len(given)
    time.sleep(0.01)
    assert len(given) == after


def test_what_one_claims_another_cannot(tmp_path):
    with opened(tmp_path) as made, Leases(made, "a") as a:
        with Leases(made, "b") as b:
            assert a.take("frame 1")
            assert not b.take("frame 1")
            assert b.take("frame 2")
            assert a.of_others() == {"frame 2"}
            a.release("frame 1")
            assert b.take("frame 1")
            assert not a.is_held("frame 1")
        assert a.of_others() == set()
        assert a.take("frame 2")


def test_the_claims_of_who_gives_no_sign_of_life_are_taken_over(tmp_path, monkeypatch):
    monkeypatch.setattr(leases, "HEARTBEAT", 0.05)
    monkeypatch.setattr(leases, "PATIENCE", 0.5)
    with opened(tmp_path) as made, Leases(made, "living") as living, Leases(made, "me") as me:
        assert living.take("frame 1")
        dead = Leases(made, "dead")
        with dead.part_folder():
            assert dead.take("frame 2")
            dead._life.close()  # as a kill, a crash or a pulled plug would
            assert me.of_others() == {"frame 1", "frame 2"}
            end = time.monotonic() + 10.0
            while me.of_others() != {"frame 1"} and time.monotonic() < end:
                time.sleep(0.05)
            assert me.take("frame 2")
            assert not dead.is_held("frame 2")
            assert not list(tmp_path.glob(".part-dead"))


def test_files_in_the_making_are_cleared_away(tmp_path):
    with opened(tmp_path) as made, Leases(made, "alive"):
        left = tmp_path / ".part-gone"
        left.mkdir()
        alive = tmp_path / ".part-alive"
        alive.mkdir()
        with Leases(made, "me") as me, me.part_folder() as folder:
            assert folder.is_dir()
            (folder / "x").write_text("x")
            assert [path for path in (left, folder, alive) if path.exists()] == [folder, alive]
        assert [path for path in (left, folder, alive) if path.exists()] == [alive]


class Sharing(RuleBasedStateMachine):
    """Three owners, and who must hold what."""

    owners = st.sampled_from("abc")
    names = st.sampled_from(["frame 1", "frame 2"])

    def __init__(self):
        super().__init__()
        self.folder = tempfile.TemporaryDirectory()
        self.data = Database(Path(self.folder.name) / "work.sqlite", leases.TABLES, create=True)
        self.claims = {owner: Leases(self.data, owner) for owner in "abc"}
        self.held = {}

    @rule(owner=owners, name=names)
    def take(self, owner, name):
        assert self.claims[owner].take(name) == (self.held.setdefault(name, owner) == owner)

    @rule(owner=owners, name=names)
    def give(self, owner, name):
        self.claims[owner].release(name)
        if self.held.get(name) == owner:
            del self.held[name]

    @rule(owner=owners)
    def die(self, owner):
        leases.leave(self.data, owner)
        self.held = {name: each for name, each in self.held.items() if each != owner}

    @rule(owner=owners)
    def live_on(self, owner):
        """An owner with a heartbeat since the last check does not expire."""
        beat = leases._beats(self.data).get(owner)
        self.claims[owner]._send_heartbeat()
        leases.leave(self.data, owner, beat)

    @invariant()
    def each_is_held_by_one(self):
        for owner, claims in self.claims.items():
            assert claims.of_others() == {name for name, each in self.held.items() if each != owner}
            for name in ("frame 1", "frame 2"):
                assert claims.is_held(name) == (self.held.get(name) == owner)

    def teardown(self):
        for claims in self.claims.values():
            claims.__exit__()
        self.data.close()
        self.folder.cleanup()


TestSharing = Sharing.TestCase
TestSharing.settings = settings(max_examples=6, stateful_step_count=12, deadline=None)
