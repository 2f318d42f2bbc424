"""Light of near flames: cards at the flames that burn, with the light of their heat, for lighting alone."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.scene.fire import build as fire
from firetwin.scene.fire import flame_light, flame_volume, flames, lamps
from firetwin.shot.light import exposure
from firetwin.shot.sections import Light
from firetwin.shot.shot import Shot
from firetwin.shot.terrain import noise
from near_fire import FRAMES, moved


def cards(scene, frame, subframe=0.0):
    """Places (n, 3), sizes (n, 3), light (n,), W, and radiance (n,) of the cards in a frame."""
    bpy.data.objects["Firetwin Flame Light"].hide_viewport = False
    scene.frame_set(frame, subframe=subframe)
    graph = bpy.context.evaluated_depsgraph_get()
    thing = bpy.data.objects["Firetwin Flame Light"].evaluated_get(graph)
    geometry = thing.evaluated_geometry()  # owns the points
    parts = geometry.instances_pointcloud()
    count = len(parts.attributes["position"].data) if parts else 0
    if not count:
        return np.empty((0, 3)), np.empty((0, 3)), np.empty(0), np.empty(0)
    radiance = np.empty(count, np.float32)
    parts.attributes["radiance"].data.foreach_get("value", radiance)
    found = [i.matrix_world.copy() for i in graph.object_instances if i.parent == thing]
    size = np.array([m.to_scale()[:] for m in found])
    place = np.array([m.translation[:] for m in found])
    return place, size, radiance * size[:, 0] * size[:, 2] * 4.0 * np.pi, radiance


@pytest.fixture
def amid(close, run):
    """Settings with a camera over the middle of the flames of `close`."""
    shot = Shot(close, run)
    points = flames.front_flames(shot)
    burning = points.position[points.lit(float(shot.frames.first))]
    east, north, _ = burning[np.argsort(burning[:, 0])[len(burning) // 2]]
    latitude, longitude = shot.ground.geodetic(np.array([east]), np.array([north]))
    return moved(close, latitude=float(latitude[0]), longitude=float(longitude[0]), height=60.0)


@pytest.fixture
def lit(amid, run, stage, scene):
    """A scene with a camera among the flames, by day."""
    scene.frame_end = FRAMES
    shot = Shot(amid, run)
    fire.build(shot, stage)
    scene.camera = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    scene.collection.objects.link(scene.camera)
    scene.camera.location = shot.paths[0].position[0]
    return shot


def test_cards_stand_at_burning_flames_and_emit_their_share_of_heat(lit, scene):
    stops = exposure.at(lit, np.array([0.5 * (1 + FRAMES)]))[0]
    thick = flame_light.thick_radiance(stops, 0.0)
    shot, points = lit, flames.front_flames(lit, None, flame_light.LAYOUT)
    away = np.linalg.norm(points.position - shot.paths[0].position[0], axis=1)
    share = 1.0 - noise.smoothstep(*flame_light.REACH, away)
    layers = flame_light.layers(shot, points)
    assert layers.max() > 2.0
    total = []
    for frame in (1, 12, 24):
        time = shot.frames.time(frame)
        place, _, light, radiance = cards(scene, frame)
        burning = np.flatnonzero(
            (flames.life((time - points.arrival_time) / points.residence) > 0) & (share > 0)
        )
        assert len(place) == len(burning) > 10
        most = thick / layers[burning]  # cards of deep flames add up to as much as the picture shows
        assert (radiance <= 1.0001 * most).all()
        thin = radiance < 0.9 * most
        assert thin.sum() > 10
        light *= -np.log1p(-np.minimum(radiance / most, 0.95)) * most / radiance  # of thin flames
        at = burning[thin]
        heat = (
            points.heat[at] * share[at] * flames.life((time - points.arrival_time[at]) / points.residence[at])
        )
        total.append(light[thin].sum() / (flame_volume.RADIATED * flame_light.LIGHT * heat.sum()))
    assert np.array(total) == pytest.approx(1.0, abs=0.1)


def test_flames_flicker_without_jumps_and_the_same_in_any_order(lit, scene):
    light = np.array([cards(scene, 6, part)[2] for part in (0.0, 0.25, 0.5, 0.75)])
    assert np.array_equal(cards(scene, 6, 0.25)[2], light[1])
    later = cards(scene, 20)[2]
    change = np.abs(np.diff(light, axis=0)) / light[:-1]
    assert 0.0 < change.mean() < 0.05
    assert change.max() < 0.3
    if len(later) == len(light[0]):
        assert np.abs(later / light[0] - 1.0).mean() > 2.0 * change.mean()


def test_only_lighting_rays_see_them(lit):
    for name in ("Firetwin Flame Light", "Firetwin Flame Light Card"):
        thing = bpy.data.objects[name]
        assert thing.visible_diffuse
        assert not any((thing.visible_camera, thing.visible_shadow, thing.visible_volume_scatter))
        assert owned.is_ours(thing)
    assert bpy.data.objects["Firetwin Flame Light"].users_collection[0].name == "Firetwin Lamps"


def test_lamps_leave_out_the_heat_of_flames_with_their_own_light(amid, run):
    shot = Shot(amid, run)
    every, far = (lamps.place_lamps(shot, near).heat.sum() for near in ((0.0, 0.0), flame_light.FAR_LAMPS))
    assert far < every
    sources = shot.fire.sources(float(shot.frames.first)).luminous()
    assert shot.visibility.distance(sources.position).min() < flame_light.REACH[1]


@pytest.mark.parametrize("change", ["lamps", "engine", "flames"])
def test_none_are_made_when_off_or_where_they_cannot_light(amid, run, stage, change):
    settings = {
        "lamps": replace(amid, light=Light(lamps=0)),
        "engine": replace(amid, render=replace(amid.render, engine="eevee")),
        "flames": replace(amid, fire=replace(amid.fire, flames=False)),
    }[change]
    fire.build(Shot(settings, run), stage)
    assert "Firetwin Flame Light" not in bpy.data.objects
