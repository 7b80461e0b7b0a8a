/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "upstream.H"
#include "mathematicalConstants.H"

namespace Foam
{

//- m/d^2 below which the integrals are summed as a series, as differences of large numbers lose digits there
static constexpr scalar mostOfSeries = 0.5;

//- Terms of the series at most: it converges for -1 < m/d^2 < 1, and films are never as thin as that at an inlet
static constexpr label mostTerms = 200;

} // End namespace Foam


Foam::upstreamFilm::upstreamFilm
(
    const scalar drag,
    const scalar radius,
    const scalar distance,
    const scalar film,
    const scalar flow
)
{
    const scalar m = 2*radius*film - sqr(distance), t = m/sqr(distance);
    scalar I2 = 0, I3 = 0;
    if (t < mostOfSeries)
    {
        // (1 + t/x^2)^-n over x = s/d, term by term
        scalar power = 1;
        for (label k = 0; k < mostTerms && mag(power) > 1e-14; ++k, power *= -t)
        {
            I2 += power*(k + 1)/(2*k + 3);
            I3 += power*(k + 1)*(k + 2)/(2*(2*k + 5));
        }
        I2 /= pow3(distance);
        I3 /= pow5(distance);
    }
    else
    {
        const scalar a = Foam::sqrt(m), angle = Foam::atan2(a, distance), square = sqr(distance) + m;
        I2 = angle/(2*pow3(a)) - distance/(2*m*square);
        I3 = 3*angle/(8*pow5(a)) - distance/(4*m*sqr(square)) - 3*distance/(8*sqr(m)*square);
    }
    pressure = 12*drag*(4*sqr(radius)*I2 - 8*pow3(radius)*flow*I3);
    load = 12*drag*radius*(1/film - flow/(2*sqr(film))) - distance*pressure;
}
