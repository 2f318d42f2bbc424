"""Constants: of nature against CODATA in SciPy, of air against the laws that relate them."""

import numpy as np
import pytest
from firetwin_core import constants, geo
from scipy import constants as codata


def test_physical_constants_are_those_of_codata():
    assert codata.g == constants.GRAVITY
    assert pytest.approx(codata.Stefan_Boltzmann, rel=1e-9) == constants.STEFAN_BOLTZMANN


def test_the_ellipsoid_is_that_of_the_local_frame():
    """The pole lies a (1 - f) from the centre: 2 a (1 - f) below the other pole."""
    _, _, up = geo.LocalFrame(90.0, 0.0).forward([-90.0, 0.0], [0.0, 0.0], [0.0, 0.0]).T
    polar = np.sqrt(1.0 - constants.ECCENTRICITY_SQUARED) * constants.SEMI_MAJOR_AXIS
    assert -up == pytest.approx([2.0 * polar, polar], rel=1e-12)


def test_air_is_dry_air_at_a_thousand_hectopascal():
    gas = codata.R / 28.9644e-3  # J/kg/K, molar mass of the U.S. Standard Atmosphere 1976
    assert pytest.approx(3.5 * gas, rel=2e-4) == constants.SPECIFIC_HEAT
    assert pytest.approx(1e5 / (gas * constants.AIR_TEMPERATURE), rel=2e-3) == constants.AIR_DENSITY
    heat = constants.SPECIFIC_HEAT * constants.AIR_DENSITY * constants.AIR_TEMPERATURE
    assert pytest.approx(codata.g / (np.pi * heat)) == constants.BUOYANCY_FLUX


def test_fuel_has_the_heat_of_wrf_sfire():
    assert constants.HEAT_OF_COMBUSTION == 17.433e6
