/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "incompressible.H"
#include "oilLaw.H"

addOilLaw(densityLaw, incompressible)


Foam::densityLaws::incompressible::incompressible(const dictionary& dict)
:
    rho0_(positive(dict, "density"))
{}


Foam::scalar Foam::densityLaws::incompressible::density(const scalar) const
{
    return rho0_;
}
