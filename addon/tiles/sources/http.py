"""Tilesets of servers over https, with the HTTP cache."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from typing import NoReturn
from urllib.parse import urljoin

from ...errors import InputError, input_error
from .. import contents, policies
from ..json_text import parse
from ..policies import Policy
from . import secret
from ._source import MAX_BYTES, Source, missing, unpack
from .address import Origin, origin
from .backoff import MAX_RETRIES, MAX_RETRY_AFTER, Backoff, Clock, retry_delay
from .connection import Connection, Response, TransportError
from .http_cache import CachedAnswer, HttpCache
from .network import Network
from .watchdog import Spent

_GONE = (404, 410)
_DENIED = (400, 401, 403)
_LATER = (408, 425, 429, 500, 502, 503, 504)
_MOVED = (301, 302, 303, 307, 308)
_MAX_REDIRECTS = 5
_MAX_FAILURES = 3  # consecutive files that failed after all retries
_DEEPEST_SESSION = 4  # nesting depth of the file with the session
_WORDS = 300  # characters of a service's message


class Http(Source):
    """A tileset of a server.

    Parameters
    ----------
    url
        URL of the root; its secrets are sent only to its host.
    bearer
        Token for the header Authorization, sent only to the root's host.
    renew
        Gets a new URL and bearer of the root from a service that issues them.

    Attributes
    ----------
    missing
        URIs that were unavailable offline.
    """

    local = False
    parallel = 8

    def __init__(
        self,
        url: str,
        network: Network | None = None,
        clock: Clock | None = None,
        bearer: str = "",
        policy: Policy | None = None,
        renew: Callable[[], tuple[str, str]] | None = None,
    ) -> None:
        self.network, self.clock, self.renew = network or Network(), clock or Clock(), renew
        self.redactor = secret.Redactor()
        self.root, self._secrets = secret.split(url)
        self.redactor.add(*self._secrets.values(), bearer)
        self.bearer = bearer
        self.home = origin(self.root, self.name(self.root))
        self.policy = policy or policies.for_host(self.home.host)
        self.missing: list[str] = []
        self._session = self._secrets.pop(self.policy.session_parameter, "")
        self._add_key()
        keep = self.network.cache is not None and self.policy.may_store
        self._cache = (
            HttpCache(self.network.cache, self.network.limit) if keep and self.network.cache else None
        )
        self._connection = Connection(self.network.private, self.redactor, self.network.pace)
        self._spent = Spent()
        self._backoff = Backoff(self.clock)
        self._lock = threading.Lock()
        self._failures = 0
        self._own: dict[str, dict[str, str]] = {}

    def resolve(self, base: str, reference: str) -> str:
        """Resolve to a URL without secrets; a session in it is used for all later requests."""
        name = self.name(base)
        try:
            url, secrets = secret.split(urljoin(base, reference.strip()))
        except ValueError as error:
            raise input_error(name, f"refers to an invalid URL: {self._redacted(error)}") from None
        self.redactor.add(*secrets.values())
        self._check_origin(url, name)
        session = secrets.pop(self.policy.session_parameter, "")
        if session and not self._session:
            self._session = session
        if secrets:
            self._own[url] = secrets
        return url

    def read(self, uri: str, max_bytes: int = MAX_BYTES) -> bytes:
        """Read the body of the response, from the cache if it is fresh."""
        now, name = self.clock.now(), self.name(uri)
        fresh_root = uri == self.root and bool(self.policy.session_parameter)
        kept = self._cache.find(uri, now) if self._cache and not fresh_root else None
        if kept is not None and now < kept.expires:
            return unpack(kept.body, max_bytes, name)
        if not self.network.online:
            return self._offline(uri, kept, max_bytes)
        return unpack(self._fetch(uri, kept, max_bytes), max_bytes, name)

    def name(self, uri: str) -> str:
        """Return the URL, redacted."""
        return self.redactor.text(uri)

    def close(self) -> None:
        """Close connections and the cache."""
        self._connection.close()
        if self._cache:
            self._cache.close()

    def _offline(self, uri: str, kept: CachedAnswer | None, max_bytes: int) -> bytes:
        """Read a file from the cache without the server."""
        if kept is not None and not kept.strict and self.policy.may_work_offline:
            return unpack(kept.body, max_bytes, self.name(uri))
        self.missing.append(uri)
        state = (
            "is not in the cache" if kept is None else "is cached, but must not be used without the server"
        )
        reason = f"{state}, and the network may not be used: {self.network.setting}"
        if uri == self.root:
            raise input_error(self.name(uri), reason)
        raise missing(self.name(uri), reason)

    def _check_origin(self, url: str, name: str) -> Origin:
        """Return the origin of a URL; it must be the root's or an allowed host."""
        found = origin(url, name)
        if found != self.home and not (found.scheme == "https" and found.host in self.network.hosts):
            reason = f"refers to {found}, another host than {self.home}; --host {found.host} allows it"
            raise input_error(name, self.redactor.text(reason))
        return found

    def _add_key(self) -> None:
        """Take the user's key from the environment, if the service needs one and the URL has none."""
        policy = self.policy
        if not policy.key_parameter or policy.key_parameter in self._secrets:
            return
        key = os.environ.get(policy.key_variable, "")
        if not key:
            reason = f"{policy.name} needs a key: set the environment variable {policy.key_variable}"
            raise input_error(self.name(self.root), reason)
        self.redactor.add(key)
        self._secrets[policy.key_parameter] = key

    def _fetch(self, uri: str, kept: CachedAnswer | None, max_bytes: int) -> bytes:
        """Fetch a body from the server, with retries."""
        name, tries, cut_off, refreshed = self.name(uri), 0, 0, False
        while True:
            self._backoff.wait()
            session = self._session
            why, asked = "", None
            try:
                response = self._ask(uri, kept, max_bytes, session)
            except TransportError as error:
                if error.slow:
                    self._give_up(name, self._redacted(error), "cannot be had")
                if error.cut_off:
                    cut_off += 1
                    if cut_off > 1:
                        raise missing(name, f"ends early, twice: {self._redacted(error)}") from None
                    continue
                why = self._redacted(error)
            else:
                status = response.status
                if status == 304 and kept is not None:
                    return self._confirm(uri, kept, response)
                if status == 200:
                    if (fault := contents.truncation(response.body)) is None:
                        return self._store(uri, response)
                    cut_off += 1
                    if cut_off > 1:
                        raise missing(name, f"ends early, twice: {fault}")
                    continue
                if status in _GONE:
                    raise missing(name, f"is not there (status {status})")
                if status in _DENIED:
                    if not refreshed and (session or self.renew):
                        self._refresh(session)
                        refreshed = True
                        continue
                    raise self._denied_error(uri, response, bool(session or self.renew))
                if status not in _LATER:
                    raise missing(name, f"cannot be had (status {status}{self._service_message(response)})")
                why, asked = (
                    f"status {status}{self._service_message(response)}",
                    response.headers.get("Retry-After"),
                )
            self._schedule_retry(name, why, asked, tries)
            tries += 1

    def _schedule_retry(self, name: str, why: str, asked: str | None, tries: int) -> None:
        """Pause the source before a retry, or give up."""
        if tries >= MAX_RETRIES:
            self._give_up(name, why, f"cannot be had after {MAX_RETRIES + 1} attempts")
        wait = retry_delay(asked, tries, self.clock)
        if wait > MAX_RETRY_AFTER:
            raise input_error(name, f"the server asks to wait {wait:,.0f} s ({why}); try again then")
        self._backoff.extend(wait)

    def _give_up(self, name: str, why: str, what: str) -> NoReturn:
        """Give up a file, and the source after `_MAX_FAILURES` consecutive ones."""
        with self._lock:
            self._failures += 1
            stop = self._failures >= _MAX_FAILURES
        if stop:
            raise input_error(name, f"the server does not respond ({why}); try again later")
        raise missing(name, f"{what} ({why})")

    def _request(
        self, url: str, session: str, headers: dict[str, str], max_bytes: int, name: str
    ) -> Response:
        """Send one request, if the time limits of host and job allow it."""
        pace = self.network.pace
        for spent, most, whose in (
            (self._spent, pace.host, f"to {self.home}"),
            (self.network.spent, pace.job, "of this job"),
        ):
            if spent.seconds > most:
                reason = (
                    f"the requests {whose} took more than {most:,.0f} s; run it again, which uses the cache"
                )
                raise input_error(name, reason)
        began = time.monotonic()
        try:
            return self._connection.ask(*self._with_secrets(url, session, headers), max_bytes, name)
        finally:
            for spent in (self._spent, self.network.spent):
                spent.add(time.monotonic() - began)

    def _ask(self, uri: str, kept: CachedAnswer | None, max_bytes: int, session: str) -> Response:
        """Send a request; follow redirects within the host."""
        url = uri
        headers = {}
        if kept is not None and kept.etag:
            headers["If-None-Match"] = kept.etag
        elif kept is not None and kept.modified:
            headers["If-Modified-Since"] = kept.modified
        for _ in range(_MAX_REDIRECTS):
            response = self._request(url, session, headers, max_bytes, self.name(uri))
            if response.status not in _MOVED:
                return response
            target, secrets = secret.split(urljoin(url, response.headers.get("Location", "")))
            self.redactor.add(*secrets.values())
            there, here = origin(target, self.name(uri)), origin(url, self.name(uri))
            if there != here:
                reason = f"is redirected to {there}, another host; name its URL there"
                raise input_error(self.name(uri), self.redactor.text(reason))
            self._own[target] = self._own.get(target, {}) | secrets
            url = target
        raise missing(self.name(uri), f"is redirected more than {_MAX_REDIRECTS} times")

    def _with_secrets(self, url: str, session: str, headers: dict[str, str]) -> tuple[str, dict[str, str]]:
        """Add secrets to URL and headers; secrets of the root go only to its host."""
        secrets = dict(self._own.get(url, {}))
        if origin(url, self.name(url)) == self.home:
            secrets = self._secrets | secrets
            if session and self.policy.session_parameter and url != self.root:
                secrets[self.policy.session_parameter] = session
            if self.bearer:
                headers = headers | {"Authorization": f"Bearer {self.bearer}"}
        return secret.with_secrets(url, secrets), headers

    def _store(self, uri: str, response: Response) -> bytes:
        with self._lock:
            self._failures = 0
        if self._cache:
            self._cache.put(uri, response.body, response.headers, self.clock.now())
        return response.body

    def _confirm(self, uri: str, kept: CachedAnswer, response: Response) -> bytes:
        if self._cache:
            self._cache.refresh(uri, response.headers, self.clock.now())
        return kept.body

    def _refresh(self, session: str) -> None:
        """Get a new session from the root, unless another thread already has."""
        with self._lock:
            if self._session != session:
                return
            if self.renew:
                url, self.bearer = self.renew()
                self.redactor.add(self.bearer, *secret.split(url)[1].values())
                self._secrets |= secret.split(url)[1]
                return
            self._session = self._new_session(session)

    def _new_session(self, old: str) -> str:
        """Read the session that the root, or its first nested tileset, names now."""
        url, parameter = self.root, self.policy.session_parameter
        for _ in range(_DEEPEST_SESSION):
            response = self._ask(url, None, MAX_BYTES, "")
            if response.status != 200:
                raise self._denied_error(url, response, True)
            documents = [
                secret.split(urljoin(url, each))
                for each in contents.references(parse(response.body, self.name(url)).value)
            ]
            for _, secrets in documents:
                self.redactor.add(*secrets.values())
                if secrets.get(parameter, old) != old:
                    return secrets[parameter]
            url = next((each for each, _ in documents if contents.kind_by_name(each) == "json"), url)
            self._check_origin(url, self.name(self.root))
        raise input_error(self.name(self.root), "names no new session; try again later")

    def _denied_error(self, uri: str, response: Response, within_session: bool) -> InputError:
        """Make the error of a refused request; a file of an open server is missing."""
        reason = f"is refused (status {response.status}{self._service_message(response)})"
        if within_session or uri == self.root or self.bearer:
            return input_error(self.name(uri), f"{reason}; check the key and its rights")
        return missing(self.name(uri), reason)

    def _service_message(self, response: Response) -> str:
        """Return the service's message, redacted and shortened."""
        text = " ".join(response.body[:4096].decode("utf-8", "replace").split())
        return f": {self.redactor.text(text)[:_WORDS]}" if text else ""

    def _redacted(self, error: Exception) -> str:
        return self.redactor.text(str(error))
