/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "lineContact.H"
#include "positive.H"
#include "mathematicalConstants.H"

using Foam::constant::mathematical::pi;

Foam::lineContact::lineContact(const dictionary& dict)
:
    radius(positive(dict, "reducedRadius")),
    modulus(positive(dict, "reducedModulus")),
    load(positive(dict, "load")),
    lowerSpeed(dict.get<scalar>("lowerSpeed")),
    upperSpeed(dict.get<scalar>("upperSpeed")),
    halfWidth(Foam::sqrt(8*load*radius/(pi*modulus))),
    pressure(2*load/(pi*halfWidth))
{
    if (!(entrainment() > 0) || entrainment() > GREAT)
    {
        FatalIOErrorInFunction(dict)
            << "lowerSpeed, upperSpeed: got " << lowerSpeed << ", " << upperSpeed
            << ", allowed are speeds with a mean above 0 (the film runs in +x)"
            << exit(FatalIOError);
    }
}
