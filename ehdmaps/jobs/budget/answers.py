"""Question asked of a contact at one operating point, and the answer of one way of computing it.

An answer has what a user looks at: approach, films, stiffness, damping, and the compliances of the film. Errors are
relative to the value of a reference. Three quantities go through zero, and take the larger of two scales:

- approach: the dry approach and the film offset together, since the one is taken off the other;
- film compliance: a hundredth of 1/k, where the film hardly gives way beside the solids;
- damping and loss compliance: a fiftieth of k b/u and of b/(u k), since c of an isothermal, Newtonian film goes through
  zero in the damping valley and is below zero at its bottom. Values are compared as they are solved, below zero too.

The last two are the ratios of the bars to which `ehdmaps.jobs.make.law_check` holds contact laws.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from textwrap import shorten

from ehdmaps.jobs.make.sampling import COMPLIANCE_BARS, DAMPING_BARS
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import FilmSolution, contact_solution
from ehdmaps.units import point_text

QUANTITIES = (
    "approach",
    "stiffness",
    "damping",
    "film offset",
    "central film",
    "minimum film",
    "film compliance",
    "loss compliance",
)
"""What is judged, by the names of the columns; they are those of a map's variables with a blank for "_"."""

COMPLIANCE_SHARE = COMPLIANCE_BARS[1] / COMPLIANCE_BARS[0]
"""Film compliance that an error is relative to at least, over 1/k."""

DAMPING_SHARE = DAMPING_BARS[1] / DAMPING_BARS[0]
"""Damping that an error is relative to at least, over k b/u."""

_LONGEST = 200


@dataclass(frozen=True)
class Question:
    """One contact at one operating point.

    Attributes
    ----------
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    point : OperatingPoint
        Load, speed and temperature; the speed is above zero.
    frequency : float
        Frequency of a small oscillation [Hz], for what is asked over frequency.
    """

    contact: LineContact
    lubricant: Lubricant
    point: OperatingPoint
    frequency: float

    @property
    def place(self) -> str:
        """Contact, load, speed and temperature, in words."""
        at = self.point
        return f"{self.contact.name}, {point_text(at.load, at.entrainment_speed, at.temperature)}"

    @property
    def dry_compliance(self) -> float:
        """d(delta_el)/dw of the solids [m2/N]."""
        return float(self.contact.structural_compliance(self.point.load))

    @property
    def passing_time(self) -> float:
        """b/u, in which the surfaces pass through half of the dry contact [s]."""
        half = half_width(self.point.load, self.contact.radius, self.contact.reduced_modulus)
        return float(half) / self.point.entrainment_speed


@dataclass(frozen=True)
class Answer:
    """Result of one way of computing a contact.

    Attributes
    ----------
    values : mapping of str to float
        Values by quantity, SI, per unit length; a quantity that is not known is left out.
    stated : mapping of str to float
        Numerical errors that the way states of itself, in the units of the values; those that it states.
    lost : str
        Why there is no answer; empty where there is one.
    """

    values: Mapping[str, float] = field(default_factory=dict)
    stated: Mapping[str, float] = field(default_factory=dict)
    lost: str = ""


def film_answer(film: FilmSolution, question: Question) -> Answer:
    """Answer that follows from a film.

    Parameters
    ----------
    film : FilmSolution
        The film, in the limit of slow motion.
    question : Question
        What it belongs to.
    """
    if not film.status.usable:
        # of a program's log the beginning is enough here
        return Answer(
            lost=shorten("; ".join(filter(None, (film.status.word, film.reason))), _LONGEST, placeholder=" ...")
        )
    solution = contact_solution(film, question.contact, question.point)
    values = {name: float(getattr(solution, name.replace(" ", "_"))) for name in QUANTITIES}
    stated = {
        name: abs(getattr(solution, f"{name.replace(' ', '_')}_error") * values[name])
        for name in QUANTITIES
        if name != "approach"
    }
    # the solids are exact: the approach has the error of the film offset
    stated["approach"] = stated["film offset"]
    return Answer(known(values), known(stated))


def known(values: Mapping[str, float]) -> dict[str, float]:
    """Values that are numbers.

    Parameters
    ----------
    values : mapping of str to float
        Values by name; NaN where one is not known.
    """
    return {name: value for name, value in values.items() if math.isfinite(value)}


def scales(truth: Answer, question: Question, least_film: float = 0.0) -> dict[str, float]:
    """Scales that errors are relative to, by quantity, in the units of the values.

    Parameters
    ----------
    truth : Answer
        Answer of the reference.
    question : Question
        What was asked.
    least_film : float
        Film that errors of films are relative to at least [m].
    """
    sizes = {name: abs(value) for name, value in truth.values.items()}
    stiffness, time = sizes.get("stiffness", math.nan), question.passing_time
    floors = {
        "approach": float(question.contact.structural_approach(question.point.load)) + sizes.get("film offset", 0.0),
        "film compliance": COMPLIANCE_SHARE / stiffness,
        "damping": DAMPING_SHARE * stiffness * time,
        "loss compliance": DAMPING_SHARE * time / stiffness,
        "film offset": least_film,
        "central film": least_film,
        "minimum film": least_film,
    }
    return {name: max(value, floors.get(name, 0.0)) for name, value in sizes.items()}
