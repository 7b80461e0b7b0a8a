/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "Roelands.H"
#include "oilLaw.H"

addOilLaw(viscosityLaw, Roelands)


Foam::viscosityLaws::Roelands::Roelands(const dictionary& dict)
:
    eta0_(positive(dict, "viscosity")),
    alpha_(notNegative(dict, "pressureViscosity")),
    z_(positive(dict, "exponent")),
    scale_(positive(dict, "pressureScale"))
{}


Foam::scalar Foam::viscosityLaws::Roelands::viscosity(const scalar p) const
{
    return eta0_*Foam::exp(alpha_*scale_/z_*(Foam::pow(1 + p/scale_, z_) - 1));
}
