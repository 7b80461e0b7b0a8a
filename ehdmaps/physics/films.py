"""Published formulas of lubricated line contacts: film thickness, damping, rolling force; one function each.

Published film thickness formulas of lubricated line contacts, one function each.

Groups: M, L, H = h/R (eta0 us/(E'R))^(-1/2) of Moes; U, W, G of Dowson and Higginson, which give h/R
(see `ehdmaps.physics.moes`). All are isothermal, Newtonian and fully flooded.

Published damping formulas of line contacts, per unit length unless said otherwise.

The rigid films follow from the Reynolds equation of a parabolic gap h + x^2/(2R); their constants are
verified by quadrature in the tests.

Rolling force of a line contact: what the film resists with to pure rolling, per unit length.

Both walls run at u, so that only the pressure gradient shears the film: tau = dp/dx (y - h/2). Each wall feels
h/2 dp/dx against its motion, and the two together

    F = Int h dp/dx dx,        power lost in the film: F u.

The integral runs to the exit of the film; behind it the oil runs along with the walls. No shear law enters.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray, Values, as_given

MARTIN_CONSTANT = 2.447484
"""H M of the rigid isoviscous rolling film: half of w h/(eta u R) = 4.894968 (mean speed u)."""


def martin_minimum(load_number: Values) -> Values:
    """Minimum film of rigid cylinders and an isoviscous oil, H = 2.4475/M (central and minimum film are one).

    w = 4.895 eta0 u R/h_min with the mean speed u and the Reynolds exit condition. A limit for M -> 0, L ->
    0; full solutions at M = 0.1, L = 0 are 0.2 % above.

    References
    ----------
    H. M. Martin, Lubrication of gear teeth, Engineering (London) 102, 1916, 119-121; the constant is the
    exact one of the Reynolds equation, often printed as 4.9.

    Examples
    --------
    >>> round(martin_minimum(0.1), 3)
    24.475
    """
    return as_given(MARTIN_CONSTANT / load_number, load_number)


def dowson_higginson_minimum(speed_number: float, load_number: Values, material_number: float) -> Values:
    """Minimum film, h/R = 2.65 U^0.70 G^0.54 W^-0.13.

    Fitted to compressible solutions in the piezoviscous-elastic regime; full solutions lie within -7/+16 %
    of it for M >= 2. It vanishes for an isoviscous oil and must not be used there.

    Parameters
    ----------
    speed_number : float
        U = eta0 u/(E'R), u the mean of the surface speeds; see `dowson_groups`.
    load_number : float or array
        W = w/(E'R).
    material_number : float
        G = alpha E'.

    References
    ----------
    D. Dowson, Elastohydrodynamics, Proc. Inst. Mech. Engrs 182 (3A), 1968, 151-167.

    Examples
    --------
    >>> f"{dowson_higginson_minimum(1e-11, 3e-5, 5000.0):.4g}"
    '2.035e-05'
    """
    return as_given(2.65 * speed_number**0.70 * material_number**0.54 * load_number**-0.13, load_number)


def dowson_toyoda_central(speed_number: float, load_number: Values, material_number: float) -> Values:
    """Central film, h/R = 3.06 U^0.69 G^0.56 W^-0.10.

    For an incompressible oil in the piezoviscous-elastic regime; within 22 % of full solutions for
    2 <= M <= 1000.

    Parameters
    ----------
    speed_number : float
        U = eta0 u/(E'R), u the mean of the surface speeds; see `dowson_groups`.
    load_number : float or array
        W = w/(E'R).
    material_number : float
        G = alpha E'.

    References
    ----------
    D. Dowson, S. Toyoda, A central film thickness formula for elastohydrodynamic line contacts, Proc. 5th
    Leeds-Lyon Symposium on Tribology, 1978, 60-65.

    Examples
    --------
    >>> f"{dowson_toyoda_central(1e-11, 3e-5, 5000.0):.4g}"
    '2.627e-05'
    """
    return as_given(3.06 * speed_number**0.69 * material_number**0.56 * load_number**-0.10, load_number)


def pan_hamrock_central(speed_number: float, load_number: Values, material_number: float) -> Values:
    """Central film, h/R = 2.922 W^-0.166 U^0.692 G^0.470.

    Fitted to compressible solutions with Roelands' law in the piezoviscous-elastic regime.

    Parameters
    ----------
    speed_number : float
        U = eta0 u/(E'R), u the mean of the surface speeds; see `dowson_groups`.
    load_number : float or array
        W = w/(E'R).
    material_number : float
        G = alpha E'.

    References
    ----------
    P. Pan, B. J. Hamrock, Simple formulas for performance parameters used in elastohydrodynamically
    lubricated line contacts, J. Tribology 111, 1989, 246-251.

    Examples
    --------
    >>> f"{pan_hamrock_central(1e-11, 3e-5, 5000.0):.4g}"
    '2.203e-05'
    """
    return as_given(2.922 * load_number**-0.166 * speed_number**0.692 * material_number**0.470, load_number)


def asymptotes(load_number: float, oil_number: float) -> tuple[float, float, float, float]:
    """Film numbers of the four regimes: rigid and elastic isoviscous, rigid and elastic piezoviscous.

    H_RI = 3/M, H_EI = 2.621 M^(-1/5), H_RP = 1.287 L^(2/3), H_EP = 1.311 M^(-1/8) L^(3/4), see `moes_central`.

    Parameters
    ----------
    load_number : float
        M, > 0.
    oil_number : float
        L, >= 0.

    Examples
    --------
    >>> [round(H, 3) for H in asymptotes(20.0, 10.0)]
    [0.15, 1.44, 5.974, 5.07]
    """
    M, L = load_number, oil_number
    return 3.0 / M, 2.621 * M**-0.2, 1.287 * L ** (2.0 / 3.0), 1.311 * M**-0.125 * L**0.75


def elastic_piezoviscous(load_number: float, oil_number: float) -> bool:
    """Tell whether a contact is where the power laws of loaded contacts hold: 2 <= M <= 1000, piezoviscous and elastic.

    Of the four regimes it is that whose asymptote is the smaller of the piezoviscous two and above the isoviscous ones.
    Beyond L = 150 there are no full solutions to compare with.

    Parameters
    ----------
    load_number : float
        M, > 0.
    oil_number : float
        L, >= 0.

    Examples
    --------
    >>> elastic_piezoviscous(20.0, 10.0), elastic_piezoviscous(20.0, 1.0), elastic_piezoviscous(0.2, 10.0)
    (True, False, False)
    """
    rigid_isoviscous, elastic_isoviscous, rigid, elastic = asymptotes(load_number, oil_number)
    known = 2.0 <= load_number <= 1000.0 and oil_number <= 150.0
    return known and max(rigid_isoviscous, elastic_isoviscous) <= elastic <= rigid


def moes_central(load_number: Values, oil_number: float) -> Values:
    """Central film number H of an incompressible oil over all four regimes.

    The regimes rigid or elastic (R, E), isoviscous or piezoviscous (I, P)
    H_RI = 3/M, H_EI = 2.621 M^(-1/5), H_RP = 1.287 L^(2/3), H_EP = 1.311 M^(-1/8) L^(3/4) are joined by
    H^s = (H_RI^(7/3) + H_EI^(7/3))^(3s/7) + (H_RP^(-7/2) + H_EP^(-7/2))^(-2s/7),
    s = (7 + 8 exp(-2 H_EI/H_RI))/5.

    Parameters
    ----------
    load_number : float or array
        M, > 0; any size, it neither overflows nor divides by zero.
    oil_number : float
        L, >= 0.

    Notes
    -----
    Incompressible central films lie within +1/-6 % of it for M >= 2; compressible minimum films are 0.70 to
    0.80 of it: it is no minimum film. At low load 3/M is 23 % above the exact rigid limit 2.4475/M.

    References
    ----------
    C. H. Venner, A. A. Lubrecht, Multilevel Methods in Lubrication, Elsevier, 2000; after H. Moes, Wear 159,
    1992, 57-66.

    Examples
    --------
    >>> round(moes_central(20.0, 10.0), 3)
    5.101
    """
    film_number, _ = moes_central_and_slope(load_number, oil_number)
    return film_number


def moes_central_and_slope(load_number: Values, oil_number: float) -> tuple[Values, Values]:
    """Film number H of `moes_central` and its derivative dH/dM, in closed form.

    Written with logarithms of the regimes, so that neither end of M nor L = 0 overflows.

    Examples
    --------
    >>> H, slope = moes_central_and_slope(20.0, 10.0)
    >>> round(H, 3), round(slope, 4)
    (5.101, -0.0258)
    """
    M = np.asarray(load_number, dtype=float)
    L = float(oil_number)
    rigid_isoviscous, elastic_isoviscous = 3.0 / M, 2.621 * M**-0.2
    rigid_piezoviscous, elastic_piezoviscous = 1.287 * L ** (2.0 / 3.0), 1.311 * M**-0.125 * L**0.75

    # Isoviscous part Q and piezoviscous part P, with their slopes d ln/d ln M.
    ratio = elastic_isoviscous / rigid_isoviscous
    Q = rigid_isoviscous * (1.0 + ratio ** (7.0 / 3.0)) ** (3.0 / 7.0)
    slope_Q = -1.0 + 0.8 * ratio ** (7.0 / 3.0) / (1.0 + ratio ** (7.0 / 3.0))
    bend = (elastic_piezoviscous / rigid_piezoviscous) ** 3.5 if L > 0.0 else np.zeros_like(M)
    P = elastic_piezoviscous * (1.0 + bend) ** (-2.0 / 7.0)
    slope_P = -0.125 / (1.0 + bend)

    with np.errstate(under="ignore"):
        blend = np.exp(-2.0 * ratio)
        s = (7.0 + 8.0 * blend) / 5.0
        slope_s = -(16.0 / 5.0) * 0.8 * ratio * blend  # ds/d ln M
        quotient = P / Q
        weight = quotient**s / (1.0 + quotient**s)
        log_sum = np.log1p(quotient**s)
        log_quotient = np.log(quotient) if L > 0.0 else np.zeros_like(M)
        H = Q * np.exp(log_sum / s)
        log_slope = slope_Q + weight * (slope_P - slope_Q)
        log_slope = log_slope + slope_s * (weight * log_quotient / s - log_sum / s**2)
    return as_given(H, load_number), as_given(log_slope * H / M, load_number)


ROLLING_FILM_CONSTANT = 6.548276
"""c/(eta (R/h)^1.5) of the rigid isoviscous rolling film with the Reynolds exit."""


def rolling_film_damping(film: Values, viscosity: float, radius: float) -> Values:
    """Damping of a rigid isoviscous rolling film, c = 6.548 eta (R/h)^1.5 [N s/m2].

    The exit of the film is free (Reynolds condition) and moves with the squeeze; linear in the squeeze
    velocity, at a rate small against the rolling.

    Parameters
    ----------
    film : float or array
        h, the smallest film [m], h << R.
    viscosity : float
        eta [Pa s].
    radius : float
        R [m].

    Examples
    --------
    >>> round(rolling_film_damping(1e-6, viscosity=0.1, radius=5e-3))
    231517
    """
    return as_given(ROLLING_FILM_CONSTANT * viscosity * (radius / film) ** 1.5, film)


def dietl_damping(
    load: Values,
    speed: float,
    viscosity: float,
    pressure_viscosity: float,
    radius: float,
    reduced_modulus: float,
    length: float,
    inlet_length_factor: float = 1.0,
) -> Values:
    """Damping of a whole contact by Dietl's regression, equation 23 of the thesis [N s/m], not per length.

    c = K0 R^0.781 l^0.769 E'^1.069 eta0^0.531 alpha^0.424 q^-0.136 us^-0.434 f^-0.563, K0 = 0.1963, all in SI (a
    further factor 1e-3 of the source converts to N s/mm). Dimensions close only with q per length, and K0 in kg^-0.04
    m^0.06 s^0.115. It does not add up over slices.

    Parameters
    ----------
    load : float or array
        q [N/m].
    speed : float
        Entrainment speed u [m/s], half of the sum us of both surface speeds.
    viscosity, pressure_viscosity : float
        eta0 [Pa s] and alpha [1/Pa] at ambient pressure.
    radius, reduced_modulus : float
        R [m] and E' [Pa].
    length : float
        l of the contact [m].
    inlet_length_factor : float
        Length factor f of the inlet zone. The sources at hand do not say how it is found: 1 is assumed.

    References
    ----------
    P. Dietl, Damping and stiffness characteristics of rolling element bearings, PhD thesis, TU Wien, 1997; taken from
    later work that quotes it.

    Examples
    --------
    >>> round(dietl_damping(88571.4, 1.7, 0.0845, 2.24e-8, 5.5152e-3, 230.769e9, 0.7e-3), 1)
    341.5
    """
    lengths: float = 0.1963 * radius**0.781 * length**0.769
    oil = viscosity**0.531 * pressure_viscosity**0.424
    factors: float = (2.0 * speed) ** -0.434 * inlet_length_factor**-0.563
    return as_given(lengths * reduced_modulus**1.069 * oil * load**-0.136 * factors, load)


RIGID_ROLLING_CONSTANT = 4.159245
"""F/sqrt(eta u w) of the rigid isoviscous rolling film with the Reynolds exit, the limit of light loads, whatever the
radius: w = 4.895 eta u R/h and F = 9.202 eta u sqrt(R/h), both walls together."""


def film_times_rise(film: FloatArray, pressure: FloatArray) -> float:
    """Int h dp over the nodes of a grid, to fourth order in the index of the nodes.

    The nodes may be graded, as long as they are smoothly so; dp vanishes at both ends, as it does at the exit of a film
    and far before it. The unit is that of film times pressure.

    Parameters
    ----------
    film, pressure : ndarray, shape (n,)
        h and p at the nodes, along the rolling; n >= 4.

    Examples
    --------
    >>> x = np.linspace(-1.0, 1.0, 41)
    >>> round(film_times_rise(1.0 - x, (1.0 - x**2) ** 2), 5), round(16 / 15, 5)
    (1.06667, 1.06667)
    """
    middle = 0.5 * (film[1:] + film[:-1])
    bend = film[:-3] - film[1:-2] - film[2:-1] + film[3:]
    # h half-way less h''/24: -1/16 and -1/48 of the bend, which is 2 h''
    middle[1:-1] -= bend / 12.0
    return float(middle @ (pressure[1:] - pressure[:-1]))


def rolling_force_of_inlet(distance: float, film: float, flow: float, wedge: float, radius: float) -> float:
    """Int h dp/dx dx over all of the inlet before a place, where the gap is a parabola and the oil as at rest.

    dp/dx = wedge (h - flow)/h^3 and h = film + (s^2 - distance^2)/(2 radius) at the distances s beyond. In SI wedge is
    12 eta0 u.

    Parameters
    ----------
    distance : float
        Distance of the place before the contact centre, many film lengths sqrt(2 h R).
    film : float
        h at the place.
    flow : float
        Mass flow over density at rest and speed: the film whose oil at rest the contact takes in.
    wedge : float
        Factor of Reynolds' equation.
    radius : float
        Reduced radius R; it is 1 where films are in b^2/R and lengths in b.
    """
    least = film - 0.5 * distance**2 / radius
    once = 2.0 * radius / distance * (1.0 - 2.0 * least * radius / (3.0 * distance**2))
    twice = 4.0 * radius**2 / (3.0 * distance**3)
    return wedge * (once - flow * twice)
