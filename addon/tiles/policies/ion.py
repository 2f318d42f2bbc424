"""Assets of Cesium ion; each asset has its credits."""

from . import Policy

POLICY = Policy(
    name="Cesium ion",
    hosts=("cesium.com",),
    key_variable="CESIUM_ION_TOKEN",
    may_work_offline=False,
    may_pack=False,
    may_export=False,
    logo="Cesium ion",
    no_drape="its assets are tilesets; name them in tiles.sources",
)
