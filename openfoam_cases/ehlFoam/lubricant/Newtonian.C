/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "Newtonian.H"
#include "positive.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace shearLaws
{
    defineTypeNameAndDebug(Newtonian, 0);
    addToRunTimeSelectionTable(shearLaw, Newtonian, dictionary);
}
}


Foam::shearLaws::Newtonian::Newtonian(const dictionary&)

{}


Foam::scalar Foam::shearLaws::Newtonian::viscosity(const scalar mu, const scalar) const
{
    return mu;
}
