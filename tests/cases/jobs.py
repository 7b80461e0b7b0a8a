"""Texts of jobs: the bearing NU308 with the oil FVA3, where nothing else is said."""

from __future__ import annotations


def map_job(
    load: str, entrainment_speed: str, temperature: str, solver: str = "formula", bearing: str = "NU308"
) -> str:
    """A job of a named bearing; the axes as TOML has them."""
    return f"""
schema = 1
[bearing]
name = "{bearing}"
[lubricant]
name = "FVA3"
[grid]
load = {load}
entrainment_speed = {entrainment_speed}
temperature = {temperature}
[solver]
name = "{solver}"
structural_law = "iso16281"
"""


def spaced(low: str, high: str, points: int) -> str:
    """An axis of equal ratios."""
    return f'{{ from = "{low}", to = "{high}", points = {points}, spacing = "log" }}'


SMALL = map_job(spaced("1 N/mm", "1000 N/mm", 7), '["0.5 m/s", "1 m/s", "2 m/s"]', '["20 degC", "40 degC"]')
"""A map of 84 points by the film formula."""

DRY = map_job(spaced("1 N/mm", "1000 N/mm", 4), spaced("0.1 m/s", "10 m/s", 4), '["40 degC"]', solver="hertz")
"""The smallest map: one temperature, dry contacts."""

WIDE_AXES = (spaced("0.1 N/mm", "1000 N/mm", 13), spaced("0.05 m/s", "10 m/s", 6), '["30 degC", "40 degC", "50 degC"]')
WIDE = map_job(*WIDE_AXES)
"""All loads, speeds and temperatures of the shipped scenes, by the film formula."""

FINE = (
    map_job(spaced("0.1 N/mm", "1000 N/mm", 25), spaced("0.1 m/s", "5 m/s", 6), '["40 degC"]', solver="reynolds")
    + "law_check = 0\n"
)
"""The shipped job of NU308 with fewer speeds and one temperature: what the machines of the pages need."""

LINE = """
schema = 1
[contact]
radius = "5 mm"
reference_depth = "5 mm"
[lubricant]
viscosity_law = "barus"
viscosity = "80 mPa s"
pressure_viscosity = "20 1/GPa"
density = "880 kg/m^3"
[grid]
load = ["1 N/mm", "10 N/mm", "100 N/mm"]
entrainment_speed = ["0 m/s", "1 m/s"]
temperature = ["40 degC"]
[solver]
name = "formula"
structural_law = "half_space"
"""
"""A bare line contact."""
