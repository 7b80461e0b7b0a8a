"""Choices: what a command takes in place of what its file states, one row each, in the same words in both programs.

A row says how a choice is called, what --help says of it, how its text is read, how a value is told to people, and what
it changes. `MAP_CHOICES` are those of a map; those of a scene are in `mbs.scene.choices`. What takes long to import is
imported by the function that needs it: the command line lists these rows before it knows what is asked.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from ehdmaps.errors import InputError, Problems
from ehdmaps.units import FILM, Display, closest, quantity_between, quantity_within, short

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from ehdmaps.physics.approach import StructuralLaw
    from ehdmaps.physics.oil_supply import OilSupply
    from ehdmaps.physics.surface import Surface

Subject = TypeVar("Subject")


@dataclass(frozen=True)
class Choice(Generic[Subject]):
    """A choice: a row of a table such as `MAP_CHOICES`.

    Attributes
    ----------
    name : str
        Name of the choice: --NAME on the command line.
    metavar : str
        How --help calls its value.
    said : str
        Meaning, for --help.
    default : str
        Value where it is left out, for --help; {file} stands for what states it: a scene, a job.
    read : callable
        Reader of a text, which gives a value; raises `InputError` with what was got and what is allowed.
    change : callable
        The subject with that value; raises `InputError` where it does not fit.
    text : callable
        A value for people.
    together : bool
        Whether several texts are one value, with semicolons between them; else each is a case.
    """

    name: str
    metavar: str
    said: str
    default: str
    read: Callable[[str], Any]
    change: Callable[[Subject, Any], Subject]
    text: Callable[[Any], str] = str
    together: bool = False

    @property
    def key(self) -> str:
        """Its name among the arguments of a command line."""
        return self.name.replace("-", "_")

    def help(self, file: str, more: str = "") -> str:
        """Text of --help.

        Parameters
        ----------
        file : str
            What states it where it is left out: a scene, a job.
        more : str
            What else is said, before the default.
        """
        default = f"; default: {self.default.format(file=file)}" if self.default else ""
        return (self.said + more + default).replace("%", "%%")

    def values(self, texts: Iterable[str], problems: Problems) -> list[Any]:
        """Read all texts that were given; what is wrong, and what comes twice, is noted and left out.

        Parameters
        ----------
        texts : iterable of str
            What was given.
        problems : Problems
            Appended to.
        """
        values: list[Any] = []
        for text in texts:
            with problems.after(f"--{self.name}: "):
                value = self.read(text)
                if value in values:
                    raise InputError(f"got {text!r:.60} twice; allowed: each once")
                values.append(value)
        return values


def one_of(allowed: Callable[[], Sequence[str]]) -> Callable[[str], str]:
    """A reader of a name.

    Parameters
    ----------
    allowed : callable
        Gives the names that are allowed.
    """

    def read(text: str) -> str:
        names = tuple(allowed())
        if text not in names:
            raise InputError(f"got {text!r:.60}{closest(text, names)}; allowed: {', '.join(names)}")
        return text

    return read


def _structures() -> Sequence[str]:
    """Names of the structural laws."""
    from ehdmaps.physics.approach import STRUCTURAL_LAWS

    return STRUCTURAL_LAWS


def _physics() -> Sequence[str]:
    """Names of what a film knows of heat."""
    from ehdmaps.physics.heat import PHYSICS

    return PHYSICS


def _shears() -> Sequence[str]:
    """Names of the laws of the shear stress."""
    from ehdmaps.physics.rheology import SHEARS

    return tuple(SHEARS)


def supply_from_text(text: str) -> OilSupply:
    """Read a supply from one text: a kind of lubrication, or the thickness of an oil layer.

    Parameters
    ----------
    text : str
        One of the names of `ehdmaps.physics.oil_supply.LAYERS`, or a length such as "5 um".

    Raises
    ------
    InputError
        With one problem, which does not say where: the caller knows that.

    Examples
    --------
    >>> supply_from_text("oil air").label
    'oil air (oil layer 2 um)'
    >>> supply_from_text("5 um").oil_layer
    5e-06
    """
    from ehdmaps.physics.oil_supply import LAYERS, THICKEST, THINNEST, OilSupply

    if text in LAYERS:
        return OilSupply.named(text)
    names = tuple(LAYERS)
    wrong = (
        f"got {short(text)}{closest(text, names)}; allowed: {', '.join(names)}, or the thickness of an oil layer of "
        f"{FILM.text(THINNEST)} to {FILM.text(THICKEST)}, such as '5 um'"
    )
    return OilSupply(quantity_within(text, "m", THINNEST, THICKEST, wrong))


def surface_from_text(text: str) -> Surface:
    """Read a surface from one text: the combined rms roughness, or "smooth".

    Parameters
    ----------
    text : str
        Length such as "0.2 um", or "smooth".

    Raises
    ------
    InputError
        With one problem, which does not say where: the caller knows that.

    Examples
    --------
    >>> surface_from_text("0.2 um").label
    'roughness 0.2 um'
    """
    from ehdmaps.physics.surface import FINEST, ROUGHEST, SMOOTH, Surface

    if text == "smooth":
        return SMOOTH
    wrong = (
        f"got {short(text)}; allowed: a combined rms roughness of {FILM.text(FINEST)} to {FILM.text(ROUGHEST)}, such "
        "as '0.2 um', or smooth"
    )
    return Surface(quantity_within(text, "m", FINEST, ROUGHEST, wrong))


def _with_structure(emap: EHDMap, law: StructuralLaw) -> EHDMap:
    """The same films between solids of another structural law."""
    return emap.with_structure(law)


def _with_roughness(emap: EHDMap, surface: Surface) -> EHDMap:
    """The same films with laws of other surfaces."""
    return emap.with_surface(surface)


def _with_supply(emap: EHDMap, supply: OilSupply) -> EHDMap:
    """The same films with laws of another oil supply."""
    return emap.with_supply(supply)


STRUCTURE: Choice[EHDMap] = Choice(
    "structural-law",
    "NAME",
    "law of the solids in approach, k and c: iso16281 | palmgren | half_space | fe",
    "that of the job",
    one_of(_structures),
    _with_structure,
)
ROUGHNESS: Choice[EHDMap] = Choice(
    "roughness",
    "LENGTH",
    'combined rms roughness, such as "0.2 um", or smooth: film and asperities share the load',
    "that of the job",
    surface_from_text,
    _with_roughness,
    lambda surface: "smooth" if surface.smooth else str(surface.label),
)
SUPPLY: Choice[EHDMap] = Choice(
    "supply",
    "OIL",
    "oil that the contacts get: flooded | oil bath | oil air | grease, or the oil layer before each contact, such as "
    "'5 um'",
    "that of the job, flooded where it states none",
    supply_from_text,
    _with_supply,
    lambda supply: str(supply.short),
)

MAP_CHOICES: tuple[Choice[EHDMap], ...] = (STRUCTURE, ROUGHNESS, SUPPLY)
"""What is chosen of a map that is there: its films stay, its laws change."""


def _unchanged(subject: Subject, value: Any) -> Subject:
    """Same subject: what a solver is told changes nothing that is there."""
    return subject


PHYSICS: Choice[Any] = Choice(
    "physics",
    "NAME",
    "heat in the films: isothermal | inlet-heat | thermal",
    "that of the {file}",
    one_of(_physics),
    _unchanged,
)
SHEAR: Choice[Any] = Choice(
    "shear",
    "LAW",
    "law of the shear stress in the films: newtonian | eyring | carreau | limiting",
    "that of the {file}",
    one_of(_shears),
    _unchanged,
)


def texts_of(arguments: argparse.Namespace, choice: Choice[Any]) -> list[str]:
    """The texts that were given for a choice, however often.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of a command, which may lack this one.
    choice : Choice
        The choice.
    """
    given = getattr(arguments, choice.key, None)
    texts = [] if given is None else [given] if isinstance(given, str) else list(given)
    return ["; ".join(texts)] if texts and choice.together else texts


def add_choices(
    command: argparse.ArgumentParser,
    choices: Iterable[Choice[Any]],
    file: str,
    *,
    several: bool,
    more: Callable[[Choice[Any]], str] = lambda choice: "",
) -> None:
    """Add an option for each choice, in a group of their own.

    Parameters
    ----------
    command : argparse.ArgumentParser
        The command.
    choices : iterable of Choice
        Choices that it takes.
    file : str
        What states them where they are left out: a scene, a job.
    several : bool
        Whether an option may be given more than once; who reads it says what is wrong about that.
    more : callable
        What --help says of that, by choice.
    """
    group = command.add_argument_group("choices", f"in place of what the {file} states")
    for choice in choices:
        group.add_argument(
            f"--{choice.name}",
            metavar=choice.metavar,
            action="append" if several else "store",
            help=choice.help(file, more(choice)),
        )


def read_option(
    option: str, text: str | None, unit: str, limits: tuple[float, float], display: Display, problems: Problems
) -> float | None:
    """Read a quantity of the command line within limits; None if absent or wrong, with the problem noted.

    Parameters
    ----------
    option : str
        Name of the option, such as "--highest".
    text : str or None
        What was given; None if it was left out.
    unit : str
        SI unit of the value.
    limits : (float, float)
        Smallest and largest value that is allowed, in SI.
    display : Display
        How messages show them.
    problems : Problems
        Appended to.
    """
    if text is None:
        return None
    with problems.after(f"{option}: "):
        return quantity_between(text, unit, *limits, display)
    return None
