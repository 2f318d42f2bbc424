"""Kinds of camera: each module of this folder is one, unless its name begins with "_".

It defines a frozen dataclass derived from `Rig`, made of keys (see `schema.key`) that lie flat in the
camera's table, and names it `RIG`. The module's name is the kind's name, the first line of the class's
docstring its description.
"""

from __future__ import annotations

import functools
import importlib
import pkgutil
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from firetwin_core.run import Run

    from ...settings.protocols import CameraSettings, Frames, ShotView
    from ...settings.schema import Where
    from ._view import View

    Place = tuple[Where, float, float]

USUAL = "drone"  # where a camera names no kind


class Rig:
    """How a camera is set up and moved: what is particular to its kind.

    Attributes
    ----------
    around
        It sees all round with two eyes, which Cycles alone renders, in pictures that are square.
    """

    around: ClassVar[bool] = False

    @classmethod
    def from_view(cls, view: View) -> Rig:
        """One that shows about what is seen in a view; a usual one where its kind cannot."""
        return cls()

    def validate(self) -> tuple[Where, str] | None:
        """What no single key can say: where in its table, and words that follow the camera's name."""
        return None

    def coordinates(self) -> list[Place]:
        """Where in the table a place stands, and its latitude and longitude: all must be on the ground."""
        return []

    def input_files(self) -> list[Path]:
        """Files that its way depends on."""
        return []

    def followed(self, cameras: Sequence[CameraSettings]) -> CameraSettings | None:
        """Another of these cameras on whose way its own depends."""
        return None

    def validate_against(self, run: Run, frames: Frames) -> tuple[Where, str] | None:
        """What of it does not fit the run: where in its table, and words that follow the camera's name."""
        return None

    def path(self, camera: CameraSettings, shot: ShotView, ground: Any) -> Any:
        """The camera's `path.Path` through the shot over this `terrain.Ground`."""
        raise NotImplementedError


@functools.cache
def kinds() -> dict[str, type[Rig]]:
    """Every kind of camera by its name."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__) if module.name[0] != "_")
    return {name: importlib.import_module(f"{__name__}.{name}").RIG for name in names}
