"""Camera targets: look-at empties and path curves, which artists can edit."""

from __future__ import annotations

import itertools

import bpy
import numpy as np
from mathutils import Vector, geometry

from ..blender import compat, owned
from ..errors import Error
from ..scene.camera import ground_raycast, read_edits
from ..shot.cameras import sparse_keys, targets
from . import go_to, navigation, scene_file
from .job import InThread, Steps
from .working import Working, report_errors

AIM, PATH = "Firetwin Aim", "Firetwin Path"  # names of the constraints
_TARGETS = (
    ("head", "Head of the fire", "Part of the front with the highest rate of spread, in every frame"),
    ("fire", "Centre of the fire", "Centre of the burning terrain, in every frame"),
    ("point", "Ground in the view", "Terrain in the centre of this view"),
    ("station", "Place", "A place by name or coordinates; empty: the text of Go to"),
    ("object", "Active object", "Active object, such as a label"),
    ("none", "Nothing", "Remove the target; the camera's own keys set its direction"),
)
_ABOVE = 100.0  # m, height of a target above burning ground
_CLOSE = 1.0  # m, tolerance of a target's keyframes


class FIRETWIN_OT_camera_aim(Working, bpy.types.Operator):
    """Add an empty as the look-at target of the scene's camera: the fire, a point or a place"""

    bl_idname = "firetwin.camera_aim"
    bl_label = "Point camera at"
    bl_options = {"REGISTER", "UNDO"}

    target: bpy.props.EnumProperty(name="Target", description="Look-at target of the camera", items=_TARGETS)
    place: bpy.props.StringProperty(
        name="Place", description="Name or coordinates of the place to look at", options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return navigation.can_navigate(cls, context) and navigation.has_editable_camera(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Find the target, then create the empty and the constraint."""
        scene, target, at = context.scene, self.target, self.place or context.scene.firetwin.go_to
        uid, name, other = scene.session_uid, scene.camera.name, context.active_object
        way = None
        if target == "point":
            matrix = navigation.camera_from_view(context)[0]
            place, turn = read_edits.matrix_pose(matrix)
            met = ground_raycast.cast_ray(owned.stage(scene), place, -turn[:, 2])
            way = np.array([met if met is not None else place - 2000.0 * turn[:, 2]])
        elif target == "station":
            met = go_to.find_position(scene, at)
            if met is None:
                raise Error(f'no place is called "{at}"; choose one from the list, or type coordinates')
            way = np.array([met])
        elif target in targets.MOVING:
            chosen = scene_file.shot_source(scene.firetwin)
            shot = yield InThread("reading the run", lambda **_: chosen.shot())
            yield "finding the fire"
            way = targets.follow(target, shot.bare_ground, shot.frames.times, _ABOVE)
        yield "turning the camera"
        scene = owned.scene(uid)
        obj = scene.objects[name]
        _remove_constraint(obj, AIM)
        if target == "none":
            return f"{name} looks in the direction of its keys"
        empty = other
        if target != "object":
            assert way is not None
            empty = create_moving_empty(scene, f"Aim at {at if target == 'station' else target}", way)
        if empty is None or empty == obj:
            return "Select another object as the target first"
        hook = obj.constraints.new("TRACK_TO")
        hook.name, hook.target = AIM, empty
        hook.track_axis, hook.up_axis = "TRACK_NEGATIVE_Z", "UP_Y"
        return f"{name} looks at {empty.name}"


def create_moving_empty(scene: bpy.types.Scene, name: str, way: np.ndarray) -> bpy.types.Object:
    """Create an empty, owned by the artist, that follows a path (frames, 3) with few keyframes."""
    empty = bpy.data.objects.new(name, None)
    empty.empty_display_type, empty.empty_display_size = "SPHERE", 100.0
    scene.collection.objects.link(empty)
    empty.location = way[0]
    if len(way) > 1:
        kept, slopes = sparse_keys.keys(way, _CLOSE)
        for axis in range(3):
            compat.animate_smoothly(empty, "location", axis, kept + 1, way[kept, axis], slopes[:, axis])
        owned.unmark(empty.animation_data.action)
    return empty


def _remove_constraint(obj: bpy.types.Object, name: str) -> None:
    for each in [constraint for constraint in obj.constraints if constraint.name == name]:
        obj.constraints.remove(each)


class FIRETWIN_OT_camera_path(bpy.types.Operator):
    """Draw the path of the scene's camera as a curve, or make it follow the selected curve.

    The curve can be edited. The position along it is keyed on the constraint "Firetwin Path"
    """

    bl_idname = "firetwin.camera_path"
    bl_label = "Draw camera path"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not navigation.can_navigate(cls, context) or not navigation.has_editable_camera(cls, context):
            return False
        if context.scene.camera.constraints.get(PATH):
            cls.poll_message_set("The camera follows a curve: edit the curve, or remove the constraint")
            return False
        return True

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        scene, obj, chosen = context.scene, context.scene.camera, context.active_object
        if chosen is not None and chosen.type == "CURVE" and chosen.select_get():
            curve, factors = chosen, {1: 0.0, scene.firetwin.frames: 1.0}
        else:
            keyed = _keyed_positions(obj)
            if len(keyed) < 2:
                self.report({"WARNING"}, "Set two keys of the camera, or select a curve, first")
                return {"CANCELLED"}
            curve, factors = _draw_curve(scene, obj, keyed)
        curve.data.use_path = True
        compat.remove_fcurves(obj, ("location",))
        obj.location = (0.0, 0.0, 0.0)
        hook = obj.constraints.new("FOLLOW_PATH")
        hook.name, hook.target, hook.use_fixed_location = PATH, curve, True
        obj.constraints.move(len(obj.constraints) - 1, 0)
        for frame, factor in factors.items():
            hook.offset_factor = factor
            obj.keyframe_insert(f'constraints["{PATH}"].offset_factor', frame=frame)
        self.report({"INFO"}, f"{obj.name} follows {curve.name}")
        return {"FINISHED"}


def _keyed_positions(obj: bpy.types.Object) -> dict[int, Vector]:
    """Return positions of a camera at the frames of its location keyframes."""
    curves = [curve for curve in compat.fcurves(obj) if curve.data_path == "location"]
    frames = sorted({round(point.co[0]) for curve in curves for point in curve.keyframe_points})
    at = {curve.array_index: curve for curve in curves}
    return {f: Vector(at[i].evaluate(f) if i in at else obj.location[i] for i in range(3)) for f in frames}


def _draw_curve(
    scene: bpy.types.Scene, obj: bpy.types.Object, keyed: dict[int, Vector]
) -> tuple[bpy.types.Object, dict[int, float]]:
    """Create a curve through points; also return the camera's offset along it at their frames."""
    data = bpy.data.curves.new(f"Path of {obj.name}", "CURVE")
    data.dimensions, data.resolution_u = "3D", 32
    spline = data.splines.new("BEZIER")
    spline.bezier_points.add(len(keyed) - 1)
    for point, place in zip(spline.bezier_points, keyed.values(), strict=True):
        point.co = place
        point.handle_left_type = point.handle_right_type = "AUTO"
    curve = bpy.data.objects.new(data.name, data)
    scene.collection.objects.link(curve)
    scene.view_layers[0].update()  # to evaluate the "AUTO" handles
    points, length = spline.bezier_points, [0.0]
    for a, b in itertools.pairwise(points):
        steps = geometry.interpolate_bezier(a.co, a.handle_right, b.handle_left, b.co, 65)
        length.append(length[-1] + sum((q - p).length for p, q in itertools.pairwise(steps)))
    return curve, {frame: at / (length[-1] or 1.0) for frame, at in zip(keyed, length, strict=True)}


classes = (FIRETWIN_OT_camera_aim, FIRETWIN_OT_camera_path)
