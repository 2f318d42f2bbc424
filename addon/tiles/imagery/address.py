"""URL templates of tiles: ``https://.../{z}/{x}/{y}.png``, or ``{-y}`` for rows from the south (TMS)."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from urllib.parse import urlsplit

from ... import limits
from ...errors import InputError, input_error
from .. import policies
from ..sources import secret
from ..sources.address import origin
from .mercator import DEEPEST, NORTHMOST

_PLACES = re.compile(r"\{([^{}]*)\}")
_KNOWN = {"z", "x", "y", "-y"}
_VARIABLE = re.compile(r"\$\{([A-Za-z_][A-Za-z0-9_]*)\}")
WORLD = (-180.0, -NORTHMOST, 180.0, NORTHMOST)
"""West, south, east and north, degrees."""


@dataclass(frozen=True)
class TileAddress:
    """URLs, levels and bounds of a server's tiles in the matrix set WebMercatorQuad.

    Attributes
    ----------
    template
        URL with {z}, {x} and {y} or {-y}.
    lowest, highest
        Available levels.
    names
        Names of levels that differ from their numbers.
    bounds
        West, south, east and north of the coverage, degrees.
    """

    template: str
    lowest: int = 0
    highest: int = DEEPEST
    names: Mapping[int, str] = field(default_factory=dict)
    bounds: tuple[float, float, float, float] = WORLD

    def url(self, level: int, column: int, row: int) -> str:
        """Fill in the URL of a tile; columns wrap at the date line."""
        count = 1 << level
        values = {
            "z": self.names.get(level, str(level)),
            "x": str(column % count),
            "y": str(row),
            "-y": str(count - 1 - row),
        }
        return _PLACES.sub(lambda found: values[found[1]], self.template)


def is_template(url: str) -> bool:
    """Test whether a URL is a template of tiles, not the URL of WMTS capabilities."""
    return bool(_PLACES.search(_VARIABLE.sub("", url)))


def check(url: str) -> None:
    """Check the address of a drape without network access.

    Raises
    ------
    InputError
        The address is invalid, or the terms of its service forbid draping.
    """
    name = secret.Redactor().text(secret.split(url)[0])
    host = origin(url, name).host
    policy = policies.for_host(host)
    if policy.no_drape:
        raise input_error(name, f"{policy.name} may not be draped: {policy.no_drape}")
    for variable in _VARIABLE.finditer(url):
        _check_variable(variable[1], policy, name)
    if not is_template(url):
        return
    if "{" in (urlsplit(url).netloc):
        raise input_error(name, "has a variable in its host; name one host")
    found = [each[1] for each in _PLACES.finditer(_VARIABLE.sub("", url))]
    if unknown := sorted(set(found) - _KNOWN):
        raise input_error(name, f"has {{{unknown[0]}}}; known are {{z}}, {{x}}, {{y}} and {{-y}}")
    rows = [each for each in found if each in ("y", "-y")]
    if sorted(each for each in found if each not in rows) != ["x", "z"] or len(rows) != 1:
        raise input_error(name, "must have {z}, {x} and one of {y} and {-y}, each once")


def with_variables(url: str) -> str:
    """Replace ``${NAME}`` in a URL by environment variables.

    Raises
    ------
    InputError
        A variable may not be used, is not set, or is not a secret parameter of the URL.
    """
    name = secret.Redactor().text(secret.split(url)[0])
    policy = policies.for_host(origin(url, name).host)
    values = []

    def value(found: re.Match[str]) -> str:
        _check_variable(found[1], policy, name)
        if not (text := os.environ.get(found[1], "")):
            raise input_error(name, f"needs the environment variable {found[1]}")
        values.append(text)
        return text

    whole = _VARIABLE.sub(value, url)
    hidden = secret.split(whole)[1].values()
    if any(each not in hidden for each in values):
        raise misplaced(name)
    return whole


def _check_variable(variable: str, policy: policies.Policy, name: str) -> None:
    """Check that a scene file may send an environment variable to a host.

    A scene file of someone else could send any variable, such as the password of another service, to a host
    of its choice.

    Raises
    ------
    InputError
        It is neither ``FIRETWIN_KEY_*`` nor the key of the service at this host.
    """
    if variable == policy.key_variable or variable.startswith(limits.KEY_PREFIX):
        return
    allowed = " and ".join(filter(None, (f"{limits.KEY_PREFIX}*", policy.key_variable)))
    reason = f"asks for the environment variable {variable}; only {allowed} are sent to this host"
    raise input_error(name, f"{reason}: set {limits.KEY_PREFIX}NAME and name it in the URL")


def misplaced(name: str) -> InputError:
    """Make the error of a variable that is not a secret parameter."""
    known = "key, api_key, access_token or token"
    return input_error(name, f"has a variable that is not the complete value of a parameter such as {known}")
