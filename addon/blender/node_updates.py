"""Changes of a node tree that Blender follows up once, at the end, and not after every change.

Blender updates the complete tree after each new node, link and value, so that the time to build a tree grows
with the square of its size. It skips updates while it calls the `update` function of a tree whose type is
written in Python; the next update of a tree follows up the changes that were made in the meantime.
"""

from __future__ import annotations

import atexit
from collections.abc import Callable
from typing import Any

import bpy


class _Caller(bpy.types.NodeTree):
    """An empty node tree whose update makes a change."""

    bl_idname, bl_label, bl_icon = "FiretwinNodeUpdates", "Firetwin Node Updates", "NODETREE"
    change: Callable[[], None] | None = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Offer this type in no menu."""
        return False

    def update(self) -> None:
        """Make the change that waits, if one does."""
        change, _Caller.change = _Caller.change, None
        if change is not None:
            change()


class DeferredUpdates:
    """Makes changes of node trees without an update of their trees, until `end`."""

    _open = 0

    def __init__(self) -> None:
        if not _Caller.is_registered:
            bpy.utils.register_class(_Caller)
            atexit.register(_unregister)
        DeferredUpdates._open += 1
        self._caller = bpy.data.node_groups.new(".firetwin_updates", _Caller.bl_idname)

    def change(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function that changes node trees, and return its result."""
        results: list[Any] = []
        errors: list[Exception] = []

        def call() -> None:
            try:
                results.append(function(*arguments))
            except Exception as error:  # Blender would print it and go on
                errors.append(error)

        _Caller.change = call
        self._caller.interface_update(bpy.context)
        if errors:
            raise errors[0]
        return results[0]

    def end(self, tree: bpy.types.NodeTree) -> None:
        """Update a tree after its last change."""
        bpy.data.node_groups.remove(self._caller)
        DeferredUpdates._open -= 1
        if not DeferredUpdates._open:
            _unregister()
        tree.interface_update(bpy.context)


def end_all() -> None:
    """End deferred updates that an error interrupted, so that nothing of them remains in the file."""
    DeferredUpdates._open = 0
    _unregister()


def _unregister() -> None:
    """Remove the type and its trees: Blender as a module hangs at exit if a script leaves one."""
    atexit.unregister(_unregister)
    if _Caller.is_registered:
        for tree in [tree for tree in bpy.data.node_groups if tree.bl_idname == _Caller.bl_idname]:
            bpy.data.node_groups.remove(tree)
        bpy.utils.unregister_class(_Caller)
