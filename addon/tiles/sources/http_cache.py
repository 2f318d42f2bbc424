"""Cache of servers' responses on disk (RFC 9111, a private cache)."""

from __future__ import annotations

import contextlib
import hashlib
import os
import sys
import threading
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from email.utils import parsedate_to_datetime
from pathlib import Path
from typing import Any, TypeVar

from ... import files
from ...database import Database
from ...errors import InputError

_T = TypeVar("_T")

LIMIT = 4_000_000_000  # bytes
_TABLES = """
CREATE TABLE answer (key TEXT PRIMARY KEY, url TEXT NOT NULL, file TEXT NOT NULL, length INTEGER NOT NULL,
    sha256 TEXT NOT NULL, etag TEXT NOT NULL, modified TEXT NOT NULL, expires REAL NOT NULL,
    strict INTEGER NOT NULL, used REAL NOT NULL);
CREATE INDEX answer_used ON answer (used)
"""
_COLUMNS = "key, url, file, length, sha256, etag, modified, expires, strict, used"
_TOUCH = 60.0  # s between updates of the time of use
_KEPT = 0.9  # of the limit, after eviction


@dataclass(frozen=True)
class CachedAnswer:
    """A response in the cache.

    Attributes
    ----------
    expires
        End of freshness, s since 1970.
    strict
        Must be revalidated when stale (must-revalidate, no-cache).
    """

    body: bytes
    etag: str
    modified: str
    expires: float
    strict: bool


@dataclass(frozen=True)
class Rules:
    """Caching rules from the headers of a response."""

    store: bool
    expires: float
    strict: bool


def folder() -> Path:
    """Return the user's cache folder."""
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData/Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library/Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "firetwin" / "tiles"


def rules(headers: Mapping[str, str], now: float) -> Rules:
    """Parse the headers of a response received at `now` (seconds since 1970).

    A response without max-age and Expires is revalidated at each use.
    """
    words: dict[str, str] = {}
    for each in headers.get("Cache-Control", "").lower().split(","):
        name, _, value = each.strip().partition("=")
        words[name] = value.strip('" ')
    age = 0.0
    if "max-age" in words:
        with contextlib.suppress(ValueError):
            age = float(int(words["max-age"])) - float(int(headers.get("Age", "0") or "0"))
    elif "Expires" in headers:
        with contextlib.suppress(ValueError, TypeError):
            date = headers.get("Date")
            sent = parsedate_to_datetime(date).timestamp() if date else now
            age = parsedate_to_datetime(headers["Expires"]).timestamp() - sent
    if "no-cache" in words:
        age = 0.0
    strict = bool({"must-revalidate", "no-cache"} & set(words))
    return Rules("no-store" not in words and headers.get("Vary", "") != "*", now + max(age, 0.0), strict)


class HttpCache:
    """Responses by their URLs without secrets. Several processes may use one folder.

    Parameters
    ----------
    limit
        Limit, bytes; the least recently used responses are evicted.
    """

    def __init__(self, place: Path, limit: int = LIMIT) -> None:
        self.place, self.limit = place, limit
        self._own = threading.local()
        self._lock = threading.Lock()
        self._size: int | None = None

    def find(self, url: str, now: float) -> CachedAnswer | None:
        """Find the response of a URL; None without one. A damaged response is removed."""
        return self._try(lambda data: self._find(data, _key(url), now), None)

    def put(self, url: str, body: bytes, headers: Mapping[str, str], now: float) -> None:
        """Store a response if its headers allow; nothing is stored on a full disk."""
        found = rules(headers, now)
        if found.store:
            self._try(lambda data: self._put(data, url, body, headers, found, now), None)
        else:
            self._try(lambda data: self._replace(data, _key(url), None), None)

    def refresh(self, url: str, headers: Mapping[str, str], now: float) -> None:
        """Update a response that the server confirmed (status 304)."""
        found = rules(headers, now)
        command = "UPDATE answer SET expires = ?, strict = ?, used = ? WHERE key = ?"
        values = (found.expires, int(found.strict), now, _key(url))
        self._try(lambda data: data.execute(command, *values), None)

    def prune(self, limit: int | None = None) -> int:
        """Remove the least recently used responses until `limit` bytes remain; return the bytes left."""
        most = self.limit if limit is None else limit
        return self._try(lambda data: self._prune(data, most), 0)

    def content(self) -> tuple[int, int, float]:
        """Return the number of responses, their bytes, and the time of last use (s since 1970)."""
        query = "SELECT COUNT(*), COALESCE(SUM(length), 0), COALESCE(MAX(used), 0) FROM answer"
        if not (self.place / "answers.db").exists():
            return 0, 0, 0.0
        number, total, used = self._try(lambda data: data.fetch_one(query), None) or (0, 0, 0.0)
        return int(number), int(total), float(used)

    def close(self) -> None:
        """Close this thread's database."""
        data = getattr(self._own, "data", None)
        if data is not None:
            data.close()
            self._own.data = None

    def _find(self, data: Database, key: str, now: float) -> CachedAnswer | None:
        row = data.fetch_one(f"SELECT {_COLUMNS} FROM answer WHERE key = ?", key)
        if row is None:
            return None
        _, _, name, length, sha256, etag, modified, expires, strict, used = row
        try:
            body = (self.place / name).read_bytes()
        except OSError:
            body = b""
        if len(body) != length or hashlib.sha256(body).hexdigest() != sha256:
            data.execute("DELETE FROM answer WHERE key = ? AND file = ?", key, name)
            self._unlink(name)
            return None
        if abs(now - used) > _TOUCH:
            data.execute("UPDATE answer SET used = ? WHERE key = ?", now, key)
        return CachedAnswer(body, etag, modified, expires, bool(strict))

    def _put(
        self, data: Database, url: str, body: bytes, headers: Mapping[str, str], rules: Rules, now: float
    ) -> None:
        key = _key(url)
        name = f"{key[:2]}/{key[2:18]}-{uuid.uuid4().hex[:12]}"
        files.write(self.place / name, lambda part: part.write_bytes(body))
        values = (
            *(key, url, name, len(body), hashlib.sha256(body).hexdigest()),
            *(headers.get("ETag", ""), headers.get("Last-Modified", "")),
            *(rules.expires, int(rules.strict), now),
        )
        try:
            self._replace(data, key, values)
        except BaseException:
            self._unlink(name)
            raise
        self._note_growth(data, len(body))

    def _replace(self, data: Database, key: str, values: tuple[Any, ...] | None) -> None:
        """Replace or remove the row of a key; the file of the former row is removed."""
        with data.change():
            before = data.fetch_one("SELECT file FROM answer WHERE key = ?", key)
            data.execute("DELETE FROM answer WHERE key = ?", key)
            if values is not None:
                data.execute(f"INSERT INTO answer ({_COLUMNS}) VALUES ({', '.join('?' * 10)})", *values)
        if before is not None:
            self._unlink(before[0])

    def _note_growth(self, data: Database, more: int) -> None:
        with self._lock:
            if self._size is None:
                self._size = _total(data)
            else:
                self._size += more
            over = self._size > self.limit
        if over:
            left = self._prune(data, round(_KEPT * self.limit))
            with self._lock:
                self._size = left

    def _prune(self, data: Database, limit: int) -> int:
        gone = []
        with data.change():
            total = _total(data)
            for key, name, length in data.fetch_all(
                "SELECT key, file, length FROM answer ORDER BY used, key"
            ):
                if total <= limit:
                    break
                data.execute("DELETE FROM answer WHERE key = ?", key)
                gone.append(name)
                total -= length
        for name in gone:
            self._unlink(name)
        return total

    def _unlink(self, name: str) -> None:
        with contextlib.suppress(OSError):
            (self.place / name).unlink(missing_ok=True)

    def _try(self, work: Callable[[Database], _T], otherwise: _T) -> _T:
        """Use this thread's database; on an error the cache behaves as if empty."""
        try:
            return work(self._data())
        except (InputError, OSError):  # no database, or the disk is full
            self.close()
            self._set_aside()
            return otherwise

    def _data(self) -> Database:
        if getattr(self._own, "data", None) is None:
            if not self.place.exists():
                self.place.mkdir(mode=0o700, parents=True, exist_ok=True)
            self._own.data = Database(self.place / "answers.db", _TABLES, create=True, journal="WAL")
        return self._own.data

    def _set_aside(self) -> None:
        """Remove a file that is not a database, so that the next use creates one."""
        path = self.place / "answers.db"
        try:
            Database(path, _TABLES, create=True, journal="WAL").close()
        except InputError as error:
            if "is not a store" in error.reason:
                for end in ("", "-wal", "-shm"):
                    with contextlib.suppress(OSError):
                        path.with_name(path.name + end).unlink(missing_ok=True)


def _total(data: Database) -> int:
    (total,) = data.fetch_one("SELECT COALESCE(SUM(length), 0) FROM answer") or (0,)
    return int(total)


def _key(url: str) -> str:
    return hashlib.sha256(url.encode()).hexdigest()
