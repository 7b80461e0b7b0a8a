"""What an analysis compares: a law as it was chosen, a scene with its law, and models with their labels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ehdmaps.errors import InputError
from ehdmaps.physics.oil_supply import OilSupply
from mbs.model.relaxation import Films
from mbs.scene.assembly import Model, assemble
from mbs.scene.map_set import MapSet
from mbs.scene.scene import Scene


@dataclass(frozen=True)
class LawChoice:
    """A contact law as it was chosen.

    Attributes
    ----------
    label : str
        The law in two words.
    name : str or None
        Name of the law, as `mbs.scene.assembly.assemble` takes it.
    maps : MapSet or None
        The maps of the law `map`, one for each type of bearing.
    films : {"slow", "memory"} or None
        Which films it is to have.
    supply : OilSupply or None
        Oil supply of all bearings; None for that of the scene, or of the map.
    """

    label: str
    name: str | None
    maps: MapSet | None = None
    films: Films | None = None
    supply: OilSupply | None = None

    @property
    def has_films(self) -> bool:
        """Whether it knows an oil."""
        return self.name in ("map", "formula") or (self.name is None and self.maps is not None)


@dataclass(frozen=True, eq=False)
class Subject:
    """What is run: a scene with a law.

    Attributes
    ----------
    scene : Scene
        The scene.
    law : LawChoice
        The law.
    clearance : float or None
        Diametral clearance of all bearings [m]; None for those of the scene.
    """

    scene: Scene
    law: LawChoice
    clearance: float | None = None

    def model(self) -> Model:
        """The model; see `mbs.scene.assembly.assemble`."""
        law = self.law
        return assemble(self.scene, law.name, law.maps, self.clearance, law.films, law.supply)


@dataclass(frozen=True, eq=False)
class Case:
    """One of the models that are compared.

    Attributes
    ----------
    label : str
        Difference from the other cases; the law if there is none.
    model : Model
        Scene with its law, clearance and loads.
    clearance : float
        Diametral clearance [m]; NaN if the bearings have not all the same.
    load_factor : float
        Factor of all loads of the scene.
    start_angle : float or None
        Angle at which all cages start instead of the scene's angles [rad].
    subject : Subject or None
        What the model was made from, where that is known.
    """

    label: str
    model: Model
    clearance: float
    load_factor: float = 1.0
    start_angle: float | None = None
    subject: Subject | None = None


def common_clearance(model: Model) -> float:
    """Diametral clearance of all bearings [m]; NaN if they have not all the same."""
    found = {entry.geometry.diametral_clearance for entry in model.scene.bearings}
    return found.pop() if len(found) == 1 else math.nan


def as_cases(models: Model | Case | Sequence[Model | Case]) -> tuple[Case, ...]:
    """One or more models as cases; a model is called by its law.

    Parameters
    ----------
    models : Model, Case, or a sequence of them
        Models, at least one. Those of one law that differ in something else have to be cases, each with a label.

    Raises
    ------
    InputError
        If there is none, or two of the same law are given without labels.
    """
    given = [models] if isinstance(models, (Model, Case)) else list(models)
    cases = tuple(
        entry if isinstance(entry, Case) else Case(entry.label, entry, common_clearance(entry)) for entry in given
    )
    labels = [case.label for case in cases]
    # Who gives cases has chosen their labels.
    chosen = bool(given) and all(isinstance(entry, Case) for entry in given)
    if not chosen and len(set(labels)) < max(len(labels), 1):
        raise InputError(
            f"models: got {len(labels)} with the labels {', '.join(labels) or 'none'}; allowed: at least one, and each "
            "label once; give a Case with a label of its own for each model"
        )
    return cases
