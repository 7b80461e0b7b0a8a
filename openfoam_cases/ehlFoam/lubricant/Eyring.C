/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "Eyring.H"
#include "oilLaw.H"

addOilLaw(shearLaw, Eyring)


Foam::shearLaws::Eyring::Eyring(const dictionary& dict)
:
    stress_(positive(dict, "stress"))
{}


Foam::scalar Foam::shearLaws::Eyring::viscosity(const scalar mu, const scalar rate) const
{
    const scalar s = mu*mag(rate)/stress_;
    return s < 1e-3 ? mu*(1 - s*s/6) : mu*Foam::asinh(s)/s;
}
