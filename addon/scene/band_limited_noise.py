"""Band-limited noise: octaves smaller than a pixel are omitted, as they cost time and cannot be resolved."""

from __future__ import annotations

from copy import copy
from math import log2
from typing import Any

from ..blender import nodes


class Grain:
    """Noise at a position, limited to wavelengths of at least `least` pixels; unlimited without `pixel`."""

    def __init__(
        self, tree: nodes.Tree, position: Any, pixel: nodes.Value | None, least: float = 1.0
    ) -> None:
        self._tree, self._position, self._pixel, self.least = tree, position, pixel, least
        self._octaves = None if pixel is None else -tree.math("LOGARITHM", pixel * least, 2.0)

    def coarser(self, least: float) -> Grain:
        """Return the same noise at the same position with a different minimum wavelength."""
        return Grain(self._tree, self._position, self._pixel, least)

    def at(self, position: Any) -> Grain:
        """Return the same octaves at another position."""
        other = copy(self)
        other._position = position
        return other

    def noise(self, size: float, octaves: float = 2.0, roughness: float = 0.55) -> nodes.Value:
        """Add band-limited noise, see `Tree.noise`; the remaining octaves keep their amplitudes."""
        if self._octaves is None:
            return self._tree.noise(self._position, size, octaves, roughness)
        low = -log2(size)
        detail = self._octaves.ramp(low, low + octaves, 0.0, octaves)
        inputs = {"Vector": self._position, "Scale": 1.0 / size, "Detail": detail, "Roughness": roughness}
        total = self._tree.output("ShaderNodeTexNoise", inputs, normalize=False)
        weights = sum(roughness**octave for octave in range(int(octaves) + 1))
        return self._tree.math("MULTIPLY_ADD", total, 0.5 / weights, 0.5)
