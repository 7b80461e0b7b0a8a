/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "Newtonian.H"
#include "oilLaw.H"

addOilLaw(shearLaw, Newtonian)


Foam::shearLaws::Newtonian::Newtonian(const dictionary&)
{}


Foam::scalar Foam::shearLaws::Newtonian::viscosity(const scalar mu, const scalar) const
{
    return mu;
}
