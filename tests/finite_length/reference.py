"""Contact of a roller of finite length by finite elements, also by CalculiX: the reference for its length.

Both bodies are bricks; their surfaces' compliance is exact for the mesh, and the contact between opposite nodes has no
penalty: forces push, gaps do not overlap. A quarter is meshed; loads that are not even along the roller are put
together from an even and an odd part. Whoever reads the results needs no finite elements: they are files.
"""

from __future__ import annotations

import json
import math
import re
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.inputs import read_text
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import STEEL, Material, reduced_modulus
from ehdmaps.physics.surface import iso_profile
from ehdmaps.solids.calculix import run_deck
from tests.finite_length.bricks import Block, QuarterModel, quarter_meshes, surface_compliance
from tests.finite_length.solution import touching

_LONGEST_FILE = 20_000_000

FORMAT = 1
"""Of the files."""

FOLDER = Path(__file__).parent / "data"
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
            "`python -m tests.finite_length --solve`"
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
    text = read_text(path, _LONGEST_FILE, "a file made by `python -m tests.finite_length --solve`")
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
            f"{path}: is no file of contacts over the length ({error!r:.80}); allowed: one made by "
            "`python -m tests.finite_length --solve`"
        ) from None


def _case(entry: dict[str, Any]) -> LengthCase:
    """A case of a file."""
    values: dict[str, Any] = {k: np.array(value) if isinstance(value, list) else value for k, value in entry.items()}
    return LengthCase(**values)


PURPOSE = "checking the contact of a roller of finite length"

_JOB = "length"
_PENALTY = 5e7
"""Stiffness of the contact in CalculiX [N/mm3]: 0.03 um at 1.5 GPa."""

_PER_LINE = 12
_TOTAL = re.compile(r"total force \(fx,fy,fz\) for set STANDS.*\n\s*\n\s*(\S+)\s+(\S+)\s+(\S+)")


def load_by_calculix(
    roller: Block, race: Block, depths: FloatArray, material: Material, approach: float, folder: Path
) -> float:
    """Load of the whole roller at an approach [N], of a quarter model that CalculiX solves.

    Parameters
    ----------
    roller, race : Block
        The bodies, see `quarter_meshes`.
    depths : array (ny,)
        Profile of the roller in its layers [m].
    material : Material
        Material of both bodies.
    approach : float
        How far the middle plane of the roller comes nearer to the ground [m].
    folder : Path
        Empty, for the files of CalculiX.

    Raises
    ------
    InputError
        If CalculiX is missing.
    AnalysisError
        If it fails, or prints no load.
    """
    text = "\n".join(_deck(roller, race, depths, material, approach)) + "\n"
    run_deck(text, folder, _JOB, PURPOSE)
    totals = _TOTAL.findall((folder / f"{_JOB}.dat").read_text("utf-8", "replace"))
    if not totals:
        raise AnalysisError(f"CalculiX: {_JOB}.dat holds no total force; the contact may not have converged")
    return -4.0 * float(totals[-1][2])


def _deck(roller: Block, race: Block, depths: FloatArray, material: Material, approach: float) -> Iterator[str]:
    """The deck in N and mm, in which the limits of its contact search are made."""
    shaped = roller.positions.copy()
    # The profile moves the surface, and the columns below less and less.
    top, surface = shaped[:, :, -1:, 2], shaped[:, :, :1, 2]
    shaped[..., 2] += depths[:, None, None] * (top - shaped[..., 2]) / (top - surface)
    first = shaped.size // 3
    positions = np.concatenate([shaped.reshape(-1, 3), race.positions.reshape(-1, 3)])
    yield "*NODE, NSET=ALL"
    for number, (x, y, z) in enumerate((1e3 * positions).tolist(), start=1):
        yield f"{number},{x:.11e},{y:.11e},{z:.11e}"
    yield "*ELEMENT, TYPE=C3D8I, ELSET=SOLID"
    bricks = [_elements(roller, 0), _elements(race, first)]
    for number, nodes in enumerate((np.concatenate([part.reshape(-1, 8) for part in bricks]) + 1).tolist(), start=1):
        yield ",".join(map(str, [number, *nodes]))
    held = np.concatenate([roller.held.reshape(-1, 3), race.held.reshape(-1, 3)])
    stands = np.flatnonzero(held[:first, 2])
    yield from _node_set("STANDS", stands)
    yield from _node_set("GROUND", first + np.flatnonzero(held[first:, 2]))
    yield from _node_set("ACROSS", np.flatnonzero(held[:, 0]))
    yield from _node_set("ALONG", np.flatnonzero(held[:, 1]))
    numbers = [np.arange(1, len(part.reshape(-1, 8)) + 1).reshape(part.shape[:-1]) for part in bricks]
    numbers[1] += numbers[0].size
    columns = int(roller.touching[0].any(axis=1).sum()) - 1
    layers = roller.positions.shape[0]
    yield "*SURFACE, NAME=SLAVE"
    yield from (f"{number},S1" for number in numbers[0][:, :columns, 0].ravel())
    yield "*SURFACE, NAME=MASTER"
    yield from (f"{number},S2" for number in numbers[1][:layers, : columns + 1, -1].ravel())
    modulus = 1e-6 * material.youngs_modulus
    yield from ("*MATERIAL, NAME=MATERIAL", "*ELASTIC", f"{modulus:.12e},{material.poisson_ratio:.12e}")
    yield "*SOLID SECTION, ELSET=SOLID, MATERIAL=MATERIAL"
    yield "*SURFACE INTERACTION, NAME=CONTACT"
    yield from ("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{_PENALTY:.6e}")
    yield from ("*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE", "SLAVE,MASTER")
    yield from ("*BOUNDARY", "ACROSS,1,1", "ALONG,2,2", "GROUND,3,3")
    yield from ("*STEP, INC=50", "*STATIC", "1.,1.,1e-3", "*BOUNDARY", f"STANDS,3,3,{-1e3 * approach:.10e}")
    yield from ("*NODE PRINT, NSET=STANDS, TOTALS=ONLY", "RF", "*END STEP")


def _elements(block: Block, first: int) -> IntArray:
    """Nodes of all elements, (layers, columns, rows, 8), counted from `first`."""
    layers, nx, nz, _ = block.positions.shape
    steps = (first + nx * nz * np.arange(layers - 1))[:, None, None]
    return np.asarray((block.layer_elements()[None] + steps).reshape(layers - 1, nx - 1, nz - 1, 8))


def _node_set(name: str, nodes: IntArray) -> Iterator[str]:
    """A set of nodes."""
    yield f"*NSET, NSET={name}"
    numbers = (nodes + 1).tolist()
    for start in range(0, len(numbers), _PER_LINE):
        yield ",".join(map(str, numbers[start : start + _PER_LINE]))


DEEPEST = 1e-3
"""The profile of ISO has no bound at the ends; a depth no contact reaches [m]."""


def profile_depths(name: str, bearing: BearingGeometry, places: FloatArray) -> FloatArray:
    """Depths of a named profile [m], bounded.

    Parameters
    ----------
    name : str
        iso or straight.
    bearing : BearingGeometry
        The bearing.
    places : array (n,)
        Places along the roller, ends included [m].
    """
    if name == "straight":
        return np.zeros_like(places)
    with np.errstate(divide="ignore"):
        return np.minimum(iso_profile(places, bearing.roller_diameter, bearing.roller_length), DEEPEST)


def make_reference(
    bearing: BearingGeometry, levels: Sequence[float] = LEVELS, calculix: bool = True
) -> LengthReference:
    """Solve all cases of a bearing on all meshes.

    Parameters
    ----------
    bearing : BearingGeometry
        The bearing.
    levels : sequence of float
        Sizes of the elements, the coarsest first.
    calculix : bool
        Whether CalculiX solves the straight roller on the coarsest mesh too.

    Raises
    ------
    InputError
        If CalculiX is missing.
    AnalysisError
        If a contact is not found.
    """
    model, load = quarter_model(bearing), light_load(bearing)
    wanted = [
        (name, load * factor, load * factor * arm * bearing.roller_length)
        for name in ("iso", "straight")
        for factor, arm in ((1.0, 0.0), (HEAVY, 0.0), (1.0, TILT_ARM))
    ]
    cases: dict[float, list[LengthCase]] = {}
    unknowns: dict[float, int] = {}
    check: dict[str, float] = {}
    for level in levels:
        contact = MeshedContact(model, level)
        unknowns[level] = contact.unknowns
        cases[level] = [
            contact.solve(name, profile_depths(name, bearing, contact.places), *loads) for name, *loads in wanted
        ]
        if calculix and not check:
            straight = next(case for case in cases[level] if case.profile == "straight" and case.moment == 0.0)
            layers = contact.roller.positions.shape[0]
            with tempfile.TemporaryDirectory() as folder:
                by_calculix = load_by_calculix(
                    contact.roller, contact.race, np.zeros(layers), STEEL, straight.approach, Path(folder)
                )
            check = {"approach": straight.approach, "load": straight.load, "load_by_calculix": by_calculix}
    return LengthReference(bearing.name, model, cases, unknowns, check)
