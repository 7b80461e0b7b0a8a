"""Contact of a roller of finite length by finite elements: the reference for everything else about its length.

Both bodies are bricks; their surfaces' compliance is exact for the mesh, and the contact between opposite nodes has no
penalty: forces push, gaps do not overlap. A quarter is meshed; loads that are not even along the roller are put
together from an even and an odd part. Whoever reads the results needs no finite elements: they are files.
"""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.inputs import read_text
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import STEEL, Material, reduced_modulus
from ehdmaps.solids.three_d_compliance import surface_compliance
from ehdmaps.solids.three_d_contact import touching
from ehdmaps.solids.three_d_mesh import QuarterModel, quarter_meshes

_LONGEST_FILE = 20_000_000

FORMAT = 1
"""Of the files."""

FOLDER = Path(__file__).parent / "length_data"
"""Folder of the shipped files."""

LEVELS = (2.0, 1.4, 1.0)
"""Sizes of the elements of the meshes, the last is the finest."""

LIGHT_PRESSURE, HEAVY, TILT_ARM = 1.3e9, 2.5, 0.1
"""Hertz pressure of the light load [Pa], the heavy load over it, arm of a tilting moment over the length."""

_WIDTH_DEPTHS, _BEYOND = 1.0, 0.4


@dataclass(frozen=True, eq=False)
class LengthCase:
    """A roller under a load.

    Attributes
    ----------
    profile : str
        iso or straight.
    load, moment : float
        [N], [N m].
    places : array (n,)
        Nodes along the roller [m].
    load_per_length : array (n,)
        w [N/m]: the forces on the nodes of each place over the length that they stand for.
    peak_pressure : array (n,)
        Pressure of the nodes in the middle of the width, from their forces [Pa].
    approach, tilt : float
        Approach in the middle [m], tilt.
    """

    profile: str
    load: float
    moment: float
    places: FloatArray
    load_per_length: FloatArray
    peak_pressure: FloatArray
    approach: float
    tilt: float


@dataclass(frozen=True, eq=False)
class LengthReference:
    """Cases of one roller, with meshes of several sizes.

    Attributes
    ----------
    bearing : str
        Name of the bearing.
    model : QuarterModel
        What was meshed.
    cases : dict of float to list of LengthCase
        Cases by the size of the elements; the same ones in the same order.
    unknowns : dict of float to int
        Freedoms of both bodies by the size of the elements.
    check : dict of str to float
        Loads of the coarsest mesh at one approach, here and by CalculiX' contact; empty if it was not run.
    """

    bearing: str
    model: QuarterModel
    cases: dict[float, list[LengthCase]]
    unknowns: dict[float, int]
    check: dict[str, float]

    @property
    def finest(self) -> list[LengthCase]:
        """Cases of the finest mesh."""
        return self.cases[min(self.cases)]


def quarter_model(bearing: BearingGeometry, material: Material = STEEL) -> QuarterModel:
    """Model of the inner contact of a roller; the raceway's body is as deep as the roller is thick.

    Parameters
    ----------
    bearing : BearingGeometry
        The bearing.
    material : Material
        Material of all bodies.
    """
    radius, modulus = bearing.inner_radius, reduced_modulus(material, material)
    return QuarterModel(
        roller_diameter=bearing.roller_diameter,
        roller_length=bearing.roller_length,
        raceway_diameter=bearing.inner_raceway_diameter,
        race_depth=bearing.roller_diameter,
        race_width=_WIDTH_DEPTHS * bearing.roller_diameter,
        beyond=_BEYOND * bearing.roller_length,
        half_width=4.0 * radius * LIGHT_PRESSURE / modulus,
    )


def light_load(bearing: BearingGeometry, material: Material = STEEL) -> float:
    """Load of a roller whose mean per length has the pressure `LIGHT_PRESSURE` [N].

    Parameters
    ----------
    bearing : BearingGeometry
        The bearing.
    material : Material
        Material of all bodies.
    """
    modulus = reduced_modulus(material, material)
    return LIGHT_PRESSURE**2 * 2.0 * math.pi * bearing.inner_radius / modulus * bearing.roller_length


class MeshedContact:
    """Roller and raceway on one mesh, ready for any profile and load.

    Parameters
    ----------
    model : QuarterModel
        The sizes.
    level : float
        Size of the elements.
    material : Material
        Material of both bodies.
    """

    def __init__(self, model: QuarterModel, level: float, material: Material = STEEL) -> None:
        self.roller, self.race = quarter_meshes(model, level)
        even, odd = (
            sum(parts)
            for parts in zip(*(surface_compliance(body, material) for body in (self.roller, self.race)), strict=True)
        )
        half = self.roller.positions[:, 0, 0, 1]
        self.columns = self.roller.positions[0, self.roller.touching[0].any(axis=1), 0, 0]
        self.places = np.concatenate([-half[:0:-1], half])
        self.compliance = _whole(np.asarray(even), np.asarray(odd), half.size, self.columns.size)
        self.widths = node_widths(self.places)
        self.unknowns = self.roller.positions.size + self.race.positions.size
        x = self.columns
        self._arcs = sum(r - np.sqrt(r**2 - x**2) for r in (0.5 * model.roller_diameter, 0.5 * model.raceway_diameter))

    def solve(self, name: str, depths: FloatArray, load: float, moment: float) -> LengthCase:
        """Pressures under a load and a moment.

        Parameters
        ----------
        name : str
            Name of the profile.
        depths : array (n,)
            Profile at `places` [m].
        load, moment : float
            [N], [N m].

        Raises
        ------
        AnalysisError
            If none are found.
        """
        count = self.columns.size
        gap = (self._arcs[None, :] + depths[:, None]).ravel()
        arms = np.repeat(self.places, count)
        rigid = np.stack([np.ones(gap.size), arms], axis=1)
        # A half of the width is meshed.
        forces, motions = touching(self.compliance, gap, rigid, np.full(gap.size, 2.0), np.array([load, moment]))
        shaped = forces.reshape(-1, count)
        return LengthCase(
            profile=name,
            load=load,
            moment=moment,
            places=self.places,
            load_per_length=2.0 * shaped.sum(axis=1) / self.widths,
            peak_pressure=shaped[:, 0] / (0.5 * self.columns[1] * self.widths),
            approach=float(motions[0]),
            tilt=float(motions[1]),
        )


def node_widths(places: FloatArray) -> FloatArray:
    """Lengths that nodes stand for, (n,) [m].

    Parameters
    ----------
    places : array (n,)
        The nodes [m].
    """
    return np.convolve(np.diff(places), [0.5, 0.5])


def _whole(even: FloatArray, odd: FloatArray, layers: int, columns: int) -> FloatArray:
    """Compliance of nodes of the whole length from those of half of it, for even and for odd loads."""
    count = layers * columns
    order = np.arange(count).reshape(layers, columns)
    mirrored = order[:0:-1].ravel()
    quarter = np.concatenate([mirrored, order.ravel()])
    sides = np.concatenate([-np.ones(mirrored.size), np.ones(count)])
    sides[mirrored.size : mirrored.size + columns] = 0.0  # the middle has no odd part
    # Of a force one half is even and one half odd; that of the middle is shared by both halves of the length.
    return np.asarray(
        0.5 * even[np.ix_(quarter, quarter)] + 0.5 * sides[:, None] * odd[np.ix_(quarter, quarter)] * sides
    )


def save_reference(reference: LengthReference, path: Path) -> None:
    """Write the cases as JSON, in SI with six digits.

    Parameters
    ----------
    reference : LengthReference
        The cases.
    path : Path
        The file.
    """

    def plain(case: LengthCase) -> dict[str, Any]:
        return {
            name: [float(f"{number:.6g}") for number in value] if isinstance(value, np.ndarray) else value
            for name, value in vars(case).items()
        }

    content = {
        "format": FORMAT,
        "bearing": reference.bearing,
        "model": asdict(reference.model),
        "meshes": [
            {"level": level, "unknowns": reference.unknowns[level], "cases": [plain(case) for case in cases]}
            for level, cases in reference.cases.items()
        ],
        "check": reference.check,
    }
    path.write_text(json.dumps(content, separators=(",", ":")) + "\n", "utf-8")


def shipped_reference(bearing: str) -> LengthReference:
    """The shipped cases of a bearing.

    Parameters
    ----------
    bearing : str
        Such as "NU308".

    Raises
    ------
    InputError
        If there are none.
    """
    names = sorted(path.stem for path in FOLDER.glob("*.json"))
    if bearing not in names:
        raise InputError(
            f"reference over the length: got {bearing!r:.60}; allowed: {', '.join(names)}; for others run "
            "`ehdmaps length JOB --solve FILE.json`"
        )
    return read_reference(FOLDER / f"{bearing}.json")


def read_reference(path: str | Path) -> LengthReference:
    """Cases from a file of `save_reference`.

    Parameters
    ----------
    path : str or Path
        The file.

    Raises
    ------
    InputError
        If it is no such file.
    """
    text = read_text(path, _LONGEST_FILE, "a file made by `ehdmaps length JOB --solve FILE.json`")
    try:
        content = json.loads(text)
        if content["format"] != FORMAT:
            raise InputError(f"{path}: got format {content['format']!r:.20}; allowed: {FORMAT}; make the file anew")
        meshes = content["meshes"]
        return LengthReference(
            bearing=content["bearing"],
            model=QuarterModel(**content["model"]),
            cases={mesh["level"]: [_case(entry) for entry in mesh["cases"]] for mesh in meshes},
            unknowns={mesh["level"]: mesh["unknowns"] for mesh in meshes},
            check=content["check"],
        )
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(
            f"{path}: is no file of contacts over the length ({error!r:.80}); allowed: one made by `ehdmaps length JOB "
            "--solve FILE.json`"
        ) from None


def _case(entry: dict[str, Any]) -> LengthCase:
    """A case of a file."""
    values: dict[str, Any] = {k: np.array(value) if isinstance(value, list) else value for k, value in entry.items()}
    return LengthCase(**values)
