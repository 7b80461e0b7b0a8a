/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "fullStress.H"
#include "addToRunTimeSelectionTable.H"
#include "fvc.H"
#include "linear.H"

namespace Foam
{
    defineTypeNameAndDebug(fullStress, 0);
    addToRunTimeSelectionTable(filmFlow, fullStress, dictionary);


//- Change of v and of a temperature [T_b] over which the equations are linear
static constexpr scalar stressPressureStep = 1e-7, stressWarmthStep = 1e-7;


//- Viscosity between two places, of layers under one stress: over 1 over the mean of 1/mu of an exponential mu
static scalar layered(const scalar mu, const scalar other)
{
    const scalar rise = Foam::log(other/mu);
    return mag(rise) < 1e-4 ? mu/(1 - rise/2 + sqr(rise)/6) : rise/(1/mu - 1/other);
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
    U_(film.fixedOnSurfaces<vector>("U", dimVelocity)),
    relative_(film.fixedOnSurfaces<vector>("relative", dimVelocity)),
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
            const scalar y = film_.middle(j);
            const scalar slipped = (1 - y)*slip(0) + y*slip(1);
            local[place(i, j, along)] = slipped/contact_.entrainment();
            local[place(i, j, across)] =
                (meanSpeed() + slipped)/contact_.entrainment()*slope*(y - film_.lowerShare());
            local[place(i, j, pressure)] = oil_.unknown(loadPressure(column[i]));
        }
    }
    return local;
}


Foam::scalar Foam::fullStress::cellStep
(
    const filmState& state,
    const label kind,
    const label column,
    const label row
) const
{
    if (kind == pressure) return stressPressureStep;
    if (kind == warmth) return stressWarmthStep;
    auto speed = [&](const label j) { return state.local[place(column, j, along)]; };
    const scalar here = speed(row), unit = contact_.entrainment();
    return velocityStep
    (
        state.local[place(column, row, pressure)],
        0.5*(state.h[column] + state.h[column + 1])*film_.share(row),
        row > 0 ? speed(row - 1) : 2*slip(0)/unit - here,
        here,
        row + 1 < film_.rows() ? speed(row + 1) : 2*slip(1)/unit - here
    );
}


Foam::scalar Foam::fullStress::sourceInCell(const label row, const label equation) const
{
    return equation == pressure ? -film_.share(row) : 0;
}


void Foam::fullStress::putOil(const filmState& state, const filmState* rate, scalarField& densityRate)
{
    putTemperature(state);
    forAll(p_, c)
    {
        const label i = c/film_.rows(), j = c % film_.rows();
        const scalar v = state.local[place(i, j, pressure)];
        p_[c] = oil_.pressure(v);
        mu_[c] = oil_.viscosity(v);
        rho_[c] = oil_.density(v);
        fraction_[c] = oil_.fraction(v);
        if (rate) densityRate[c] = densitySlope(v)*rate->local[place(i, j, pressure)];
        if (!heat_.valid()) continue;
        const scalar T = (*T_)[c], cold = rho_[c];
        mu_[c] = heat_->oil().viscosity(p_[c], T);
        rho_[c] = heat_->oil().density(p_[c], T);
        if (rate)
        {
            densityRate[c] = (densityRate[c]/cold - heat_->oil().expansion(p_[c], T)*fraction_[c]
               *heat_->bulk()*rate->local[place(i, j, warmth)])*rho_[c];
        }
    }
    p_.boundaryFieldRef()[film_.inlet()] == inletPressure(state);
    p_.correctBoundaryConditions();
    rho_.correctBoundaryConditions();
    fraction_.correctBoundaryConditions();
}


void Foam::fullStress::putVelocity(const filmState& state, const filmState* rate)
{
    const scalar speed = contact_.entrainment();
    const vector mean(meanSpeed(), 0, 0);
    forAll(relative_, c)
    {
        const label i = c/film_.rows(), j = c % film_.rows();
        relative_[c] = speed*vector(state.local[place(i, j, along)], state.local[place(i, j, across)], 0);
        U_[c] = relative_[c] + mean;
    }
    // the surfaces: their own speeds along themselves, and the speed of approach
    const scalarField still(film_.columns() + 1, Zero);
    for (const label side : {0, 1})
    {
        const label patch = side ? film_.upper() : film_.lower();
        const scalarField slope(film_.surfaceSlope(side));
        const scalarField lift(film_.surfaceRate(side, rate ? rate->x : still, rate ? rate->h : still));
        const labelUList& cells = film_.mesh().boundary()[patch].faceCells();
        vectorField wall(cells.size());
        forAll(cells, f)
        {
            const label i = cells[f]/film_.rows();
            const scalar root = Foam::sqrt(1 + sqr(slope[i])), own = meanSpeed() + slip(side);
            wall[f] = vector(slip(side) - own*sqr(slope[i])/(root*(1 + root)), own/root*slope[i] + lift[i], 0);
        }
        relative_.boundaryFieldRef()[patch] == wall;
        U_.boundaryFieldRef()[patch] == wall + mean;
    }
    relative_.correctBoundaryConditions();
    U_.correctBoundaryConditions();
}


Foam::FixedList<Foam::scalarField, 3> Foam::fullStress::dilation
(
    const filmState& state,
    const filmState* rate,
    const volTensorField& gradU,
    const scalarField& densityRate
) const
{
    const vectorField gradient(fvc::grad(rho_)().primitiveField());
    const fvMesh& mesh = film_.mesh();
    FixedList<scalarField, 3> result;
    result[0] = tr(gradU.primitiveField());
    auto full = [&](const label c) { return state.local[place(c/film_.rows(), c % film_.rows(), pressure)] > 0; };
    auto squeezed = [&](const label c, const vector& U)
    {
        const label i = c/film_.rows();
        const vector own(rate ? 0.5*(rate->x[i] + rate->x[i + 1]) : 0, 0, 0);
        return -(((U - own) & gradient[c]) + densityRate[c])/rho_[c];
    };
    forAll(gradient, c)
    {
        if (full(c)) result[0][c] = squeezed(c, U_[c]);
    }
    for (const label side : {0, 1})
    {
        const label patch = side ? film_.upper() : film_.lower();
        const labelUList& cells = mesh.boundary()[patch].faceCells();
        result[1 + side] = wallGradient(film_, relative_, patch) & mesh.boundary()[patch].nf();
        forAll(cells, f)
        {
            if (full(cells[f])) result[1 + side][f] = squeezed(cells[f], U_.boundaryField()[patch][f]);
        }
    }
    return result;
}


Foam::tmp<Foam::surfaceScalarField> Foam::fullStress::faceViscosity
(
    const filmState& state,
    const surfaceVectorField& normalGradient
) const
{
    const fvMesh& mesh = film_.mesh();
    tmp<surfaceScalarField> tface(linear<scalar>(mesh).interpolate(mu_));
    surfaceScalarField& face = tface.ref();
    forAll(face, f)
    {
        if (film_.columnFace(f) >= 0) face[f] = layered(mu_[mesh.owner()[f]], mu_[mesh.neighbour()[f]]);
    }
    for (const label patch : {film_.lower(), film_.upper()})
    {
        // shear is greatest at the surface itself, and the oil thinnest
        const labelUList& cells = mesh.boundary()[patch].faceCells();
        const vectorField normal(mesh.boundary()[patch].nf());
        forAll(cells, f)
        {
            const vector& gradient = normalGradient.boundaryField()[patch][f];
            const label c = cells[f];
            const scalar mu = heat_.valid() ? heat_->oil().viscosity(p_[c], T_->boundaryField()[patch][f])
              : oil_.viscosity(state.local[place(c/film_.rows(), c % film_.rows(), pressure)]);
            face.boundaryFieldRef()[patch][f] =
                oil_.sheared(mu, mag(gradient - (gradient & normal[f])*normal[f]), p_[c]);
        }
    }
    return tface;
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
    putOil(state, rate, densityRate);
    putVelocity(state, rate);

    volScalarField shape(film_.field("shape", sqr(dimLength)));
    volScalarField shapeAcross(film_.field("shapeAcross", sqr(dimLength)));
    forAll(shape, c)
    {
        const label j = c % film_.rows();
        const scalar h = film_.film(c/film_.rows());
        shape[c] = sqr(h)*film_.parabola(j);
        shapeAcross[c] = 0.25*sqr(h*film_.share(j));
    }
    shape.correctBoundaryConditions();
    shapeAcross.correctBoundaryConditions();

    const volTensorField gradU(fvc::grad(relative_));
    forAll(mu_, c)
    {
        mu_[c] = oil_.sheared(mu_[c], Foam::sqrt(2.0)*mag(dev(symm(gradU[c]))), p_[c]);
    }
    mu_.correctBoundaryConditions();
    const FixedList<scalarField, 3> dilated(dilation(state, rate, gradU, densityRate));

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
       *film_.carriedSmooth(rho_, oil_.density(0))*film_.carriedSharp(fraction_, volumeFlux, 1);
    // nothing passes the surfaces
    flux_.boundaryFieldRef()[film_.lower()] = 0.0;
    flux_.boundaryFieldRef()[film_.upper()] = 0.0;
    rho_ *= fraction_;

    // momentum: mu (grad(U) + its transpose - 2/3 div(U))
    surfaceVectorField normalGradient(fvc::snGrad(relative_));
    for (const label patch : {film_.lower(), film_.upper()})
    {
        normalGradient.boundaryFieldRef()[patch] = wallGradient(film_, relative_, patch);
    }
    const surfaceScalarField muFace(faceViscosity(state, normalGradient));
    volScalarField spread(film_.field("spread", dimPressure));
    spread.primitiveFieldRef() = mu_.primitiveField()*dilated[0];
    spread.correctBoundaryConditions();
    const surfaceScalarField spreadFace(linear<scalar>(mesh).interpolate(spread));
    surfaceVectorField traction
    (
        muFace*normalGradient*mesh.magSf()
      + (mesh.Sf() & linear<tensor>(mesh).interpolate(mu_*T(gradU)))
      - (scalar(2)/3)*spreadFace*mesh.Sf()
    );
    forAll(traction, f)
    {
        if (film_.columnFace(f) < 0) continue;
        traction[f].x() = 2*muFace[f]*normalGradient[f].x()*mesh.magSf()[f]
          - scalar(2)/3*spreadFace[f]*mesh.Sf()[f].x();
    }
    const vectorField force(fvc::surfaceIntegrate(traction)().primitiveField() - gradient.primitiveField());

    // stress on the surfaces
    scalarField load(mesh.nCells(), Zero);
    for (const label side : {0, 1})
    {
        const label patch = side ? film_.upper() : film_.lower();
        const labelUList& cells = mesh.boundary()[patch].faceCells();
        // along the surface, against its normal at the lower one
        const vectorField normal(mesh.boundary()[patch].nf()), out(normalGradient.boundaryField()[patch]);
        wallStress_[side] = (side ? 1 : -1)*muFace.boundaryField()[patch]*fraction_.boundaryField()[patch]
           *((out - (out & normal)*normal) & vector(1, 0, 0));
        forAll(cells, f)
        {
            const label c = cells[f];
            load[c] += 0.5*(p_[c] - scalar(4)/3*mu_[c]*dilated[1 + side][f])/contact_.pressure;
        }
    }

    const scalarField unit(sqr(filmOfCells())/(mu_.primitiveField()*speed));
    List<scalarField> result(cellSize() + (heat_.valid() ? 2 : 1));
    result[along] = force.component(vector::X)*unit;
    result[across] = force.component(vector::Y)*unit;
    result[pressure] = gathered(flux_, rho_, densityRate, rate)/massUnit_;
    result[cellSize()] = load;
    continuity_ = max(mag(result[pressure]));
    if (heat_.valid())
    {
        result[warmth] =
            heatResidual(state, rate, muFace, spread.primitiveField()*dilated[0], gradient.primitiveField());
        result[cellSize() + 1] = heat_->wallFlux(*T_, fraction_);
    }
    return result;
}


Foam::scalarField Foam::fullStress::heatResidual
(
    const filmState& state,
    const filmState* rate,
    const surfaceScalarField& muFace,
    const scalarField& spread,
    const vectorField& gradient
)
{
    const surfaceScalarField shearRate(film_.acrossGradient(relative_.component(vector::X)));
    scalarField flux(p_.size(), Zero), compression(p_.size()), temperatureRate(p_.size(), Zero);
    forAll(flux_, f)
    {
        if (film_.columnFace(f) < 0) flux[film_.mesh().owner()[f]] = flux_[f];
    }
    forAll(compression, c)
    {
        // pressure as the oil that passes has it change, on a mesh that moves
        const label i = c/film_.rows(), j = c % film_.rows();
        const scalar v = state.local[place(i, j, pressure)];
        vector own(Zero);
        scalar pressureRate = 0;
        if (rate)
        {
            own.x() = 0.5*(rate->x[i] + rate->x[i + 1]);
            own.y() = 0.5*(rate->h[i] + rate->h[i + 1])*(film_.middle(j) - film_.lowerShare());
            pressureRate = oil_.pressureSlope(v)*rate->local[place(i, j, pressure)];
            temperatureRate[c] = heat_->bulk()*rate->local[place(i, j, warmth)];
        }
        compression[c] = heat_->oil().expansion(p_[c], (*T_)[c])*(*T_)[c]
           *(((U_[c] - own) & gradient[c]) + pressureRate);
    }
    const scalarField shear(heat_->shearHeat(muFace*shearRate, shearRate) + scalar(4)/3*spread);
    return heat_->residual(*T_, {flux_, flux, rho_, fraction_, shear, compression, temperatureRate});
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
    if (heat_.valid()) T_->write();
}
