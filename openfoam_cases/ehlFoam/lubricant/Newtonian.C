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


Foam::shearAnswer Foam::shearLaws::Newtonian::thinning(const scalar, const scalar) const
{
    return {1, 1};
}


Foam::shearAnswer Foam::shearLaws::Newtonian::yielding(const scalar, const scalar) const
{
    return {1, 1};
}


Foam::scalar Foam::shearLaws::Newtonian::stress(const scalar) const
{
    return GREAT;
}
