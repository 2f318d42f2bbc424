"""NVIDIA cards of this machine, listed by the CUDA driver's library."""

from __future__ import annotations

import contextlib
import ctypes
import sys
from dataclasses import dataclass

_MAJOR, _MINOR = 75, 76  # CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR and _MINOR of cuda.h


@dataclass(frozen=True)
class Card:
    """NVIDIA card.

    Attributes
    ----------
    capability
        Compute capability: major and minor version, such as (9, 0).
    driver
        Version of the driver.
    """

    name: str
    capability: tuple[int, int]
    driver: str

    @property
    def architecture(self) -> str:
        """Name of the architecture as in file names of kernels, such as ``sm_90``."""
        return "sm_{}{}".format(*self.capability)


def list_cards() -> list[Card]:
    """List the NVIDIA cards that CUDA may use (`CUDA_VISIBLE_DEVICES`); empty without a driver."""
    cuda = _library("libcuda.so.1", "nvcuda.dll")
    if cuda is None or cuda.cuInit(0) != 0:
        return []
    number = ctypes.c_int()
    if cuda.cuDeviceGetCount(ctypes.byref(number)) != 0:
        return []
    driver = _driver_version()
    return [_card(cuda, index, driver) for index in range(number.value)]


def _card(cuda: ctypes.CDLL, index: int, driver: str) -> Card:
    device, name = ctypes.c_int(), ctypes.create_string_buffer(256)
    cuda.cuDeviceGet(ctypes.byref(device), index)
    cuda.cuDeviceGetName(name, len(name), device)
    major, minor = (_attribute(cuda, device, which) for which in (_MAJOR, _MINOR))
    return Card(name.value.decode(errors="replace"), (major, minor), driver)


def _attribute(cuda: ctypes.CDLL, device: ctypes.c_int, which: int) -> int:
    value = ctypes.c_int()
    cuda.cuDeviceGetAttribute(ctypes.byref(value), which, device)
    return value.value


def _driver_version() -> str:
    """Return the version of the driver by NVML; "unknown" without that library."""
    library, text = _library("libnvidia-ml.so.1", "nvml.dll"), ctypes.create_string_buffer(96)
    if library is None or library.nvmlInit_v2() != 0:
        return "unknown"
    try:
        found = library.nvmlSystemGetDriverVersion(text, len(text)) == 0
    finally:
        library.nvmlShutdown()
    return text.value.decode(errors="replace") if found else "unknown"


def _library(linux: str, windows: str) -> ctypes.CDLL | None:
    if sys.platform == "darwin":
        return None
    with contextlib.suppress(OSError):
        return ctypes.CDLL(windows if sys.platform == "win32" else linux)
    return None
