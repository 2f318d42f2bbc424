"""`firetwin track`: a camera's path as a GPX track."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import SCENES, Command, add_overwrite, add_scene
from ..progress import result

_DETAIL = """\
One point per frame: WGS84 degrees, metres above sea level (the datum of the run's elevations) and model
time in UTC. A drone camera with track = "FILE.gpx" follows it. Flight planners and maps can read the file."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    add_scene(parser)
    parser.add_argument("--camera", metavar="NAME", type=types.name, help="name of the camera (the first)")
    parser.add_argument("--out", metavar="FILE.gpx", type=types.path, required=True, help="file to write")
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Write a camera's path as a GPX track."""
    from .. import output
    from ..auto_framing import fitted_scene
    from ..errors import UsageError
    from ..shot import comparison
    from ..shot.cameras import track_xml

    if arguments.out.suffix.lower() != ".gpx":
        raise UsageError(f"--out: {arguments.out} does not end in .gpx; name a .gpx file")
    output.check(arguments.out, arguments.overwrite)
    shot = fitted_scene.find_source(arguments).shot()
    names = [camera.name for camera in shot.settings.cameras]
    if not names:
        raise UsageError(f"{arguments.scene} has no [[cameras]]; add one to write its path")
    alone = comparison.for_view(shot, arguments.camera or names[0])
    (view,) = alone.paths
    moments = [alone.utc(frame) for frame in range(1, alone.frames.count + 1)]
    text = track_xml.gpx_text(view.camera.name, *alone.local_frame.reverse(view.position), moments)
    output.write_text(arguments.out, text, arguments.overwrite)
    result(arguments.out)


COMMAND = Command("track", "write a camera's path as a GPX track", _DETAIL, SCENES, _run, _add)
