"""A server of tiles on this machine that can lie: wrong lengths, late answers, sessions that end."""

import contextlib
import http.server
import threading
import time
import urllib.parse

from firetwin.tiles.sources import backoff


class Clock(backoff.Clock):
    """A clock that does not wait; it remembers how long it should have."""

    def __init__(self):
        self.time, self.slept = time.time(), []
        super().__init__(now=lambda: self.time, sleep=self._sleep, jitter=lambda: 1.0)

    def _sleep(self, seconds):
        self.slept.append(seconds)
        self.time += seconds


class Reply:
    """One answer.

    Attributes
    ----------
    length
        Content-Length, if not the length of the body.
    """

    def __init__(self, status=200, body=b"", headers=None, length=None):
        self.status, self.body, self.headers, self.length = status, body, headers or {}, length


class Server:
    """Answers by path: a reply, bytes, a list of replies to be given one after another, or a function.

    Attributes
    ----------
    asked
        Paths of all requests, with their queries.
    headers
        Headers of all requests.
    """

    def __init__(self):
        self.answers, self.asked, self.headers = {}, [], []
        lock = threading.Lock()
        outer = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self):
                with lock:
                    outer.asked.append(self.path)
                    outer.headers.append(dict(self.headers))
                    reply = outer.reply(self)
                self.send_response(reply.status)
                for name, value in reply.headers.items():
                    self.send_header(name, value)
                length = len(reply.body) if reply.length is None else reply.length
                self.send_header("Content-Length", str(length))
                self.end_headers()
                if reply.status != 304:
                    self.wfile.write(reply.body)
                if length != len(reply.body):
                    self.close_connection = True

            def log_message(self, *_):
                pass

        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._server.server_port}"
        threading.Thread(target=self._server.serve_forever, args=(0.01,), daemon=True).start()

    def reply(self, handler):
        parts = urllib.parse.urlsplit(handler.path)
        found = self.answers.get(parts.path, Reply(404, b"no such file"))
        if callable(found):
            found = found(dict(urllib.parse.parse_qsl(parts.query)), handler.headers)
        if isinstance(found, list):
            found = found.pop(0) if len(found) > 1 else found[0]
        return Reply(body=found) if isinstance(found, bytes) else found

    def close(self):
        self._server.shutdown()
        self._server.server_close()


@contextlib.contextmanager
def serving():
    """A server, closed at the end."""
    server = Server()
    try:
        yield server
    finally:
        server.close()
