"""3D Tiles: decoding of content to flat arrays, selection of tiles for a shot, and ground extraction.

No function opens a file.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .lod import ViewSet

REPLACES: int
UNCONDITIONAL: int
CONTENT: int
PENDING: int
BROKEN: int
OUTSIDE_REQUEST_VOLUME: int
PASS_THROUGH: int
GROUND: int
VEGETATION: int
BUILDING: int

def screen_error(
    centre: ArrayLike,
    axis: ArrayLike,
    half: ArrayLike,
    padding: ArrayLike,
    error: ArrayLike,
    views: ViewSet,
    pixels: ArrayLike,
    max_distance: float = float("inf"),
    margin: float = 0.0,
    shadows: bool = False,
) -> NDArray[np.float64]:
    """Compute the screen-space error of n tiles, the maximum over all views.

    Perspective: error * pixels / max(distance, 1e-7 m), where distance is measured from the camera to the
    nearest point of the tile's volume. Orthographic: error * pixels. Tiles are culled by their bounding
    spheres; see `lod.visible_mask`, also for `max_distance`, `margin` and `shadows`.

    Parameters
    ----------
    centre, axis, half, padding
        Bounding volumes: oriented boxes with centres (n, 3) in m, orthonormal edge directions (n, 3, 3) as
        rows and half lengths (n, 3) in m, padded by a radius (n,) in m. A sphere is a box with half lengths
        of 0.
    error
        (n,) geometric errors, m.
    views
        m views.
    pixels
        (m,) scales. Perspective: pixels per metre at a distance of 1 m, height / (2 tan(angle / 2)).
        Orthographic: pixels per metre.

    Returns
    -------
    error
        (n,) screen-space errors, pixels; -1 for tiles that no view sees.

    Raises
    ------
    ValueError
        A shape does not fit, or a number is negative or NaN.
    """

def contains_any(
    centre: ArrayLike, axis: ArrayLike, half: ArrayLike, padding: ArrayLike, position: ArrayLike
) -> NDArray[np.bool_]:
    """Test for each of n volumes whether it contains at least one of the positions (m, 3).

    `screen_error` describes the volumes. Returns an array of shape (n,).
    """

class Cut:
    """A cut through the tree: the tiles that a shot shows (see `select`)."""

    @property
    def tiles(self) -> NDArray[np.int64]:
        """Indices of the tiles whose content is shown, ascending."""
    @property
    def expand(self) -> NDArray[np.int64]:
        """Indices of pending tiles whose children must be loaded, ascending."""
    @property
    def stand_ins(self) -> NDArray[np.int64]:
        """Indices of tiles that are shown in place of broken descendants."""
    @property
    def missing(self) -> NDArray[np.int64]:
        """Indices of broken tiles without a stand-in, or whose stand-in is shown anyway."""
    @property
    def error(self) -> float:
        """Maximum screen-space error used, pixels: as requested, or raised to fit the budget."""
    @property
    def fits(self) -> bool:
        """True if the cut is within the budget."""
    @property
    def bytes(self) -> int:
        """Total size of the contents shown."""
    @property
    def triangles(self) -> int:
        """Total number of triangles shown."""

def select(
    parent: ArrayLike,
    flags: ArrayLike,
    screen_error: ArrayLike,
    bytes: ArrayLike,
    triangles: ArrayLike,
    error: float,
    max_tiles: int = -1,
    max_bytes: int = -1,
    max_triangles: int = -1,
) -> Cut:
    """Select a cut through a tree of n tiles. The run time is linear in n.

    A tile is refined if its screen-space error is above `error` or if it is UNCONDITIONAL. If a tile
    REPLACES, all its children are selected or none; those that no view sees stay coarse. Otherwise each child
    is selected on its own if a view sees it. The nearest ancestor with content replaces a BROKEN tile. If the
    cut exceeds the budget, `error` is raised to the smallest screen-space error of any tile at which the cut
    fits, found by bisection. If no cut fits, the coarsest one is returned.

    Parameters
    ----------
    parent
        (n,) index of the parent, less than the tile's own; -1 for roots.
    flags
        (n,) sums of

        - REPLACES: the tile's refinement is REPLACE, otherwise ADD;
        - UNCONDITIONAL: the tile is refined at any error;
        - CONTENT: the tile has renderable content;
        - PENDING: the tile has children that are not loaded yet;
        - BROKEN: the content is not available;
        - OUTSIDE_REQUEST_VOLUME: no camera is inside the viewer request volume; the tile and its descendants
          are skipped;
        - PASS_THROUGH: the parent of an external or implicit tileset, which hands its own state to its
          children and shows its content together with them.
    screen_error
        (n,) pixels; negative if no view sees the tile.
    bytes, triangles
        (n,) sizes of the contents; 0 if unknown.
    error
        Maximum screen-space error, pixels.
    max_tiles, max_bytes, max_triangles
        Budget; negative for no limit.

    Raises
    ------
    ValueError
        A shape does not fit, a parent does not come before its child, or an error is negative or NaN.
    """

class Image:
    """An encoded image of a tile, embedded in the content or external."""

    @property
    def kind(self) -> str:
        """Format by magic bytes: jpeg, png or webp; empty if only the uri is known."""
    @property
    def width(self) -> int:
        """Pixels, from the header; 0 if only the uri is known."""
    @property
    def height(self) -> int:
        """Pixels, from the header; 0 if only the uri is known."""
    @property
    def data(self) -> bytes:
        """The encoded file; empty if only the uri is known."""
    @property
    def uri(self) -> str:
        """Address relative to the content; empty if the image is embedded."""

class Material:
    """Base colour of a range of triangles. Lighting properties such as roughness are not read."""

    @property
    def colour(self) -> list[float]:
        """Linear RGBA factor of the image's and the vertices' colours."""
    @property
    def image(self) -> int:
        """Index in `Tile.images`; -1 for none."""
    @property
    def wrap_u(self) -> str:
        """Horizontal texture wrapping: repeat, clamp or mirror."""
    @property
    def wrap_v(self) -> str:
        """Vertical texture wrapping: repeat, clamp or mirror."""
    @property
    def alpha_mode(self) -> str:
        """Alpha mode: opaque, mask or blend."""
    @property
    def alpha_cutoff(self) -> float:
        """Alpha below which a masked material is transparent."""
    @property
    def double_sided(self) -> bool:
        """True if back faces are visible."""

class Range:
    """A range of vertices and triangles with one material. Ranges are contiguous."""

    @property
    def material(self) -> int:
        """Index in `Tile.materials`; -1 for none."""
    @property
    def first_vertex(self) -> int:
        """First row of `Tile.position`."""
    @property
    def vertices(self) -> int:
        """Number of vertices."""
    @property
    def first_triangle(self) -> int:
        """First row of `Tile.triangle`."""
    @property
    def triangles(self) -> int:
        """Number of triangles; 0 for points."""
    @property
    def points(self) -> bool:
        """True if the vertices are a point cloud."""
    @property
    def has_normals(self) -> bool:
        """False if `Tile.normal` has computed smooth normals here (0 for points)."""

class Tile:
    """Decoded content: read-only arrays of n vertices and m triangles relative to an origin."""

    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) centre of all vertices in the scene's frame, rounded to metres."""
    @property
    def position(self) -> NDArray[np.float32]:
        """(n, 3) m from the origin. Content without geometry is valid and has no vertices."""
    @property
    def normal(self) -> NDArray[np.float32]:
        """(n, 3) unit vectors; computed if the content has none (see `Range.has_normals`)."""
    @property
    def uv(self) -> NDArray[np.float32]:
        """(n, 2) texture coordinates from the lower left corner; 0 without any."""
    @property
    def colour(self) -> NDArray[np.float32]:
        """(n, 4) linear RGBA; (0, 4) if no vertex has a colour."""
    @property
    def triangle(self) -> NDArray[np.uint32]:
        """(m, 3) rows of `position`, counter-clockwise seen from outside."""
    @property
    def ranges(self) -> list[Range]:
        """Ranges sorted by material; points come last."""
    @property
    def materials(self) -> list[Material]:
        """Materials in use."""
    @property
    def images(self) -> list[Image]:
        """Images in use."""
    @property
    def copyright(self) -> str:
        """Distinct copyright notices of the content, separated by semicolons."""
    @property
    def spacing(self) -> float:
        """Resolution of the content, m: spacing of float32 numbers at the vertex farthest from its origin.

        It is 0.5 m for Earth-centred float32 positions, whatever the decoder.
        """
    @property
    def not_finite(self) -> int:
        """Number of dropped vertices: NaN, infinite or farther than 1e9 m from the scene's origin."""
    @property
    def lines(self) -> int:
        """Number of dropped line primitives."""

def decode(
    content: bytes,
    matrix: ArrayLike,
    name: str,
    resources: dict[str, bytes] | None = None,
    earth_matrix: ArrayLike | None = None,
    up_axis: str = "Y",
) -> Tile:
    """Decode a b3dm, i3dm, cmpt, pnts, glb or glTF. The type is detected from the magic bytes.

    Transforms are multiplied in float64 in this order: `matrix`, RTC_CENTER or the i3dm instance, CESIUM_RTC
    (z up), glTF's y-up to z-up rotation, nodes, EXT_mesh_gpu_instancing. Instances are expanded. Draco,
    meshopt and quantized attributes are supported. Skins, animations, morph targets and feature metadata are
    ignored. Images stay encoded.

    Draco's decoder does not validate its data: damaged content may make it allocate gigabytes or crash.
    Decode untrusted content in a separate process with memory and time limits.

    Parameters
    ----------
    content
        The encoded tile.
    matrix
        (4, 4) transform from the content's frame (z up) to the scene's, m; multiplies column vectors.
    name
        Name of the content in error messages.
    resources
        External files by uri (see `list_missing_resources`). They may include images: their headers are
        checked, and `Image.data` holds them.
    earth_matrix
        (4, 4) transform from the content's frame to Earth-centred metres, used by EAST_NORTH_UP of i3dm only.
        None: identity.
    up_axis
        X, Y or Z: `asset.gltfUpAxis` of the tileset.

    Raises
    ------
    InputError
        The content is damaged, a resource is missing, a required extension is not supported, or a limit is
        exceeded: 10 million vertices, 1 million instances, 1 GB decoded, images of 16384 pixels per side, 8
        levels of nested cmpt. The reason starts with the position in the JSON.
    ValueError
        A matrix is not finite, not affine or singular.
    """

def list_missing_resources(content: bytes, name: str, resources: dict[str, bytes] | None = None) -> list[str]:
    """List the uris of external files that `decode` needs in addition to `resources`.

    These are buffers and models, sorted and relative to the content; images are optional and not listed. Call
    it again with the new files until the list is empty, because a model may need buffers. The uris are not
    normalized: percent signs and dots are returned as written, and the caller decides which uris may be
    fetched.

    Raises
    ------
    InputError
        The content is damaged or is not a tile.
    """

def content_type(content: bytes, name: str) -> str:
    """Detect the content type: b3dm, i3dm, cmpt, pnts, glb, gltf, tileset or subtree.

    Binary types are detected from their magic bytes, JSON from its keys.

    Raises
    ------
    InputError
        The type is unknown.
    """

class HeightMap:
    """Maximum height of triangles at the points of a regular grid (a digital surface model)."""

    def __init__(self, low: tuple[float, float], step: float, rows: int, columns: int) -> None:
        """Create a grid of points at low + (column, row) * step, m.

        Raises
        ------
        ValueError
            `step` is not above 0.
        """
    def add(self, position: ArrayLike, origin: tuple[float, float, float], triangle: ArrayLike) -> None:
        """Raise the heights to triangles (t, 3): rows of positions (n, 3) in m, relative to an origin.

        Vertical triangles are ignored.

        Raises
        ------
        IndexError
            A vertex does not exist.
        """
    @property
    def height(self) -> NDArray[np.float32]:
        """(rows, columns) m; NaN without a triangle."""

def find_ground(
    height: ArrayLike, step: float, max_width: float = 60.0
) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    """Extract the ground below roofs and crowns from a surface model, and classify its points.

    A progressive morphological filter (Zhang et al. 2003, IEEE Transactions on Geoscience and Remote Sensing
    41(4)): points that an opening with a growing window lowers by more than a threshold belong to objects, if
    these have steep sides. Ground heights below objects are interpolated linearly between the ground on their
    sides.

    Parameters
    ----------
    height
        (ny, nx) surface model, m; NaN for gaps. Subtract a coarse terrain model first for best results.
    step
        Grid spacing, m.
    max_width
        Width of the widest object, m.

    Returns
    -------
    ground
        (ny, nx) ground heights, m.
    surface_class
        (ny, nx) GROUND, VEGETATION or BUILDING. A building has at least 2 points with a smooth surface.

    Raises
    ------
    ValueError
        `step` or `max_width` is not above 0.
    """
