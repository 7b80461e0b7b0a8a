/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "FVA3.H"
#include "positive.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace viscosityLaws
{
    defineTypeNameAndDebug(FVA3, 0);
    addToRunTimeSelectionTable(viscosityLaw, FVA3, dictionary);
}
}


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
