/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "FVA3.H"
#include "oilLaw.H"

addOilLaw(viscosityLaw, FVA3)


Foam::viscosityLaws::FVA3::FVA3(const dictionary& dict)
:
    eta0_(positive(dict, "viscosity")),
    alpha_(notNegative(dict, "pressureViscosity")),
    scale_(positive(dict, "pressureScale"))
{}


Foam::scalar Foam::viscosityLaws::FVA3::viscosity(const scalar p) const
{
    return eta0_*Foam::exp(alpha_*p/(1 + p/scale_));
}
