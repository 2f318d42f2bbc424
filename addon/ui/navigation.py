"""Cameras from the 3D view: new cameras, keyframes at the view's position, and lenses."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..blender import compat, owned
from ..scene.camera import ground_raycast, read_edits
from ..shot.cameras import rigs, rotation
from ..shot.cameras.lenses import LENSES
from ..shot.cameras.rigs._view import View
from ..shot.settings import Camera
from . import camera_edits, camera_list, job, keys, panel_state, run, scene_file, working
from .job import InThread, Message, Steps
from .sidebar import SidebarPanel
from .working import Working

_AHEAD = 2000.0  # m, distance of the view's target if its ray misses the terrain
_SENSOR = 36.0  # mm, sensor width assumed for a view

_kinds: list[tuple[str, str, str]] = []  # Blender does not hold a reference to these texts


def find_view(context: bpy.types.Context) -> bpy.types.SpaceView3D | None:
    """Return the 3D view whose sidebar was clicked, or one of the window; None without any."""
    if context.space_data is not None and context.space_data.type == "VIEW_3D":
        return context.space_data
    areas = context.window.screen.areas if context.window is not None else ()
    return next((area.spaces.active for area in areas if area.type == "VIEW_3D"), None)


def camera_from_view(context: bpy.types.Context) -> tuple[Matrix, float, float]:
    """Return the 3D view as a camera: matrix, and focal length and sensor (mm) of the same field of view."""
    shown, camera = find_view(context), context.scene.camera
    region = shown.region_3d if shown is not None else None  # the sidebar's region has none
    if shown is None or region is None or (region.view_perspective == "CAMERA" and camera is not None):
        return camera.matrix_world.copy(), camera.data.lens, camera.data.sensor_width
    matrix = region.view_matrix.inverted()
    if region.view_perspective == "ORTHO":
        matrix.translation = region.view_location + matrix.col[2].to_3d() * region.view_distance
        return matrix, shown.lens, 2.0 * _SENSOR
    return matrix, 0.5 * _SENSOR * region.window_matrix[0][0], _SENSOR


def create_view(stage: owned.Stage, matrix: Matrix, lens: float, sensor: float) -> View:
    """Create the view of this camera, from which rigs are created."""
    frame = read_edits.built_frame(stage)
    place, turn = read_edits.matrix_pose(matrix)
    met = ground_raycast.cast_ray(stage, place, -turn[:, 2])
    flat = Vector((-turn[0, 2], -turn[1, 2], 0.0))
    ahead = Vector(place) + (flat.normalized() if flat.length > 0.0 else flat) * _AHEAD
    aim = np.array(ahead if met is None else met)
    (latitude, to_latitude), (longitude, to_longitude), (height, _) = frame.reverse(np.array([place, aim]))
    under = ground_raycast.terrain_height(stage, place)
    return View(
        float(latitude),
        float(longitude),
        float(height),
        max(float(place[2] - (under or 0.0)), 1.0),
        *rotation.angles(frame, place, turn),
        (float(to_latitude), float(to_longitude)),
        float(np.hypot(*(aim - place)[:2])),
        float(place[2] - aim[2]),
        round(lens, 3),
        round(sensor, 3),
    )


def can_navigate(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether there is a built scene to navigate; otherwise set the poll message."""
    if not working.is_editable(cls, context):
        return False
    return panel_state.require(cls, context)


def has_editable_camera(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether the scene has an editable camera; otherwise set the poll message."""
    if not working.is_editable(cls, context):
        return False
    obj = context.scene.camera
    if obj is None or obj.type != "CAMERA":
        cls.poll_message_set("Add a camera first")
        return False
    if obj.library is not None or obj.data.library is not None:
        cls.poll_message_set("This camera is linked from another file: change it there, or make it local")
        return False
    return True


def kind_items(self: object, context: bpy.types.Context) -> list[tuple[str, str, str]]:
    """Return the kinds of camera; the kind with exactly the view's pose comes first."""
    names = sorted(rigs.kinds(), key=lambda name: name != "poses")
    _kinds[:] = [(name, keys.label(name), _first_line(rigs.kinds()[name])) for name in names]
    return _kinds


def _first_line(kind: type) -> str:
    return (kind.__doc__ or "").strip().partition("\n")[0].rstrip(".")


class FIRETWIN_OT_camera_add(Working, bpy.types.Operator):
    """Add a camera with the frustum of this view"""

    bl_idname = "firetwin.camera_add"
    bl_label = "Add camera from view"
    bl_options = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(name="Kind", description="Kind of camera", items=kind_items)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_navigate(cls, context) and run.is_ready(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Add the camera's settings, then rebuild the cameras."""
        from ..scene import build

        scene, kind = context.scene, self.kind
        uid, stage = scene.session_uid, owned.stage(scene)
        for text in camera_edits.read_camera_edits(scene):
            yield Message(text, "WARNING")
        rig = rigs.kinds()[kind].from_view(create_view(stage, *camera_from_view(context)))
        taken = {item.name for item in scene.firetwin.cameras}
        name = next(name for n in range(1, 1000) if (name := kind if n == 1 else f"{kind}{n}") not in taken)
        item = camera_list.add(scene.firetwin, Camera(name, rig))
        try:
            chosen = scene_file.shot_source(scene.firetwin)
            shot = yield InThread("reading the run", lambda **_: chosen.shot())
        except Exception:
            panel = owned.scene(uid).firetwin
            panel.cameras.remove(panel.cameras.find(item.name))
            raise
        yield from build.steps(shot, owned.scene(uid), ("cameras",))
        scene = owned.scene(uid)
        scene.camera = owned.stage(scene).camera(name)
        return f'Added the camera "{name}"; rebuild the scene to add trees and fine terrain in its frustum'


class FIRETWIN_OT_camera_key(bpy.types.Operator):
    """Key the scene's camera at this frame with the position of this view (after Walk or Fly, for example).

    The camera is raised to its clearance above the terrain
    """

    bl_idname = "firetwin.camera_key"
    bl_label = "Set camera key"
    bl_options = {"REGISTER", "UNDO"}

    clearance: bpy.props.FloatProperty(
        name="Clearance",
        description="Minimum height above the terrain",
        default=10.0,
        min=0.0,
        unit="LENGTH",
    )
    lens: bpy.props.BoolProperty(name="Lens too", description="Key the focal length too", default=False)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not can_navigate(cls, context) or not has_editable_camera(cls, context):
            return False
        obj = context.scene.camera
        if any(constraint.type == "FOLLOW_PATH" for constraint in obj.constraints) or obj.parent:
            cls.poll_message_set("The camera follows a curve or has a parent: move that object instead")
            return False
        return True

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        scene, obj = context.scene, context.scene.camera
        stage, matrix = owned.stage(scene), camera_from_view(context)[0]
        lifted = ground_raycast.clearance_offset(stage, matrix.translation, self.clearance)
        turn = matrix.to_quaternion()
        if obj.rotation_mode == "QUATERNION":
            turn.make_compatible(obj.rotation_quaternion)
        else:
            compat.remove_fcurves(obj, ("rotation_euler", "rotation_axis_angle"))
            obj.rotation_mode = "QUATERNION"
        obj.location = matrix.translation + Vector((0.0, 0.0, lifted))
        obj.rotation_quaternion = turn
        turned = () if obj.constraints else ("rotation_quaternion",)  # the target constraint rotates it
        for name in ("location", *turned):
            obj.keyframe_insert(name, frame=scene.frame_current)
        if self.lens:
            obj.data.keyframe_insert("lens", frame=scene.frame_current)
        words = f"Keyed {obj.name} at frame {scene.frame_current}"
        self.report({"INFO"}, words + (f", {lifted:,.0f} m higher than the view" if lifted else ""))
        self._warn(stage, obj)
        return {"FINISHED"}

    def _warn(self, stage: owned.Stage, obj: bpy.types.Object) -> None:
        """Warn about frames between keyframes in which the terrain is too close."""
        frames = stage.scene.firetwin.frames
        size = stage.scene.render.resolution_x, stage.scene.render.resolution_y
        places = read_edits.evaluate_path(stage.scene, obj, frames, size).place
        short = [ground_raycast.clearance_offset(stage, place, self.clearance) for place in places]
        if max(short) > 0.5:
            worst = int(np.argmax(short))
            self.report(
                {"WARNING"},
                f"In frame {worst + 1} the path is {max(short):,.0f} m too low: set a key there too",
            )


class FIRETWIN_OT_camera_lens(bpy.types.Operator):
    """Set lens and sensor of the scene's camera to a drone, thermal or film camera"""

    bl_idname = "firetwin.camera_lens"
    bl_label = "Set lens and sensor"
    bl_options = {"REGISTER", "UNDO"}

    preset: bpy.props.EnumProperty(
        name="Lens",
        description="Lens and sensor",
        items=tuple((name, each.name, each.about) for name, each in LENSES.items()),
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip."""
        return LENSES[properties.preset].about

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not has_editable_camera(cls, context):
            return False
        if context.scene.camera.data.type != "PERSP":
            cls.poll_message_set("Choose a perspective camera as the scene's camera first")
            return False
        return True

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        data, lens = context.scene.camera.data, LENSES[self.preset]
        compat.remove_fcurves(data, ("lens",))
        data.sensor_fit = "HORIZONTAL"
        data.lens, data.sensor_width = lens.focal_length, lens.sensor_width
        return {"FINISHED"}


class FIRETWIN_MT_lenses(bpy.types.Menu):
    """Lenses and sensors of drones, thermal cameras and film cameras"""

    bl_idname = "FIRETWIN_MT_lenses"
    bl_label = "Lens and Sensor"

    def draw(self, context: bpy.types.Context) -> None:
        for name, each in LENSES.items():
            self.layout.operator(FIRETWIN_OT_camera_lens.bl_idname, text=each.name).preset = name


class FIRETWIN_PT_flying(SidebarPanel, bpy.types.Panel):
    """Manual camera work from this view"""

    bl_idname = "FIRETWIN_PT_flying"
    bl_label = "Camera by Hand"
    bl_parent_id = "FIRETWIN_PT_cameras"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return panel_state.is_built(context.scene)

    def draw(self, context: bpy.types.Context) -> None:
        layout, scene = self.layout, context.scene
        column = layout.column()
        column.enabled = job.Job.current is None
        column.operator_menu_enum(
            FIRETWIN_OT_camera_add.bl_idname, "kind", text="Add camera from view", icon="OUTLINER_OB_CAMERA"
        )
        column.prop(scene, "camera", text="")
        row = column.row(align=True)
        row.operator_context = "INVOKE_REGION_WIN"  # the sidebar is not a view
        row.operator("firetwin.fly", text="Walk", icon="VIEW_PAN").mode = "walk"
        row.operator("firetwin.fly", text="Fly", icon="ORIENTATION_GIMBAL").mode = "fly"
        column.operator(FIRETWIN_OT_camera_key.bl_idname, text="Set key here", icon="KEY_HLT")
        row = column.row(align=True)
        row.operator_menu_enum("firetwin.camera_aim", "target", text="Look at", icon="CON_TRACKTO")
        row.operator("firetwin.camera_path", text="Draw path", icon="CON_FOLLOWPATH")
        column.menu("FIRETWIN_MT_named", icon="TRACKER")
        column.menu(FIRETWIN_MT_lenses.bl_idname, icon="CAMERA_DATA")
        row = column.row(align=True)
        row.prop(scene.firetwin, "go_to", text="", icon="VIEWZOOM", placeholder="38.82 -120.55")
        row.operator("firetwin.go", text="", icon="FORWARD").smooth = scene.firetwin.go_smoothly
        row.menu("FIRETWIN_MT_go", text="", icon="DOWNARROW_HLT")


classes = (
    FIRETWIN_OT_camera_add,
    FIRETWIN_OT_camera_key,
    FIRETWIN_OT_camera_lens,
    FIRETWIN_MT_lenses,
    FIRETWIN_PT_flying,
)
