"""The roughness of surfaces as people write it: a table [surface] of a job or a scene, or a text of a command line."""

from __future__ import annotations

from ehdmaps.jobs.table import Table
from ehdmaps.physics.surface import FINEST, LIMITS, ROUGHEST, SMOOTH, Surface
from ehdmaps.units import FILM, PRESSURE, quantity_within, short

_ROUGHNESSES = f"{FILM.text(FINEST)} to {FILM.text(ROUGHEST)}"


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
    if text == "smooth":
        return SMOOTH
    wrong = f"got {short(text)}; allowed: a combined rms roughness of {_ROUGHNESSES}, such as '0.2 um', or smooth"
    return Surface(quantity_within(text, "m", FINEST, ROUGHEST, wrong))


def read_surface(section: Table) -> Surface | None:
    """Read a table [surface]; the caller closes it.

    Parameters
    ----------
    section : Table
        The table.

    Returns
    -------
    Surface or None
        None where a problem was noted.
    """
    roughness = section.quantity("roughness", "m", FINEST, ROUGHEST, FILM, required=True)
    given = {
        "asperity_product": section.number("asperity_product", *LIMITS["asperity_product"]),
        "asperity_slope": section.number("asperity_slope", *LIMITS["asperity_slope"]),
        "hardness": section.quantity("hardness", "Pa", *LIMITS["hardness"], PRESSURE),
    }
    if roughness is None:
        return None
    return Surface(roughness, **{name: value for name, value in given.items() if value is not None})


def surface_words(surface: Surface | None) -> str:
    """Say which surfaces the contact laws of a map have by default.

    Parameters
    ----------
    surface : Surface or None
        What the job states; None where it states nothing.
    """
    if surface is None:
        return "smooth (none stated)"
    if surface.smooth:
        return surface.label
    return f"{surface.label}: contact laws share the load with asperities, the points are those of smooth surfaces"


def surface_keys(surface: Surface) -> dict[str, str | float]:
    """Return the keys of [surface] for a rough surface: the way back from `read_surface`.

    Parameters
    ----------
    surface : Surface
        The surface.

    Examples
    --------
    >>> surface_keys(Surface(2e-7))
    {'roughness': '2e-07 m'}
    """
    usual = Surface(surface.roughness)
    keys: dict[str, str | float] = {"roughness": f"{surface.roughness!r} m"}
    for name in ("asperity_product", "asperity_slope"):
        if getattr(surface, name) != getattr(usual, name):
            keys[name] = getattr(surface, name)
    if surface.hardness != usual.hardness:
        keys["hardness"] = f"{surface.hardness!r} Pa"
    return keys
