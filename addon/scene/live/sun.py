"""Live sun: the film's sun without shadows, which EEVEE would draw again whenever the viewer moves."""

from __future__ import annotations

import bpy

from ...blender import owned
from ...blender.owned import Stage
from . import switch


def build(stage: Stage, collection: bpy.types.Collection) -> bpy.types.Object | None:
    """Build "Firetwin Live Sun" with the animation of the film's; None if the film has no sun."""
    film = switch.film_sun(stage)
    if film is None:
        return None
    sun = film.copy()
    sun.data = owned.mark(film.data.copy())
    sun.name = sun.data.name = sun[owned.NAME] = f"Firetwin {switch.SUN}"
    sun.data.use_shadow = False
    collection.objects.link(owned.mark(sun, switch.SUN))
    return sun
