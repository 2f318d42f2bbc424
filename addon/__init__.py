"""Firetwin: fly through and film the output of a coupled fire-atmosphere model."""

import sys

_AVX2 = 40
"""Windows' PF_AVX2_INSTRUCTIONS_AVAILABLE; its core has one version of each function, for AVX2."""

if sys.platform == "win32":
    import ctypes

    if not ctypes.windll.kernel32.IsProcessorFeaturePresent(_AVX2):
        raise ImportError(
            "Firetwin for Windows needs a processor with AVX2, from 2013 or later; use another one"
        )


def register() -> None:
    """Add Firetwin's panel, operators and command to Blender."""
    from . import ui

    ui.register()


def unregister() -> None:
    """Take away everything that `register` added."""
    from . import ui

    ui.unregister()
