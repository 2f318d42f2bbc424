"""Checks of URLs and addresses: TLS, allowed hosts, and no private addresses for public tilesets."""

from __future__ import annotations

import ipaddress
import socket
from dataclasses import dataclass
from urllib.parse import SplitResult, urlsplit

from ... import limits
from ...errors import InputError, input_error

_PORTS = {"http": 80, "https": 443}


@dataclass(frozen=True)
class Origin:
    """Scheme, host and port of a URL."""

    scheme: str
    host: str
    port: int

    def __str__(self) -> str:
        port = "" if self.port == _PORTS[self.scheme] else f":{self.port}"
        return f"{self.scheme}://{self.host}{port}"


def origin(url: str, name: str) -> Origin:
    """Parse the origin of a URL.

    Parameters
    ----------
    name
        Name of the URL or of the file with it, for messages.

    Raises
    ------
    InputError
        The URL is not http or https, has a user name, or is plain http to another machine.
    """
    try:
        parts: SplitResult = urlsplit(url)
        port = parts.port
    except ValueError as error:
        raise input_error(name, f"is not a URL: {error}") from None
    if parts.scheme not in _PORTS or not parts.hostname:
        raise input_error(name, f"{parts.scheme or 'no scheme'}: is not read from a server; only https is")
    if "@" in parts.netloc:
        raise input_error(name, "has a user name; keys go into environment variables")
    found = Origin(parts.scheme, parts.hostname.lower(), port or _PORTS[parts.scheme])
    if found.scheme == "http" and not is_loopback(found.host):
        raise input_error(name, "is plain http, which anyone on the way can read; use https")
    return found


def is_loopback(host: str) -> bool:
    """Test whether a host name refers to this machine."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class Guard:
    """Connections to hosts whose addresses were checked.

    Parameters
    ----------
    private
        Allow addresses of private networks.
    """

    def __init__(self, private: bool) -> None:
        self.private = private

    def connect(self, host: str, port: int, timeout: float) -> socket.socket:
        """Connect to the checked address, so that no second look-up can change it.

        Raises
        ------
        InputError
            The host has a private address.
        OSError
            The host is unknown or does not respond.
        """
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)
        found = found[: limits.DOWNLOAD_ADDRESSES]
        for *_, place in found:
            self._check(host, str(place[0]))
        last: OSError = OSError(f"{host} has no address")
        for family, kind, protocol, _, place in found:
            connection = socket.socket(family, kind, protocol)
            try:
                connection.settimeout(timeout)
                connection.connect(place)
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                return connection
            except OSError as error:
                connection.close()
                last = error
        raise last

    def _check(self, host: str, address: str) -> None:
        if is_loopback(host):
            return
        number = ipaddress.ip_address(address.partition("%")[0])
        mapped = getattr(number, "ipv4_mapped", None)
        if (mapped or number).is_global and not (mapped or number).is_multicast:
            return
        if self.private and (mapped or number).is_private and not (mapped or number).is_loopback:
            return
        raise refused_address(host, address)


def refused_address(host: str, address: str) -> InputError:
    """Make the InputError of a host with a private address."""
    reason = f"has the address {address}, which is not public; --private allows private networks"
    return input_error(host, reason)
