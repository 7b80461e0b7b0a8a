/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "freeVolume.H"
#include "oilLaw.H"

addOilLaw(viscosityLaw, freeVolume)


Foam::viscosityLaws::freeVolume::freeVolume(const dictionary& dict)
:
    eta0_(positive(dict, "viscosity")),
    alpha_(notNegative(dict, "pressureViscosity")),
    scale_(positive(dict, "pressureScale")),
    free_(positive(dict, "freeVolume")),
    end_(scale_*(Foam::exp(0.9*free_) - 1))
{}


Foam::scalar Foam::viscosityLaws::freeVolume::viscosity(const scalar p) const
{
    const scalar inside = min(p, end_);
    const scalar g = Foam::log(1 + inside/scale_);
    const scalar left = 1 - g/free_;
    const scalar slope = alpha_/((1 + inside/scale_)*sqr(left));
    return eta0_*Foam::exp(alpha_*scale_*g/left + slope*(p - inside));
}
