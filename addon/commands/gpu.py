"""`firetwin gpu`: GPUs and their kernels."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import MACHINE, Command
from ..progress import result, say

_DETAIL = """\
Lists the GPUs that Cycles finds, whether their kernels are ready, and the kernel caches of the driver.
Blender ships kernels for many NVIDIA cards, but not for A100, H100, H200 and B200. For these the driver
compiles them at their first use, which takes 6 to 10 minutes. --warm compiles them in advance; run it once on
each machine of a farm. --kernels makes them with ptxas (Python package nvidia-cuda-nvcc-cu12) and saves them
in Blender's folder, which must be writable, as in a virtual environment. It needs no GPU."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--warm", action="store_true", help="compile the kernels into the driver's cache")
    form.add_argument(
        "--kernels",
        metavar="ARCH",
        type=types.architecture,
        help="make Cycles' kernels for an NVIDIA architecture, such as sm_90; needs no GPU",
    )


def _run(arguments: argparse.Namespace) -> None:
    """List GPUs, or prepare their kernels."""
    from ..jobs import gpu

    if arguments.kernels:
        lines = gpu.make_kernels(arguments.kernels, say)
    else:
        lines = gpu.warm(say) if arguments.warm else gpu.describe(say)
    result("\n".join(lines))


COMMAND = Command("gpu", "list GPUs, or prepare their kernels", _DETAIL, MACHINE, _run, _add)
