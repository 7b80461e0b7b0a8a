"""Contacts of a job behind an oil layer: what `ehdmaps solve --supply` adds to the record and the table of a point."""

from __future__ import annotations

import math
from typing import Any

from ehdmaps.ehl.solver import SuppliedFilm
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.units import FILM


def supplied_record(supply: OilSupply, found: SuppliedFilm) -> dict[str, Any]:
    """Return what a supply adds to the plain values of one contact, SI; None where there is no number.

    Parameters
    ----------
    supply : OilSupply
        Oil supply of the contact.
    found : SuppliedFilm
        Film behind it.
    """
    values = {
        "oil_layer": supply.oil_layer,
        "flow_ratio": found.flow_ratio,
        "meniscus": found.meniscus,
        "supplied_compliance": found.supplied_compliance,
    }
    plain = {key: value if math.isfinite(value) else None for key, value in values.items()}
    return {"supply": supply.label, **plain}


def supplied_table(supply: OilSupply, found: dict[str, SuppliedFilm]) -> str:
    """Return the printed table: a line a contact.

    Parameters
    ----------
    supply : OilSupply
        Oil supply of the contacts.
    found : dict
        Films by the name of the contact.
    """
    lines = [
        f"oil supply: {supply.label}; k and c of a starved contact are those of a meniscus that stays where it is",
        f"  {'':12s}{'flow over flooded':>20s}{'meniscus before the centre':>30s}",
    ]
    lines += [
        f"  {name:12s}{_number(film.flow_ratio):>20s}{_place(film.meniscus):>30s}" for name, film in found.items()
    ]
    return "\n".join(lines)


def _number(ratio: float) -> str:
    return "-" if math.isnan(ratio) else f"{ratio:.4g}"


def _place(meniscus: float) -> str:
    if math.isnan(meniscus):
        return "-"
    return "flooded" if meniscus == math.inf else FILM.text(meniscus)
