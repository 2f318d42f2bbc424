"""The choice between GPU and processor on imitated devices, and the kernels and caches behind it."""

import os
import stat
import sys

import pytest
import zstandard
from firetwin.errors import Error
from firetwin.gpu import caches, cards, choice, kernels
from firetwin.gpu.cards import Card

H100 = Card("NVIDIA H100", (9, 0), "580.1")
L4 = Card("NVIDIA L4", (8, 9), "580.1")
GPU = "NVIDIA H100 by OptiX"
COMPILES = "first compiles its kernels for 6 to 10 minutes"
WHY = "as Blender 4.5.15 has no ready kernels for sm_90"


@pytest.mark.parametrize(
    ("wanted", "gpus", "uncompiled", "saved_s", "gpu", "text"),
    [
        ("cpu", "", [], 60.0, False, "the processor"),
        ("auto", "", [], 60.0, False, "the processor (no GPU found)"),
        ("auto", GPU, [], 60.0, True, GPU),
        ("gpu", GPU, [], 60.0, True, GPU),
        (
            "auto",
            GPU,
            [H100],
            40.0,
            False,
            f"the processor: {GPU} would first compile its kernels for 6 to 10 minutes, {WHY}, to "
            "save about 40 s; `firetwin gpu --warm` compiles them once",
        ),
        (
            "auto",
            GPU,
            [H100],
            7200.0,
            True,
            f"{GPU}, which {COMPILES}, once, {WHY}; it then saves about 2 h 0 min",
        ),
        (
            "gpu",
            GPU,
            [H100],
            40.0,
            True,
            f"{GPU}, which {COMPILES}, once, {WHY}",
        ),
    ],
)
def test_the_choice_is_the_quicker_device_and_is_explained(wanted, gpus, uncompiled, saved_s, gpu, text):
    assert choice.choose(wanted, gpus, uncompiled, saved_s, "4.5.15") == choice.Choice(gpu, text)


def test_the_estimate_grows_with_the_work_and_falls_with_the_cores():
    one = choice.estimate_saving(1, 640 * 360, 6, cores=1)
    assert choice.estimate_saving(8, 640 * 360, 6, cores=16) == pytest.approx(one * 8 / 16)
    assert one < choice.estimate_saving(1, 1920 * 1080, 6, cores=1) < 9 * one
    assert choice.estimate_saving(1, 640 * 360, 6) <= one


@pytest.mark.parametrize(
    ("card", "shipped", "version", "found"),
    [
        (H100, ["sm_86", "sm_120"], (4, 5, 15), None),
        (H100, ["sm_86", "sm_120"], (5, 2, 3), None),
        (L4, ["sm_86"], (4, 5, 15), None),
        (L4, ["sm_86"], (5, 2, 3), "kernel_sm_86.cubin.zst"),
        (L4, ["sm_86", "sm_89"], (5, 2, 3), "kernel_sm_89.cubin.zst"),
        (H100, ["sm_90"], (4, 5, 15), "kernel_sm_90.cubin.zst"),
    ],
)
def test_a_kernel_is_found_as_blender_finds_it(tmp_path, card, shipped, version, found):
    for name in shipped:
        (tmp_path / f"kernel_{name}.cubin.zst").touch()
    (tmp_path / "kernel_compute_75.ptx.zst").touch()
    path = kernels.find(card, tmp_path, version)
    assert (path.name if path else None) == found


@pytest.fixture
def ptxas(tmp_path, monkeypatch):
    """An imitation of ptxas on the search path: its output repeats its arguments and its input."""
    folder = tmp_path / "bin"
    folder.mkdir()
    tool = folder / "ptxas"
    tool.write_text(
        f"#!{sys.executable}\nimport pathlib, sys\n*options, _, out, text = sys.argv[1:]\n"
        "data = pathlib.Path(text).read_text()\n"
        "if 'broken' in data: sys.exit('ptxas fatal   : Unsupported .version 99')\n"
        "pathlib.Path(out).write_text(' '.join(options) + data)\n"
    )
    tool.chmod(0o755)
    monkeypatch.setenv("PATH", str(folder), prepend=os.pathsep)
    monkeypatch.setattr(kernels, "find_spec", lambda name: None)


def cycles_folder(tmp_path, **texts):
    folder = tmp_path / "lib"
    folder.mkdir()
    for name, text in texts.items():
        (folder / f"kernel_{name}.ptx.zst").write_bytes(zstandard.compress(text.encode()))
    return folder


@pytest.mark.posix("scripts in place of ptxas")
def test_kernels_are_made_from_the_nearest_older_text(tmp_path, ptxas):
    folder = cycles_folder(tmp_path, compute_75="old", compute_89="near", compute_120="new")
    made = kernels.make("sm_90", folder)
    assert made == folder / "kernel_sm_90.cubin.zst" == kernels.find(H100, folder, (4, 5, 15))
    assert zstandard.decompress(made.read_bytes(), 1000) == b"-arch=sm_90 -O3 --split-compile=0near"
    with pytest.raises(Error, match=r"kernel_sm_90.cubin.zst exists already; remove it"):
        kernels.make("sm_90", folder)
    with pytest.raises(Error, match=r"no intermediate code .* for sm_70"):
        kernels.make("sm_70", folder)


@pytest.mark.posix("scripts in place of ptxas")
def test_a_failed_translation_leaves_no_file(tmp_path, ptxas):
    folder = cycles_folder(tmp_path, compute_75="broken")
    with pytest.raises(Error, match=r"kernel_compute_75.ptx.zst for sm_90: ptxas fatal   : Unsupported"):
        kernels.make("sm_90", folder)
    assert [each.name for each in folder.iterdir()] == ["kernel_compute_75.ptx.zst"]


def test_without_ptxas_the_remedy_is_named(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(kernels, "find_spec", lambda name: None)
    with pytest.raises(Error, match=r"ptxas is missing; .* install nvidia-cuda-nvcc-cu12"):
        kernels.make("sm_90", cycles_folder(tmp_path, compute_75="text"))


def test_a_compiled_card_is_remembered_while_its_cache_remains(tmp_path):
    given = {"CUDA_CACHE_PATH": str(tmp_path / "cuda")}
    assert not caches.is_compiled(H100, "4.5.15", given)
    caches.record_compiled([H100], "4.5.15", given)
    assert not caches.is_compiled(H100, "4.5.15", given)  # CUDA has saved nothing
    (tmp_path / "cuda" / "0").mkdir()
    assert caches.is_compiled(H100, "4.5.15", given)
    assert not caches.is_compiled(H100, "5.2.3", given)
    assert not caches.is_compiled(Card("NVIDIA H100", (9, 0), "590.2"), "4.5.15", given)
    caches.record_compiled([L4], "4.5.15", given)
    assert caches.is_compiled(H100, "4.5.15", given)
    (tmp_path / "cuda" / "firetwin-compiled.json").write_text("{")
    assert not caches.is_compiled(H100, "4.5.15", given)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have local caches")
def test_caches_are_private_folders_of_this_machine_unless_they_are_chosen(tmp_path, monkeypatch):
    monkeypatch.setattr(caches.os.path, "exists", lambda path: False)
    assert caches.environment({}, tmp_path) == {}  # no driver
    monkeypatch.setattr(caches.os.path, "exists", lambda path: path == "/dev/nvidiactl")
    own = tmp_path / f"firetwin-gpu-{os.getuid()}"
    assert caches.environment({"OPTIX_CACHE_PATH": "/mine"}, tmp_path) == {
        "CUDA_CACHE_PATH": str(own / "cuda"),
        "CUDA_CACHE_MAXSIZE": "4294967296",
    }
    assert stat.S_IMODE(own.stat().st_mode) == 0o700
    own.rmdir()
    own.symlink_to(tmp_path)
    assert caches.environment({}, tmp_path) == {}  # someone else's link


def test_cards_are_listed_by_the_drivers_library(monkeypatch):
    class Cuda:
        def cuInit(self, flags):
            return 0

        def cuDeviceGetCount(self, number):
            number._obj.value = 2
            return 0

        def cuDeviceGet(self, device, index):
            device._obj.value = index

        def cuDeviceGetName(self, name, size, device):
            name.value = b"NVIDIA H100" if device.value else b"NVIDIA L4"

        def cuDeviceGetAttribute(self, value, which, device):
            value._obj.value = {75: (8, 9), 76: (9, 0)}[which][device.value]

    monkeypatch.setattr(cards, "_library", lambda linux, windows: Cuda() if "cuda" in linux else None)
    assert cards.list_cards() == [
        Card("NVIDIA L4", (8, 9), "unknown"),
        Card("NVIDIA H100", (9, 0), "unknown"),
    ]
    assert cards.list_cards()[1].architecture == "sm_90"
    monkeypatch.setattr(cards, "_library", lambda linux, windows: None)
    assert cards.list_cards() == []
