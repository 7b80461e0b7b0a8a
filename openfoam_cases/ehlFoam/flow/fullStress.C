/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "fullStress.H"
#include "addToRunTimeSelectionTable.H"
#include "fvc.H"
#include "linear.H"
#include "fixedValueFvPatchFields.H"
#include "zeroGradientFvPatchFields.H"

namespace Foam
{
    defineTypeNameAndDebug(fullStress, 0);
    addToRunTimeSelectionTable(filmFlow, fullStress, dictionary);


//- Velocity: fixed on the two surfaces, zero gradient at the ends
static tmp<volVectorField> velocity(const filmMesh& film)
{
    wordList types(film.field("pattern", dimless)().boundaryField().types());
    types[film.lower()] = fixedValueFvPatchVectorField::typeName;
    types[film.upper()] = fixedValueFvPatchVectorField::typeName;
    return tmp<volVectorField>::New
    (
        IOobject("U", film.mesh().time().timeName(), film.mesh(), IOobject::NO_READ, IOobject::AUTO_WRITE),
        film.mesh(),
        dimensionedVector("U", dimVelocity, Zero),
        types
    );
}


//- dU/dn on a surface [1/s], n out of the film
static tmp<vectorField> wallGradient(const filmMesh& film, const volVectorField& U, const label patch)
{
    const fvPatchVectorField& wall = U.boundaryField()[patch];
    const labelUList& cells = wall.patch().faceCells();
    auto tgradient = tmp<vectorField>::New(cells.size());
    forAll(cells, f)
    {
        // a row is twice the distance of a face from the middle of its cell
        const label second = film.second(cells[f], patch == film.upper());
        tgradient.ref()[f] =
            filmMesh::wallGradient(wall[f], U[cells[f]], U[second])*(0.5*wall.patch().deltaCoeffs()[f]);
    }
    return tgradient;
}

} // End namespace Foam


Foam::fullStress::fullStress(const dictionary& dict, filmMesh& film, const lineContact& contact)
:
    filmFlow(dict, film, contact),
    p_(film.field("p", dimPressure, true)),
    mu_(film.field("mu", dimDynamicViscosity)),
    rho_(film.field("rho", dimDensity)),
    fraction_(film.field("liquidFraction", dimless)),
    U_(velocity(film)),
    flux_
    (
        IOobject("massFlux", film.mesh().time().timeName(), film.mesh()),
        film.mesh(),
        dimensionedScalar("zero", dimMass/dimTime, 0)
    ),
    continuity_(0)
{
    flux_.setOriented();
}


Foam::scalarField Foam::fullStress::start
(
    const scalarField& x,
    const scalarField& h,
    const scalarField& column
) const
{
    // Couette flow that follows the surfaces, the load as pressure
    scalarField local(column.size()*blockSize(), Zero);
    forAll(column, i)
    {
        const scalar slope = (h[i + 1] - h[i])/(x[i + 1] - x[i]);
        for (label j = 0; j < film_.rows(); ++j)
        {
            const label place = i*blockSize() + 3*j;
            const scalar y = film_.middle(j);
            local[place] = ((1 - y)*contact_.lowerSpeed + y*contact_.upperSpeed)/contact_.entrainment();
            local[place + 1] = local[place]*slope*(y - film_.lowerShare());
            local[place + 2] = oil_.unknown(loadPressure(column[i]));
        }
    }
    return local;
}


Foam::scalar Foam::fullStress::sourceInCell(const label row, const label equation) const
{
    return equation == 2 ? -film_.share(row) : 0;
}


Foam::List<Foam::scalarField> Foam::fullStress::residual
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
    volScalarField shapeAcross(film_.field("shapeAcross", sqr(dimLength)));
    for (label i = 0; i < film_.columns(); ++i)
    {
        for (label j = 0; j < film_.rows(); ++j)
        {
            const label c = film_.cell(i, j), place = i*blockSize() + 3*j;
            const scalar v = state.local[place + 2];
            U_[c] = speed*vector(state.local[place], state.local[place + 1], 0);
            p_[c] = oil_.pressure(v);
            mu_[c] = oil_.viscosity(v);
            rho_[c] = oil_.density(v);
            fraction_[c] = oil_.fraction(v);
            shape[c] = sqr(film_.film(i))*film_.parabola(j);
            shapeAcross[c] = 0.25*sqr(film_.film(i)*film_.share(j));
            if (rate)
            {
                densityRate[c] = densitySlope(v)*rate->local[place + 2];
            }
        }
    }

    // the surfaces: their own speeds along themselves, and the speed of approach
    const scalarField still(film_.columns() + 1, Zero);
    for (const label patch : {film_.lower(), film_.upper()})
    {
        const bool upper = patch == film_.upper();
        const scalarField slope(film_.surfaceSlope(upper ? 1 : 0));
        const scalarField lift
        (
            film_.surfaceRate(upper ? 1 : 0, rate ? rate->x : still, rate ? rate->h : still)
        );
        const labelUList& cells = mesh.boundary()[patch].faceCells();
        vectorField Uwall(cells.size());
        forAll(cells, f)
        {
            const label i = cells[f]/film_.rows();
            const scalar along =
                (upper ? contact_.upperSpeed : contact_.lowerSpeed)/Foam::sqrt(1 + sqr(slope[i]));
            Uwall[f] = vector(along, along*slope[i] + lift[i], 0);
        }
        U_.boundaryFieldRef()[patch] == Uwall;
    }
    U_.correctBoundaryConditions();
    p_.boundaryFieldRef()[film_.inlet()] == inletPressure(state);
    p_.correctBoundaryConditions();
    rho_.correctBoundaryConditions();
    fraction_.correctBoundaryConditions();
    shape.correctBoundaryConditions();
    shapeAcross.correctBoundaryConditions();

    const volTensorField gradU(fvc::grad(U_));
    forAll(mu_, c)
    {
        mu_[c] = oil_.sheared(mu_[c], Foam::sqrt(2.0)*mag(dev(symm(gradU[c]))), p_[c]);
    }
    mu_.correctBoundaryConditions();

    // mass
    const volVectorField gradient(fvc::grad(p_));
    const volScalarField mobility(shape/mu_), mobilityAcross(shapeAcross/mu_);
    const surfaceScalarField slope(fvc::snGrad(p_)*mesh.magSf());
    const surfaceScalarField alongFlux
    (
        (linear<vector>(mesh).interpolate(U_ + mobility*gradient) & mesh.Sf())
      - mobilityOnFaces(mobility, mu_)*slope
    );
    const surfaceScalarField acrossFlux
    (
        (linear<vector>(mesh).interpolate(U_ + mobilityAcross*gradient) & mesh.Sf())
      - linear<scalar>(mesh).interpolate(mobilityAcross)*slope
    );
    surfaceScalarField volumeFlux
    (
        film_.acrossFilm*acrossFlux + (1 - film_.acrossFilm)*alongFlux
    );
    if (rate)
    {
        volumeFlux -= film_.sweptFlux(rate->x, rate->h);
    }
    flux_ = volumeFlux
       *film_.carriedSmooth(rho_, oil_.density(0))*film_.carriedSharp(fraction_, 1);
    // nothing passes the surfaces
    flux_.boundaryFieldRef()[film_.lower()] = 0.0;
    flux_.boundaryFieldRef()[film_.upper()] = 0.0;
    rho_ *= fraction_;

    // momentum
    surfaceScalarField muFace(linear<scalar>(mesh).interpolate(mu_));
    surfaceVectorField normalGradient(fvc::snGrad(U_));
    for (const label patch : {film_.lower(), film_.upper()})
    {
        normalGradient.boundaryFieldRef()[patch] = wallGradient(film_, U_, patch);
        // shear is greatest at the surface itself, and the oil thinnest
        const labelUList& cells = mesh.boundary()[patch].faceCells();
        const vectorField normal(mesh.boundary()[patch].nf());
        scalarField& muWall = muFace.boundaryFieldRef()[patch];
        forAll(cells, f)
        {
            const vector& gradient = normalGradient.boundaryField()[patch][f];
            const label c = cells[f];
            const scalar v = state.local[place(c/film_.rows(), c % film_.rows(), 2)];
            muWall[f] = oil_.sheared(oil_.viscosity(v), mag(gradient - (gradient & normal[f])*normal[f]), p_[c]);
        }
    }
    volVectorField force
    (
        fvc::surfaceIntegrate
        (
            muFace*normalGradient*mesh.magSf()
          + (mesh.Sf() & linear<tensor>(mesh).interpolate(mu_*dev2(T(gradU))))
        )
      - gradient
    );

    // normal stress on the surfaces
    scalarField load(mesh.nCells(), Zero);
    for (const label patch : {film_.lower(), film_.upper()})
    {
        const labelUList& cells = mesh.boundary()[patch].faceCells();
        const scalarField stretch
        (
            normalGradient.boundaryField()[patch] & mesh.boundary()[patch].nf()
        );
        // along the surface, against its normal at the lower one
        const label side = patch == film_.upper() ? 1 : 0;
        const vectorField gradient(normalGradient.boundaryField()[patch]);
        wallStress_[side] = (side ? 1 : -1)*muFace.boundaryField()[patch]*fraction_.boundaryField()[patch]
           *((gradient - (gradient & mesh.boundary()[patch].nf())*mesh.boundary()[patch].nf()) & vector(1, 0, 0));
        forAll(cells, f)
        {
            const label c = cells[f];
            load[c] += 0.5*(p_[c] - scalar(4)/3*mu_[c]*stretch[f])/contact_.pressure;
        }
    }

    const scalarField unit(sqr(filmOfCells())/(mu_.primitiveField()*speed));
    List<scalarField> result(4);
    result[0] = force.primitiveField().component(vector::X)*unit;
    result[1] = force.primitiveField().component(vector::Y)*unit;
    result[2] = gathered(flux_, rho_, densityRate, rate)/massUnit_;
    result[3] = load;
    continuity_ = max(mag(result[2]));
    return result;
}


Foam::scalarField Foam::fullStress::columnFraction() const
{
    scalarField fraction(film_.columns(), Zero);
    forAll(fraction_, c) fraction[c/film_.rows()] += film_.share(c % film_.rows())*fraction_[c];
    return fraction;
}


Foam::scalarField Foam::fullStress::columnDensity() const
{
    scalarField density(film_.columns(), Zero);
    forAll(rho_, c) density[c/film_.rows()] += film_.share(c % film_.rows())*rho_[c];
    return density;
}


Foam::scalarField Foam::fullStress::columnFlux() const
{
    return filmFlow::columnFlux(flux_);
}


void Foam::fullStress::write()
{
    p_.write();
    U_.write();
    mu_.write();
    rho_.write();
    fraction_.write();
}
