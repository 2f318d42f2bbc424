"""Numerical core of Firetwin: functions of NumPy arrays."""

from . import constants as constants
from . import flames as flames
from . import flow as flow
from . import flux as flux
from . import forest as forest
from . import geo as geo
from . import lod as lod
from . import particles as particles
from . import run as run
from . import sensor as sensor
from . import terrain as terrain
from . import tiles as tiles
from . import volume as volume

__version__: str

class Error(Exception):
    """Base class of the errors that Firetwin raises."""

class InputError(Error):
    """Invalid input file: ``path``, ``line`` and ``column`` (from 1; 0 if unknown), ``reason``."""

    path: str
    line: int
    column: int
    reason: str

def set_threads(threads: int) -> None:
    """Use at most this many worker threads; 0 uses all cores."""

def build_info() -> dict[str, str]:
    """Return compiler and library versions of this build."""
