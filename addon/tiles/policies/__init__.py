"""Terms of services of tiles, as data: one file for each service, without keys."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from urllib.parse import urlsplit

from ... import plugins


@dataclass(frozen=True)
class Policy:
    """Terms of a source. A source's HTTP headers may be stricter.

    Attributes
    ----------
    name
        Name for messages.
    hosts
        Hosts of the service, subdomains included.
    assets
        Numbers of Cesium ion's assets that lead to this service.
    key_variable
        Environment variable that holds the user's key; empty: it needs none.
    key_parameter
        Parameter of URLs that carries the key; empty: a bearer header does.
    session_parameter
        Parameter of URLs that carries a session; empty: there are none.
    may_store
        Responses may be cached, as their headers allow.
    may_work_offline
        Cached responses may be used offline.
    may_prefetch
        Tiles that no view shows may be fetched, as `firetwin tiles info` does.
    may_flatten
        The surface may be changed.
    may_analyse
        Masks, depth, poses and measurements may be made from it.
    may_pack
        It may be packed into a .blend file.
    may_export
        It may be written to other formats.
    other_geocoder
        Place names may come from a source other than the service.
    pixel_error
        Screen-space error that the source recommends, pixels; 0: none.
    logo
        Text that each picture must show in addition to the tiles' credits.
    no_drape
        Reason for which its pictures must not be draped; empty: they may be.
    """

    name: str = ""
    hosts: tuple[str, ...] = ()
    assets: tuple[int, ...] = ()
    key_variable: str = ""
    key_parameter: str = ""
    session_parameter: str = ""
    may_store: bool = True
    may_work_offline: bool = True
    may_prefetch: bool = True
    may_flatten: bool = True
    may_analyse: bool = True
    may_pack: bool = True
    may_export: bool = True
    other_geocoder: bool = True
    pixel_error: float = 0.0
    logo: str = ""
    no_drape: str = ""


OPEN = Policy("a server that you name")


def known() -> Iterable[Policy]:
    """List the policies of all services."""
    return plugins.values(__name__, "POLICY").values()


def for_host(host: str) -> Policy:
    """Return the policy of a host; `OPEN` for hosts of no known service."""
    for policy in known():
        if any(host == each or host.endswith(f".{each}") for each in policy.hosts):
            return policy
    return OPEN


def for_source(place: str) -> Policy:
    """Return the policy of a source by its name, without network access.

    An asset of ion may refer to another service, known only from ion's response: the opened source has its
    policy.
    """
    kind, _, number = place.partition(":")
    if kind == "ion":
        own = (each for each in known() if number.isdecimal() and int(number) in each.assets)
        return next(own, plugins.module(__name__, "ion").POLICY)
    try:
        return for_host(urlsplit(place).hostname or "") if "://" in place else OPEN
    except ValueError:  # not a URL: opening it reports the error
        return OPEN
