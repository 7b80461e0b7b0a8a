/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "lubricant.H"
#include "positive.H"

Foam::lubricant::lubricant(const dictionary& dict, const scalar pressureUnit)
:
    viscosity_(viscosityLaw::New(dict.subDict("viscosity"))),
    density_(densityLaw::New(dict.subDict("density"))),
    shear_(shearLaw::New(dict.subDict("shear"))),
    unit_(pressureUnit),
    range_(positive(dict.subDict("cavitation"), "pressureRange"))
{}
