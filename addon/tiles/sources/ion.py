"""Assets of Cesium ion, whose endpoint issues a URL and a token."""

from __future__ import annotations

import os
from dataclasses import replace
from urllib.parse import urlsplit

from ...errors import input_error
from .. import policies
from ..json_text import Node, parse
from ..policies.ion import POLICY
from .backoff import Clock
from .http import Http
from .network import Network

API = "https://api.cesium.com"
PREFIX = "ion:"


def open_asset(asset: str, network: Network, clock: Clock | None = None, api: str = API) -> Http:
    """Open the tileset of an asset, such as ``ion:96188``.

    Parameters
    ----------
    api
        Address of the service.

    Raises
    ------
    InputError
        The environment has no token, or the service refuses it.
    """
    number = asset.removeprefix(PREFIX)
    if not number.isdecimal():
        raise input_error(asset, "must be ion: and the number of an asset")
    token = os.environ.get(POLICY.key_variable, "")
    if not token:
        reason = f"Cesium ion needs a token: set the environment variable {POLICY.key_variable}"
        raise input_error(asset, reason)
    url = f"{api}/v1/assets/{number}/endpoint"
    uncached = replace(network, cache=None)

    def ask() -> Node:
        service = Http(url, uncached, clock, bearer=token, policy=POLICY)
        try:
            return parse(service.read(service.root, 1 << 20), service.name(service.root))
        finally:
            service.close()

    def renew() -> tuple[str, str]:
        answer = ask()
        return answer.need("url").text(), answer.need("accessToken").text()

    answer = ask()
    if (external := answer.get("externalType")) is not None:
        target = answer.need("options").need("url").text()
        return Http(target, network, clock, policy=_policy_of(target, external))
    if answer.need("type").text() != "3DTILES":
        raise answer.need("type").error("is not 3DTILES; choose an asset of 3D tiles")
    return Http(
        answer.need("url").text(),
        network,
        clock,
        bearer=answer.need("accessToken").text(),
        policy=POLICY,
        renew=renew,
    )


def _policy_of(url: str, external: Node) -> policies.Policy:
    """Return the policy of the service that an asset refers to."""
    if external.text() != "3DTILES":
        raise external.error("is not 3DTILES; choose an asset of 3D tiles")
    return policies.for_host(urlsplit(url).hostname or "")
