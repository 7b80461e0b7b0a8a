/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "filmFlow.H"
#include "upstream.H"
#include "linear.H"
#include "fvcSurfaceIntegrate.H"

namespace Foam
{
    defineTypeNameAndDebug(filmFlow, 0);
    defineRunTimeSelectionTable(filmFlow, dictionary);

//- Least change of a velocity, over that of the surfaces, of which difference quotients keep some digits
static constexpr scalar leastVelocityStep = 1e-11;

}


Foam::autoPtr<Foam::filmFlow> Foam::filmFlow::New
(
    const word& flow,
    const dictionary& dict,
    filmMesh& film,
    const lineContact& contact
)
{
    auto entry = dictionaryConstructorTablePtr_->cfind(flow);
    if (!entry.found())
    {
        FatalIOErrorInLookup
        (
            dict, "flow", flow, *dictionaryConstructorTablePtr_
        ) << exit(FatalIOError);
    }
    return autoPtr<filmFlow>(entry()(dict, film, contact));
}


Foam::filmFlow::filmFlow(const dictionary& dict, filmMesh& film, const lineContact& contact)
:
    film_(film),
    contact_(contact),
    oil_(dict, contact.pressure),
    heat_(dict.found("heat") ? new filmHeat(dict.subDict("heat"), film, contact) : nullptr),
    T_(heat_.valid() ? film.fixedOnSurfaces<scalar>("T", dimTemperature).ptr() : nullptr),
    expectedFilm_(contact.filmUnit()*dict.subDict("mesh").get<scalar>("film")),
    massUnit_(oil_.density(0)*contact.entrainment()*film.depth*expectedFilm_)
{}


Foam::scalar Foam::filmFlow::densitySlope(const scalar v) const
{
    const scalar step = 1e-6;
    auto mass = [&](const scalar u) { return oil_.fraction(u)*oil_.density(u); };
    return v > 0
      ? (mass(v + step) - mass(v))/step
      : (mass(v) - mass(v - step))/step;
}


Foam::tmp<Foam::surfaceScalarField> Foam::filmFlow::mobilityOnFaces
(
    const volScalarField& mobility,
    const volScalarField& viscosity
) const
{
    // mobility x viscosity is a matter of shape alone
    tmp<surfaceScalarField> tface
    (
        linear<scalar>(film_.mesh()).interpolate(mobility*viscosity)
       /linear<scalar>(film_.mesh()).interpolate(viscosity)
    );
    surfaceScalarField& face = tface.ref();
    forAll(face, f)
    {
        if (film_.columnFace(f) < 0) continue;
        const label P = film_.mesh().owner()[f], N = film_.mesh().neighbour()[f];
        const scalar muP = viscosity[P], muN = viscosity[N];
        const scalar rise = Foam::log(muN/muP);
        const scalar fluidity = mag(rise) < 1e-4
          ? (1 - rise/2 + sqr(rise)/6)/muP
          : (1/muP - 1/muN)/rise;
        const scalar weight = film_.mesh().weights()[f];
        face[f] = fluidity*(weight*mobility[P]*muP + (1 - weight)*mobility[N]*muN);
    }
    return tface;
}


Foam::tmp<Foam::scalarField> Foam::filmFlow::gathered
(
    const surfaceScalarField& massFlux,
    const volScalarField& density,
    const scalarField& densityRate,
    const filmState* rate
) const
{
    const fvMesh& mesh = film_.mesh();
    tmp<scalarField> tmass(fvc::surfaceIntegrate(massFlux)().primitiveField()*mesh.V());
    if (rate)
    {
        tmass.ref() += densityRate*mesh.V()
          + density.primitiveField()*film_.volumeRate(rate->x, rate->h);
    }
    return tmass;
}


Foam::scalar Foam::filmFlow::inletPressure(const filmState& state) const
{
    return upstreamFilm
    (
        oil_.viscosity(0)*contact_.entrainment(), contact_.radius, -state.x[0], state.h[0], expectedFilm_
    ).pressure;
}


void Foam::filmFlow::putTemperature(const filmState& state)
{
    if (!heat_.valid()) return;
    volScalarField& T = *T_;
    for (label i = 0; i < film_.columns(); ++i)
    {
        for (label j = 0; j < film_.rows(); ++j)
        {
            T[film_.cell(i, j)] = heat_->temperature(state.local[place(i, j, warmthKind())]);
        }
    }
    for (const label patch : {film_.lower(), film_.upper()})
    {
        const labelUList& cells = film_.mesh().boundary()[patch].faceCells();
        scalarField wall(cells.size());
        const label first = patch == film_.upper() ? film_.columns() : 0;
        forAll(wall, f) wall[f] = heat_->temperature(state.wall[first + cells[f]/film_.rows()]);
        T.boundaryFieldRef()[patch] == wall;
    }
    T.correctBoundaryConditions();
}


Foam::scalarField Foam::filmFlow::filmOfCells() const
{
    scalarField h(film_.mesh().nCells());
    forAll(h, c)
    {
        h[c] = film_.film(c/film_.rows());
    }
    return h;
}


Foam::scalarField Foam::filmFlow::columnFlux(const surfaceScalarField& massFlux) const
{
    scalarField flux(film_.columns() + 1, Zero);
    forAll(massFlux, face)
    {
        const label k = film_.columnFace(face);
        if (k > 0) flux[k] += massFlux[face]/film_.depth;
    }
    flux.first() = -sum(massFlux.boundaryField()[film_.inlet()])/film_.depth;
    flux.last() = sum(massFlux.boundaryField()[film_.outlet()])/film_.depth;
    return flux;
}


void Foam::filmFlow::writeWallStress() const
{
    volScalarField& stress = regIOobject::store
    (
        new volScalarField
        (
            IOobject("wallShear", film_.mesh().time().timeName(), film_.mesh()),
            film_.mesh(),
            dimensionedScalar("wallShear", dimPressure, 0)
        )
    );
    for (const label side : {0, 1})
    {
        stress.boundaryFieldRef()[side ? film_.upper() : film_.lower()] == wallStress_[side];
    }
    stress.write();
}


Foam::scalar Foam::filmFlow::velocityStep
(
    const scalar v,
    const scalar thickness,
    const scalar below,
    const scalar velocity,
    const scalar above
) const
{
    // Newtonian up to this difference over a row; beyond, stress is about linear in the logarithm of the rate
    const scalar newtonian =
        oil_.shearStress(oil_.pressure(v))*thickness/(oil_.viscosity(v)*contact_.entrainment());
    const scalar least = min(mag(velocity - below), mag(above - velocity));
    return min(scalar(1e-6), max(1e-4*max(newtonian, least), leastVelocityStep));
}
