"""How thick and how thin a film may be before its numbers lose their meaning.

Thick: the gap of two cylinders is taken as a parabola, and the flow in it as that of a thin film. At the places
x = sqrt(2 h R), where the gap is twice the film and much of the pressure is built up, a parabola is h/(2 R) off the
circle, relatively, to first order, and the surfaces are inclined by sqrt(2 h/R). At h/R = 0.01 that is half a per cent
and 8 degrees: up to there nobody needs a word. At h/R = 0.3 the parabola is 18 % off, the inclination is 51 degrees,
and the whole film would reach around three quarters of the cylinder: nothing is left of the theory.

Thin: below a nanometre a film is no continuum, but some molecules. Below the roughness the surfaces touch before such a
film is all that carries.
"""

from __future__ import annotations

THIN_FILM_LIMIT = 0.01
"""h/R above which a film is outside thin-film theory, and is said to be an asymptote."""

THICK_NOTE = "film thicker than 1 % of the radius: limit of thin-film theory, Reynolds with a parabolic gap"
"""What is said of a film above `THIN_FILM_LIMIT`."""

THICKEST_FILM = 0.3
"""h/R above which a film is refused."""

CONTINUUM = 1e-9
"""Film below which there is no continuum [m]."""

NO_CONTINUUM, BELOW_ROUGHNESS = "film below 1 nm: no continuum", "film below the roughness"
"""What is said of films that are too thin for their solution to be taken as it is."""

HEAVIEST_LOAD_NUMBER = 2e6
"""Moes' M above which the film is too thin for double precision to see it beside the elastic deflection."""

LIGHTEST_LOAD_NUMBER = 1e-12
"""Moes' M below which double precision does not see the elastic deflection, of size b^2/R, beside the film, H ~ 1/M:
the linear response, made of both, loses digits, and its equations are singular from 1e-16 on."""


def too_thick(film: float, radius: float, thickest: float = THICKEST_FILM) -> str:
    """Why a film is refused; empty where it is not.

    Lines that stand for their groups only, from which contact laws are made, have no thickness of their own: for them
    the limit is infinite.

    Parameters
    ----------
    film : float
        Film offset h [m].
    radius : float
        Reduced radius R [m].
    thickest : float
        Largest h/R that is taken.
    """
    if not film > thickest * radius:
        return ""
    return (
        f"film h/R = {film / radius:.3g} above {thickest:g}: neither thin-film theory nor a parabolic gap holds; "
        "take a higher load, a lower speed or a thinner oil"
    )


def too_thin(film: float, roughness: float = 0.0) -> str:
    """What a film is too thin for, in words that follow its status; empty where it is not.

    Parameters
    ----------
    film : float
        Minimum film [m]; 0 is the dry contact, of which nobody is told that it has a thin film.
    roughness : float
        Combined rms roughness [m]; 0 where none is known.
    """
    if not film > 0.0:
        return ""
    if film < CONTINUUM:
        return NO_CONTINUUM
    return BELOW_ROUGHNESS if film < roughness else ""
