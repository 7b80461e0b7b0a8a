/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "Barus.H"
#include "oilLaw.H"

addOilLaw(viscosityLaw, Barus)


Foam::viscosityLaws::Barus::Barus(const dictionary& dict)
:
    eta0_(positive(dict, "viscosity")),
    alpha_(notNegative(dict, "pressureViscosity"))
{}


Foam::scalar Foam::viscosityLaws::Barus::viscosity(const scalar p) const
{
    return eta0_*Foam::exp(alpha_*p);
}
