/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "columnLayout.H"
#include "positive.H"
#include <cmath>

namespace Foam
{

/*-  The numbers of the layout are a choice: they decide how many columns an
     error takes, and a point is judged by the difference of two layouts
*/

//- x^2/(2H) at the exit of a film of constant viscosity between rigid
//  surfaces: 0.475^2, of Reynolds' condition in a parabolic gap
static constexpr scalar rigidExitSquared = 0.226;

//- How far the exit of a thin film lies behind the Hertz zone [H^(2/3)]: a guess, solutions have 0.1 to 0.45
static constexpr scalar thinExit = 0.25;

//- Rounding of the Hertz zone's term at its ends, and weight of it, in the contact's own length
static constexpr scalar blur = 0.1, coreWeight = 0.25;

//- Centre of the finest columns of the inlet, inside the edge [zones], and their weight
static constexpr scalar inletShift = 0.3, inletWeight = 1;

//- Centre before the exit, width [zones] and weight of the finest columns there
static constexpr scalar exitShift = 0.25, exitWidth = 0.6, exitWeight = 0.6;

//- Weight of the columns about the pressure spike
static constexpr scalar spikeWeight = 0.5;

//- Inlet of a film without thickness [b], and outlet where none is given [zones]
static constexpr scalar leastInlet = 1, usualOutlet = 3;

} // End namespace Foam

Foam::columnLayout::columnLayout(const dictionary& dict)
{
    const scalar H = positive(dict, "film");
    const scalar inletLength = positive(dict, "inletLength");
    const scalar outletLength = dict.found("outletLength") ? positive(dict, "outletLength") : usualOutlet;
    const scalar spikePosition = dict.get<scalar>("spikePosition");
    const scalar spikeWidth = notNegative(dict, "spikeWidth");

    const scalar length = Foam::sqrt(2*H);
    const scalar thin = Foam::pow(H, scalar(2)/3);
    const scalar zone = thin/(1 + thin/length);
    exit_ = Foam::sqrt(1 + rigidExitSquared*2*H) + thinExit*thin/(1 + thin);
    // pressure rises over half of a thick film's length, and at the edge of the Hertz zone of a thin one
    inletEdge_ = -Foam::sqrt(1 + 0.25*sqr(length));
    start_ = inletEdge_ - leastInlet - inletLength*length;
    if (dict.found("longestInlet")) start_ = max(start_, -positive(dict, "longestInlet"));
    end_ = exit_ + outletLength*zone;
    blur_ = blur*Foam::sqrt(1 + sqr(length));
    core_ = coreWeight/Foam::sqrt(1 + 0.25*sqr(length));

    terms_.append(FixedList<scalar, 3>({inletEdge_ + inletShift*zone, zone, inletWeight}));
    terms_.append(FixedList<scalar, 3>({exit_ - exitShift*zone, exitWidth*zone, exitWeight}));
    if (spikeWidth > 0)
    {
        terms_.append(FixedList<scalar, 3>({spikePosition, spikeWidth, spikeWeight}));
    }
}


void Foam::columnLayout::index(const scalar x, scalar& s, scalar& slope) const
{
    const scalar left = std::hypot(x - inletEdge_, blur_);
    const scalar right = std::hypot(x - exit_, blur_);
    s = core_*(left - right);
    slope = core_*((x - inletEdge_)/left - (x - exit_)/right);
    for (const auto& term : terms_)
    {
        const scalar ratio = (x - term[0])/term[1];
        s += term[2]*Foam::asinh(ratio);
        slope += term[2]/(term[1]*Foam::sqrt(1 + sqr(ratio)));
    }
}


Foam::scalarField Foam::columnLayout::faces(const label columns) const
{
    scalarField x(columns + 1);
    scalar first, last, slope, s;
    index(start_, first, slope);
    index(end_, last, slope);
    x[0] = start_;
    x[columns] = end_;
    for (label k = 1; k < columns; ++k)
    {
        const scalar target = first + k*(last - first)/columns;
        scalar low = x[k - 1], high = end_;
        x[k] = low;
        for (label step = 0; step < 200 && high - low > 1e-14*(end_ - start_); ++step)
        {
            index(x[k], s, slope);
            if (mag(target - s) < 1e-13*(last - first)) break;
            (s > target ? high : low) = x[k];
            x[k] += (target - s)/slope;
            if (x[k] <= low || x[k] >= high) x[k] = 0.5*(low + high);
        }
    }
    return x;
}
