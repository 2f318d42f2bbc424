"""Tilesets of folders and archives: nothing leaves them."""

import gzip
import io
import os
import zipfile

import pytest
from firetwin.errors import InputError
from firetwin.tiles.loader import Loader
from firetwin.tiles.sources import MissingError, Network, archive, open_source
from firetwin.tiles.sources._source import gunzip
from firetwin.tiles.sources.folder import Folder
from firetwin.tiles.sources.local import relative
from tilesets import GLB, as_bytes, tile, tileset, write

SET = {
    "tileset.json": tileset(tile(8.0, "in/a%20b.glb?v=2#x", [tile(4.0, "in/sub.json")])),
    "in/a b.glb": GLB,
}
SET["in/sub.json"] = tileset(tile(2.0, "../c.glb"))
SET["c.glb"] = gzip.compress(GLB)


def zipped(path, files, method=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", method) as out:
        for name, value in files.items():
            out.writestr(name, as_bytes(value))
    return path


@pytest.mark.parametrize("kind", ["folder", "file", "3tz"])
def test_all_of_a_tileset_is_read(tmp_path, kind):
    folder = write(tmp_path / "t", SET)
    place = {"folder": folder, "file": folder / "tileset.json", "3tz": tmp_path / "x.3tz"}[kind]
    zipped(tmp_path / "x.3tz", SET)
    source = open_source(str(place))
    loader = Loader(source)
    assert loader.expand_all()
    contents = {}
    assert not loader.check(range(loader.tree.contents), contents.__setitem__)
    assert list(contents.values()) == [GLB, GLB]
    assert not loader.tree.broken
    assert source.size("in/a b.glb") is not None
    assert source.size("gone") is None
    with pytest.raises(MissingError):
        source.read("gone.glb")
    source.close()


@pytest.mark.parametrize(
    ("reference", "message"),
    [
        ("../../x.glb", "leaves the tileset's folder"),
        ("../..", "leaves the tileset's folder"),
        ("/etc/passwd", "is absolute"),
        ("//host/x.glb", "not a file of the tileset"),
        ("file:///etc/passwd", "not a file of the tileset"),
        ("https://elsewhere.example/x.glb", "not a file of the tileset"),
        ("data:text/plain,x", "not a file of the tileset"),
        ("C:/x.glb", "not a file of the tileset"),
        ("in/C:x.glb", "a colon"),
        ("..\\x.glb", "a backslash"),
        ("%2e%2e/x.glb", "hides a dot"),
        ("%2E%2E/x.glb", "hides a dot"),
        ("..%2fx.glb", "hides a dot"),
        ("..%5Cx.glb", "hides a dot"),
        ("x%00.glb", "hides a dot"),
        ("x\0.glb", "NUL"),
        ("?v=1", "names no file"),
    ],
)
def test_references_that_lead_out(reference, message):
    with pytest.raises(InputError, match=rf"^t\.json: the reference .*{message}"):
        relative("in/t.json", reference, "t.json")


def test_escapes_are_undone_once():
    assert relative("in/t.json", "%2565.glb", "t.json") == "in/%65.glb"
    assert relative("in/t.json", "./a/../b.glb", "t.json") == "in/b.glb"
    assert relative("in/t.json", "../b.glb", "t.json") == "b.glb"


def test_references_within_a_folder_above_are_allowed_by_the_user_alone(tmp_path):
    files = {"a/tileset.json": tileset(tile(8.0, "../tiles/x.glb")), "tiles/x.glb": GLB}
    files["b/tileset.json"] = tileset(tile(8.0, "../../secret.glb"))
    folder = write(tmp_path / "set", files)
    write(tmp_path, {"secret.glb": GLB})
    with pytest.raises(InputError, match="leaves the tileset's folder; --tile-root DIR, or root under"):
        Loader(open_source(str(folder / "a"))).check([0])
    network = Network(root=folder)
    for place in ("a", "a/tileset.json"):
        loader, contents = Loader(open_source(str(folder / place), network)), {}
        loader.check([0], contents.__setitem__)
        assert contents == {0: GLB}
        assert loader.source.name(loader.source.root) == str(folder / "a/tileset.json")
    with pytest.raises(InputError, match="leaves the tileset's folder"):
        Loader(open_source(str(folder / "b"), network)).check([0])
    (folder / "tiles/link.glb").symlink_to(tmp_path / "secret.glb")
    with pytest.raises(InputError, match="is a link that leaves"):
        open_source(str(folder / "a"), network).read("tiles/link.glb")
    own = open_source(str(write(tmp_path / "own", SET)), network)  # not in the folder of the option
    assert own.root == "tileset.json"


def test_links_that_lead_out_are_refused_and_others_followed(tmp_path):
    folder = write(tmp_path / "t", SET)
    (tmp_path / "secret.glb").write_bytes(GLB)
    (folder / "out.glb").symlink_to(tmp_path / "secret.glb")
    (folder / "way").symlink_to(tmp_path)
    (folder / "inside.glb").symlink_to(folder / "c.glb")
    source = Folder(folder)
    for each in ("out.glb", "way/secret.glb"):
        with pytest.raises(InputError, match="is a link that leaves") as caught:
            source.read(each)
        assert not isinstance(caught.value, MissingError)
    assert source.read("inside.glb") == GLB


def test_what_is_no_file_is_missing_and_sizes_are_limited(tmp_path):
    source = Folder(write(tmp_path / "t", SET))
    os.mkfifo(tmp_path / "t/pipe")
    for each in ("in", "pipe"):
        with pytest.raises(MissingError, match="is not a file"):
            source.read(each)
    with pytest.raises(InputError, match="has 12 bytes; at most 5"):
        source.read("in/a b.glb", 5)


@pytest.mark.parametrize("place", ["nowhere", "nowhere/tileset.json", "nowhere.3tz"])
def test_what_is_not_there(tmp_path, place):
    with pytest.raises(InputError, match=r"is not there|cannot be opened"):
        open_source(str(tmp_path / place))


@pytest.mark.parametrize(
    "name",
    [
        *("../x.glb", "/x.glb", "in/../../x", "C:x.glb", "./x.glb", "in//x.glb"),
        *(["in\\x.glb"] if os.sep == "/" else []),  # zipfile of Windows reads it as in/x.glb
    ],
)
def test_members_that_lead_out_are_refused(tmp_path, name):
    path = zipped(tmp_path / "x.3tz", SET | {name: GLB})
    with pytest.raises(InputError, match="leaves the archive"):
        archive.Archive(path)


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_a_member_that_is_there_twice_is_refused(tmp_path):
    path = tmp_path / "x.3tz"
    with zipfile.ZipFile(path, "w") as out:
        out.writestr("tileset.json", b"{}")
        out.writestr("tileset.json", b"[]")
    with pytest.raises(InputError, match="is there twice"):
        archive.Archive(path)


def test_growth_damage_and_other_methods(tmp_path):
    many = b"0" * 5_000_000
    path = zipped(tmp_path / "x.3tz", SET | {"bomb": many, "fine": GLB * 100})
    source = archive.Archive(path)
    with pytest.raises(InputError, match="grows more than 64 times"):
        source.read("bomb")
    with pytest.raises(InputError, match="at most 10"):
        source.read("fine", 10)
    other = archive.Archive(zipped(tmp_path / "y.3tz", SET, zipfile.ZIP_BZIP2))
    with pytest.raises(InputError, match="compressed by method 12"):
        other.read("tileset.json")
    data = bytearray(
        zipped(tmp_path / "z.3tz", {"tileset.json": b"x" * 100}, zipfile.ZIP_STORED).read_bytes()
    )
    data[data.index(b"xxxx") + 5] = ord("y")
    (tmp_path / "z.3tz").write_bytes(data)
    with pytest.raises(MissingError, match="is damaged"):
        archive.Archive(tmp_path / "z.3tz").read("tileset.json")
    (tmp_path / "w.3tz").write_bytes(b"PK" + bytes(100))
    with pytest.raises(InputError, match=r"cannot be opened as a \.3tz"):
        archive.Archive(tmp_path / "w.3tz")


def test_gzip_within_limits():
    data = gzip.compress(b"abc" * 1000)
    assert gunzip(data, 10_000, "x") == b"abc" * 1000
    for broken, kind, message in (
        (data[:-9], MissingError, "ends early"),
        (data[:-5] + b"\0" * 5, MissingError, "is damaged"),
        (data[:10] + b"\xff" + data[11:], MissingError, "is damaged"),
    ):
        with pytest.raises(kind, match=message):
            gunzip(broken, 10_000, "x")
    with pytest.raises(InputError, match="grows to more than 100 bytes"):
        gunzip(data, 100, "x")
    bomb = io.BytesIO()
    with gzip.GzipFile(fileobj=bomb, mode="wb") as file:
        file.write(b"0" * 20_000_000)
    with pytest.raises(InputError, match="grows to more than"):
        gunzip(bomb.getvalue(), 1 << 28, "x")


def test_damaged_names_in_an_archive(tmp_path):
    data = zipped(tmp_path / "x.3tz", {"!": b"1"}, zipfile.ZIP_STORED).read_bytes()
    (tmp_path / "x.3tz").write_bytes(data.replace(b"!", b"\0"))  # zipfile cuts names there
    with pytest.raises(InputError, match="leaves the archive"):
        archive.Archive(tmp_path / "x.3tz")
    data = zipped(tmp_path / "y.3tz", {"tileset.json": b"{}"}, zipfile.ZIP_STORED).read_bytes()
    data = bytearray(data.replace(b"tileset.json", b"\xff" * 12, 1))  # the name before the content
    data[7] |= 0x08  # which is UTF-8
    (tmp_path / "y.3tz").write_bytes(data)
    with pytest.raises(MissingError, match="is damaged"):
        archive.Archive(tmp_path / "y.3tz").read("tileset.json")
