"""Input files of a scene file, for the list of sources."""

from __future__ import annotations

from ..shot.settings import Settings


def find(settings: Settings | None) -> list[tuple[str, str]]:
    """List the input files of a scene file: role and name."""
    if settings is None:
        return []
    named = (
        ("Elevation model", settings.terrain.elevation),
        ("Orthophoto of the film", settings.terrain.photo),
        ("Land use of the film", settings.terrain.land_use),
        ("Buildings of the film", settings.terrain.buildings),
        ("Picture of the Earth", settings.terrain.globe),
        ("Named places", settings.labels.file),
    )
    found = [(what, path.name) for what, path in named if path]
    if settings.terrain.photo_url:
        found.append(("Orthophoto of the film", settings.terrain.photo_credit))
    return found
