"""Library of solved flames: blocks of mixture fraction, and the solver that computes them."""

from pathlib import Path

FOLDER = Path(__file__).parent
