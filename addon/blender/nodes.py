"""Node tree builder: arithmetic on sockets, with lookup by name.

ground, tree = nodes.material("Firetwin Ground", (0.30, 0.26, 0.17))
colour = tree.input("Ember Colour", (1.0, 0.11, 0.012), "Spots that glow in the ash", "Fire")
with tree.frame("Embers"):
    age = nodes.model_time(tree) - tree.attribute("arrival_time")
    embers = (age / -3600.0).exp()
tree.surface(nodes.thermal_switch(tree, tree.emission(colour, embers), radiance))

A material is one group node with named inputs and tooltips. The nodes in the group are laid out in frames.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from . import compat, layout, owned
from .node_updates import DeferredUpdates

Inputs = Mapping[str, Any] | Mapping[int, Any] | Mapping[str | int, Any] | Sequence[Any]

TIME = "firetwin_time"
THERMAL = "firetwin_thermal"
MASKS = "firetwin_masks"
SURFACE = "Firetwin Surface"
FLAMES = "Firetwin Flames"
WARMTH = "Firetwin Warmth"
"""AOVs of solid surfaces, see `thermal_switch`; and of flames, see `flames`. Those of all flames in front of
a solid surface add up, without mutual attenuation (Cycles 4.5)."""
FIRE = "Firetwin Fire"
"""Light group of all objects that write the flames' AOVs."""
SUN, FIRELIGHT = "Firetwin Sun", "Firetwin Firelight"
"""Light groups of the sun, and of the lamps of the fire."""
GLOW = "Firetwin Glow"
"""AOV of the radiance that flames and embers on surfaces emit to the camera, dimmed by haze."""
_SAME_SOCKETS = frozenset(
    f"ShaderNode{name}"
    for name in ("AddShader", "Attribute", "CombineXYZ", "Emission", "MixShader", "SeparateXYZ", "TexNoise")
) | {"NodeGroupInput"}
"""Kinds of nodes whose sockets can be looked up by name before an update."""


class Value:
    """An output socket with arithmetic; every operation adds a Math node to its tree."""

    def __init__(self, tree: Tree, socket: bpy.types.NodeSocket) -> None:
        self.tree, self.socket = tree, socket

    def __add__(self, other: Any) -> Value:
        return self.tree.math("ADD", self, other)

    def __radd__(self, other: Any) -> Value:
        return self.tree.math("ADD", other, self)

    def __sub__(self, other: Any) -> Value:
        return self.tree.math("SUBTRACT", self, other)

    def __rsub__(self, other: Any) -> Value:
        return self.tree.math("SUBTRACT", other, self)

    def __mul__(self, other: Any) -> Value:
        return self.tree.math("MULTIPLY", self, other)

    def __rmul__(self, other: Any) -> Value:
        return self.tree.math("MULTIPLY", other, self)

    def __truediv__(self, other: Any) -> Value:
        return self.tree.math("DIVIDE", self, other)

    def __rtruediv__(self, other: Any) -> Value:
        return self.tree.math("DIVIDE", other, self)

    def __neg__(self) -> Value:
        return self.tree.math("MULTIPLY", self, -1.0)

    def __gt__(self, other: Any) -> Value:
        return self.tree.math("GREATER_THAN", self, other)

    def __lt__(self, other: Any) -> Value:
        return self.tree.math("LESS_THAN", self, other)

    def exp(self) -> Value:
        """Raise Euler's number to this value."""
        return self.tree.math("EXPONENT", self)

    def power(self, exponent: Any) -> Value:
        """Raise this value to the power of `exponent`."""
        return self.tree.math("POWER", self, exponent)

    def clamp(self) -> Value:
        """Clamp this value between 0 and 1."""
        return self.tree.math("ADD", self, 0.0, clamp=True)

    def smoothstep(self, low: Any, high: Any) -> Value:
        """Interpolate smoothly from 0 below `low` to 1 above `high`, or the reverse if high < low."""
        return self.tree.output(
            "ShaderNodeMapRange",
            {"Value": self, "From Min": low, "From Max": high, "To Min": 0.0, "To Max": 1.0},
            interpolation_type="SMOOTHSTEP",
        )

    def ramp(self, low: Any, high: Any, start: Any = 0.0, end: Any = 1.0) -> Value:
        """Interpolate linearly from `start` at `low` to `end` at `high`, clamped outside."""
        return self.tree.output(
            "ShaderNodeMapRange",
            {"Value": self, "From Min": low, "From Max": high, "To Min": start, "To Max": end},
            clamp=True,
        )


class Tree:
    """A node tree under construction; inputs may be sockets, nodes, `Value`s or numbers.

    The tree of a material is the group that `material` uses; Blender updates it when `finish` is called.
    """

    def __init__(self, node_tree: bpy.types.NodeTree, material: bpy.types.Material | None = None) -> None:
        self.node_tree, self.material = node_tree, material
        self._frame: bpy.types.Node | None = None
        self._deferred = DeferredUpdates() if material is not None else None

    @contextmanager
    def frame(self, label: str) -> Iterator[None]:
        """Put nodes added during a `with` block into a frame with this label; frames can be nested."""
        before, self._frame = self._frame, self._new("NodeFrame")
        self._frame.label = label
        try:
            yield
        finally:
            self._frame = before

    def input(
        self,
        name: str,
        default: float | Sequence[float],
        help: str,
        panel: str = "",
        least: float | None = 0.0,
        most: float | None = None,
    ) -> Value:
        """Return an input of this group, created on first use: a number, integer, or colour (3 or 4 values).

        Parameters
        ----------
        help
            One line for the tooltip, without trailing period.
        panel
            Name of the panel that shows the input.
        least, most
            Bounds of a number; None for no bound.
        """
        interface = self.node_tree.interface
        if not any(_is_input(item, name) for item in interface.items_tree):
            parent = next((item for item in interface.items_tree if _is_panel(item, panel)), None)
            if panel and parent is None:
                parent = self._change(interface.new_panel, panel)
            shade = (*default, 1.0)[:4] if isinstance(default, Sequence) else None
            kind = f"NodeSocket{'Color' if shade else 'Int' if isinstance(default, int) else 'Float'}"
            about = {"description": help, "in_out": "INPUT", "socket_type": kind, "parent": parent}
            made = self._change(functools.partial(interface.new_socket, name, **about))
            self._change(setattr, made, "default_value", shade or default)
            for bound, value in (("min_value", least), ("max_value", most)):
                if value is not None and not shade:
                    self._change(setattr, made, bound, value)
        return self.output("NodeGroupInput", name=name)

    def node(self, kind: str, inputs: Inputs = (), **properties: Any) -> bpy.types.Node:
        """Add a node: first its properties, then its inputs by name (or in order)."""
        node = self._new(kind)
        for name, value in properties.items():
            if getattr(node, name) != value:  # Blender updates the complete tree after every change
                self._change(setattr, node, name, value)
        if self._deferred and _shows_sockets_late(kind, inputs, properties):
            self.node_tree.interface_update(bpy.context)
        pairs = inputs.items() if isinstance(inputs, Mapping) else enumerate(inputs)
        for socket, value in pairs:
            self.connect(value, compat.find_socket(node.inputs, socket))
        return node

    def _new(self, kind: str) -> bpy.types.Node:
        """Add a node to the current frame.

        Blender numbers nodes of one name one by one, in a time that grows with the square of their number.
        """
        node = self._change(self.node_tree.nodes.new, kind)
        if node.name[-4:-3] == ".":
            self._change(setattr, node, "name", f"{node.name[:-4]} {len(self.node_tree.nodes)}")
        if self._frame is not None and kind != "NodeFrame":
            self._change(setattr, node, "parent", self._frame)
        return node

    def _change(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function that changes the tree; the tree of a material is not updated yet."""
        return self._deferred.change(function, *arguments) if self._deferred else function(*arguments)

    def output(
        self,
        kind: str,
        inputs: Inputs = (),
        name: str | int = 0,
        **properties: Any,
    ) -> Value:
        """Add a node and return one of its outputs, by default the first."""
        return self.pick(self.node(kind, inputs, **properties), name)

    def pick(self, node: bpy.types.Node, name: str | int = 0) -> Value:
        """Return an output of a node."""
        return Value(self, compat.find_socket(node.outputs, name))

    def connect(self, value: Any, socket: bpy.types.NodeSocket) -> None:
        """Link an output to an input socket, or set the input's constant."""
        if isinstance(value, Value):
            value = value.socket
        elif isinstance(value, bpy.types.Node):
            value = compat.find_socket(value.outputs, 0)
        if isinstance(value, bpy.types.NodeSocket):
            self._change(self.node_tree.links.new, value, socket)
            return
        if socket.type == "RGBA" and isinstance(value, Sequence):
            value = (*value[:3], 1.0)
        known = socket.default_value
        same = tuple(known) == tuple(value) if hasattr(value, "__len__") else known == value
        if not same:
            self._change(setattr, socket, "default_value", value)

    def math(self, operation: str, *operands: Any, clamp: bool = False) -> Value:
        """Add a Math node."""
        return self.output("ShaderNodeMath", operands, operation=operation, use_clamp=clamp)

    def vector(self, operation: str, *operands: Any, name: str | int = 0) -> Value:
        """Add a Vector Math node."""
        return self.output("ShaderNodeVectorMath", operands, name, operation=operation)

    def separate(self, vector: Any) -> tuple[Value, Value, Value]:
        """Separate a vector into x, y and z."""
        node = self.node("ShaderNodeSeparateXYZ", [vector])
        return self.pick(node, "X"), self.pick(node, "Y"), self.pick(node, "Z")

    def combine(self, x: Any, y: Any, z: Any) -> Value:
        """Combine components into a vector."""
        return self.output("ShaderNodeCombineXYZ", [x, y, z])

    def mix(self, factor: Any, a: Any, b: Any) -> Value:
        """Mix two numbers: a at factor 0, b at factor 1."""
        return self.output("ShaderNodeMix", {0: factor, 1: a, 2: b}, data_type="FLOAT", clamp_factor=True)

    def mix_colour(self, factor: Any, a: Any, b: Any, blend: str = "MIX") -> Value:
        """Mix two colours: a at factor 0, b at factor 1."""
        inputs = {0: factor, 1: a, 2: b}
        return self.output("ShaderNodeMix", inputs, data_type="RGBA", blend_type=blend, clamp_factor=True)

    def mix_shader(self, factor: Any, a: Any, b: Any) -> Value:
        """Mix two shaders: a at factor 0, b at factor 1."""
        return self.output("ShaderNodeMixShader", [factor, a, b])

    def add_shader(self, a: Any, b: Any) -> Value:
        """Add two shaders."""
        return self.output("ShaderNodeAddShader", [a, b])

    def emission(self, colour: Any, strength: Any = 1.0) -> Value:
        """Add an emissive surface or volume."""
        return self.output("ShaderNodeEmission", {"Color": colour, "Strength": strength})

    def colours(self, place: Any, stops: Sequence[Sequence[float]] | NDArray[np.float64]) -> Value:
        """Interpolate linearly between colours at equal steps of `place` from 0 to 1, clamped outside.

        In some releases a Color Ramp is a table of 257 steps, with errors of 0.003 at its stops.
        """
        pieces = len(stops) - 1
        total: Any = tuple(stops[0])
        for index, (start, end) in enumerate(itertools.pairwise(stops)):
            inputs = {
                "Vector": place,
                "From Min": 3 * (index / pieces,),
                "From Max": 3 * ((index + 1) / pieces,),
                "To Min": (0.0, 0.0, 0.0),
                "To Max": tuple(after - before for before, after in zip(start, end, strict=True)),
            }
            more = self.output("ShaderNodeMapRange", inputs, "Vector", data_type="FLOAT_VECTOR", clamp=True)
            total = self.vector("ADD", more, total)
        return total

    def attribute(self, name: str, kind: str = "GEOMETRY", output: str = "Fac") -> Value:
        """Read a named attribute of the GEOMETRY, the INSTANCER, the OBJECT or the VIEW_LAYER."""
        return self.output("ShaderNodeAttribute", (), output, attribute_name=name, attribute_type=kind)

    def noise(
        self, position: Any, size: float, octaves: Any = 2.0, roughness: float = 0.55, name: str = "Fac"
    ) -> Value:
        """Add Perlin noise, 0..1 about 0.5, with features of `size` (units of `position`)."""
        inputs = {"Vector": position, "Scale": 1.0 / size, "Detail": octaves, "Roughness": roughness}
        return self.output("ShaderNodeTexNoise", inputs, name)

    def cells(self, position: Any, size: float, name: str = "Distance", **properties: Any) -> Value:
        """Add Voronoi cells `size` wide; return the distance from their centres (cells) or their colour."""
        inputs = {"Vector": position, "Scale": 1.0 / size}
        return self.output("ShaderNodeTexVoronoi", inputs, name, **properties)

    def aov(self, name: str, value: Any, colour: bool = True) -> None:
        """Write a colour (or a number) to the AOV of this name, in view layers that have it."""
        self.node("ShaderNodeOutputAOV", {"Color" if colour else "Value": value}, aov_name=name)

    def surface(self, shader: Any, displacement: Any = None) -> None:
        """Connect `shader` to the surface output of this material or world, and a material's displacement."""
        if self.material is not None:
            self._show({"Surface": shader} | ({} if displacement is None else {"Displacement": displacement}))
            return
        self.node("ShaderNodeOutputWorld", {"Surface": shader})
        layout.arrange(self.node_tree)

    def volume(self, shader: Any) -> None:
        """Connect `shader` to the volume output of this material."""
        self._show({"Volume": shader})

    def geometry(self, value: Any) -> None:
        """Connect the output of a geometry node group."""
        self.finish({"Geometry": value})

    def _show(self, outputs: Mapping[str, Any]) -> None:
        for what in outputs:
            kind = "NodeSocketVector" if what == "Displacement" else "NodeSocketShader"
            self.node_tree.interface.new_socket(what, in_out="OUTPUT", socket_type=kind)
        self.finish(outputs)
        around = Tree(compat.node_tree(self.material))
        group = around.node("ShaderNodeGroup", node_tree=self.node_tree)
        group.width = 2.0 * layout.WIDE - layout.GAP
        output = around.node("ShaderNodeOutputMaterial", {what: around.pick(group, what) for what in outputs})
        output.location = 2.0 * layout.WIDE, 0.0

    def finish(self, outputs: Mapping[str, Any]) -> None:
        """Connect the outputs of a group, by name, and lay out its nodes."""
        self.node("NodeGroupOutput", outputs)
        if self._deferred:
            self._deferred.end(self.node_tree)
            self._deferred = None
        for node in self.node_tree.nodes:
            if node.bl_idname == "NodeGroupInput":
                for socket in node.outputs:
                    socket.hide = not socket.is_linked
        layout.arrange(self.node_tree)


def _shows_sockets_late(kind: str, inputs: Inputs, properties: Mapping[str, Any]) -> bool:
    """Return True if an update must enable and disable sockets of a new node before they are looked up."""
    if kind == "ShaderNodeMath":
        return len(inputs) > 2
    if kind == "ShaderNodeMapRange":
        return "data_type" in properties
    return kind not in _SAME_SOCKETS


def _is_input(item: bpy.types.NodeTreeInterfaceItem, name: str) -> bool:
    return item.item_type == "SOCKET" and item.in_out == "INPUT" and item.name == name


def _is_panel(item: bpy.types.NodeTreeInterfaceItem, name: str) -> bool:
    return item.item_type == "PANEL" and item.name == name


def material(name: str, colour: tuple[float, float, float] | None = None) -> tuple[bpy.types.Material, Tree]:
    """Create an owned material called `name`, and return it with the empty tree of its group.

    Parameters
    ----------
    colour
        Red, green and blue in Blender's solid view, where no shader is evaluated; renders ignore it.
    """
    new = owned.mark(bpy.data.materials.new(name))
    if colour is not None:
        new.diffuse_color, new.roughness = (*colour, 1.0), 1.0
    return new, Tree(owned.mark(bpy.data.node_groups.new(f"{name} Shader", "ShaderNodeTree")), new)


def geometry(name: str) -> tuple[Tree, bpy.types.Node]:
    """Create an owned geometry node group (geometry in, geometry out).

    Returns
    -------
    tree, group input node
    """
    group = owned.mark(bpy.data.node_groups.new(name, "GeometryNodeTree"))
    group.is_modifier = True
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    tree = Tree(group)
    return tree, tree.node("NodeGroupInput")


def compositor(name: str, help: str, outputs: Mapping[str, str]) -> Tree:
    """Create an owned compositor node group for users, with a tooltip.

    Parameters
    ----------
    outputs
        name -> socket type such as "NodeSocketColor".
    """
    group = owned.mark(bpy.data.node_groups.new(name, "CompositorNodeTree"))
    group.description = help
    for label, kind in outputs.items():
        group.interface.new_socket(label, in_out="OUTPUT", socket_type=kind)
    return Tree(group)


def model_time(tree: Tree) -> Value:
    """Read the current model time (s since the start of the run) in a shader.

    It is an animated custom property of the scene: attributes of type VIEW_LAYER fall back to the scene.
    """
    return tree.attribute(TIME, "VIEW_LAYER")


def switch(tree: Tree, kind: str, shader: Any, other: Any) -> Value:
    """Replace `shader` by `other` in view layers whose property `kind` (`THERMAL`, `MASKS`) is 1."""
    return tree.mix_shader(tree.attribute(kind, "VIEW_LAYER"), shader, other)


def thermal_switch(tree: Tree, shader: Any, value: Any) -> Value:
    """Replace a surface's `shader` by a number as pixel value in view layers with `firetwin_thermal` = 1.

    View layers with the AOV `SURFACE` render both: its channels are 1 km / distance, 1, and the number.
    """
    nearness = 1000.0 / tree.output("ShaderNodeCameraData", name="View Distance")
    tree.aov(SURFACE, tree.combine(nearness, 1.0, value))
    return switch(tree, THERMAL, shader, tree.emission(value, 1.0))


def flames(tree: Tree, light: Any, emissivity: Any, warmth: Any) -> None:
    """Write a flame's contribution to the AOVs of flames.

    The channels of `FLAMES` are the red of its light, the same times its distance (m), and its emissivity.
    `WARMTH` is its emissivity times the radiance (W m-2 sr-1) of a black body of its temperature.
    """
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    tree.aov(FLAMES, tree.combine(light, light * distance, emissivity))
    tree.aov(WARMTH, emissivity * warmth, colour=False)


def over(tree: Tree, shader: Any) -> Value:
    """Make the `shader` of an overlay slightly transparent, so that depth and AOVs pass through it."""
    trace = tree.output("ShaderNodeBsdfTransparent", {"Color": 3 * (1.0e-3,)})
    return tree.add_shader(shader, trace)


def mask_switch(tree: Tree, shader: Any, kind: Any, number: Any = 0.0) -> Value:
    """Replace `shader` by class and instance number in view layers with `firetwin_masks` = 1.

    A pixel is then (number mod 4096, 1, class + 8 floor(number / 4096)), all times the transmittance of smoke
    in front of it: the ratios are whole numbers that 32 bits represent exactly. A surface without a number is
    (0, 1, class).
    """
    if isinstance(number, Value):
        low = tree.math("MODULO", number, 4096.0)
        kind = (number - low) * (8.0 / 4096.0) + kind
    else:
        low = number
    return switch(tree, MASKS, shader, tree.emission(tree.combine(low, 1.0, kind), 1.0))
