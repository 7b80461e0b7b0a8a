/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "thinFilm.H"
#include "addToRunTimeSelectionTable.H"
#include "fvc.H"
#include "linear.H"

namespace Foam
{
    defineTypeNameAndDebug(thinFilm, 0);
    addToRunTimeSelectionTable(filmFlow, thinFilm, dictionary);


//- Change of a temperature [T_b] over which the equations are linear
static constexpr scalar warmthStep = 1e-7;

} // End namespace Foam


Foam::thinFilm::thinFilm(const dictionary& dict, filmMesh& film, const lineContact& contact)
:
    filmFlow(dict, film, contact),
    couette_(film.fixedOnSurfaces<scalar>("couette", dimVelocity)),
    u_(film.fixedOnSurfaces<scalar>("u", dimVelocity)),
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
    couette_.boundaryFieldRef()[film.lower()] == contact.lowerSpeed;
    couette_.boundaryFieldRef()[film.upper()] == contact.upperSpeed;
    forAll(couette_, c)
    {
        const scalar level = film.middle(c % film.rows());
        couette_[c] = (1 - level)*contact.lowerSpeed + level*contact.upperSpeed;
    }
    couette_.correctBoundaryConditions();
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
    const scalar slide = (contact_.upperSpeed - contact_.lowerSpeed)/contact_.entrainment();
    auto speed = [&](const label j)
    {
        return state.local[place(column, j, velocity)] + slide*film_.middle(j);
    };
    const scalar here = speed(row);
    return velocityStep
    (
        state.column[column],
        0.5*(state.h[column] + state.h[column + 1])*film_.share(row),
        row > 0 ? speed(row - 1) : -here,
        here,
        row + 1 < film_.rows() ? speed(row + 1) : 2*slide - here
    );
}


Foam::scalarField Foam::thinFilm::addedVelocity(const filmState& state, const label column) const
{
    scalarField added(film_.rows());
    forAll(added, j) added[j] = contact_.entrainment()*state.local[place(column, j, velocity)];
    return added;
}


Foam::shearedColumn Foam::thinFilm::sheared(const filmState& state, const label column) const
{
    const scalar v = state.column[column];
    return shearedColumn
    (
        oil_.shear(),
        0.5*(state.h[column] + state.h[column + 1]),
        max(oil_.pressure(v), scalar(0)),
        contact_.upperSpeed - contact_.lowerSpeed,
        faceViscosity(state, column)
    );
}


Foam::scalarField Foam::thinFilm::faceViscosity(const filmState& state, const label column) const
{
    const scalar v = state.column[column];
    const label rows = film_.rows();
    scalarField viscosity(rows + 1, oil_.viscosity(v));
    if (!heat_.valid()) return viscosity;
    auto row = [&](const label j) { return state.local[place(column, j, warmth)]; };
    forAll(viscosity, k)
    {
        const scalar warm = k == 0 ? state.wall[column]
          : k == rows ? state.wall[film_.columns() + column] : 0.5*(row(k - 1) + row(k));
        viscosity[k] = heat_->oil().viscosity(oil_.pressure(v), heat_->temperature(warm));
    }
    return viscosity;
}


void Foam::thinFilm::balance(filmState& state) const
{
    if (newtonian()) return;
    label top = 0;
    forAll(state.column, i)
    {
        if (state.column[i] > state.column[top]) top = i;
    }
    auto mass = [&](const label i)
    {
        const scalar h = 0.5*(state.h[i] + state.h[i + 1]);
        if (!heat_.valid()) return oil_.density(state.column[i])*h;
        scalar sum = 0;
        for (label j = 0; j < film_.rows(); ++j)
        {
            const scalar T = heat_->temperature(state.local[place(i, j, warmth)]);
            sum += heat_->oil().density(oil_.pressure(state.column[i]), T);
        }
        return sum/film_.rows()*h;
    };
    forAll(state.column, i)
    {
        for (label j = 0; j < film_.rows(); ++j)
        {
            state.local[place(i, j, velocity)] = mass(top)/mass(i) - 1;
        }
    }
}


void Foam::thinFilm::settle(const filmState& before, filmState& after)
{
    film_.move(after.x, after.h);
    for (label i = 0; i < film_.columns(); ++i)
    {
        for (label j = 0; j < film_.rows(); ++j) p_[film_.cell(i, j)] = oil_.pressure(after.column[i]);
    }
    p_.boundaryFieldRef()[film_.inlet()] == inletPressure(after);
    p_.correctBoundaryConditions();
    const scalarField gradient(fvc::grad(p_)().primitiveField().component(vector::X));
    const scalar speed = contact_.entrainment(), slide = contact_.upperSpeed - contact_.lowerSpeed;
    for (label i = 0; i < film_.columns(); ++i)
    {
        auto put = [&](const shearedColumn& column)
        {
            const scalarField settled(column.velocity()/speed);
            forAll(settled, j) after.local[place(i, j, velocity)] = settled[j];
        };
        shearedColumn byGradient(sheared(after, i));
        byGradient.meetGradient(gradient[film_.cell(i, 0)]);
        if (newtonian())
        {
            // a step may change viscosities a hundredfold: what its tangent adds to velocities, pressure does not drive
            put(byGradient);
            continue;
        }
        // where the column was: its flux, and the gradient of its stress
        const scalarField was(addedVelocity(before, i));
        const scalar h = 0.5*(before.h[i] + before.h[i + 1]);
        const scalarField rate(shearedColumn::rates(was, h, slide));
        const scalar pressure = max(oil_.pressure(before.column[i]), scalar(0));
        const scalarField viscosity(faceViscosity(before, i));
        auto stress = [&](const label k)
        {
            return viscosity[k]*rate[k]*oil_.shear().yielding(viscosity[k]*rate[k], pressure).factor;
        };
        const scalar wasGradient = (stress(film_.rows()) - stress(0))/h;

        shearedColumn byFlow(sheared(after, i));
        byFlow.meetFlow(average(addedVelocity(after, i)), wasGradient);
        const scalar unit = oil_.shear().stress(pressure)/h;
        auto moved = [&](const shearedColumn& column)
        {
            return mag(column.gradient() - wasGradient)/unit + mag(column.flow() - average(was))/speed;
        };
        put(moved(byGradient) < moved(byFlow) ? byGradient : byFlow);
    }
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
    putTemperature(state);
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
                const scalar T = (*T_)[c];
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
    p_.boundaryFieldRef()[film_.inlet()] == inletPressure(state);
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
        muFace[f] = oil_.sheared(muFace[f], shearRate[f], p_[mesh.owner()[f]]);
    }
    for (const label patch : {film_.lower(), film_.upper()})
    {
        scalarField& muWall = muFace.boundaryFieldRef()[patch];
        forAll(muWall, f)
        {
            muWall[f] = oil_.sheared(muWall[f], shearRate.boundaryField()[patch][f], p_.boundaryField()[patch][f]);
        }
    }
    const volScalarField gradient(fvc::grad(p_)().component(vector::X));
    const scalarField force
    (
        fvc::surfaceIntegrate(muFace*shearRate*film_.flatArea())().primitiveField()
      - gradient.primitiveField()
    );

    for (const label side : {0, 1})
    {
        const label patch = side ? film_.upper() : film_.lower();
        wallStress_[side] = muFace.boundaryField()[patch]*shearRate.boundaryField()[patch]
           *fraction_.boundaryField()[patch];
    }

    // viscosity of a cell under shear
    const scalarField oilViscosity(mu_.primitiveField());
    for (label i = 0; i < film_.columns(); ++i)
    {
        for (label j = 0; j < film_.rows(); ++j)
        {
            const label c = film_.cell(i, j);
            mu_[c] = oil_.sheared(mu_[c], cellShearRate(i, j), p_[c]);
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
       *film_.carriedSmooth(rho_, oil_.density(0))*film_.carriedSharp(fraction_, volumeFlux, 1);
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


void Foam::thinFilm::exactDerivatives
(
    const filmState& state,
    const label column,
    Eigen::Ref<Eigen::MatrixXd> block
) const
{
    const label rows = film_.rows();
    const scalar v = state.column[column], p = max(oil_.pressure(v), scalar(0));
    const scalar h = 0.5*(state.h[column] + state.h[column + 1]);
    const scalar slide = contact_.upperSpeed - contact_.lowerSpeed, perStep = rows*contact_.entrainment()/h;
    const scalarField viscosity(faceViscosity(state, column));
    auto stress = [&](const label k, const scalar rate)
    {
        return viscosity[k]*rate*oil_.shear().yielding(viscosity[k]*rate, p).factor;
    };
    const scalarField velocities(addedVelocity(state, column)), rate(shearedColumn::rates(velocities, h, slide));

    // of rates and stresses on the faces, by the velocities of the rows
    Eigen::MatrixXd rateBy(rows + 1, rows), stressBy(rows + 1, rows);
    for (label k = 0; k <= rows; ++k)
    {
        const scalar tangent = viscosity[k]*oil_.shear().yielding(viscosity[k]*rate[k], p).slope;
        for (label j = 0; j < rows; ++j)
        {
            rateBy(k, j) = perStep*shearedColumn::rateByVelocity(rows, k, j);
            stressBy(k, j) = tangent*rateBy(k, j);
        }
    }

    // the momentum of a cell is the difference of the stresses on its two faces
    for (label j = 0; j < rows; ++j)
    {
        const scalar mu = heat_.valid()
          ? heat_->oil().viscosity(oil_.pressure(v), heat_->temperature(state.local[place(column, j, warmth)]))
          : oil_.viscosity(v);
        const scalar unit = rows*h/(mu*contact_.entrainment());
        for (label k = 0; k < rows; ++k)
        {
            block(j*cellSize(), k*cellSize()) = unit*(stressBy(j + 1, k) - stressBy(j, k));
        }
    }
    if (!heat_.valid()) return;

    // heat of shear: what the difference quotients have of it is taken out
    const scalar unit = heat_->shearUnit(h)*oil_.fraction(v);
    auto heatOf = [&](const scalarField& r)
    {
        scalarField heat(rows);
        forAll(heat, j) heat[j] = filmHeat::shearHeat(stress(j, r[j]), stress(j + 1, r[j + 1]), r[j], r[j + 1]);
        return heat;
    };
    const scalarField heat(heatOf(rate));
    for (label k = 0; k < rows; ++k)
    {
        const scalar step = cellStep(state, velocity, column, k);
        scalarField moved(velocities);
        moved[k] += contact_.entrainment()*step;
        const scalarField movedHeat(heatOf(shearedColumn::rates(moved, h, slide)));
        for (label j = 0; j < rows; ++j)
        {
            // bilinear in stresses and rates
            const scalar exact =
                filmHeat::shearHeat(stressBy(j, k), stressBy(j + 1, k), rate[j], rate[j + 1])
              + filmHeat::shearHeat(stress(j, rate[j]), stress(j + 1, rate[j + 1]), rateBy(j, k), rateBy(j + 1, k));
            block(j*cellSize() + warmth, k*cellSize()) -= unit*(exact - (movedHeat[j] - heat[j])/step);
        }
    }
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


void Foam::thinFilm::write()
{
    const fvMesh& mesh = film_.mesh();
    volVectorField& U = regIOobject::store
    (
        new volVectorField
        (
            IOobject("U", mesh.time().timeName(), mesh, IOobject::NO_READ, IOobject::AUTO_WRITE),
            (couette_ + u_)*vector(1, 0, 0)
        )
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
