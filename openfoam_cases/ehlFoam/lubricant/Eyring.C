/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "Eyring.H"
#include "oilLaw.H"
#include <cmath>

addOilLaw(shearLaw, Eyring)


Foam::shearLaws::Eyring::Eyring(const dictionary& dict)
:
    stress_(positive(dict, "stress"))
{}


Foam::shearAnswer Foam::shearLaws::Eyring::thinning(const scalar tau, const scalar) const
{
    const scalar s = min(mag(tau)/stress_, farthest);
    if (s < 1e-4) return {1 + s*s/6, 1 + 0.5*s*s};
    if (s < most) return {std::sinh(s)/s, std::cosh(s)};
    const scalar slope = std::cosh(most); // its tangent
    return {std::sinh(most)/s + slope*(1 - most/s), slope};
}


Foam::shearAnswer Foam::shearLaws::Eyring::yielding(const scalar newton, const scalar) const
{
    const scalar y = mag(newton)/stress_;
    if (y < small) return {1, 1};
    return {std::asinh(y)/y, 1/std::hypot(scalar(1), y)};
}


Foam::scalar Foam::shearLaws::Eyring::stress(const scalar) const
{
    return stress_;
}
