"""3D Tiles: content decoded to flat arrays, and the choice of tiles for a shot. Nothing here opens a file."""

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
    """(n,) screen-space error of tiles in pixels: the largest over the views that see them; -1: none does.

    Perspective: error * pixels / max(distance, 1e-7 m), with the distance of the camera from the nearest point
    of the tile's volume. Orthographic: error * pixels. A view sees a tile by its bounding sphere (see
    `lod.visible_mask`, also for the last three arguments).

    Parameters
    ----------
    centre, axis, half, padding
        Volumes: boxes with centres (n, 3) m, orthonormal directions of edges (n, 3, 3) as rows, half lengths
        (n, 3) m, widened by (n,) m. A sphere is a box without extent.
    error
        (n,) geometric errors, m.
    pixels
        (m,) of each view. Perspective: pixels of 1 m at a distance of 1 m, height / (2 tan(angle / 2)).
        Orthographic: pixels of 1 m.

    Raises
    ------
    ValueError
        A shape does not fit, or a number is below 0 or NaN.
    """

def contains_any(
    centre: ArrayLike, axis: ArrayLike, half: ArrayLike, padding: ArrayLike, position: ArrayLike
) -> NDArray[np.bool_]:
    """(n,) whether any position (m, 3) is inside each volume (see `screen_error`)."""

class Cut:
    """The tiles that a shot shows (see `select`)."""

    @property
    def tiles(self) -> NDArray[np.int64]:
        """Numbers of the tiles whose content is shown, ascending."""
    @property
    def expand(self) -> NDArray[np.int64]:
        """Numbers of pending tiles whose children the cut needs, ascending."""
    @property
    def stand_ins(self) -> NDArray[np.int64]:
        """Numbers of tiles that stand in for broken ones below them."""
    @property
    def missing(self) -> NDArray[np.int64]:
        """Numbers of broken tiles for which no tile stands in, or an ancestor that is shown anyway."""
    @property
    def error(self) -> float:
        """Screen-space error above which tiles are refined, pixels: what was asked for, or more to fit."""
    @property
    def fits(self) -> bool:
        """Whether the cut keeps within the budget."""
    @property
    def bytes(self) -> int:
        """Sum over the tiles shown."""
    @property
    def triangles(self) -> int:
        """Sum over the tiles shown."""

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
    """Choose one cut of a tree of n tiles. The time is linear in n.

    A tile is refined where its screen-space error is above `error`, and UNCONDITIONAL ones always. Children of
    a tile that REPLACES are chosen all or none; those that no view sees stay coarse. Other children are chosen
    each by itself, where a view sees it. In place of a BROKEN tile its nearest ancestor with content is shown.
    Beyond the budget the error is raised for all tiles to the next screen-space error of any tile at which the
    cut fits, found by bisection; where nothing fits the coarsest cut is given.

    Parameters
    ----------
    parent
        (n,) number of the parent, smaller than the tile's own; -1 for roots.
    flags
        (n,) sums of: REPLACES; UNCONDITIONAL; CONTENT: it has something to show; PENDING: it has children that
        are not read yet; BROKEN: its content cannot be had; OUTSIDE_REQUEST_VOLUME: no eye is in its request volume, so that it
        and what is below is left out; PASS_THROUGH: it stands for its children and shows its own content with them.
    screen_error
        (n,) pixels; below 0: no view sees the tile.
    bytes, triangles
        (n,) of the contents, 0 where unknown.
    max_tiles, max_bytes, max_triangles
        Budget; below 0: no limit.

    Raises
    ------
    ValueError
        A shape does not fit, a parent does not come before its child, or an error is negative or NaN.
    """

class Image:
    """An encoded picture of a tile, as it lies in the content or beside it."""

    @property
    def kind(self) -> str:
        """jpeg, png or webp by its first bytes; empty where only the uri is known."""
    @property
    def width(self) -> int:
        """Pixels, by its header; 0 where only the uri is known."""
    @property
    def height(self) -> int:
        """Pixels, by its header; 0 where only the uri is known."""
    @property
    def data(self) -> bytes:
        """The file; empty where only the uri is known."""
    @property
    def uri(self) -> str:
        """Where it lies, relative to the content; empty where the content holds it."""

class Material:
    """What a range of triangles looks like. Lighting is not read: whoever draws it decides."""

    @property
    def colour(self) -> list[float]:
        """Linear red, green, blue and alpha, to be multiplied with the picture's and the vertices'."""
    @property
    def image(self) -> int:
        """Index of the picture in `Tile.images`; -1 for none."""
    @property
    def wrap_u(self) -> str:
        """repeat, clamp or mirror beyond the picture's sides."""
    @property
    def wrap_v(self) -> str:
        """The same beyond its top and bottom."""
    @property
    def alpha_mode(self) -> str:
        """opaque, mask or blend."""
    @property
    def alpha_cutoff(self) -> float:
        """Alpha below which a mask shows nothing."""
    @property
    def double_sided(self) -> bool:
        """Whether triangles show from behind too."""

class Range:
    """Vertices and triangles of one material; ranges follow one another without gaps."""

    @property
    def material(self) -> int:
        """Index in `Tile.materials`; -1 for none."""
    @property
    def first_vertex(self) -> int:
        """Row of `Tile.position`."""
    @property
    def vertices(self) -> int:
        """Number of rows."""
    @property
    def first_triangle(self) -> int:
        """Row of `Tile.triangle`."""
    @property
    def triangles(self) -> int:
        """Number of rows; 0 for points."""
    @property
    def points(self) -> bool:
        """Whether its vertices are points of a cloud."""
    @property
    def has_normals(self) -> bool:
        """Whether the content has normals. Else `Tile.normal` has smooth ones here, and 0 for points."""

class Tile:
    """Decoded content: read-only arrays of n vertices and m triangles about an origin."""

    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) m in the scene's frame, whole metres: the middle of all vertices."""
    @property
    def position(self) -> NDArray[np.float32]:
        """(n, 3) m from the origin. No vertex is a content without geometry, which is no error."""
    @property
    def normal(self) -> NDArray[np.float32]:
        """(n, 3) unit vectors; smooth where the content has none (see `Range.has_normals`)."""
    @property
    def uv(self) -> NDArray[np.float32]:
        """(n, 2) place in the picture, from its lower left corner; 0 where there is none."""
    @property
    def colour(self) -> NDArray[np.float32]:
        """(n, 4) linear red, green, blue and alpha; (0, 4) where no vertex has a colour."""
    @property
    def triangle(self) -> NDArray[np.uint32]:
        """(m, 3) rows of `position`, counter-clockwise from outside."""
    @property
    def ranges(self) -> list[Range]:
        """By material; points come last."""
    @property
    def materials(self) -> list[Material]:
        """Those that are used."""
    @property
    def images(self) -> list[Image]:
        """Those that are used."""
    @property
    def copyright(self) -> str:
        """Notices of the content, each once, with semicolons between them."""
    @property
    def spacing(self) -> float:
        """Metres between neighbouring float32 numbers at the content's vertex farthest from its own origin.

        Where positions are Earth-centred in float32 it is 0.5: no decoder can do better with such content.
        """
    @property
    def not_finite(self) -> int:
        """Vertices left out because they are NaN, infinite or more than 1e9 m away."""
    @property
    def lines(self) -> int:
        """Primitives of lines, which are left out."""

def decode(
    content: bytes,
    matrix: ArrayLike,
    name: str,
    resources: dict[str, bytes] | None = None,
    earth_matrix: ArrayLike | None = None,
    up_axis: str = "Y",
) -> Tile:
    """Decode a b3dm, i3dm, cmpt, pnts, glb or glTF, told by its first bytes.

    All transforms are multiplied in float64: matrix, RTC_CENTER or an instance of i3dm, CESIUM_RTC (z up),
    glTF's y to z, nodes, instances of EXT_mesh_gpu_instancing. Instances are expanded. Draco, meshopt and
    quantised attributes are read. Skins, animations, morphs and features are ignored; pictures are not
    decoded. Damaged Draco data may make Draco's own decoder ask for gigabytes or crash: content from
    elsewhere belongs into a process of its own, with limits of memory and time.

    Parameters
    ----------
    content
        The file.
    matrix
        (4, 4), of columns on its right: the content's frame (z up) to the scene's, m.
    name
        What messages call the content.
    resources
        Files beside the content by uri (`list_missing_resources`). A picture may be among them; its header is
        then checked and `Image.data` has it.
    earth_matrix
        (4, 4) the content's frame to the Earth-centred one; None where it is that one. Only EAST_NORTH_UP of
        i3dm needs it.
    up_axis
        X, Y or Z: `asset.gltfUpAxis` of the tileset.

    Raises
    ------
    InputError
        The content is damaged, lacks a resource, requires an extension that is not known, or asks for more
        than the limits: 10 million vertices, a million instances, 1 GB when decoded, pictures of 16384
        pixels a side, cmpt in cmpt 8 deep. The reason begins with the place in the JSON.
    ValueError
        A matrix is not finite, not affine or has the determinant 0.
    """

def list_missing_resources(content: bytes, name: str, resources: dict[str, bytes] | None = None) -> list[str]:
    """List uris, relative to the content, of files that `decode` needs beside those in `resources`.

    These are buffers and models, sorted; pictures are not needed. Ask again with what was found until the
    list is empty, for a model may need buffers. The uris are as the content writes them, percent signs and
    dots included: whoever fetches them decides what may be fetched.
    """

def content_type(content: bytes, name: str) -> str:
    """Tell b3dm, i3dm, cmpt, pnts, glb, gltf, tileset or subtree by what is in it.

    Raises
    ------
    InputError
        It is none of these.
    """

class HeightMap:
    """Heights of the highest surface of triangles above points of an even grid."""

    def __init__(self, low: tuple[float, float], step: float, rows: int, columns: int) -> None:
        """Points at low + (column, row) * step, m.

        Raises
        ------
        ValueError
            The step is not above 0.
        """
    def add(self, position: ArrayLike, origin: tuple[float, float, float], triangle: ArrayLike) -> None:
        """Raise the heights to triangles (t, 3) of positions (n, 3), m about an origin.

        Upright triangles count for nothing.

        Raises
        ------
        IndexError
            A vertex does not exist.
        """
    @property
    def height(self) -> NDArray[np.float32]:
        """(rows, columns) m; NaN where there is no triangle."""

def find_ground(
    height: ArrayLike, step: float, max_width: float = 60.0
) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    """Heights of the ground (ny, nx), m, below roofs and crowns, and what each point shows.

    A progressive morphological filter (Zhang et al. 2003, IEEE Transactions on Geoscience and Remote Sensing
    41(4)): openings by windows that grow to `max_width`. What one lowers by more than a threshold is an object, if
    its sides are steep. Below objects heights are linear between the ground on their sides.

    Parameters
    ----------
    height
        (ny, nx) highest surface, m, best as its height above what is known of the ground; NaN without.
    step
        m between points.
    max_width
        m, width of the widest object.

    Returns
    -------
    Heights, and GROUND, VEGETATION or BUILDING for each point. Buildings have 2 points or more of an even surface.

    Raises
    ------
    ValueError
        A number is not above 0.
    """
