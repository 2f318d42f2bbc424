"""HTTP requests with urllib3 (bundled with Blender): checked addresses, verified TLS, size limits."""

from __future__ import annotations

import logging
import ssl
import threading
import time
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

import firetwin_core

from ... import extras, limits
from ...errors import InputError, UsageError, input_error
from ._source import GROWTH, missing
from .address import Guard, origin
from .secret import Redactor
from .watchdog import PACE, Pace, Watch, Watchdog

TIMEOUT = float(limits.DOWNLOAD_SILENCE)  # s without data
_PIECE = 1 << 16  # bytes
_FREE = 1 << 20  # bytes; smaller bodies may exceed the ratio


class TransportError(Exception):
    """A missing or incomplete response.

    Attributes
    ----------
    cut_off
        The response began and ended early.
    slow
        A time limit ended the request; a repetition would take as long.
    """

    def __init__(self, text: str, cut_off: bool = False, slow: bool = False) -> None:
        super().__init__(text)
        self.cut_off, self.slow = cut_off, slow


@dataclass(frozen=True)
class Response:
    """A response with decompressed body."""

    status: int
    headers: Mapping[str, str]
    body: bytes


class Connection:
    """Connections to the hosts of a source.

    Raises
    ------
    UsageError
        urllib3 is not installed.
    """

    def __init__(self, private: bool, redactor: Redactor, pace: Pace = PACE) -> None:
        self._pace, self._watchdog, self._current = pace, Watchdog(), threading.local()
        self._library, self._guard, self._redactor = _urllib3(), Guard(private), redactor
        self._pools: dict[tuple[str, str, int], Any] = {}
        self._lock = threading.Lock()
        logging.getLogger("urllib3.connectionpool").addFilter(redactor)

    def ask(self, url: str, headers: dict[str, str], max_bytes: int, name: str) -> Response:
        """Send one GET request, without redirects and retries, within the time limits.

        Parameters and errors are as in `_ask`.
        """
        watch = self._current.watch = Watch(self._pace)
        try:
            with self._watchdog.watching(watch):
                return self._ask(url, headers, max_bytes, name)
        except (TransportError, InputError):
            if not watch.expired:
                raise
            seconds = time.monotonic() - watch.began
            raise TransportError(f"sends too slowly: left after {seconds:,.0f} s", slow=True) from None

    def _ask(self, url: str, headers: dict[str, str], max_bytes: int, name: str) -> Response:
        """Send one GET request, without redirects and retries.

        Parameters
        ----------
        max_bytes
            Limit on the body, compressed and decompressed.
        name
            Name of the URL, for messages.

        Raises
        ------
        TransportError
            The response is missing or incomplete.
        InputError
            The certificate or address is refused, or the response is too large.
        """
        parts, library = urlsplit(url), self._library
        path = (parts.path or "/") + (f"?{parts.query}" if parts.query else "")
        everything = {
            "User-Agent": f"Firetwin/{firetwin_core.__version__}",
            "Accept-Encoding": "gzip",
            **headers,
        }
        try:
            response = self._pool(url, name).request(
                "GET",
                path,
                headers=everything,
                redirect=False,
                retries=False,
                preload_content=False,
                decode_content=False,
                timeout=library.Timeout(connect=TIMEOUT, read=TIMEOUT),
            )
        except library.exceptions.SSLError as error:
            reason = f"its certificate cannot be verified ({self._redactor.text(str(error))[:200]})"
            raise input_error(name, reason) from None
        except (library.exceptions.HTTPError, OSError) as error:
            raise TransportError(self._redactor.text(str(error))) from None
        try:
            body = self._body(response, max_bytes, name)
        except BaseException as error:
            response.close()  # the rest would be read as the next response
            if not isinstance(error, library.exceptions.HTTPError | OSError):
                raise
            timed_out = isinstance(error, library.exceptions.ReadTimeoutError | TimeoutError)
            raise TransportError(self._redactor.text(str(error)), cut_off=not timed_out) from None
        finally:
            response.release_conn()
        return Response(response.status, response.headers, body)

    def close(self) -> None:
        """Close all connections."""
        for pool in self._pools.values():
            pool.close()
        logging.getLogger("urllib3.connectionpool").removeFilter(self._redactor)

    def _body(self, response: Any, max_bytes: int, name: str) -> bytes:
        """Read and decompress the body within the limits; zlib verifies gzip's checksum."""
        coding = response.headers.get("Content-Encoding", "identity").strip().lower()
        if coding not in ("identity", "gzip", ""):
            raise missing(name, f"has the content encoding {coding[:40]!r}, which was not asked for")
        engine = zlib.decompressobj(31) if coding == "gzip" else None
        raw, size, pieces = 0, 0, []
        while piece := response.read(_PIECE):
            self._current.watch.step()
            raw += len(piece)
            limit = max_bytes if engine is None else min(max_bytes, max(GROWTH * raw, _FREE))
            if engine is not None:
                piece = self._inflate(engine, piece, limit + 1 - size)
            size += len(piece)
            if size > limit or raw > max_bytes:
                raise input_error(
                    name, f"is larger than {max_bytes:,} bytes, or grows more than {GROWTH} times"
                )
            pieces.append(piece)
        stated = response.headers.get("Content-Length", "")
        if stated.isdecimal() and raw != int(stated):
            raise TransportError(f"has {raw:,} bytes, not {int(stated):,} as announced", cut_off=True)
        if engine is not None and not engine.eof:
            raise TransportError("its compressed body ends early", cut_off=True)
        return b"".join(pieces)

    @staticmethod
    def _inflate(engine: Any, piece: bytes, room: int) -> bytes:
        try:
            return engine.decompress(piece, max(room, 1))
        except zlib.error as error:
            raise TransportError(f"its compressed body is damaged: {error}", cut_off=True) from None

    def _pool(self, url: str, name: str) -> Any:
        found = origin(url, name)
        key = (found.scheme, found.host, found.port)
        with self._lock:
            if key not in self._pools:
                self._pools[key] = self._make_pool(*key)
            return self._pools[key]

    def _make_pool(self, scheme: str, host: str, port: int) -> Any:
        """Make a pool whose connections go to addresses checked by the guard."""
        guard, library, current = self._guard, self._library, self._current
        base: Any = library.connection.HTTPConnection
        if scheme == "https":
            base = library.connection.HTTPSConnection

        class Guarded(base):
            handle: Any = None  # of the connection; it survives the start of TLS

            def _new_conn(self) -> Any:
                made = guard.connect(self.host, self.port, TIMEOUT)
                self.handle = made.dup()
                current.watch.attach(self.handle)
                return made

            def putrequest(self, *given: Any, **more: Any) -> None:
                if self.handle is not None:
                    current.watch.attach(self.handle)
                super().putrequest(*given, **more)

            def close(self) -> None:
                super().close()
                if self.handle is not None:
                    self.handle.close()
                    self.handle = None

        if scheme == "https":
            pool = library.HTTPSConnectionPool(host, port, maxsize=8, ssl_context=_tls())
        else:
            pool = library.HTTPConnectionPool(host, port, maxsize=8)
        pool.ConnectionCls = Guarded
        return pool


def _tls() -> ssl.SSLContext:
    """Make a context that verifies certificates, with authorities of the system and of certifi."""
    context = ssl.create_default_context()
    try:
        import certifi
    except ImportError:
        return context
    context.load_verify_locations(certifi.where())
    return context


def _urllib3() -> Any:
    try:
        import urllib3
        import urllib3.connection
        import urllib3.exceptions
    except ImportError:
        text = f"tiles of servers need urllib3; install it with: {extras.install('tiles')}"
        raise UsageError(text) from None
    return urllib3
