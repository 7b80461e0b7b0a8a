/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "Carreau.H"
#include "oilLaw.H"
#include <cmath>

addOilLaw(shearLaw, Carreau)


Foam::shearLaws::Carreau::Carreau(const dictionary& dict)
:
    stress_(positive(dict, "stress")),
    power_(0.5*(1/positive(dict, "exponent") - 1))
{
    if (power_ < 0)
    {
        FatalIOErrorInFunction(dict)
            << "exponent: got " << dict.get<scalar>("exponent") << ", allowed are numbers above 0, up to 1"
            << exit(FatalIOError);
    }
}


Foam::shearAnswer Foam::shearLaws::Carreau::thinning(const scalar tau, const scalar) const
{
    const scalar s = min(mag(tau)/stress_, farthest);
    const scalar factor = std::exp(min(power_*std::log1p(s*s), most));
    return {factor, factor*(1 + 2*power_*s*s/(1 + s*s))};
}


Foam::shearAnswer Foam::shearLaws::Carreau::yielding(const scalar newton, const scalar) const
{
    const scalar y = mag(newton)/stress_;
    if (y < small) return {1, 1};
    // Newton in ln s, where ln y = ln s + power ln(1 + s^2) rises with a slope of 1 to 1/n
    const scalar wanted = std::log(y);
    scalar logS = wanted > 0 ? wanted/(1 + 2*power_) : wanted;
    for (label iteration = 0; iteration < 50; ++iteration)
    {
        const scalar s = std::exp(logS), share = s*s/(1 + s*s);
        const scalar move = (wanted - logS - power_*std::log1p(s*s))/(1 + 2*power_*share);
        logS += move;
        if (mag(move) < 1e-14) break;
    }
    const scalar s = std::exp(logS), share = s*s/(1 + s*s);
    return {s/y, s/(y*(1 + 2*power_*share))};
}


Foam::scalar Foam::shearLaws::Carreau::stress(const scalar) const
{
    return stress_;
}
