"""Oil supply and roughness as files state them: the tables [supply] and [surface]."""

from __future__ import annotations

from ehdmaps.jobs.table import Table
from ehdmaps.physics.oil_supply import LAYERS, THICKEST, THINNEST, OilSupply
from ehdmaps.physics.surface import FINEST, LIMITS, ROUGHEST, Surface
from ehdmaps.units import FILM, PRESSURE

KEYS = ("oil_layer", "lubrication")
"""Keys of [supply]; a table has one of them."""


def read_supply(section: Table) -> OilSupply | None:
    """Read a table with one of the keys of `KEYS`; the caller closes it.

    Parameters
    ----------
    section : Table
        The table [supply].

    Returns
    -------
    OilSupply or None
        None where a problem was noted.
    """
    layer = section.quantity("oil_layer", "m", THINNEST, THICKEST, FILM)
    kind = section.choice("lubrication", tuple(LAYERS))
    given = [key for key in KEYS if key in section]
    if len(given) != 1:
        got = "both" if given else "neither"
        section.note(
            "", f'got {got} of oil_layer and lubrication; allowed: one of the two, such as lubrication = "oil air"'
        )
        return None
    if kind is not None:
        return OilSupply.named(kind)
    return None if layer is None else OilSupply(layer)


def supply_words(supply: OilSupply | None) -> str:
    """Say which oil supply the contact laws of a map have by default.

    Parameters
    ----------
    supply : OilSupply or None
        What the job states; None where it states nothing.
    """
    if supply is None:
        return "flooded (none stated)"
    if supply.flooded:
        return supply.label
    return f"{supply.label}: contact laws cap the films by it, the points are those of flooded films"


def supply_keys(supply: OilSupply) -> dict[str, str]:
    """Return the keys of [supply] for a supply: the way back from `read_supply`.

    Parameters
    ----------
    supply : OilSupply
        The supply.

    Examples
    --------
    >>> supply_keys(OilSupply.named("grease"))
    {'lubrication': 'grease'}
    """
    if supply.flooded or supply.oil_layer == LAYERS.get(supply.lubrication):
        return {"lubrication": "flooded" if supply.flooded else supply.lubrication}
    return {"oil_layer": f"{supply.oil_layer!r} m"}


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
