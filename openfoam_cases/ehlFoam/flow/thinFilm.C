/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "thinFilm.H"
#include "addToRunTimeSelectionTable.H"
#include "fvc.H"
#include "linear.H"
#include "fixedValueFvPatchFields.H"
#include "zeroGradientFvPatchFields.H"

namespace Foam
{
    defineTypeNameAndDebug(thinFilm, 0);
    addToRunTimeSelectionTable(filmFlow, thinFilm, dictionary);


//- Change of a temperature [T_b] over which the equations are linear
static constexpr scalar warmthStep = 1e-7;


//- A cell field whose values on the two surfaces are fixed
static tmp<volScalarField> fixedOnSurfaces
(
    const filmMesh& film,
    const word& name,
    const dimensionSet& dimensions
)
{
    wordList types(film.field("pattern", dimensions)().boundaryField().types());
    types[film.lower()] = fixedValueFvPatchScalarField::typeName;
    types[film.upper()] = fixedValueFvPatchScalarField::typeName;
    return tmp<volScalarField>::New
    (
        IOobject(name, film.mesh().time().timeName(), film.mesh()),
        film.mesh(),
        dimensionedScalar(name, dimensions, 0),
        types
    );
}

} // End namespace Foam


Foam::thinFilm::thinFilm(const dictionary& dict, filmMesh& film, const lineContact& contact)
:
    filmFlow(dict, film, contact),
    couette_(fixedOnSurfaces(film, "couette", dimVelocity)),
    u_(fixedOnSurfaces(film, "u", dimVelocity)),
    p_(film.field("p", dimPressure, true)),
    mu_(film.field("mu", dimDynamicViscosity)),
    rho_(film.field("rho", dimDensity)),
    fraction_(film.field("liquidFraction", dimless)),
    flux_
    (
        IOobject("massFlux", film.mesh().time().timeName(), film.mesh()),
        film.mesh(),
        dimensionedScalar("zero", dimMass/dimTime, 0)
    )
{
    flux_.setOriented();
    if (heat_.valid()) T_.reset(fixedOnSurfaces(film, "T", dimTemperature).ptr());
    couette_.boundaryFieldRef()[film.lower()] == contact.lowerSpeed;
    couette_.boundaryFieldRef()[film.upper()] == contact.upperSpeed;
    forAll(couette_, c)
    {
        const scalar level = film.middle(c % film.rows());
        couette_[c] = (1 - level)*contact.lowerSpeed + level*contact.upperSpeed;
    }
    couette_.correctBoundaryConditions();
}


Foam::scalar Foam::thinFilm::cellStep
(
    const filmState& state,
    const label kind,
    const label column,
    const label row
) const
{
    if (kind == across) return heat_->acrossStep(massUnit_, column);
    if (kind == warmth) return warmthStep;
    return velocityStep(oil_.viscosity(state.column[column]), column, row);
}


Foam::scalarField Foam::thinFilm::start
(
    const scalarField&,
    const scalarField&,
    const scalarField& column
) const
{
    // Couette flow; Newton's first step adds what pressure drives
    return scalarField(column.size()*blockSize(), Zero);
}


Foam::List<Foam::scalarField> Foam::thinFilm::residual
(
    const filmState& state,
    const filmState* rate
)
{
    const fvMesh& mesh = film_.mesh();
    const scalar speed = contact_.entrainment();
    film_.move(state.x, state.h);

    scalarField densityRate(mesh.nCells(), Zero);
    volScalarField shape(film_.field("shape", sqr(dimLength)));
    for (label i = 0; i < film_.columns(); ++i)
    {
        const scalar v = state.column[i];
        const scalar p = oil_.pressure(v), mu = oil_.viscosity(v), rho = oil_.density(v);
        const scalar fraction = oil_.fraction(v), slope = rate ? densitySlope(v) : 0;
        for (label j = 0; j < film_.rows(); ++j)
        {
            const label c = film_.cell(i, j);
            p_[c] = p;
            mu_[c] = mu;
            rho_[c] = rho;
            fraction_[c] = fraction;
            u_[c] = speed*state.local[place(i, j, velocity)];
            shape[c] = sqr(film_.film(i))*film_.parabola(j);
            if (rate) densityRate[c] = slope*rate->column[i];
            if (heat_.valid())
            {
                const scalar T = heat_->temperature(state.local[place(i, j, warmth)]);
                (*T_)[c] = T;
                mu_[c] = heat_->oil().viscosity(p, T);
                rho_[c] = heat_->oil().density(p, T);
                if (rate)
                {
                    densityRate[c] = (densityRate[c]/rho - heat_->oil().expansion(p, T)*fraction
                       *heat_->bulk()*rate->local[place(i, j, warmth)])*rho_[c];
                }
            }
        }
    }
    if (heat_.valid())
    {
        for (const label patch : {film_.lower(), film_.upper()})
        {
            const labelUList& cells = mesh.boundary()[patch].faceCells();
            scalarField wall(cells.size());
            const label first = patch == film_.upper() ? film_.columns() : 0;
            forAll(wall, f) wall[f] = heat_->temperature(state.wall[first + cells[f]/film_.rows()]);
            T_->boundaryFieldRef()[patch] == wall;
        }
        T_->correctBoundaryConditions();
    }
    p_.correctBoundaryConditions();
    mu_.correctBoundaryConditions();
    rho_.correctBoundaryConditions();
    fraction_.correctBoundaryConditions();
    u_.correctBoundaryConditions();
    shape.correctBoundaryConditions();

    // momentum: shear stress on the faces between rows
    const surfaceScalarField shearRate
    (
        film_.acrossGradient(u_) + film_.acrossGradient(couette_)
    );
    surfaceScalarField muFace(linear<scalar>(mesh).interpolate(mu_));
    if (heat_.valid()) warmFaces(muFace);
    forAll(muFace, f)
    {
        muFace[f] = oil_.sheared(muFace[f], shearRate[f]);
    }
    for (const label patch : {film_.lower(), film_.upper()})
    {
        scalarField& muWall = muFace.boundaryFieldRef()[patch];
        forAll(muWall, f)
        {
            muWall[f] = oil_.sheared(muWall[f], shearRate.boundaryField()[patch][f]);
        }
    }
    const volScalarField gradient(fvc::grad(p_)().component(vector::X));
    const scalarField force
    (
        fvc::surfaceIntegrate(muFace*shearRate*film_.flatArea())().primitiveField()
      - gradient.primitiveField()
    );

    // viscosity of a cell under shear
    const scalarField oilViscosity(mu_.primitiveField());
    for (label i = 0; i < film_.columns(); ++i)
    {
        for (label j = 0; j < film_.rows(); ++j)
        {
            const label c = film_.cell(i, j);
            mu_[c] = oil_.sheared(mu_[c], cellShearRate(i, j));
        }
    }
    mu_.correctBoundaryConditions();

    // mass
    const volScalarField mobility(shape/mu_);
    surfaceScalarField volumeFlux
    (
        (linear<vector>(mesh).interpolate((couette_ + u_ + mobility*gradient)*vector(1, 0, 0)) & mesh.Sf())
      - mobilityOnFaces(mobility, mu_)*fvc::snGrad(p_)*mesh.magSf()
    );
    if (rate)
    {
        volumeFlux -= film_.sweptFlux(rate->x, rate->h);
    }
    flux_ = (1 - film_.acrossFilm)*volumeFlux
       *film_.carriedSmooth(rho_, oil_.density(0))*film_.carriedSharp(fraction_, 1);
    rho_ *= fraction_;

    List<scalarField> result(heat_.valid() ? 5 : 2);
    result[0] = force*sqr(filmOfCells())/(oilViscosity*speed);
    result[cellSize()] = gathered(flux_, rho_, densityRate, rate)/massUnit_;
    if (heat_.valid())
    {
        addHeat(result, muFace*shearRate, shearRate, gradient.primitiveField(), state, rate);
    }
    return result;
}


void Foam::thinFilm::warmFaces(surfaceScalarField& muFace) const
{
    const fvMesh& mesh = film_.mesh();
    forAll(muFace, f)
    {
        if (film_.columnFace(f) >= 0) continue;
        const label below = mesh.owner()[f], above = mesh.neighbour()[f];
        muFace[f] = heat_->oil().viscosity(p_[below], 0.5*(T_()[below] + T_()[above]));
    }
    for (const label patch : {film_.lower(), film_.upper()})
    {
        const labelUList& cells = mesh.boundary()[patch].faceCells();
        scalarField& muWall = muFace.boundaryFieldRef()[patch];
        forAll(cells, f) muWall[f] = heat_->oil().viscosity(p_[cells[f]], T_().boundaryField()[patch][f]);
    }
}


void Foam::thinFilm::addHeat
(
    List<scalarField>& residuals,
    const surfaceScalarField& stress,
    const surfaceScalarField& shearRate,
    const scalarField& gradient,
    const filmState& state,
    const filmState* rate
)
{
    const scalarField& lack = residuals[cellSize()];
    scalarField& continuity = residuals[across];
    continuity = lack;
    scalarField flux(lack.size()), compression(lack.size()), temperatureRate(lack.size(), Zero);
    for (label i = 0; i < film_.columns(); ++i)
    {
        // pressure as the oil that passes has it change, on a mesh that moves
        const scalar pressureRate = rate ? oil_.pressureSlope(state.column[i])*rate->column[i] : 0;
        const scalar meshSpeed = rate ? 0.5*(rate->x[i] + rate->x[i + 1]) : 0;
        for (label j = 0; j < film_.rows(); ++j)
        {
            const label c = film_.cell(i, j);
            const scalar leaves = state.local[place(i, j, across)];
            flux[c] = massUnit_*leaves;
            continuity[c] += leaves - (j > 0 ? state.local[place(i, j - 1, across)] : 0);
            compression[c] = heat_->oil().expansion(p_[c], T_()[c])*T_()[c]
               *((couette_[c] + u_[c] - meshSpeed)*gradient[c] + pressureRate);
            if (rate) temperatureRate[c] = heat_->bulk()*rate->local[place(i, j, warmth)];
        }
    }
    residuals[warmth] = heat_->residual
    (
        T_(),
        {flux_, flux, rho_, fraction_, heat_->shearHeat(stress, shearRate), compression, temperatureRate}
    );
    residuals[cellSize() + 1] = heat_->wallFlux(T_(), fraction_);
}


Foam::scalarField Foam::thinFilm::columnFraction() const
{
    scalarField fraction(film_.columns());
    forAll(fraction, i) fraction[i] = fraction_[film_.cell(i, 0)];
    return fraction;
}


Foam::scalarField Foam::thinFilm::columnDensity() const
{
    scalarField density(film_.columns());
    forAll(density, i) density[i] = rho_[film_.cell(i, 0)];
    return density;
}


Foam::scalarField Foam::thinFilm::columnFlux() const
{
    return filmFlow::columnFlux(flux_);
}


Foam::scalar Foam::thinFilm::cellShearRate(const label column, const label row) const
{
    const label c = film_.cell(column, row);
    const bool first = row == 0, last = row + 1 == film_.rows();
    const scalar dy = (last ? 1 : film_.middle(row + 1)) - (first ? 0 : film_.middle(row - 1));
    const scalar du = (last ? 0 : u_[c + 1]) - (first ? 0 : u_[c - 1]);
    return (du/dy + contact_.upperSpeed - contact_.lowerSpeed)/film_.film(column);
}


Foam::scalar Foam::thinFilm::stressByPressure() const
{
    const scalar step = 1e-6;
    scalar most = 0;
    for (label i = 0; i < film_.columns(); ++i)
    {
        const scalar v = oil_.unknown(p_[film_.cell(i, 0)]);
        if (v <= 0) continue;
        for (label j = 0; j < film_.rows(); ++j)
        {
            const scalar rate = cellShearRate(i, j);
            const scalar rise = oil_.sheared(oil_.viscosity(v + step), rate)
              - oil_.sheared(oil_.viscosity(v), rate);
            most = max(most, mag(rate*rise)/(step*oil_.pressureSlope(v)));
        }
    }
    return most;
}


void Foam::thinFilm::write()
{
    const fvMesh& mesh = film_.mesh();
    volVectorField U
    (
        IOobject("U", mesh.time().timeName(), mesh, IOobject::NO_READ, IOobject::AUTO_WRITE),
        (couette_ + u_)*vector(1, 0, 0)
    );
    // across the film: what continuity asks for, from the lower surface upwards
    const scalarField lack(fvc::surfaceIntegrate(flux_)().primitiveField()*mesh.V());
    for (label i = 0; i < film_.columns(); ++i)
    {
        const scalar area = film_.length(i)*film_.depth;
        const scalar slope = (film_.h()[i + 1] - film_.h()[i])/film_.length(i);
        scalar below = 0;
        for (label j = 0; j < film_.rows(); ++j)
        {
            const label c = film_.cell(i, j);
            const scalar level = film_.middle(j) - film_.lowerShare();
            U[c].y() = -(below + 0.5*lack[c])/(rho_[c]*area) + U[c].x()*level*slope;
            below += lack[c];
        }
    }
    U.correctBoundaryConditions();
    p_.write();
    U.write();
    mu_.write();
    rho_.write();
    fraction_.write();
    if (heat_.valid()) T_->write();
}
