"""Install the zip of the extension as a user does, film a frame with it, and remove it: ``install.py ZIP``.

Blender's settings, extensions and files are in a separate folder, which is empty before and after.
"""

import importlib
import os
import site
import sys
import tempfile
from collections import Counter
from pathlib import Path

NAME = "bl_ext.user_default.firetwin"
BUNDLED = ("firetwin_core", "astral", "tomlkit", "tqdm", *(["tzdata"] if sys.platform == "win32" else []))
WIDTH, HEIGHT = 64, 36
SCENE = f"""\
run = "run"
time = {{ start = 2014-09-17T23:12:00Z, frames = 1 }}
forest = {{ draw_distance = 500.0 }}
smoke = {{ spin_up = 60.0 }}
render = {{ resolution = [{WIDTH}, {HEIGHT}], samples = 1 }}
[[cameras]]
name = "drone"
keys = [{{ latitude = 38.977, longitude = -120.572, height = 150.0, target = "head" }}]
"""


def keys(bpy):
    """Every shortcut of every key configuration, and the number of equal ones; key maps without any, too."""
    shortcuts = Counter()
    bpy.context.window_manager.keyconfigs.update()
    for config in bpy.context.window_manager.keyconfigs:
        for keymap in config.keymaps:
            place = (config.name, keymap.name, keymap.space_type, keymap.region_type)
            shortcuts[place] += 1
            shortcuts.update((*place, item.idname, item.to_string()) for item in keymap.keymap_items)
    return set(shortcuts.items())


def state(bpy):
    """Traces that an add-on could leave in Blender."""
    import addon_utils

    def names(things):
        return {name for name in dir(things) if not name.startswith("__")}

    handlers = {
        (name, function.__module__)
        for name in dir(bpy.app.handlers)
        if isinstance(found := getattr(bpy.app.handlers, name), list)
        for function in found
    }
    return {
        "classes": names(bpy.types),
        "scene properties": names(bpy.types.Scene),
        "object properties": names(bpy.types.Object),
        "window properties": names(bpy.types.WindowManager),
        "operators": set(dir(bpy.ops.firetwin)),
        "handlers": handlers,
        "keys": keys(bpy),
        "add-ons": {addon.module for addon in bpy.context.preferences.addons},
        "known add-ons": {module.__name__ for module in addon_utils.modules()},
        "modules": {name for name in sys.modules if name.startswith("bl_ext.")},
    }


def files(folder):
    """Every file below, but for Blender's own notes about its folders."""
    return {
        str(path.relative_to(folder))
        for path in Path(folder).rglob("*")
        if path.is_file() and ".cache" not in path.parts and path.name != ".gitignore"
    }


def same(before, after):
    """Nothing more and nothing less than before."""
    for what, names in before.items():
        assert after[what] == names, f"{what}: left behind {after[what] - names}, gone {names - after[what]}"


def work_here(work, progress, tell=print, **_):
    """Do a worker's work in this process: Blender as a module cannot start another with its extensions."""
    return work(progress=progress, tell=tell)


def use(bpy, folder):
    """Write the sample run, film a frame of it, and build the same scene, with the installed package."""
    cli = importlib.import_module(NAME + ".cli")
    importlib.import_module(NAME + ".jobs.worker").run = work_here
    (folder / "scene.toml").write_text(SCENE)
    assert cli.main(["sample", str(folder / "run"), "--frames", "3"]) == 0
    assert cli.main(["info", str(folder / "missing")]) == 1
    assert cli.main(["render", str(folder / "scene.toml"), "--out", str(folder / "film")]) == 0
    pictures = sorted((folder / "film").rglob("*.png"))
    assert pictures, "no picture was rendered"
    for path in pictures:
        picture = bpy.data.images.load(str(path))
        assert tuple(picture.size) == (WIDTH, HEIGHT)
        tones = {round(value, 3) for value in picture.pixels[:][::4]}
        assert len(tones) > 20, f"{path.name} has {len(tones)} tones of red"
        print(f"rendered: {path.relative_to(folder)}, {path.stat().st_size} bytes, {len(tones)} tones of red")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module=NAME)
    shot = importlib.import_module(NAME + ".shot.source").ShotSource(str(folder / "scene.toml")).shot()
    importlib.import_module(NAME + ".scene.build").build(shot)
    assert [object for object in bpy.data.objects if object.type == "CAMERA"]
    assert sum(len(mesh.vertices) for mesh in bpy.data.meshes) > 1000


def check_places(resources):
    """The code that runs is the installed one."""
    package = Path(sys.modules[NAME].__file__)
    assert package.is_relative_to(resources / "extensions/user_default/firetwin"), package
    for name in BUNDLED:
        place = Path(importlib.import_module(name).__file__)
        assert place.is_relative_to(resources / "extensions/.local"), place
        print(f"{name}: {place.relative_to(resources)}")


def scratch():
    """Make a temporary folder; Windows keeps files in it that are mapped or loaded until Blender ends."""
    return tempfile.TemporaryDirectory(ignore_cleanup_errors=True)


def cycle(bpy, zipped, resources, disable_first):
    """Install, use, disable, enable, and uninstall."""
    clean, clean_files = state(bpy), files(resources)
    repository = "user_default"
    done = bpy.ops.extensions.package_install_files(filepath=zipped, repo=repository, enable_on_install=True)
    assert done == {"FINISHED"}
    assert NAME in bpy.context.preferences.addons
    assert "FIRETWIN" in " ".join(dir(bpy.types))
    check_places(resources)
    new = sorted(files(resources) - clean_files)
    size = sum((resources / name).stat().st_size for name in new)
    print(f"installed: {len(new)} files, {size} bytes")
    with scratch() as folder:
        use(bpy, Path(folder))
    bpy.ops.wm.read_factory_settings(use_empty=True)  # switches add-ons off, as a new start does
    assert bpy.ops.preferences.addon_enable(module=NAME) == {"FINISHED"}
    assert bpy.ops.preferences.addon_disable(module=NAME) == {"FINISHED"}
    off = state(bpy)
    same(clean | {what: off[what] for what in ("known add-ons", "modules")}, off)
    if not disable_first:
        assert bpy.ops.preferences.addon_enable(module=NAME) == {"FINISHED"}
    index = [place.module for place in bpy.context.preferences.extensions.repos].index(repository)
    bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="firetwin")
    after = state(bpy)
    # Blender forgets the modules of an extension that is uninstalled while it is on, and only of such a one.
    same(clean | ({"modules": after["modules"]} if disable_first else {}), after)
    left = files(resources) - clean_files
    if sys.platform == "win32":  # Blender marks loaded libraries, and removes them at its next start
        left = {name for name in left if "stale" not in name}
    assert not left, f"files left behind: {sorted(left)}"
    print("uninstalled: no file, class, property, operator, handler or key is left")


def main(zipped):
    """Two rounds: uninstalled while on, and after it was switched off."""
    with scratch() as resources:
        os.environ["BLENDER_USER_RESOURCES"] = resources
        import bpy
        import numpy as np  # noqa: F401

        # Blender's executable has only its packages and packages of extensions.
        here = str(Path(bpy.__file__).parents[1])
        sys.path[:] = [place for place in sys.path if place not in {here, *site.getsitepackages()}]
        print(f"Blender {bpy.app.version_string}, Python {sys.version.split()[0]}")
        bpy.ops.wm.read_factory_settings(use_empty=True)
        for disable_first in (False, True):
            cycle(bpy, os.path.abspath(zipped), Path(resources), disable_first)
        sys.stdout.flush()


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except BaseException:
        import traceback

        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
    os._exit(0)  # Python's own end can hang with `bpy` loaded
