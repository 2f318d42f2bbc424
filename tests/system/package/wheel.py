"""Check one wheel of the core with Blender: ``wheel.py FOLDER before|after|preloaded``.

FOLDER holds the unpacked wheel. `before` and `after` say when the core is imported, seen from `bpy`;
`preloaded` first loads TBB, OpenVDB, OpenImageIO, OpenEXR and Imath of Blender so that all their symbols are
visible to the core, as they are inside Blender's executable.
"""

import ctypes
import importlib.util
import os
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np

SHARED = ("tbb", "Imath", "Iex", "IlmThread", "OpenEXRCore", "OpenEXR", "openvdb")
SHARED += ("OpenImageIO_Util", "OpenImageIO")


def preload():
    """Blender's own libraries, every symbol of them visible."""
    found = importlib.util.find_spec("bpy").submodule_search_locations[0]
    missing = []
    for name in SHARED:
        files = sorted(Path(found, "lib").glob(f"lib{name}.so*"))
        if files:
            ctypes.CDLL(str(files[0]), mode=ctypes.RTLD_GLOBAL)
        else:
            missing.append(name)
    assert not missing, f"this Blender has no shared {', '.join(missing)}"


def raised(function, *arguments):
    """Return the error of a call."""
    try:
        function(*arguments)
    except Exception as error:
        return error
    raise AssertionError(f"{function.__name__}{arguments} raised nothing")


def check_errors(core, folder):
    """Errors name the file, the line and the column; errors of worker threads arrive too."""
    path = folder / "bad.txt"
    path.write_text("1 2 3\n4 five 6\n")
    error = raised(core.run.read_grid, path)
    assert type(error) is core.InputError, error
    assert isinstance(error, core.Error)
    assert (error.path, error.line, error.column) == (str(path), 2, 3), vars(error)
    nan = np.full((40, 40, 40), np.nan, np.float32)
    error = raised(core.volume.write, folder / "nan.vdb", {"density": nan}, 1.0)
    assert type(error) is ValueError, error
    assert "finite" in str(error), error
    assert type(raised(core.geo.LocalFrame, "north", 0, 0)) is TypeError
    assert type(raised(core.set_threads, -1)) is ValueError


def check_volume(core, bpy, folder):
    """A volume of the core changes the pixels of a Cycles picture."""
    path = folder / "smoke.vdb"
    x, y, z = np.mgrid[-1:1:48j, -1:1:48j, -1:1:48j]
    ball = np.where(x * x + y * y + z * z < 0.8, 2.0, 0.0).astype(np.float32)
    frame = core.volume.write(path, {"density": ball}, 2.0 / 47, (-1.0, -1.0, -1.0))
    assert frame.active_voxels == np.count_nonzero(ball)

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.seed = 4, False, 1
    scene.render.resolution_x, scene.render.resolution_y = 48, 32
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.world = bpy.data.worlds.new("sky")
    scene.world.color = (0.6, 0.6, 0.6)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (0, 0, 6)
    scene.collection.objects.link(camera)
    scene.camera = camera
    volume = bpy.data.volumes.new("smoke")
    volume.filepath = str(path)
    assert volume.grids.load(), volume.grids.error_message
    assert [grid.name for grid in volume.grids] == ["density"]
    smoke = bpy.data.objects.new("smoke", volume)
    scene.collection.objects.link(smoke)
    material = bpy.data.materials.new("smoke")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    shader, output = nodes.new("ShaderNodeVolumePrincipled"), nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(shader.outputs["Volume"], output.inputs["Volume"])
    volume.materials.append(material)
    with_smoke = render(core, bpy, folder / "with.exr")
    smoke.hide_render = True
    without = render(core, bpy, folder / "without.exr")
    changed = np.abs(with_smoke - without).max(axis=2) > 0.02
    assert changed[8:24, 16:32].mean() > 0.9, "the smoke does not show"
    assert not changed[:3].any(), "the picture changed outside of the smoke"


def render(core, bpy, path):
    """Blender's picture, read by our OpenImageIO."""
    bpy.context.scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return core.sensor.read_image(path)[..., :3]


def check_image(core, bpy, folder):
    """Blender reads the floats that we wrote."""
    pixels = np.random.default_rng(1).random((20, 30, 3)).astype(np.float32) * 1000
    path = folder / "kelvin.exr"
    core.sensor.write_image(path, pixels)
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    read = np.empty(20 * 30 * 4, np.float32)
    image.pixels.foreach_get(read)
    assert np.array_equal(read.reshape(20, 30, 4)[::-1, :, :3], pixels)
    assert np.array_equal(core.sensor.read_image(path), pixels)


def check_usd(core, bpy, folder):
    """USD, which works on Blender's TBB, goes out and in again while ours is busy."""
    frame = core.geo.LocalFrame(38.8, -120.6, 1000.0)
    side = 300
    axes = np.linspace(38.7, 38.9, side), np.linspace(-120.7, -120.5, side)
    fuel, height = np.full((side, side), 1.0, np.float32), np.zeros((side, side), np.float32)
    done = threading.Event()
    counts = []

    def work():
        while not done.is_set():
            counts.append(len(core.forest.trees(fuel, *axes, height, frame)))

    bpy.ops.wm.read_factory_settings(use_empty=True)
    for _ in range(20):
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    thread = threading.Thread(target=work)
    thread.start()
    try:
        path = folder / "spheres.usdc"
        assert bpy.ops.wm.usd_export(filepath=str(path)) == {"FINISHED"}
        bpy.ops.wm.read_factory_settings(use_empty=True)
        assert bpy.ops.wm.usd_import(filepath=str(path)) == {"FINISHED"}
    finally:
        done.set()
        thread.join()
    assert sum(object.type == "MESH" for object in bpy.data.objects) == 20
    assert set(counts) == {side * side}


def main(folder, order):
    """Import in the order asked for, then check everything."""
    sys.path.insert(0, folder)
    if order == "preloaded":
        preload()
    if order == "after":
        import bpy
        import firetwin_core as core
    else:
        import firetwin_core as core

        check_errors(core, Path(tempfile.mkdtemp()))
        import bpy
    assert Path(core.__file__).parent == Path(folder).resolve(), core.__file__
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        check_errors(core, scratch)
        check_volume(core, bpy, scratch)
        check_image(core, bpy, scratch)
        check_usd(core, bpy, scratch)
        check_errors(core, scratch)
        check_volume(core, bpy, scratch)
    print(f"ok: {Path(core.__file__).name}, Blender {bpy.app.version_string}, {order}", flush=True)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except BaseException:
        import traceback

        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
    os._exit(0)  # Python's own end can hang with `bpy` loaded
