/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "DowsonHigginson.H"
#include "oilLaw.H"

addOilLaw(densityLaw, DowsonHigginson)


Foam::densityLaws::DowsonHigginson::DowsonHigginson(const dictionary& dict)
:
    rho0_(positive(dict, "density"))
{}


Foam::scalar Foam::densityLaws::DowsonHigginson::density(const scalar p) const
{
    return rho0_*(0.59e9 + 1.34*p)/(0.59e9 + p);
}
