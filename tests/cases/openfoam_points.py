"""The points at which the CFD of the film is held against the Reynolds equation, and how they compare."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.ehl.start import reynolds_start
from ehdmaps.openfoam.parameters import Flow
from ehdmaps.openfoam.solver import OpenFoamSolver
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import DRY_COMPLIANCE, half_width, max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import FilmSolution

OIL = Lubricant.named("FVA3")


@dataclass(frozen=True)
class Place:
    """A point of a map: bearing, contact (0 inner, 1 outer), load [N/m], entrainment speed [m/s], celsius [degC]."""

    bearing: str
    side: int
    load: float
    speed: float
    celsius: float

    @property
    def contact(self) -> LineContact:
        """The line contact."""
        return BearingGeometry.named(self.bearing).contacts(STEEL, "iso16281")[self.side]

    @property
    def groups(self) -> tuple[float, float]:
        """Moes' M and L."""
        oil, contact = OIL.at(self.celsius + 273.15), self.contact
        alpha = oil.pressure_viscosity.pressure_viscosity
        return moes_groups(self.load, self.speed, oil.viscosity, alpha, contact.radius, contact.reduced_modulus)

    def __str__(self) -> str:
        side = ("inner", "outer")[self.side]
        return f"{self.bearing} {side} {self.load / 1e3:g} N/mm {self.speed:g} m/s {self.celsius:g} degC"


PLACES = tuple(
    Place(*place)
    for place in (
        ("NU308", 0, 2e3, 0.5, 40.0),
        ("NU308", 1, 1e3, 2.0, 60.0),
        ("NU308", 0, 5e3, 1.0, 20.0),
        ("NU308", 1, 2e4, 0.2, 80.0),
        ("NU308", 0, 2e4, 2.0, 100.0),
        ("NU308", 1, 5e4, 1.0, 120.0),
        ("NU308", 0, 2e5, 0.2, 120.0),
        ("NU308", 1, 1e5, 5.0, 100.0),
        ("NU308", 1, 5e4, 0.05, 20.0),
        ("NU308", 0, 1e4, 2.0, 60.0),
        ("NU308", 1, 2e4, 1.0, 100.0),
        ("NU308", 1, 3e3, 0.1, 40.0),
        ("N1014", 1, 2e3, 1.0, 100.0),
        ("N1014", 0, 1e4, 0.1, 60.0),
        ("N1014", 1, 1e4, 3.3, 40.0),
        ("N1014", 0, 5e4, 0.5, 80.0),
        ("N1014", 1, 1e5, 2.0, 120.0),
        ("N1014", 0, 1e2, 0.05, 20.0),
        ("N1014", 0, 2e4, 1.0, 90.0),
        ("N1014", 0, 3e3, 5.0, 80.0),
        ("N1014", 0, 1e5, 1.0, 100.0),
        ("N1014", 1, 5e2, 1.0, 60.0),
        ("NU308", 0, 5e3, 5.0, 20.0),
        ("NU308", 0, 5e4, 4.0, 80.0),
        ("N1014", 1, 2e4, 0.2, 40.0),
    )
)
"""25 points drawn over both maps: light and heavy, slow and fast, cold and hot."""

SPIKED = (
    Place("N1014", 0, 8.8889e4, 3.297, 40.0),
    Place("N1014", 1, 2e4, 3.0, 30.0),
    Place("NU308", 0, 5e4, 2.0, 40.0),
)
"""Cold and loaded: a pressure spike so steep that the walls bear more than any oil does."""

THICK = (Place("N1014", 0, 5e2, 10.0, 40.0), Place("N1014", 1, 1e2, 10.0, 20.0))
"""Light and fast: films so thick that their slopes are not small."""


FILM_BARS: dict[Flow, float] = {"thin_film": 1e-3, "full_stress": 2e-3}
"""Most that films of a Newtonian oil may differ from the Reynolds equation, isothermal."""

FILM_BAR, DAMPING_BAR, NEWTONIAN_DAMPING_BAR = 0.01, 0.05, 0.03
"""Most that films, and c, may differ with other laws of shear and with heat; and c without either."""


@dataclass(frozen=True)
class Comparison:
    """Relative differences of the CFD from the Reynolds equation, and the CFD's own estimates of its errors."""

    place: Place
    flow: Flow
    cfd: FilmSolution
    reynolds: FilmSolution
    way: str = "newtonian"

    def difference(self, name: str) -> float:
        """Of one number of the film."""
        mine, other = getattr(self.cfd, name), getattr(self.reynolds, name)
        return float((mine - other) / abs(other))

    def explained(self, name: str) -> bool:
        """Tell whether a difference is less than the errors that both programs state."""
        return abs(self.difference(name)) < sum(
            abs(getattr(film, f"{name}_error")) for film in (self.cfd, self.reynolds)
        )

    @property
    def compliance_share(self) -> float:
        """Difference of film compliance over the compliance a b/(p_H R) of the whole contact in the log kernel."""
        contact, load = self.place.contact, self.place.load
        half = float(half_width(load, contact.radius, contact.reduced_modulus))
        peak = float(max_pressure(load, contact.radius, contact.reduced_modulus))
        dry = DRY_COMPLIANCE * half / (peak * contact.radius)
        return (self.cfd.film_compliance - self.reynolds.film_compliance) / (dry + self.reynolds.film_compliance)

    @property
    def damping(self) -> float:
        """Difference of c, whose k is that of the whole contact."""
        contact, load = self.place.contact, self.place.load
        dry = contact.structural_compliance(load)
        mine, other = (film.loss_compliance / (dry + film.film_compliance) ** 2 for film in (self.cfd, self.reynolds))
        return mine / other - 1.0

    def row(self) -> str:
        """One line of the table."""
        M, L = self.place.groups
        head = f"{self.place!s:<42} {M:7.3g} {L:5.1f}  {self.flow:<11}"
        if not self.cfd.status.usable:
            return f"{head} {self.cfd.status.word}"
        numbers = [
            self.difference("central_film"),
            self.difference("minimum_film"),
            self.cfd.film_offset_error,
            self.difference("film_compliance"),
            self.compliance_share,
            self.cfd.film_compliance_error,
            self.damping,
            self.cfd.loss_compliance_error,
        ]
        return head + " ".join(f"{100 * number:+8.2f}" for number in numbers)


HEADING = f"{'differences from reynolds, %':<42} {'M':>7} {'L':>5}  {'flow':<11}" + " ".join(
    f"{name:>8}" for name in ("h cen", "h min", "(grid)", "f.compl", "of all", "(grid)", "c", "(grid)")
)
"""Head of the table; '(grid)' is the CFD's own estimate of the error left of it (of the film offset in the first)."""


@cache
def reynolds_film(place: Place) -> FilmSolution:
    """The film by the Reynolds equation."""
    (film,) = ReynoldsSolver().solve_line(place.contact, OIL, (place.load,), place.speed, place.celsius + 273.15)
    return film


@cache
def compare(place: Place, flow: Flow, columns: int = 400, rows: int = 6) -> Comparison:
    """Solve a point both ways."""
    solver = OpenFoamSolver(flow=flow, columns=columns, rows=rows, starter=reynolds_start, timeout=300.0)
    (film,) = solver.solve_line(place.contact, OIL, (place.load,), place.speed, place.celsius + 273.15)
    return Comparison(place, flow, film, reynolds_film(place))


def thickness(place: Place) -> float:
    """h/R at the centre."""
    return reynolds_film(place).central_film / place.contact.radius


def agrees(found: Comparison) -> list[str]:
    """What does not agree as well as it should: film compliance 5 % or 0.2 % of all; films and c by the bars above."""
    newtonian = found.way == "newtonian"
    film_bar = FILM_BARS[found.flow] if newtonian else FILM_BAR
    damping_bar = NEWTONIAN_DAMPING_BAR if newtonian else DAMPING_BAR
    wrong = []
    for name in ("central_film", "minimum_film"):
        if not abs(found.difference(name)) <= film_bar:
            wrong.append(f"{name} {100 * found.difference(name):+.2f} %")
    if not (abs(found.difference("film_compliance")) <= 0.05 or abs(found.compliance_share) <= 0.002):
        wrong.append(f"film compliance {100 * found.difference('film_compliance'):+.2f} %")
    if not abs(found.damping) <= damping_bar or math.isnan(found.damping):
        wrong.append(f"c {100 * found.damping:+.2f} %")
    return wrong
