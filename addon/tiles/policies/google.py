"""Google's photorealistic tiles (Map Tiles API policies; terms of service, 3.2.3 a to c)."""

from . import Policy

POLICY = Policy(
    name="Google Photorealistic 3D Tiles",
    hosts=("tile.googleapis.com",),
    assets=(2275207,),
    key_variable="GOOGLE_MAPS_API_KEY",
    key_parameter="key",
    session_parameter="session",
    may_store=True,  # as the headers allow, and no longer
    may_work_offline=False,
    may_prefetch=False,
    may_flatten=False,
    may_analyse=False,
    may_pack=False,
    may_export=False,
    other_geocoder=False,
    pixel_error=20.0,
    logo="Google Maps",
    no_drape="its terms forbid to keep its pictures",
)
