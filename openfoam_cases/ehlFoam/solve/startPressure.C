/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "startPressure.H"
#include "interpolateXY.H"

namespace Foam
{

/*-  The numbers of a start are a choice: Newton's method finds the same film
     from others, in other steps
*/

//- H from which on a film has a hump of its own, and no longer Hertz' pressure
static constexpr scalar thick = 0.3;

//- Where the inlet leaves Hertz' pressure, inside of its edge, and length of the decay before [H^(2/3)]
static constexpr scalar edge = 0.15, decay = 0.6;

//- Least exponent of the decay, as good as none
static constexpr scalar leastExponent = -40;

//- Least pressure upstream, over the largest
static constexpr scalar trace = 1e-9;


/*-  Hertz' pressure [-] at x [b] with its edges rounded by a film H

    A thick film has a hump of its own width instead, s^2/(1 + t^2)^(5/2) with
    t = x/sqrt(1 + 2H) and s the distance before the exit: p = dp/dx = 0 at the
    exit, and far upstream the p ~ |x|^-3 of a parabolic gap.
*/
static scalar roundedHertz(const scalar x, const scalar H)
{
    if (H > thick)
    {
        const scalar width = Foam::sqrt(1 + 2*H);
        return sqr(max(1 - x/width, scalar(0)))/Foam::pow(1 + sqr(x/width), 2.5);
    }
    const scalar zone = Foam::pow(H, scalar(2)/3), rounding = edge*zone;
    if (x < -1 + rounding)
    {
        return Foam::sqrt(2*rounding)*Foam::exp(max((x + 1 - rounding)/(decay*zone), leastExponent));
    }
    return Foam::sqrt(max(1 - sqr(x), scalar(0)));
}

} // End namespace Foam


Foam::scalarField Foam::startPressure(const dictionary& dict, const lineContact& contact, const scalarField& x)
{
    scalarField middle(x.size() - 1), length(x.size() - 1), pressure(x.size() - 1);
    forAll(middle, i)
    {
        middle[i] = 0.5*(x[i] + x[i + 1]);
        length[i] = x[i + 1] - x[i];
    }
    if (dict.found("start"))
    {
        const dictionary& start = dict.subDict("start");
        const scalarField places(start.lookup("x")), values(start.lookup("pressure"));
        if (places.size() < 2 || places.size() != values.size())
        {
            FatalIOErrorInFunction(start)
                << "x, pressure: got lists of " << places.size() << " and " << values.size()
                << ", allowed are lists of the same length of at least 2" << exit(FatalIOError);
        }
        for (label i = 1; i < places.size(); ++i)
        {
            if (places[i] > places[i - 1]) continue;
            FatalIOErrorInFunction(start)
                << "x: got " << places[i] << " after " << places[i - 1]
                << ", allowed are places in rising order" << exit(FatalIOError);
        }
        pressure = interpolateXY(middle, places, values);
        forAll(middle, i)
        {
            if (middle[i] > places.last()) pressure[i] = min(values.last(), scalar(0));
        }
    }
    else
    {
        const scalar H = dict.subDict("mesh").get<scalar>("film");
        forAll(middle, i) pressure[i] = roundedHertz(middle[i]/contact.halfWidth, H);
    }
    // upstream the film is full, and a column at rest would not know it; behind
    // the exit a pressure below zero says how much of the film is oil
    const scalar least = trace*max(pressure);
    forAll(middle, i)
    {
        if (middle[i] < 0) pressure[i] = max(pressure[i], least);
    }
    return pressure*contact.load/sum(pressure*length);
}
