"""Tiles of OpenStreetMap's own servers (their tile usage policy: no bulk downloading)."""

from . import Policy

POLICY = Policy(
    name="OpenStreetMap's tile server",
    hosts=("tile.openstreetmap.org",),
    may_work_offline=False,
    may_prefetch=False,
    may_export=False,
    no_drape="its tile usage policy forbids bulk downloading; name a server that allows it",
)
