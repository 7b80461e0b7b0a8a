/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "columnLayout.H"
#include "positive.H"
#include <cmath>

Foam::columnLayout::columnLayout(const dictionary& dict)
{
    const scalar H = positive(dict, "film");
    const scalar inletLength = positive(dict, "inletLength");
    const scalar outletLength = dict.found("outletLength") ? positive(dict, "outletLength") : 3;
    const scalar spikePosition = dict.get<scalar>("spikePosition");
    const scalar spikeWidth = notNegative(dict, "spikeWidth");

    const scalar length = Foam::sqrt(2*H);
    const scalar thin = Foam::pow(H, scalar(2)/3);
    const scalar zone = thin/(1 + thin/length);
    exit_ = Foam::sqrt(1 + 0.226*2*H) + 0.25*thin/(1 + thin);
    inletEdge_ = -Foam::sqrt(1 + 0.25*sqr(length));
    start_ = inletEdge_ - 1 - inletLength*length;
    end_ = exit_ + outletLength*zone;
    blur_ = 0.1*Foam::sqrt(1 + sqr(length));
    core_ = 0.25/Foam::sqrt(1 + 0.25*sqr(length));

    terms_.append(FixedList<scalar, 3>({inletEdge_ + 0.3*zone, zone, 1.0}));
    terms_.append(FixedList<scalar, 3>({exit_ - 0.25*zone, 0.6*zone, 0.6}));
    if (spikeWidth > 0)
    {
        terms_.append(FixedList<scalar, 3>({spikePosition, spikeWidth, 0.5}));
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
