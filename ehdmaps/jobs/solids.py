"""The table [solids] of a job: the structural law, and what finite elements have to know and have found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ehdmaps.errors import InputError, problems_after
from ehdmaps.jobs.table import Table
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import Material
from ehdmaps.units import FILM, LENGTH

if TYPE_CHECKING:
    from ehdmaps.solids.sections import Sections

FE_APPROACHES = (1e-8, 1e-2)
"""Approaches at 100 N/mm [m]: far beyond of what steel bodies have."""

_OF_BEARING, _OF_CONTACT = ("inner_approach", "outer_approach"), ("approach",)
_LENGTHS = ("bore", "outside_diameter", "roller_bore", "shaft_bore", "housing_diameter")
_SEAT_LENGTHS = ("shaft_bore", "housing_diameter")
_ADVICE = "run `ehdmaps solids JOB` and add the lines that it prints"


@dataclass(frozen=True)
class SolidsKeys:
    """Content of [solids].

    Attributes
    ----------
    law : str or None
        Structural law; None where it is not there, or wrong.
    approaches : mapping of str to float
        Approaches by finite elements by the names of the contacts [m]; empty where there are none.
    sections : mapping
        What the bodies are, as arguments of `ehdmaps.solids.sections.sections_of`; lengths in m.
    """

    law: str | None = None
    approaches: Mapping[str, float] = field(default_factory=dict)
    sections: Mapping[str, float | str] = field(default_factory=dict)


NO_SOLIDS = SolidsKeys()
"""What a job without [solids] says."""


def read_solids(section: Table) -> SolidsKeys:
    """Read [solids]; the caller closes it.

    Parameters
    ----------
    section : Table
        The table.
    """
    from ehdmaps.solids.sections import SEATS  # only jobs with [solids] know rings

    law = section.choice("law", STRUCTURAL_LAWS)
    approaches = {}
    for key in (*_OF_BEARING, *_OF_CONTACT):
        value = section.quantity(key, "m", *FE_APPROACHES, FILM)
        if value is not None:
            approaches["line" if key == "approach" else key.removesuffix("_approach")] = value
    given: dict[str, float | str] = {}
    for key in _LENGTHS:
        value = section.quantity(key, "m", 0.0 if key in ("shaft_bore", "roller_bore") else 1e-4, 100.0, LENGTH)
        if value is not None:
            given[key] = value
    seat = section.choice("seat", SEATS)
    if seat is not None:
        given["seat"] = seat
    if seat == "rigid":
        for key in _SEAT_LENGTHS:
            if key in section:
                section.note(key, "stands beside seat = 'rigid', which has neither shaft nor housing; delete one")
    return SolidsKeys(law, approaches, given)


def check_solids(section: Table, bare: bool) -> None:
    """Note what does not fit the geometry of the job.

    Parameters
    ----------
    section : Table
        The table [solids].
    bare : bool
        Whether the job has [contact] in place of [bearing].
    """
    own, other, what = (_OF_CONTACT, _OF_BEARING, "[contact]") if bare else (_OF_BEARING, _OF_CONTACT, "[bearing]")
    for key in other:
        if key in section:
            section.note(key, f"stands beside {what}; allowed: {', '.join(own)}; delete it")
    missing = [key for key in own if key not in section]
    if 0 < len(missing) < len(own):
        section.note(missing[0], f"missing beside {own[1 - own.index(missing[0])]}; allowed: both, or none; {_ADVICE}")
    if bare:
        for key in (*_LENGTHS, "seat"):
            if key in section:
                section.note(key, "stands beside [contact], which has no rings; delete it, or give a [bearing]")


def fe_approaches(keys: SolidsKeys, bearing: BearingGeometry, material: Material, where: str) -> Mapping[str, float]:
    """Approaches by finite elements of a bearing for the law fe: those of the job, or those that come with the package.

    Parameters
    ----------
    keys : SolidsKeys
        What [solids] says.
    bearing : BearingGeometry
        The bearing.
    material : Material
        Material of the bodies.
    where : str
        Name of the key with the law, for messages.

    Raises
    ------
    InputError
        If there are neither.
    """
    if keys.approaches:
        return keys.approaches
    if keys.sections:
        raise InputError(
            f"{where}: got 'fe' with {', '.join(keys.sections)} of [solids], but without {' and '.join(_OF_BEARING)}; "
            f"allowed: with both; {_ADVICE}"
        )
    with problems_after(f"{where}: "):
        return bearing.fe_approaches(material)


def job_sections(keys: SolidsKeys, bearing: BearingGeometry, material: Material) -> Sections:
    """Bodies of a bearing as [solids] says, with what it leaves out as usual.

    Parameters
    ----------
    keys : SolidsKeys
        What [solids] says.
    bearing : BearingGeometry
        The bearing.
    material : Material
        Material of all bodies.

    Raises
    ------
    InputError
        If dimensions do not fit, or bore and outside diameter are neither given nor known.
    """
    from ehdmaps.solids.sections import sections_of

    return sections_of(bearing, material, **keys.sections)  # type: ignore[arg-type]


def solids_keys(approaches: Mapping[str, float]) -> dict[str, str]:
    """Keys of [solids] for approaches: the way back from `read_solids`.

    Parameters
    ----------
    approaches : mapping of str to float
        Approaches by the names of the contacts [m].

    Examples
    --------
    >>> solids_keys({"inner": 3e-6, "outer": 2e-6})
    {'inner_approach': '3e-06 m', 'outer_approach': '2e-06 m'}
    """
    return {"approach" if name == "line" else f"{name}_approach": f"{value!r} m" for name, value in approaches.items()}
