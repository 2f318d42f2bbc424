"""Image files and encoded images in memory: round trips, oiiotool as a second reader, rejected input."""

import contextlib
import re
import shutil
import subprocess
import zlib

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core.sensor import decode_image, encode_png, read_image, write_image

needs_oiiotool = pytest.mark.skipif(not shutil.which("oiiotool"), reason="needs openimageio-tools")


@pytest.fixture(params=[(5, 7), (5, 7, 1), (5, 7, 3), (5, 7, 4)], ids=str)
def pixels(request):
    values = np.random.default_rng(11).random(request.param, np.float32)
    if values.ndim == 3 and values.shape[2] == 4:
        values[..., 3] = 1
    return values


def test_exr_gives_every_float_back(tmp_path, pixels):
    pixels = pixels * np.float32(1e5)
    pixels[0, 0] = -1.5
    pixels[1, 1] = np.inf
    write_image(tmp_path / "a.exr", pixels)
    np.testing.assert_array_equal(read_image(tmp_path / "a.exr").squeeze(), pixels.squeeze())


def test_png_is_within_half_a_level(tmp_path, pixels):
    write_image(tmp_path / "a.png", pixels)
    result = read_image(tmp_path / "a.png").reshape(pixels.shape)
    assert np.abs(result - pixels).max() <= 0.5 / 255 * 1.0001
    np.testing.assert_array_equal(np.round(result * 255), np.round(pixels.astype(float) * 255))


def test_png_clamps(tmp_path):
    write_image(tmp_path / "a.png", [[-1.0, 0.0, 1.0, 7.0]])
    assert read_image(tmp_path / "a.png").ravel().tolist() == [0, 0, 1, 1]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A folder of pictures that oiiotool wrote: `grey` and `noise` in each format; and `own.exr`."""
    if not shutil.which("oiiotool"):
        pytest.skip("needs openimageio-tools")
    folder, words = tmp_path_factory.mktemp("written"), ["oiiotool"]
    write_image(folder / "grey.png", np.full((4, 6, 3), 0.5))
    for name in ("noise.png", "own.exr"):
        write_image(folder / name, np.random.default_rng(12).random((64, 64, 3)))
    for name in ("grey", "noise"):
        words += [
            f"{name}.png",
            *(part for kind in ("tif", "jpg", "exr") for part in ("-o", f"{name}.{kind}")),
        ]
        words += ["-o", f"{name}_again.png"]
    subprocess.run(words, cwd=folder, check=True)
    return folder


WRITTEN = (".tif", ".jpg", "_again.png", ".exr")


@needs_oiiotool
def test_oiiotool_reads_the_same(tmp_path):
    for name in ("a.png", "a.exr"):
        write_image(tmp_path / name, np.full((4, 6, 3), 0.25), {"Firetwin": "model time 60 s"})
    command = ["oiiotool", "--info", "-v", "--stats", "a.png", "a.exr"]
    text = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    assert text.count("6 x    4, 3 channel") == 2
    exr = text[text.index("a.exr") :]
    assert "float openexr" in exr
    assert '"zip"' in exr
    assert 'Firetwin: "model time 60 s"' in exr
    assert "Stats Avg: 0.250000 0.250000 0.250000" in exr


@pytest.mark.parametrize("name", WRITTEN)
def test_reads_what_oiiotool_writes(written, name):
    result = read_image(written / f"grey{name}")
    assert result.shape == (4, 6, 3)
    np.testing.assert_allclose(result, 128 / 255, atol=1.5 / 255)


@pytest.mark.parametrize("name", WRITTEN)
def test_decoding_bytes_equals_reading_the_file(written, name):
    decoded = decode_image((written / f"noise{name}").read_bytes())
    assert decoded.dtype == np.float32
    np.testing.assert_array_equal(decoded, read_image(written / f"noise{name}"))


def test_an_encoded_png_equals_the_written_file(tmp_path, pixels):
    write_image(tmp_path / "a.png", pixels)
    assert encode_png(pixels) == (tmp_path / "a.png").read_bytes()
    assert decode_image(encode_png(pixels)).shape == (*pixels.shape, 1)[:3]


def test_an_empty_image_cannot_be_encoded():
    with pytest.raises(core.InputError, match="at least one pixel"):
        encode_png(np.zeros((0, 3)))


def test_content_counts_not_the_name(tmp_path):
    write_image(tmp_path / "a.png", np.zeros((2, 2)))
    (tmp_path / "a.png").rename(tmp_path / "a.dds")
    assert read_image(tmp_path / "a.dds").shape == (2, 2, 1)


@pytest.mark.parametrize("content", [b"", b"DDS |", b"GIF89a", b"#?RADIANCE\n", b"\x89PNG\r\n"])
def test_other_formats_are_refused(tmp_path, content):
    (tmp_path / "a.png").write_bytes(content)
    with pytest.raises(core.InputError, match="is not a PNG"):
        read_image(tmp_path / "a.png")


@pytest.mark.parametrize("content", [b"", b"\x89", b"DDS |", b"GIF89a", b"#?RADIANCE\n", b"\x89PNG\r\n"])
def test_other_formats_in_memory_are_refused(content):
    with pytest.raises(core.InputError, match=r"^http://a/b: is not a PNG") as error:
        decode_image(content, "http://a/b")
    assert error.value.path == "http://a/b"


@pytest.mark.parametrize("content", ["text", None, 3, [1, 2]])
def test_only_bytes_can_be_decoded(content):
    with pytest.raises(TypeError):
        decode_image(content)


@pytest.mark.parametrize("name", ["a.png", "a.exr"])
def test_damaged_images_are_errors(tmp_path, name):
    write_image(tmp_path / name, np.random.default_rng(12).random((64, 64, 3)))
    content = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(content[: len(content) // 2])
    with pytest.raises(core.InputError, match="cannot be read"):
        read_image(tmp_path / name)


FILES = ("noise.png", "own.exr", "noise.tif", "noise.jpg")


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("part", [0.001, 0.02, 0.5, 0.95])
def test_truncated_bytes_decode_like_the_truncated_file(written, tmp_path, name, part):
    content = (written / name).read_bytes()
    content = content[: max(8, int(part * len(content)))]
    (tmp_path / "cut").write_bytes(content)
    results = []
    for function, argument in ((read_image, tmp_path / "cut"), (decode_image, content)):
        try:
            results.append(function(argument))
        except core.InputError as error:
            results.append(error)
    file, memory = results
    if isinstance(file, core.InputError):
        assert isinstance(memory, core.InputError)
        assert memory.reason.startswith("cannot be read")
    else:  # libjpeg fills the lost rows of a JPEG
        assert name == "noise.jpg"
        np.testing.assert_array_equal(memory, file)


@pytest.mark.parametrize("name", FILES)
def test_damaged_bytes_give_pixels_or_one_error(written, name):
    content, random = (written / name).read_bytes(), np.random.default_rng(14)
    for _ in range(200):
        damaged = bytearray(content)
        for place in random.integers(4, min(len(content), 2000), 4):
            damaged[place] = random.integers(256)
        with contextlib.suppress(core.InputError):
            assert decode_image(bytes(damaged)).ndim == 3


def test_an_exr_with_offsets_in_front_of_its_buffer(tmp_path):
    write_image(tmp_path / "a.exr", np.zeros((64, 64)))
    content = (tmp_path / "a.exr").read_bytes()
    first = (
        content.index(b"screenWindowWidth\0float\0") + 24 + 4 + 4 + 1
    )  # the chunk offsets follow the header
    for offset in (-4, -8, -(2**62)):
        damaged = bytearray(content)
        damaged[first : first + 32] = offset.to_bytes(8, "little", signed=True) * 4
        with pytest.raises(core.InputError, match="cannot be read"):
            decode_image(bytes(damaged))


def test_a_png_that_claims_a_million_by_a_million_pixels(tmp_path):
    write_image(tmp_path / "a.png", np.zeros((2, 2, 3)))
    content = bytearray((tmp_path / "a.png").read_bytes())
    content[16:24] = (1_000_000).to_bytes(4, "big") * 2
    content[29:33] = zlib.crc32(content[12:29]).to_bytes(4, "big")
    (tmp_path / "a.png").write_bytes(content)
    with pytest.raises(core.InputError, match="1000000 x 1000000 pixels"):
        read_image(tmp_path / "a.png")
    with pytest.raises(core.InputError, match="1000000 x 1000000 pixels"):
        decode_image(bytes(content))


def test_the_file_of_a_picture_does_not_tell_when_it_was_written(tmp_path):
    write_image(tmp_path / "a.exr", np.zeros((2, 2)))
    assert re.findall(rb"\d{4}:\d\d:\d\d \d\d:\d\d:\d\d", (tmp_path / "a.exr").read_bytes()) == [
        b"1970:01:01 00:00:00"
    ]


def test_writing_leaves_no_temporary_file(tmp_path):
    write_image(tmp_path / "a.png", np.zeros((2, 2)))
    with pytest.raises(core.InputError):
        write_image(tmp_path / "none" / "a.png", np.zeros((2, 2)))
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]


def test_what_cannot_be_written(tmp_path):
    for name in ("a.jpg", "a.tif", "a"):
        with pytest.raises(core.InputError, match=r"must end in \.png or \.exr"):
            write_image(tmp_path / name, np.zeros((2, 2)))
    for shape in ((0, 2), (2, 0, 3), (2, 2, 65)):
        with pytest.raises(core.InputError, match="at least one pixel"):
            write_image(tmp_path / "a.exr", np.zeros(shape))
    with pytest.raises(ValueError, match="pixels must have shape"):
        write_image(tmp_path / "a.exr", np.zeros(3))
