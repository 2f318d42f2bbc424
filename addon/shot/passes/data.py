"""Data for compositors: depth, normals, positions, motion, Cryptomatte and temperatures in one EXR.

It is made from the files of `depth`, `normal`, `masks` and `thermal`; it adds no rays.

===================================== ==================================================================
channels                              content
===================================== ==================================================================
`Z`                                   planar depth, m; the sky is 1e10
`N.X`, `N.Y`, `N.Z`                   normals: east, north, up; the sky is 0
`P.X`, `P.Y`, `P.Z`                   positions, m east, north and up of the scene's origin; the sky is 0
`forward.u`, `forward.v`              motion to the next frame, pixels right and up
`backward.u`, `backward.v`            motion to the previous frame, pixels right and up
`CryptoClass00` to `02`, r g b a      classes: sky, ground, burned, tree, smoke, fire, building
`CryptoTree00` to `02`, r g b a       single trees, alight or not, by names such as `tree_00001234`
`thermal.kelvin`, `thermal.radiance`  as in `thermal`
===================================== ==================================================================

Motion is computed from the camera before a static scene: smoke, flames and firebrands have none. The first
frame has no backward motion, and the last no forward motion.

Cryptomatte has six ranks. One ray goes through each pixel's centre; coverage is the mean of the 3 x 3 nearest
rays with weights 1, 2, 1. Edges are therefore soft, but not measured by the rays of `rgb`, and details
smaller than a pixel are noisy. Smoke covers 1 - its transmittance, and the surface behind it the rest. Flames
that hide more than half are fire, and others are not. Class coverages add up to 1. The JSON is the manifest
of the trees in the frame; the EXR has its name (`manif_file`), so keep both files in one folder, and do not
rename the JSON. The number of a tree is its instance number in `masks`.
"""

from __future__ import annotations

from . import DerivedPass

PASS = DerivedPass(
    name="data",
    order=43,
    help="Depth, normals, positions, motion, Cryptomatte and temperatures for compositors, 32-bit EXR",
    files=("exr", "json"),
    single_view=True,
    aspects=frozenset({"time", "camera", "picture"}),
    code=("render/composite.py",),
    linked=("json",),
    needs=("depth", "normal", "masks", "thermal"),
)
