/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "pointLayout.H"
#include "columnLayout.H"

namespace Foam
{

//- Centre [inside of the contact's side], width [zones x kappa] and weight of the finest columns there; weight over the
//  contact. A choice, as in columnLayout
static constexpr scalar sideShift = 0.1, sideWidth = 0.8, sideWeight = 0.5, acrossWeight = 0.6;

//- Centre [a] and width of the columns about the pressure spike, which is bent over the lines
static constexpr scalar spikeCentre = 0.6, spikeReach = 0.25;

//- Outlet [zones]: behind the sides the film ruptures farther down than behind the centre
static constexpr scalar outlet = 6;

} // End namespace Foam


Foam::pointLayout::pointLayout
(
    const pointContact& contact, const scalar film, const scalar inletLength, const label nx, const label ny
)
:
    y(ny + 1)
{
    dictionary along;
    along.set("film", film);
    along.set("inletLength", inletLength);
    along.set("outletLength", outlet);
    along.set("spikePosition", spikeCentre);
    along.set("spikeWidth", spikeReach);
    x = columnLayout(along).faces(nx);

    const scalar length = Foam::sqrt(2*film), thin = Foam::pow(film, scalar(2)/3);
    const scalar zone = thin/(1 + thin/length), kappa = contact.ellipticity;
    const scalar centre = kappa*(1 - sideShift*zone), width = sideWidth*zone*kappa;
    const scalar blur = 0.1*kappa, end = mag(x[0])/Foam::sqrt(contact.ratio);
    auto index = [&](const scalar at)
    {
        return acrossWeight/kappa*(std::hypot(at + kappa, blur) - std::hypot(at - kappa, blur))
          + sideWeight*(Foam::asinh((at - centre)/width) + Foam::asinh((at + centre)/width));
    };
    const scalar last = index(end);
    y[0] = 0;
    y[ny] = end;
    for (label k = 1; k < ny; ++k)
    {
        scalar low = y[k - 1], high = end;
        for (label step = 0; step < 100; ++step)
        {
            const scalar middle = 0.5*(low + high);
            (index(middle) < k*last/ny ? low : high) = middle;
        }
        y[k] = low;
    }
}
