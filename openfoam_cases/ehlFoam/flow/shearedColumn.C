/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "shearedColumn.H"

namespace Foam
{

//- Most steps towards a root, and the part of its bracket that counts as nothing
static constexpr label mostSteps = 200;
static constexpr scalar nothing = 1e-15;


/*-  Root of a rising function in a bracket: Newton's step where it stays inside
     and at least halves the residual, else the middle

     function   gives the value and the slope
*/
template<class Function>
static scalar risingRoot(const Function& function, scalar low, scalar high, scalar x)
{
    scalar last = GREAT;
    for (label step = 0; step < mostSteps; ++step)
    {
        scalar value, slope;
        function(x, value, slope);
        if (value == 0) return x;
        (value > 0 ? high : low) = x;
        scalar next = slope > 0 ? x - value/slope : low;
        if (!(next > low && next < high) || 2*mag(value) > last) next = 0.5*(low + high);
        last = mag(value);
        const scalar move = mag(next - x);
        x = next;
        if (move <= nothing*max(mag(x), move) || high - low <= nothing*max(mag(low), mag(high))) break;
    }
    return x;
}

} // End namespace Foam


Foam::shearedColumn::shearedColumn
(
    const shearLaw& law,
    const scalar film,
    const scalar pressure,
    const scalar slide,
    const scalarField& viscosity
)
:
    law_(law),
    film_(film),
    pressure_(pressure),
    slide_(slide),
    viscosity_(viscosity),
    lowest_(0),
    gradient_(0),
    rate_(viscosity.size(), Zero),
    yield_(viscosity.size(), Zero)
{}


Foam::scalar Foam::shearedColumn::weight(const label face) const
{
    const label n = rows();
    if (face == 0 || face == n) return scalar(1)/3;
    return 1 + (face == 1 ? scalar(1)/6 : 0) + (face == n - 1 ? scalar(1)/6 : 0);
}


void Foam::shearedColumn::shear(const scalar lowest, const scalar gradient)
{
    lowest_ = lowest;
    gradient_ = gradient;
    const scalar rise = film_*gradient;
    forAll(rate_, k)
    {
        const scalar tau = lowest + rise*k/rows();
        const shearAnswer answer(law_.thinning(tau, pressure_));
        rate_[k] = answer.factor*tau/viscosity_[k];
        yield_[k] = answer.slope/viscosity_[k];
    }
}


Foam::scalar Foam::shearedColumn::across(const scalarField& value) const
{
    scalar sum = 0;
    forAll(value, k) sum += weight(k)*value[k];
    return sum*film_/rows();
}


Foam::scalarField Foam::shearedColumn::summed(const scalarField& value) const
{
    scalarField sum(rows());
    sum[0] = (value[0] + 0.5*value[1])/3;
    for (label j = 1; j < rows(); ++j) sum[j] = sum[j - 1] + value[j];
    return sum*(film_/rows());
}


void Foam::shearedColumn::meetGradient(const scalar gradient)
{
    // between stresses of one sign at all faces, and that of plain sliding at all of them
    const scalar half = 0.5*film_*mag(gradient);
    const scalar newton = max(viscosity_)*mag(slide_)/film_;
    const scalar sliding = newton*law_.yielding(newton, pressure_).factor*(1 + SMALL);
    const scalar low = slide_ < 0 ? -half - sliding : -half, high = slide_ > 0 ? half + sliding : half;
    auto balance = [&](const scalar mean, scalar& value, scalar& slope)
    {
        shear(mean - 0.5*film_*gradient, gradient);
        value = across(rate_) - slide_;
        slope = across(yield_);
    };
    const scalar guess = slide_ == 0 ? 0 : max(low, min(high, slide_ > 0 ? sliding : -sliding));
    shear(risingRoot(balance, low, high, guess) - 0.5*film_*gradient, gradient);
}


void Foam::shearedColumn::meetFlow(const scalar flow, const scalar gradient)
{
    scalarField level(rate_.size());
    forAll(level, k) level[k] = film_*k/rows();
    // in -g, so that it rises
    auto excess = [&](const scalar fall, scalar& value, scalar& slope)
    {
        meetGradient(-fall);
        value = this->flow() - flow;
        // tau_0 follows the gradient so that the surfaces keep their speeds
        const scalar follow = -across(scalarField(yield_*level))/across(yield_);
        slope = -average(summed(scalarField(yield_*(level + follow))));
    };
    const scalar unit = 2*min(law_.stress(pressure_), max(viscosity_)*(mag(flow) + mag(slide_) + SMALL)/film_)/film_;
    scalar low = -gradient, high = -gradient, step = max(unit, mag(gradient)*1e-3), value, slope;
    excess(-gradient, value, slope);
    for (label widen = 0; widen < 100 && value != 0; ++widen)
    {
        const bool below = value < 0;
        const scalar end = (below ? high : low) + (below ? step : -step);
        excess(end, value, slope);
        (below ? low : high) = below ? high : low;
        (below ? high : low) = end;
        if ((value < 0) != below) break;
        step *= 2;
    }
    if (low < high) risingRoot(excess, low, high, 0.5*(low + high));
}


Foam::scalarField Foam::shearedColumn::velocity() const
{
    scalarField u(summed(rate_));
    forAll(u, j) u[j] -= slide_*(j + 0.5)/rows();
    return u;
}


Foam::scalar Foam::shearedColumn::rateByVelocity(const label rows, const label face, const label row)
{
    if (face == 0) return row == 0 ? 3.5 : row == 1 ? -0.5 : 0;
    if (face == rows) return row == rows - 1 ? -3.5 : row == rows - 2 ? 0.5 : 0;
    return row == face ? 1 : row == face - 1 ? -1 : 0;
}


Foam::scalarField Foam::shearedColumn::rates
(
    const scalarField& velocity,
    const scalar film,
    const scalar slide
)
{
    const label n = velocity.size();
    scalarField rate(n + 1, Zero);
    for (label k = 0; k <= n; ++k)
    {
        for (label j = max(k - 2, 0); j < min(k + 2, n); ++j) rate[k] += rateByVelocity(n, k, j)*velocity[j];
    }
    return (rate*n + slide)/film;
}
