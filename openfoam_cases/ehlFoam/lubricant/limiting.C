/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "limiting.H"
#include "oilLaw.H"
#include <cmath>

addOilLaw(shearLaw, limiting)


Foam::shearLaws::limiting::limiting(const dictionary& dict)
:
    stress_(positive(dict, "stress")),
    ratio_(notNegative(dict, "ratio"))
{}


Foam::shearAnswer Foam::shearLaws::limiting::thinning(const scalar tau, const scalar p) const
{
    const scalar s = mag(tau)/stress(p);
    if (s <= near)
    {
        const scalar left = 1 - s*s, factor = 1/std::sqrt(left);
        return {factor, factor/left};
    }
    const scalar edge = std::sqrt(growth), rise = (growth - 1)*std::log(s/near);
    if (rise <= most)
    {
        const scalar factor = edge*std::exp(rise);
        return {factor, factor*growth};
    }
    const scalar last = near*std::exp(most/(growth - 1)), factor = edge*std::exp(most); // its tangent
    return {factor*(last/s + growth*(1 - last/s)), factor*growth};
}


Foam::shearAnswer Foam::shearLaws::limiting::yielding(const scalar newton, const scalar p) const
{
    const scalar y = mag(newton)/stress(p);
    if (y < small) return {1, 1};
    const scalar edge = near*std::sqrt(growth);
    if (y <= edge)
    {
        const scalar factor = 1/std::sqrt(1 + y*y);
        return {factor, factor*factor*factor};
    }
    const scalar s = near*std::exp(std::log(y/edge)/growth);
    return {s/y, s/(y*growth)};
}


Foam::scalar Foam::shearLaws::limiting::stress(const scalar p) const
{
    return stress_ + ratio_*p;
}
