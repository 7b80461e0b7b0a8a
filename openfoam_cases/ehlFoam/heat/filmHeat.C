/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "filmHeat.H"
#include "positive.H"

namespace Foam
{

//- Change of the Peclet number of a cell over which the equations are linear
static constexpr scalar pecletStep = 1e-6;


//- How much more than conduction alone an exponentially fitted face leads: (P/2) coth(P/2) - 1
static scalar fitted(const scalar peclet)
{
    const scalar half = 0.5*mag(peclet);
    if (half < 1e-2) return sqr(half)/3*(1 - sqr(half)/15);
    return half/Foam::tanh(half) - 1;
}

} // End namespace Foam


Foam::filmHeat::filmHeat(const dictionary& dict, const filmMesh& film, const lineContact& contact)
:
    film_(film),
    bulk_(positive(dict, "temperature")),
    conductivity_(positive(dict, "oilConductivity")),
    capacity_(positive(dict, "oilHeatCapacity")),
    effusivity_(effusivityOf(dict)),
    fluxUnit_(conductivity_*bulk_/contact.filmUnit()),
    oil_(dict.subDict("isotherms")),
    along_((film.columns() + 1)*film.rows(), -1),
    across_(film.columns()*(film.rows() + 1), -1),
    dissipated_(0), compressed_(0), carried_(0), led_(0), hottest_(0), hottestWall_(0)
{
    if (!(min(contact.lowerSpeed, contact.upperSpeed) > 0))
    {
        FatalIOErrorInFunction(dict)
            << "lowerSpeed, upperSpeed: got " << contact.lowerSpeed << ", " << contact.upperSpeed
            << ", allowed with heat are speeds above 0: a wall at rest has no steady temperature"
            << exit(FatalIOError);
    }
    const label rows = film.rows();
    const fvMesh& mesh = film.mesh();
    forAll(mesh.owner(), face)
    {
        const label k = film.columnFace(face), owner = mesh.owner()[face];
        if (k >= 0) along_[k*rows + film.faceRow(face)] = face;
        else across_[owner/rows*(rows + 1) + owner % rows + 1] = face;
    }
    auto patch = [&](const label number, labelList& places, const std::function<label(label)>& place)
    {
        const labelUList& cells = mesh.boundary()[number].faceCells();
        forAll(cells, f) places[place(cells[f])] = f;
    };
    patch(film.inlet(), along_, [&](const label c) { return c; });
    patch(film.outlet(), along_, [&](const label c) { return c + rows; });
    patch(film.lower(), across_, [&](const label c) { return c/rows*(rows + 1); });
    patch(film.upper(), across_, [&](const label c) { return c/rows*(rows + 1) + rows; });
}


Foam::scalar Foam::filmHeat::effusivityOf(const dictionary& dict)
{
    return Foam::sqrt
    (
        positive(dict, "solidConductivity")*positive(dict, "solidHeatCapacity")*positive(dict, "solidDensity")
    );
}


Foam::scalar Foam::filmHeat::onAlong(const surfaceScalarField& field, const label k, const label row) const
{
    const label face = along_[k*film_.rows() + row];
    if (k == 0) return -field.boundaryField()[film_.inlet()][face];
    if (k == film_.columns()) return field.boundaryField()[film_.outlet()][face];
    return field[face];
}


Foam::scalar Foam::filmHeat::onAcross(const surfaceScalarField& field, const label column, const label level) const
{
    const label face = across_[column*(film_.rows() + 1) + level];
    if (level == 0) return field.boundaryField()[film_.lower()][face];
    if (level == film_.rows()) return field.boundaryField()[film_.upper()][face];
    return field[face];
}


Foam::scalar Foam::filmHeat::carried
(
    const volScalarField& T,
    const label k,
    const label row,
    const scalar flux
) const
{
    const label n = film_.columns();
    auto value = [&](const label column) { return T[film_.cell(column, row)]; };
    const label direction = flux < 0 ? 1 : -1;
    const label near = flux < 0 ? k : k - 1, far = near + direction, behind = near - direction;
    if (near < 0) return bulk_;
    if (near >= n) return value(n - 1);
    if (far < 0 || far >= n || behind < 0 || behind >= n) return value(near);
    auto centre = [&](const label i) { return 0.5*(film_.x()[i] + film_.x()[i + 1]); };
    const scalar a = centre(far), b = centre(near), c = centre(behind), x = film_.x()[k];
    return (x - b)*(x - c)/((a - b)*(a - c))*value(far)
      + (x - a)*(x - c)/((b - a)*(b - c))*value(near)
      + (x - a)*(x - b)/((c - a)*(c - b))*value(behind);
}


Foam::scalarField Foam::filmHeat::shearHeat
(
    const surfaceScalarField& stress,
    const surfaceScalarField& rate
) const
{
    scalarField heat(film_.mesh().nCells());
    for (label i = 0; i < film_.columns(); ++i)
    {
        for (label j = 0; j < film_.rows(); ++j)
        {
            const scalar low = onAcross(stress, i, j), high = onAcross(stress, i, j + 1);
            const scalar slow = onAcross(rate, i, j), fast = onAcross(rate, i, j + 1);
            heat[film_.cell(i, j)] = shearHeat(low, high, slow, fast);
        }
    }
    return heat;
}


Foam::scalarField Foam::filmHeat::residual(const volScalarField& T, const given& flow)
{
    const label n = film_.columns(), rows = film_.rows();
    const surfaceScalarField gradient(film_.acrossGradient(T));
    scalarField result(film_.mesh().nCells());
    dissipated_ = compressed_ = carried_ = led_ = 0;
    hottest_ = hottestWall_ = 0;
    for (label i = 0; i < n; ++i)
    {
        const scalar area = film_.length(i)*film_.depth, h = film_.film(i);
        for (label j = 0; j < rows; ++j)
        {
            const label c = film_.cell(i, j);
            const scalar volume = area*h*film_.share(j);

            // along the film
            scalar leaves = 0;
            for (const label side : {0, 1})
            {
                const scalar flux = onAlong(flow.along, i + side, j);
                const scalar value = carried(T, i + side, j, flux);
                leaves += (side ? 1 : -1)*capacity_*flux*(value - T[c]);
                if (i + side == 0) carried_ -= capacity_*flux*(value - bulk_);
                if (i + side == n) carried_ += capacity_*flux*(value - bulk_);
            }

            // across it
            for (const label side : {0, 1})
            {
                const label level = j + side;
                scalar up = -conductivity_*area*onAcross(gradient, i, level)*flow.fraction[c];
                if (level == 0 || level == rows)
                {
                    led_ += (side ? 1 : -1)*up;
                    hottestWall_ = max
                    (
                        hottestWall_,
                        T.boundaryField()[side ? film_.upper() : film_.lower()][across_[i*(rows + 1) + level]]
                    );
                }
                else
                {
                    const label below = film_.cell(i, level - 1), above = film_.cell(i, level);
                    const scalar fraction = 0.5*(flow.fraction[below] + flow.fraction[above]);
                    const scalar flux = capacity_*flow.across[below];
                    const scalar leads = conductivity_*area*fraction
                       /(h*(film_.middle(level) - film_.middle(level - 1)));
                    up = flux*(0.5*(T[below] + T[above]) - T[c])
                      - leads*(1 + fitted(flux/leads))*(T[above] - T[below]);
                }
                leaves += (side ? 1 : -1)*up;
            }

            const scalar sheared = flow.shear[c]*flow.fraction[c]*volume;
            const scalar pressed = flow.compression[c]*flow.fraction[c]*volume;
            const scalar stored = capacity_*flow.density[c]*flow.temperatureRate[c]*volume;
            dissipated_ += sheared;
            compressed_ += pressed;
            hottest_ = max(hottest_, T[c]);
            result[c] = (leaves + stored - sheared - pressed)*sqr(h)/(conductivity_*bulk_*volume);
        }
    }
    for (scalar* total : {&dissipated_, &compressed_, &carried_, &led_}) *total /= film_.depth;
    hottest_ = max(hottest_, hottestWall_);
    return result;
}


Foam::scalarField Foam::filmHeat::wallFlux(const volScalarField& T, const scalarField& fraction) const
{
    const label n = film_.columns(), rows = film_.rows();
    const surfaceScalarField gradient(film_.acrossGradient(T));
    scalarField flux(2*n);
    for (label i = 0; i < n; ++i)
    {
        const scalar unit = conductivity_/fluxUnit_;
        flux[i] = unit*fraction[film_.cell(i, 0)]*onAcross(gradient, i, 0);
        flux[n + i] = -unit*fraction[film_.cell(i, rows - 1)]*onAcross(gradient, i, rows);
    }
    return flux;
}


Foam::scalar Foam::filmHeat::acrossStep(const scalar massUnit, const label column) const
{
    const scalar leads = conductivity_*film_.length(column)*film_.depth*film_.rows()/film_.film(column);
    return pecletStep*min(max(leads/(capacity_*massUnit), scalar(1e-3)), scalar(1));
}
