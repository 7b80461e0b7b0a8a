"""A scene with its contact law, as they are chosen: by names of laws, and by maps.

What takes long to import is imported by the function that needs it: the command line lists what can be chosen before it
knows what is asked.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ehdmaps.errors import EhdmapsError, Problems
from mbs.bearings.laws import FORMULAS
from mbs.model.relaxation import Films
from mbs.scene.map_set import TABLE_LAW

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from ehdmaps.physics.oil_supply import OilSupply
    from mbs.scene.assembly import Model
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
    inlet_heat : bool or None
        Whether heat in the inlet thins films of the film table; None for the default. Maps of it know it themselves.
    """

    label: str
    name: str | None
    maps: MapSet | None = None
    films: Films | None = None
    supply: OilSupply | None = None
    inlet_heat: bool | None = None

    @property
    def has_films(self) -> bool:
        """Tell whether it knows an oil."""
        return self.name == "map" or self.name in FORMULAS or (self.name is None and self.maps is not None)

    @property
    def may_relax(self) -> bool:
        """Tell whether it has films that may relax; of ball bearings alone, too."""
        return self.has_films or self.name == TABLE_LAW


@dataclass(frozen=True, eq=False)
class Subject:
    """Subject of a run: a scene with a law.

    Attributes
    ----------
    scene : Scene
        The scene.
    law : LawChoice
        The law.
    clearance : float or None
        Diametral clearance of all bearings [m]; None for those of the scene.
    chosen : mapping of str to str
        What was chosen beside the law, by the names of the choices, as results tell it.
    """

    scene: Scene
    law: LawChoice
    clearance: float | None = None
    chosen: Mapping[str, str] = field(default_factory=dict)

    def model(self) -> Model:
        """The model; see `mbs.scene.assembly.assemble`."""
        from mbs.scene.assembly import assemble

        law = self.law
        model = assemble(self.scene, law.name, law.maps, self.clearance, law.films, law.supply, law.inlet_heat)
        return dataclasses.replace(model, chosen=self.chosen)


def named_law(name: str | None, scene: Scene) -> LawChoice:
    """A law by its name; that of the film table brings its maps.

    Parameters
    ----------
    name : str or None
        hertz, formula, table and so on, see `mbs.scene.contact_laws`; None for the default of the scene.
    scene : Scene
        Scene with its bearings and its oil.

    Raises
    ------
    InputError
        If the film table does not serve the scene. What else is wrong about a law is said by `assemble`.
    """
    from mbs.scene.contact_laws import law_in_force, law_label

    law, maps = law_in_force(name, None, scene)
    if maps is not None:
        return map_law(maps)
    # a law that is dry by default has no name, so that its models tell why
    return LawChoice(law_label(law), None if name is None and law == "hertz" else law)


def map_law(maps: MapSet, words: str = "") -> LawChoice:
    """The law of some maps.

    Parameters
    ----------
    maps : MapSet
        The maps.
    words : str
        What tells it from other laws of maps.
    """
    return LawChoice(f"{maps.label} {words}".rstrip(), "map", maps)


def opened_map(path: str, problems: Problems) -> EHDMap | None:
    """A map of a command; None where a problem was noted.

    Parameters
    ----------
    path : str
        File of a map, or a job.
    problems : Problems
        What is wrong is appended.
    """
    from ehdmaps.jobs.show.opening import open_given

    try:
        with problems:
            return open_given(path)
    except EhdmapsError as error:
        problems += [f"--map: {line}" for line in str(error).splitlines()]
    return None


def opened_maps(paths: Sequence[str], scene: Scene, problems: Problems) -> list[LawChoice]:
    """The laws of maps that are given together: one for each set, see `mbs.scene.map_set`.

    Parameters
    ----------
    paths : sequence of str
        Files of maps, or jobs.
    scene : Scene
        Scene with the bearings.
    problems : Problems
        What is wrong is appended.
    """
    from mbs.scene.map_set import map_sets

    opened = [(Path(path).stem, opened_map(path, problems)) for path in paths]
    with problems:
        sets = map_sets([(name, emap) for name, emap in opened if emap is not None], scene.bearings)
        labels = [one.label for _, one in sets]
        return [map_law(one, words if labels.count(one.label) > 1 else "") for words, one in sets]
    return []
