"""Several runs rendered: files of one call, equal cameras in all runs, and fronts."""

from pathlib import Path

import bpy
import firetwin
from firetwin.shot.settings import OtherRun
from firetwin.ui import other_runs


def test_runs_are_added_and_removed_in_the_sidebar(scene):
    firetwin.register()
    try:
        panel = scene.firetwin
        for _ in range(3):
            bpy.ops.firetwin.run_add()
        assert [item.name for item in panel.runs] == ["what-if", "what-if-2", "what-if-3"]
        assert not bpy.ops.firetwin.run_add.poll()
        bpy.ops.firetwin.run_remove(index=0)
        panel.runs[1].path = "/somewhere"
        assert other_runs.list_runs(panel)[1] == OtherRun("what-if-3", Path("/somewhere"))
    finally:
        firetwin.unregister()
