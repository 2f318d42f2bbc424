"""Terms of use of a shot's tiles, checked before tiles are fetched or pictures rendered."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ...errors import InputError, input_error
from ...tiles import policies
from ...tiles.policies import Policy
from .. import passes
from ..schema import scene_text

if TYPE_CHECKING:
    from ..settings import Settings

Use = tuple[str, str]
"""One of `_REFUSED`, and what needs it, such as a setting and its value."""

_REFUSED = {
    "analyse": "does not allow that tiles are analysed",
    "export": "does not allow that tiles are written to other formats",
    "flatten": "does not allow that the surface of tiles is changed",
    "pack": "does not allow that tiles are packed into files",
    "work_offline": "does not allow that tiles are used offline",
    "other_geocoder": "does not allow that place names come from a source other than the service",
}
"""Uses, each an attribute of `Policy` (with "may_" but for the last), and how they are refused."""

_ANALYSES = frozenset(("depth", "masks", "normal", "pose"))
"""Passes whose values are taken from the surface of tiles; so are passes that are made from them."""


def allows(policy: Policy, use: str) -> bool:
    """Return whether a policy allows a use."""
    return bool(getattr(policy, use if use == "other_geocoder" else f"may_{use}"))


def check(settings: Settings, uses: Iterable[Use]) -> None:
    """Check that every source of a scene's tiles allows these uses, without a request to a server.

    Raises
    ------
    InputError
        One does not. It names the source, its policy and what needs the use.
    """
    wanted = list(uses)
    for number, place in enumerate(settings.tiles.sources):
        check_source(settings, number, policies.for_source(place), wanted)


def check_source(settings: Settings, number: int, policy: Policy, uses: Iterable[Use]) -> None:
    """Check the source of this number by the policy that it turned out to have.

    Raises
    ------
    InputError
        It does not allow a use.
    """
    for use, wanted in uses:
        if not allows(policy, use):
            reason = f"{policy.name} {_REFUSED[use]}; leave out {wanted}, or this source"
            raise _error(settings, number, f"{settings.tiles.sources[number]}: {reason}")


def of_passes(names: Iterable[str]) -> list[Use]:
    """List the uses by passes that take values from the surface of tiles."""
    found: list[Use] = []
    for name in dict.fromkeys(names):
        if sources := _sources_of(name) & _ANALYSES:
            made = "" if name in sources else f", which is made from {' and '.join(sorted(sources))}"
            found.append(("analyse", f'the pass "{name}"{made}'))
    return found


def of_scene(settings: Settings) -> list[Use]:
    """List the uses by a scene's settings."""
    uses: list[Use] = []
    if settings.terrain.height_source == "tiles":
        uses.append(("analyse", 'terrain.height_source = "tiles"'))
    if settings.tiles.vegetation != "tileset":
        uses.append(("flatten", f'tiles.vegetation = "{settings.tiles.vegetation}" (write "tileset")'))
    if settings.labels.enabled:
        uses.append(("other_geocoder", "labels.enabled = true"))
    return uses


def _error(settings: Settings, number: int, reason: str) -> InputError:
    """InputError at a source in the scene file, or at the file where its text has none."""
    if settings.path.is_file():
        with contextlib.suppress(InputError):  # it has changed since
            return scene_text.error_at(settings.path, ("tiles", "sources", number), reason)
    return input_error(settings.path, f"tiles.sources: {reason}")


def _sources_of(name: str) -> set[str]:
    """Return a pass and all passes that it is made from."""
    made = passes.known()[name].made_from
    return {name}.union(*(_sources_of(need) for need in made))
