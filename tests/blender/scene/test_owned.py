"""Nothing but ours is changed: an inventory of all that is foreign, before and after everything we do."""

from dataclasses import replace

import bpy
import pytest
from firetwin.blender import compat, nodes, owned
from firetwin.render import layers, regrade
from firetwin.scene import build
from firetwin.shot.light.sky import HAZE
from firetwin.shot.shot import Shot

# Properties that the window and Blender change, and derived properties.
_SKIPPED = {
    "storage_type",  # of attributes: how 5.x keeps them at the moment, one value for all or an array
    "rna_type",
    "bl_rna",
    "original",
    "session_uid",
    "is_evaluated",
    "is_runtime_data",
    "tag",
    "depsgraph",
    "preview",
    "library_weak_reference",
    "bl_system_properties_get",
    "is_updated",
    "is_updated_data",
    "firetwin",
    "select",
    "children_recursive",
    "objects_recursive",
    "name_full",
    "id_root",
    "collection_children",  # for light linking: as many as there are children, ours too
    "collection_objects",
}
_NOT_IN_FILES = ("screens", "workspaces", "window_managers")
_DEEPEST = 6
_LONGEST = 500  # of longer lists only the length is compared


def inventory():
    """Describe every foreign data-block: kind, name, library and users, and a digest of its properties."""
    digests = {}
    for prop in bpy.data.bl_rna.properties:
        if prop.type == "COLLECTION" and prop.identifier not in _NOT_IN_FILES:
            for block in getattr(bpy.data, prop.identifier):
                if not owned.is_ours(block) or isinstance(block, bpy.types.Scene):
                    digests[prop.identifier, block.name_full] = digest(block)
    return digests


def foreign_parts(scene):
    """Describe an artist's data in a scene of Firetwin: layers, nodes of the compositor, objects."""
    tree = compat.compositor(scene)
    return {
        "layers": [struct(layer, 0, scene) for layer in scene.view_layers if not owned.is_ours(layer)],
        "nodes": [struct(node, 0, tree) for node in tree.nodes if not owned.is_ours(node)],
        "objects": {thing.name: digest(thing) for thing in scene.objects if not owned.is_ours(thing)},
    }


def digest(block):
    """Describe a data-block, without pointers to data of Firetwin."""
    return {"users": users(block), "keys": keys(block)} | struct(block, 0, block)


def users(block):
    """Count the users; a scene's action counts itself."""
    return block.users if not isinstance(block, bpy.types.Scene) else None


def keys(thing):
    """Custom properties except scene time and the settings of Cycles, which are described separately."""
    names = [name for name in thing.keys() if not name.startswith(("firetwin", "cycles"))]  # noqa: SIM118
    return {name: plain(thing[name]) for name in names}


def plain(value):
    """A value as one that can be compared."""
    if isinstance(value, bpy.types.ID):
        return name_of(value)
    if hasattr(value, "to_dict"):
        return value.to_dict()
    if hasattr(value, "__len__") and not isinstance(value, str | bytes | set):
        return tuple(plain(item) for item in value)
    return frozenset(value) if isinstance(value, set) else value


def name_of(block):
    """Kind and name of a data-block; None for none and for ours."""
    if block is None or owned.is_ours(block):
        return None
    return type(block).__name__, block.name_full


def struct(thing, depth, owner):
    """Describe a structure inside a data-block: all its properties, to some depth."""
    if isinstance(thing, bpy.types.AnimData):
        return animation(thing, depth, owner)
    values = {}
    for prop in thing.bl_rna.properties:
        name = prop.identifier
        if name in _SKIPPED or name.startswith("is_"):
            continue
        try:
            value = getattr(thing, name)
        except (AttributeError, RuntimeError, TypeError):
            continue
        values[name] = told(prop, value, depth, owner)
    return values


def animation(data, depth, owner):
    """Describe the animation of a data-block; empty for animation of Firetwin alone."""
    curves = [struct(curve, depth + 1, owner) for curve in data.drivers if nodes.TIME not in curve.data_path]
    tracks = [track.name for track in data.nla_tracks]
    action = name_of(data.action)
    return {"action": action, "drivers": curves, "tracks": tracks} if action or curves or tracks else None


def told(prop, value, depth, owner):
    """Describe one property."""
    if prop.type == "POINTER":
        return pointed(value, depth, owner)
    if prop.type != "COLLECTION":
        return plain(value) if not getattr(prop, "is_array", False) or len(value) < _LONGEST else len(value)
    if len(value) > _LONGEST:
        return len(value)
    things = [each for each in value if each is not None and not ours_inside(each)]
    if things and isinstance(things[0], bpy.types.ID):
        return sorted(name for each in things if (name := name_of(each)) is not None)
    return [struct(each, depth + 1, owner) for each in things] if depth < _DEEPEST else len(things)


def pointed(value, depth, owner):
    """Describe a pointer property: the name of another data-block or of a node."""
    if value is None:
        return None
    if isinstance(value, bpy.types.ID):
        inside = value.is_embedded_data and value != owner and depth < _DEEPEST
        return struct(value, depth + 1, value) if inside else name_of(value)
    if isinstance(value, bpy.types.Node):
        return value.name
    if isinstance(value, bpy.types.NodeSocket):
        return value.node.name, value.identifier
    return struct(value, depth + 1, owner) if depth < _DEEPEST else type(value).__name__


def ours_inside(thing):
    """Return True for a list item of Firetwin: a node, a view layer, a collection in a view layer."""
    if isinstance(thing, bpy.types.LayerCollection):
        return owned.is_ours(thing.collection)
    return isinstance(thing, bpy.types.Node | bpy.types.ViewLayer) and owned.is_ours(thing)


def our_blocks():
    """Find all data-blocks of Firetwin in the file, by uid."""
    kinds = [prop.identifier for prop in bpy.data.bl_rna.properties if prop.type == "COLLECTION"]
    found = (block for kind in kinds if kind not in _NOT_IN_FILES for block in getattr(bpy.data, kind))
    return {block.session_uid: block for block in found if owned.is_ours(block)}


def our_counts():
    """Count the data-blocks of each kind."""
    kinds = [type(block).__name__ for block in our_blocks().values()]
    return {kind: kinds.count(kind) for kind in kinds}


def compositor_of_somebody(scene):
    tree = compat.new_compositor(scene)
    owned.unmark(tree)
    if not tree.is_embedded_data:
        tree.name = "Mine"
    source, blur = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeBlur")
    tree.links.new(source.outputs[0], blur.inputs[0])
    compat.composite(tree, blur.outputs[0])


@pytest.fixture
def library(shot, tmp_path):
    """A .blend file with a scene of Firetwin."""
    scene = bpy.data.scenes.new("Other")
    build.build(shot, scene, parts=["light", "cameras"])
    path = tmp_path / "library.blend"
    bpy.data.libraries.write(str(path), {scene.collection.children["Firetwin"]}, fake_user=True)
    return path


@pytest.fixture
def busy(library):
    """The current scene of an artist in the middle of work, with a second scene."""
    bpy.ops.wm.read_factory_settings()
    scene = bpy.context.scene
    scene.render.engine, scene.frame_start, scene.frame_end = compat.eevee_id(), 10, 20
    scene.render.resolution_x, scene.view_settings.exposure = 333, 1.5
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 3.0
    compositor_of_somebody(scene)
    mine = bpy.data.collections.new("Mine")
    scene.collection.children.link(mine)
    mine.objects.link(bpy.data.objects.new("Empty", None))
    layer = scene.view_layers.new("Second layer")
    layer.layer_collection.children["Mine"].exclude, layer.samples = True, 5
    scene.keyframe_insert("gravity", frame=1)
    scene["note"] = "mine"
    second = bpy.data.scenes.new("Second")
    second.collection.objects.link(bpy.data.objects["Cube"])
    second.world = bpy.data.worlds.new("Second world")
    with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
        wanted.collections = ["Firetwin"]
    scene.collection.children.link(wanted.collections[0])
    bpy.context.view_layer.update()
    inventory()  # Cycles adds its settings as they are first read
    return scene


def differences(before, after, place=""):
    """List the differences of two digests, as texts."""
    if type(before) is not type(after):
        return [f"{place}: {before!r:.80} -> {after!r:.80}"]
    if isinstance(before, dict):
        pairs = [(name, before.get(name), after.get(name)) for name in {**before, **after}]
    elif isinstance(before, list | tuple) and len(before) == len(after):
        pairs = [(number, *pair) for number, pair in enumerate(zip(before, after, strict=True))]
    else:
        return [] if before == after else [f"{place}: {before!r:.80} -> {after!r:.80}"]
    return [text for name, *pair in pairs for text in differences(*pair, f"{place} {name}")]


def changed(before):
    """List changed foreign data."""
    return differences(before, inventory())


def test_nothing_foreign_changes(busy, shot):
    before = inventory()
    build.build(shot, busy)
    assert owned.has_data(busy)
    assert not owned.is_ours(busy)
    assert not changed(before)
    build.remove(busy)
    assert not changed(before)
    assert not owned.has_data(busy)
    assert not our_blocks()
    assert nodes.TIME not in busy


def test_the_inventory_sees_what_changes(busy):
    tree, world = compat.compositor(busy), busy.world.node_tree
    changes = [
        lambda: setattr(busy, "frame_end", 99),
        lambda: setattr(busy.render, "engine", "CYCLES"),
        lambda: setattr(busy.view_settings, "exposure", 0.0),
        lambda: setattr(busy.cycles, "samples", 77),
        lambda: setattr(busy.view_layers[1].layer_collection.children["Mine"], "exclude", False),
        lambda: setattr(busy.view_layers[0], "samples", 3),
        lambda: setattr(world.nodes["Background"].inputs["Strength"], "default_value", 1.0),
        lambda: tree.links.remove(tree.links[0]),
        lambda: tree.nodes.remove(tree.nodes[0]),
        lambda: setattr(bpy.data.objects["Light"].data, "energy", 1.0),
        lambda: bpy.data.collections["Mine"].objects.unlink(bpy.data.objects["Empty"]),
        lambda: busy.pop("note"),
        lambda: busy.animation_data_clear(),
        lambda: setattr(bpy.data.scenes["Second"], "world", None),
        lambda: bpy.data.libraries.remove(bpy.data.libraries[0]),
    ]
    before = inventory()
    for change in changes:
        change()
        after = inventory()
        assert differences(before, after)
        before = after


def test_an_artists_things_in_our_collections_stay(busy, shot, plain_looks):
    build.build(shot, busy)
    root = next(child for child in busy.collection.children if owned.is_ours(child))
    trees = next(child for child in root.children if owned.is_ours(child, "Forest"))
    own = bpy.data.collections.new("Own")
    root.children.link(own)
    for place in (root, trees, own):
        thing = bpy.data.objects.new(f"In {place.name}", bpy.data.meshes.new("Mesh"))
        place.objects.link(thing)
        thing.location = (1.0, 2.0, 3.0)
    bpy.context.view_layer.update()
    before = inventory()
    build.build(shot, busy)
    assert not changed(before)
    for part in build.PARTS:
        build.build(shot, busy, parts=[part])
        assert not changed(before), part
    counted = our_counts()
    build.remove(busy)
    assert not changed(before)
    assert {"In Firetwin.001", "In Firetwin Forest", "In Own"} <= set(busy.objects.keys()) or {
        "In Firetwin",
        "In Firetwin Forest",
        "In Own",
    } <= set(busy.objects.keys())
    assert our_counts() == {"Collection": 2}  # the two that hold them
    build.build(shot, busy)
    assert our_counts() == counted
    assert not changed(before)


def test_linked_data_of_ours_is_not_ours(busy, shot):
    linked = next(child for child in busy.collection.children if child.library is not None)
    assert owned.MARK in linked
    assert not owned.is_ours(linked)
    assert not owned.has_data(busy)
    override = linked.override_hierarchy_create(busy, busy.view_layers[0])
    for block in (override, *override.all_objects):
        assert block.library is None
        assert owned.MARK in block
        assert not owned.is_ours(block)
    assert not owned.has_data(busy)


def all_of(uids):
    """Describe these data-blocks of Firetwin."""
    blocks = our_blocks()
    assert uids <= set(blocks)
    return {uid: digest(blocks[uid]) for uid in uids}


@pytest.mark.slow
def test_two_scenes_do_not_disturb_each_other(shot, run, plain_ground):
    first, second = (owned.adopt(bpy.data.scenes.new(name)) for name in ("First", "Second"))
    hazy = Shot(replace(shot.settings, light=replace(shot.settings.light, haze=3.0)), run)
    build.build(shot, first.scene)
    layers.build(shot.settings, first)
    uids = {uid for uid, block in our_blocks().items() if block != second.scene}
    shared = {regrade.group().session_uid}  # one group for all scenes of a file
    uids -= {second.root.session_uid} | shared
    before = all_of(uids)
    build.build(hazy, second.scene)
    layers.build(hazy.settings, second)
    assert not differences(before, all_of(uids))
    amounts = [stage.root["haze"].nodes["Extinction"].outputs[0].default_value for stage in (first, second)]
    assert amounts == pytest.approx([HAZE, 3.0 * HAZE])
    build.build(hazy, second.scene, parts=["forest", "light"])
    layers.remove(second.scene)
    build.remove(second.scene)
    assert not differences(before, all_of(uids))
    assert set(our_blocks()) == uids | shared


def test_what_an_artist_adds_to_our_own_scene_stays(scene, stage, shot, plain_looks):
    build.build(shot, scene)
    layers.build(shot.settings, stage)
    tree = compat.compositor(scene)
    blur = tree.nodes.new("CompositorNodeBlur")
    shown = next(node for node in tree.nodes if node.bl_idname == "CompositorNodeGlare")
    tree.links.new(shown.outputs[0], blur.inputs[0])
    scene.view_layers.new("Mine").samples = 3
    scene.collection.objects.link(bpy.data.objects.new("Mine", None))
    bpy.context.view_layer.update()
    before = foreign_parts(scene)
    links, counted = len(tree.links), our_counts()
    for parts in (tuple(build.PARTS), *([part] for part in build.PARTS)):
        build.build(shot, scene, parts=parts)
        layers.build(shot.settings, stage)
        assert foreign_parts(scene) == before
        assert len(compat.compositor(scene).links) == links
        assert our_counts() == counted
    layers.remove(scene)
    build.remove(scene)
    assert [node.name for node in compat.compositor(scene).nodes] == [blur.name]
    assert scene.view_layers.keys() == ["Mine"]
    assert scene.objects.keys() == ["Mine"]
    assert not our_blocks()


def test_an_artists_copy_of_ours_stays(built, shot, plain_looks):
    scene, original = built.scene, built.camera("drone")
    original.name = "First"
    copy = original.copy()
    copy.data = original.data.copy()
    original.users_collection[0].objects.link(copy)
    copy.name = "A copy"
    assert built.camera("drone") == original
    build.build(shot, scene)
    assert "A copy" in scene.objects
    assert built.camera("drone") == original  # with the name that it was given
    assert original.name == "First"
    build.remove(scene)
    assert scene.objects.keys() == ["A copy"]
    assert scene.objects["A copy"].data is not None


def test_what_an_artist_animates_in_our_action_stays(built):
    scene = built.scene
    layers.remove(scene)
    scene.keyframe_insert("gravity", index=2, frame=1)
    build.remove(scene)
    assert {curve.data_path for curve in compat.fcurves(scene)} == {"gravity"}
    assert not our_blocks()


def test_a_scene_that_shares_ours_keeps_it(scene, shot, plain_looks):
    build.build(shot, scene)
    bpy.ops.scene.new(type="LINK_COPY")
    copy = bpy.context.window.scene
    assert copy != scene
    build.remove(copy)
    assert "Firetwin Ground" in scene.objects
    assert "Firetwin Ground" not in copy.objects


def test_a_scene_that_is_gone_is_told_in_one_line(scene, shot):
    steps = build.steps(shot, bpy.data.scenes.new("Short-lived"))
    next(steps)
    bpy.data.scenes.remove(bpy.data.scenes["Short-lived"])
    with pytest.raises(owned.Error, match="the scene is gone"):
        list(steps)
