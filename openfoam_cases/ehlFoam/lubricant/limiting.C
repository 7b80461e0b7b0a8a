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
    stress_(positive(dict, "stress"))
{}


Foam::scalar Foam::shearLaws::limiting::viscosity(const scalar mu, const scalar rate) const
{
    const scalar s = mu*mag(rate)/stress_;
    return s < 1e-3 ? mu*(1 - s/2 + s*s/6) : -mu*std::expm1(-s)/s;
}
