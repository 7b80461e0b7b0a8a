/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "pointContact.H"
#include "positive.H"
#include "mathematicalConstants.H"

using Foam::constant::mathematical::pi;

namespace
{

//- Ellipticities that are solved: an ellipse across the motion, shorter than one that is a line's
constexpr double mostEllipticity = 20;

//- Carlson's R_F(0, y, 1) and R_D(0, y, 1) by duplication
void carlson(const double y, double& first, double& second)
{
    double X = 0, Y = y, Z = 1, sum = 0, power = 1;
    for (int step = 0; step < 60; ++step)
    {
        const double l = std::sqrt(X*Y) + std::sqrt(Y*Z) + std::sqrt(Z*X);
        sum += power/(std::sqrt(Z)*(Z + l));
        power *= 0.25;
        X = 0.25*(X + l);
        Y = 0.25*(Y + l);
        Z = 0.25*(Z + l);
    }
    first = 1/std::sqrt(Z);
    second = 3*sum + power/(Z*std::sqrt(Z));
}

} // End anonymous namespace


Foam::pointContact::pointContact(const dictionary& dict)
:
    rollingRadius(positive(dict, "reducedRadius")),
    transverseRadius(positive(dict, "transverseRadius")),
    modulus(positive(dict, "reducedModulus")),
    load(positive(dict, "load")),
    lowerSpeed(dict.get<scalar>("lowerSpeed")),
    upperSpeed(dict.get<scalar>("upperSpeed")),
    ratio(rollingRadius/transverseRadius)
{
    if (!(entrainment() > 0) || entrainment() > GREAT)
    {
        FatalIOErrorInFunction(dict)
            << "lowerSpeed, upperSpeed: got " << lowerSpeed << ", " << upperSpeed
            << ", allowed are speeds with a mean above 0 (the film runs in +x)"
            << exit(FatalIOError);
    }
    double K = 0, R = 0;
    auto ratioOf = [&](const scalar kappa)
    {
        carlson(1/sqr(kappa), K, R);
        return R/3/(sqr(kappa)*(K - R/3));
    };
    if (!(ratio <= 1 + 1e-9 && ratio >= ratioOf(mostEllipticity)))
    {
        FatalIOErrorInFunction(dict)
            << "reducedRadius, transverseRadius: got " << rollingRadius << ", " << transverseRadius
            << ", allowed are radii of an ellipse across the motion that is 1 to " << mostEllipticity
            << " times as long as wide" << exit(FatalIOError);
    }
    scalar low = 1, high = mostEllipticity;
    for (label step = 0; step < 100; ++step)
    {
        ellipticity = 0.5*(low + high);
        (ratioOf(ellipticity) > ratio ? low : high) = ellipticity;
    }
    ratioOf(ellipticity);
    pressureFactor = 0.5/(K - R/3);
    dryApproach = pressureFactor*K;
    halfWidth = Foam::cbrt(3*load*rollingRadius/(pi*ellipticity*pressureFactor*modulus));
    pressure = pressureFactor*modulus*halfWidth/(2*rollingRadius);
}


Foam::scalar Foam::pointContact::unitLoad() const
{
    return 2*pi*ellipticity/3;
}


Foam::scalar Foam::pointContact::wedge(const scalar viscosity) const
{
    return 12*viscosity*entrainment()*sqr(rollingRadius)/(pow3(halfWidth)*pressure);
}
