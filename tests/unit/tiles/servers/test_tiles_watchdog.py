"""Servers that send without end: a file, a host and a job end after their time."""

import threading
import time

import pytest
from firetwin.errors import InputError
from firetwin.tiles.sources import MissingError
from firetwin.tiles.sources.http import Http
from firetwin.tiles.sources.network import Network
from firetwin.tiles.sources.watchdog import Pace, Watch, Watchdog
from lying_server import Reply, serving


@pytest.fixture
def server():
    with serving() as each:
        yield each


def drip(handler, head, stop):
    """Send a byte every hundredth of a second until the client leaves."""
    try:
        if not head:
            handler.wfile.write(b"HTTP/1.1 200 OK\r\nContent-Length: 100000\r\n\r\n")
        while not stop.is_set():
            handler.wfile.write(b"x")
            handler.wfile.flush()
            stop.wait(0.01)
    except OSError:
        stop.set()


@pytest.fixture
def dripping(server):
    """URL of a server whose files drip, and of which part: head or body."""
    stops = []

    def make(part):
        handler = server._server.RequestHandlerClass

        def get(self):
            stops.append(threading.Event())
            drip(self, part == "head", stops[-1])
            self.close_connection = True

        handler.do_GET = get
        return f"{server.url}/tileset.json"

    yield make, stops
    for stop in stops:
        stop.set()


@pytest.mark.parametrize("part", ["head", "body"])
@pytest.mark.parametrize("limit", ["piece", "file"])
def test_a_server_that_drips_is_left(dripping, part, limit):
    make, stops = dripping
    network = Network(cache=None, pace=Pace(**{limit: 0.1}))
    source = Http(make(part), network)
    try:
        with pytest.raises(MissingError, match="sends too slowly: left after"):
            source.read(source.root)
        with pytest.raises(MissingError):
            source.read(source.root)
        with pytest.raises(InputError, match="the server does not respond"):
            source.read(source.root)
    finally:
        source.close()
    assert len(stops) == 3  # no repetitions
    for stop in stops:
        assert stop.wait(5.0)  # the server sees that it was left


@pytest.mark.parametrize(("limit", "whose"), [("host", "to http://127.0.0.1"), ("job", "of this job")])
def test_the_requests_to_a_host_and_of_a_job_end_after_a_time(server, limit, whose):
    server.answers["/tileset.json"] = Reply(body=b"{}")
    source = Http(f"{server.url}/tileset.json", Network(cache=None, pace=Pace(**{limit: 0.0})))
    try:
        assert source.read(source.root) == b"{}"
        with pytest.raises(InputError, match=f"the requests {whose}.*took more than 0 s; run it again"):
            source.read(source.root)
    finally:
        source.close()


def test_a_pooled_connection_is_watched_again(server):
    server.answers["/tileset.json"] = [Reply(body=b"{}"), Reply(body=b"{}"), Reply(body=b"{}", length=9)]
    source = Http(f"{server.url}/tileset.json", Network(cache=None, pace=Pace(piece=0.2)))
    try:
        assert [source.read(source.root) for _ in range(2)] == [b"{}"] * 2
    finally:
        source.close()


def test_a_watch_ends_with_its_request():
    watchdog, watch = Watchdog(), Watch(Pace(piece=0.02))
    with watchdog.watching(watch):
        pass
    time.sleep(0.05)
    assert not watch.expired
