"""The device of a render on imitated machines, with and without a GPU and ready kernels; Cycles' status."""

from dataclasses import replace
from types import SimpleNamespace

import bpy
import pytest
from firetwin.blender import devices
from firetwin.errors import Error, InputError
from firetwin.gpu.cards import Card
from firetwin.jobs import device, gpu
from firetwin.render import cycles_status

H100 = Card("NVIDIA H100", (9, 0), "580.1")


def fake_cycles(monkeypatch, *gpus):
    """Imitate Cycles' preferences on a machine with these GPUs: pairs of kind and name."""
    found = [SimpleNamespace(type=kind, name=name, use=False) for kind, name in gpus]
    processor = SimpleNamespace(type="CPU", name="Processor", use=True)
    given = SimpleNamespace(
        compute_device_type="NONE",
        devices=[*found, processor],
        get_device_types=lambda context: [(kind, kind, "", 0) for kind in ("NONE", "CUDA", "OPTIX")],
        get_devices_for_type=lambda kind: [each for each in found if each.type == kind] + [processor],
    )
    monkeypatch.setattr(devices, "_preferences", lambda: given)
    return given


@pytest.fixture
def h100(monkeypatch, tmp_path):
    """A machine with an H100, an empty cache, and kernels in `tmp_path`; lists pictures of one sample."""
    fake_cycles(monkeypatch, ("CUDA", "NVIDIA H100"), ("OPTIX", "NVIDIA H100"))
    monkeypatch.setenv("CUDA_CACHE_PATH", str(tmp_path / "cuda"))
    monkeypatch.setattr(device.cards, "list_cards", lambda: [H100])
    monkeypatch.setattr(device.kernels, "folder", lambda: tmp_path)
    drawn = []

    def draw(gpus, tell):
        drawn.append(str(gpus))
        (tmp_path / "cuda" / "0").mkdir()  # as the driver does

    monkeypatch.setattr(device, "draw_sample", draw)
    return drawn


def asked(settings, wanted, frames=1):
    told = []
    chosen = device.select(
        replace(settings, render=replace(settings.render, device=wanted)), frames, told.append
    )
    return chosen and str(chosen), *told


def test_a_gpu_is_used_with_its_fastest_interface(scene, settings, monkeypatch):
    given = fake_cycles(monkeypatch, ("CUDA", "Card"), ("OPTIX", "Card"))
    monkeypatch.setattr(device.cards, "list_cards", list)
    for wanted in ("auto", "gpu"):
        assert asked(settings, wanted) == ("Card by OptiX", "Cycles renders on Card by OptiX")
    devices.use(devices.find_gpus(), scene)
    assert scene.cycles.device == "GPU"
    assert given.compute_device_type == "OPTIX"
    assert [each.type for each in given.devices if each.use] == ["OPTIX"]
    assert asked(settings, "cpu") == (None, "Cycles renders on the processor")
    devices.use(None, scene)
    assert scene.cycles.device == "CPU"


def test_without_a_gpu_auto_uses_the_processor_and_says_so(settings, monkeypatch, tmp_path):
    fake_cycles(monkeypatch)
    assert asked(settings, "auto") == (None, "Cycles renders on the processor (no GPU found)")
    assert gpu.describe_in_blender() == ["Cycles finds no GPU here"]
    with pytest.raises(Error, match="no GPU here; nothing to compile"):
        gpu.warm_in_blender()
    refusal = r'device = "gpu", but Cycles finds no GPU here.*"auto" or "cpu"'
    with pytest.raises(Error, match=refusal) as refused:
        asked(replace(settings, path=tmp_path / "none.toml"), "gpu")
    assert "\n" not in str(refused.value)
    (tmp_path / "scene.toml").write_text('[render]\ndevice = "gpu"\n')
    with pytest.raises(InputError, match=r"scene.toml:2:1: " + refusal):
        asked(replace(settings, path=tmp_path / "scene.toml"), "gpu")


def test_short_films_do_not_wait_for_kernels(settings, h100):
    chosen, told = asked(settings, "auto")
    assert chosen is None
    assert told.startswith("Cycles renders on the processor: NVIDIA H100 by OptiX would first compile")
    assert f"Blender {bpy.app.version_string} has no ready kernels for sm_90" in told
    assert h100 == []
    assert "kernels not ready" in gpu.describe_in_blender()[0]


@pytest.mark.parametrize(("wanted", "frames"), [("gpu", 1), ("auto", 1_000_000)])
def test_long_films_and_device_gpu_compile_once(settings, h100, wanted, frames):
    chosen, told = asked(settings, wanted, frames)
    assert chosen == "NVIDIA H100 by OptiX"
    assert "first compiles its kernels for 6 to 10 minutes" in told
    assert h100 == ["NVIDIA H100 by OptiX"]
    assert asked(settings, "auto") == (
        chosen,
        f"Cycles renders on {chosen}",
    )  # remembered, also for short films
    assert h100 == ["NVIDIA H100 by OptiX"]
    assert "kernels compiled, in the cache" in gpu.describe_in_blender()[0]


def test_ready_kernels_are_used_at_once(settings, h100, tmp_path):
    (tmp_path / "kernel_sm_90.cubin.zst").touch()
    assert asked(settings, "auto") == ("NVIDIA H100 by OptiX", "Cycles renders on NVIDIA H100 by OptiX")
    assert h100 == []
    assert "kernels ready" in gpu.describe_in_blender()[0]


def test_warming_prepares_short_films(settings, h100):
    told = []
    assert "kernels compiled, in the cache" in gpu.warm_in_blender(tell=told.append)[0]
    assert told == ["loading the kernels of Cycles on NVIDIA H100 by OptiX"]
    assert asked(settings, "auto")[0] == "NVIDIA H100 by OptiX"


def test_an_artists_renders_follow_the_preferences(scene):
    devices.follow_preferences("cpu", scene)
    assert scene.cycles.device == "CPU"
    devices.follow_preferences("auto", scene)
    assert scene.cycles.device == "GPU"  # which is the processor if the preferences name no GPU


def test_a_long_render_reports_its_samples_and_its_time(monkeypatch):
    now, told, reports = [0.0], [], []
    monkeypatch.setattr(cycles_status.time, "monotonic", lambda: now[0])

    class Beats:
        def __init__(self, every, send):
            reports.append(send)

        def __enter__(self):
            return self

        def __exit__(self, *_):
            return None

    monkeypatch.setattr(cycles_status, "heartbeats", Beats)
    handlers = bpy.app.handlers
    before = list(handlers.render_stats), list(handlers.render_complete), list(handlers.render_cancel)
    with cycles_status.reported(told.append):
        (note,) = set(handlers.render_stats) - set(before[0])
        (end,) = set(handlers.render_complete) - set(before[1])
        now[0] = 100.0
        note("Fra:1 Mem:3M | Time:00:00.10 | Scene, rgb | Loading render kernels (may take a few minutes)")
        now[0] = 110.0
        reports[0]()  # too early
        now[0] = 230.0
        reports[0]()
        note("Fra:1 Mem:3M | Time:02:11.00 | Scene, rgb | Sample 7/24")
        now[0] = 245.0
        reports[0]()
        end(None)
        reports[0]()  # between two renders
        now[0] = 300.0
        note("Fra:2 Mem:3M | Time:00:01.00 | Scene, rgb | Sample 1/24")
        reports[0]()  # the next render has just begun
    assert told == [
        "Cycles: Loading render kernels (may take a few minutes), 2 min 10 s so far",
        "Cycles: Sample 7/24, 2 min 25 s so far",
    ]
    after = list(handlers.render_stats), list(handlers.render_complete), list(handlers.render_cancel)
    assert after == before
