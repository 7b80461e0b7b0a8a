/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "pointFilm.H"
#include "mathematicalConstants.H"

namespace
{

using Foam::scalar;

//- Mean of exp(-l) between two logarithms of viscosity, and its derivatives by them
struct fluidity
{
    scalar value, byFirst, bySecond;

    fluidity(const scalar first, const scalar second)
    {
        const scalar r = second - first, scale = std::exp(-first);
        if (std::abs(r) < 1e-3)
        {
            value = scale*(1 - r/2 + r*r/6 - r*r*r/24);
            bySecond = scale*(-0.5 + r/3 - r*r/8);
        }
        else
        {
            value = -scale*std::expm1(-r)/r;
            bySecond = (std::exp(-second) - value)/r;
        }
        byFirst = -value - bySecond;
    }
};

} // End anonymous namespace


Foam::pointFilm::pointFilm
(
    const pointContact& contact, const pointLayout& layout, const lubricant& oil, const pointSolid& solid
)
:
    contact_(contact),
    layout_(layout),
    oil_(oil),
    solid_(solid),
    lambda_(contact.wedge(oil.viscosity(0))),
    gap_(layout.cells()),
    weight_(layout.nx() + 1)
{
    const label nx = layout.nx();
    for (label j = 0; j < layout.ny(); ++j)
    {
        for (label i = 0; i < nx; ++i)
        {
            gap_[layout.cell(i, j)] = gapAt(layout.centreX(i), layout.centreY(j));
        }
    }
    for (label k = 0; k <= nx; ++k)
    {
        // columns k-2, k-1, k and the ambient oil before the first one
        FixedList<scalar, 4>& w = weight_[k];
        w = scalar(0);
        if (k == 0)
        {
            w[2] = 0.5;
            w[3] = 0.5;
        }
        else if (k == nx)
        {
            w[1] = 1;
        }
        else
        {
            // of the parabola with these means over the columns
            auto at = [&](const label m) { return m < 0 ? 2*layout.x[0] - layout.x[1] : layout.x[m]; };
            FixedList<scalar, 4> face, slope;
            for (label m = 0; m < 4; ++m) face[m] = at(k - 2 + m);
            for (label m = 0; m < 4; ++m)
            {
                // derivative at the third face of the cubic that is 1 at one face, 0 at the others
                scalar derivative = 0;
                for (label left = 0; left < 4; ++left)
                {
                    if (left == m) continue;
                    scalar term = 1/(face[m] - face[left]);
                    for (label other = 0; other < 4; ++other)
                    {
                        if (other != m && other != left) term *= (face[2] - face[other])/(face[m] - face[other]);
                    }
                    derivative += term;
                }
                slope[m] = derivative;
            }
            const scalar third = (face[3] - face[2])*slope[3], second = (face[2] - face[1])*(slope[2] + slope[3]);
            (k == 1 ? w[3] : w[0]) = 1 - second - third;
            w[1] = second;
            w[2] = third;
        }
    }
}


Foam::pointFilm::columns Foam::pointFilm::columnsOf(const state& s) const
{
    const label n = layout_.cells();
    columns c;
    for (vector* each : {&c.P, &c.H, &c.theta, &c.rho, &c.logEta, &c.rhoSlope, &c.logEtaSlope}) each->setZero(n);
    const scalar eta0 = oil_.viscosity(0), rho0 = oil_.density(0), step = 1e-6;
    for (label i = 0; i < n; ++i)
    {
        const scalar v = s.v[i];
        c.P[i] = max(v, scalar(0));
        c.theta[i] = oil_.fraction(v);
        c.rho[i] = 1;
        if (v <= 0) continue;
        c.rho[i] = oil_.density(v)/rho0;
        c.logEta[i] = Foam::log(oil_.viscosity(v)/eta0);
        c.rhoSlope[i] = (oil_.density(v + step)/rho0 - c.rho[i])/step;
        c.logEtaSlope[i] = (Foam::log(oil_.viscosity(v + step)/eta0) - c.logEta[i])/step;
    }
    c.H = gap_ + solid_.kernel()*c.P;
    c.H.array() += s.offset;
    return c;
}


Foam::scalar Foam::pointFilm::faceFilm(const columns& c, const label k, const label j) const
{
    const FixedList<scalar, 4>& w = weight_[k];
    const label nx = layout_.nx();
    auto deflected = [&](const label i)
    {
        const label cell = layout_.cell(min(max(i, 0), nx - 1), j);
        return c.H[cell] - gap_[cell];
    };
    // the oil ahead is deflected as the first column
    return gapAt(layout_.x[k], layout_.centreY(j))
      + w[0]*deflected(k - 2) + w[1]*deflected(k - 1) + w[2]*deflected(k) + w[3]*deflected(0);
}


Foam::pointFilm::vector Foam::pointFilm::residual
(
    const state& s, const columns& c, slopes* derivatives, faceFluxes* fluxes
) const
{
    const label nx = layout_.nx(), ny = layout_.ny(), n = layout_.cells();
    vector lack = vector::Zero(n);
    std::vector<Eigen::Triplet<double>> byUnknown, byFilm;
    if (derivatives)
    {
        byUnknown.reserve(16*n);
        byFilm.reserve(20*n);
        derivatives->byOffset = vector::Zero(n);
    }
    if (fluxes)
    {
        fluxes->dragged = fluxes->driven = Eigen::MatrixXd::Zero(nx + 1, ny);
        fluxes->across = Eigen::MatrixXd::Zero(nx, ny + 1);
    }
    // a flux out of the cell `from` into the cell `to` (-1: none), times a factor each
    label from = -1, to = -1;
    scalar fromFactor = 0, toFactor = 0;
    auto add = [&](const scalar flux)
    {
        if (from >= 0) lack[from] += fromFactor*flux;
        if (to >= 0) lack[to] -= toFactor*flux;
    };
    auto addSlope = [&](std::vector<Eigen::Triplet<double>>& into, const label column, const scalar slope)
    {
        if (slope == 0) return;
        if (from >= 0) into.emplace_back(from, column, fromFactor*slope);
        if (to >= 0) into.emplace_back(to, column, -toFactor*slope);
    };
    auto addOffset = [&](const scalar slope)
    {
        if (from >= 0) derivatives->byOffset[from] += fromFactor*slope;
        if (to >= 0) derivatives->byOffset[to] -= toFactor*slope;
    };

    // faces across the motion
    fromFactor = toFactor = 1;
    for (label j = 0; j < ny; ++j)
    {
        for (label k = 0; k <= nx; ++k)
        {
            from = k > 0 ? layout_.cell(k - 1, j) : -1;
            to = k < nx ? layout_.cell(k, j) : -1;
            const label first = k > 0 ? from : to, second = k < nx ? to : from;
            const FixedList<scalar, 4>& w = weight_[k];
            const scalar H = faceFilm(c, k, j), theta = k > 0 ? c.theta[from] : 1;
            const label upstream[3] = {k > 1 ? layout_.cell(k - 2, j) : first, first, second};
            const scalar rho = w[0]*c.rho[upstream[0]] + w[1]*c.rho[first] + w[2]*c.rho[second] + w[3];
            const fluidity f(c.logEta[first], c.logEta[second]);
            const scalar cube = H*H*H;
            // at the inlet the slope is that of the way on outside
            const scalar x = layout_.x[0], edge = 1/x - 2*x/H;
            const scalar distance =
                k == 0 ? 1/(onward(x/layout_.centreX(0), c.H[first], H)*edge)
              : k == nx ? layout_.x[nx] - layout_.centreX(nx - 1) : layout_.centreX(k) - layout_.centreX(k - 1);
            const scalar beside = k == 0 ? 0 : c.P[first], behind = k == nx ? 0 : c.P[second];
            const scalar slope = (behind - beside)/(distance*lambda_);
            add(rho*(theta*H - cube*f.value*slope));
            if (fluxes)
            {
                fluxes->dragged(k, j) = rho*theta*H;
                fluxes->driven(k, j) = -rho*cube*f.value*slope;
            }
            if (!derivatives) continue;
            // by film
            const scalar byH = rho*(theta - 3*H*H*f.value*slope);
            for (label m = 0; m < 3; ++m) addSlope(byFilm, upstream[m], w[m]*byH);
            addSlope(byFilm, layout_.cell(0, j), w[3]*byH);
            addOffset(byH);
            // by density, fraction, pressure, viscosity
            const scalar byRho = theta*H - cube*f.value*slope, conductance = rho*cube*f.value/(distance*lambda_);
            for (label m = 0; m < 3; ++m) addSlope(byUnknown, upstream[m], w[m]*byRho*c.rhoSlope[upstream[m]]);
            if (k > 0)
            {
                if (s.v[from] <= 0) addSlope(byUnknown, from, rho*H);
                addSlope(byUnknown, from, conductance*pressureSlope(s.v[from]));
            }
            else
            {
                const scalar byEdge = -rho*cube*f.value*slope*(2/c.H[to] - 2/H + 2*x/(H*H*edge));
                addSlope(byFilm, to, byEdge);
                addOffset(byEdge);
            }
            if (k < nx) addSlope(byUnknown, to, -conductance*pressureSlope(s.v[to]));
            const scalar driven = -rho*cube*slope;
            addSlope(byUnknown, first, driven*f.byFirst*c.logEtaSlope[first]);
            addSlope(byUnknown, second, driven*f.bySecond*c.logEtaSlope[second]);
        }
    }

    // faces along the motion; none through the middle
    for (label l = 1; l <= ny; ++l)
    {
        const bool side = l == ny;
        const scalar below = layout_.centreY(l - 1), above = side ? layout_.y[ny] : layout_.centreY(l);
        const scalar weight = side ? 1 : (above - layout_.y[l])/(above - below), distance = above - below;
        for (label i = 0; i < nx; ++i)
        {
            from = layout_.cell(i, l - 1);
            to = side ? -1 : layout_.cell(i, l);
            const label second = side ? from : to;
            const scalar X = layout_.x[i + 1] - layout_.x[i];
            fromFactor = X/(layout_.y[l] - layout_.y[l - 1]);
            toFactor = side ? 0 : X/(layout_.y[l + 1] - layout_.y[l]);
            const scalar H = gapAt(layout_.centreX(i), layout_.y[l])
              + weight*(c.H[from] - gap_[from]) + (1 - weight)*(c.H[second] - gap_[second]);
            const scalar rho = weight*c.rho[from] + (1 - weight)*c.rho[second], cube = H*H*H;
            const scalar edge = -2*contact_.ratio*layout_.y[ny]/H;
            const scalar gap = side ? -1/(onward(1, c.H[from], H)*edge) : distance;
            const fluidity f(c.logEta[from], c.logEta[second]);
            const scalar slope = ((side ? 0 : c.P[to]) - c.P[from])/(gap*lambda_);
            add(-rho*cube*f.value*slope);
            if (fluxes) fluxes->across(i, l) = -rho*cube*f.value*slope;
            if (!derivatives) continue;
            const scalar byH = -3*rho*H*H*f.value*slope, conductance = rho*cube*f.value/(gap*lambda_);
            addSlope(byFilm, from, weight*byH);
            addSlope(byFilm, second, (1 - weight)*byH);
            addOffset(byH);
            const scalar byRho = -cube*f.value*slope;
            addSlope(byUnknown, from, weight*byRho*c.rhoSlope[from] + conductance*pressureSlope(s.v[from]));
            addSlope(byUnknown, second, (1 - weight)*byRho*c.rhoSlope[second]);
            if (side)
            {
                const scalar byEdge = -rho*cube*f.value*slope*(2/c.H[from] - 3/H);
                addSlope(byFilm, from, byEdge);
                addOffset(byEdge);
            }
            else
            {
                addSlope(byUnknown, to, -conductance*pressureSlope(s.v[to]));
            }
            const scalar driven = -rho*cube*slope;
            addSlope(byUnknown, from, driven*f.byFirst*c.logEtaSlope[from]);
            addSlope(byUnknown, second, driven*f.bySecond*c.logEtaSlope[second]);
        }
    }
    if (derivatives)
    {
        derivatives->byUnknown.resize(n, n);
        derivatives->byFilm.resize(n, n);
        derivatives->byUnknown.setFromTriplets(byUnknown.begin(), byUnknown.end());
        derivatives->byFilm.setFromTriplets(byFilm.begin(), byFilm.end());
    }
    return lack;
}


Foam::pointFilm::vector Foam::pointFilm::storage
(
    const columns& c, const vector& vRate, const vector& filmRate
) const
{
    vector stored(layout_.cells());
    for (label j = 0; j < layout_.ny(); ++j)
    {
        for (label i = 0; i < layout_.nx(); ++i)
        {
            const label m = layout_.cell(i, j);
            const scalar byUnknown = c.theta[m] < 1 ? c.H[m] : c.rhoSlope[m]*c.H[m];
            stored[m] = (layout_.x[i + 1] - layout_.x[i])
               *(byUnknown*vRate[m] + c.theta[m]*c.rho[m]*filmRate[m]);
        }
    }
    return stored;
}


void Foam::pointFilm::outside(const columns& c, vector& load, vector& deflection) const
{
    load = deflection = vector::Zero(layout_.cells());
    const label nx = layout_.nx(), ny = layout_.ny();
    // a sector of the plane behind a piece of the edge: what falls with r^-3 from there on
    auto sector = [&](const label cell, const scalar x, const scalar y, const scalar distance, const scalar length, const scalar share)
    {
        const scalar sum = 2*distance*length*share;
        load[cell] += sum/contact_.unitLoad();
        deflection[cell] += contact_.pressureFactor/constant::mathematical::pi*sum/(2*std::hypot(x, y));
    };
    for (label j = 0; j < ny; ++j)
    {
        const label cell = layout_.cell(0, j);
        const scalar x = layout_.x[0], y = layout_.centreY(j);
        sector(cell, x, y, -x, layout_.y[j + 1] - layout_.y[j], onward(x/layout_.centreX(0), c.H[cell], faceFilm(c, 0, j)));
    }
    for (label i = 0; i < nx; ++i)
    {
        const label cell = layout_.cell(i, ny - 1);
        const scalar x = layout_.centreX(i), y = layout_.y[ny];
        const scalar edge = c.H[cell] - gap_[cell] + gapAt(x, y);
        sector(cell, x, y, y, layout_.x[i + 1] - layout_.x[i], onward(1, c.H[cell], edge));
    }
}


Foam::scalar Foam::pointFilm::load(const columns& c) const
{
    return loadSlope(c).dot(c.P);
}


Foam::pointFilm::vector Foam::pointFilm::loadSlope(const columns& c) const
{
    vector slope, deflection;
    outside(c, slope, deflection);
    for (label j = 0; j < layout_.ny(); ++j)
    {
        for (label i = 0; i < layout_.nx(); ++i)
        {
            slope[layout_.cell(i, j)] += 2*layout_.area(i, j)/contact_.unitLoad();
        }
    }
    return slope;
}


Foam::scalar Foam::pointFilm::approach(const columns& c, const scalar offset, const vector& pressure) const
{
    // what the oil outside deflects, the same over all of the contact, is part of the offset
    vector load, deflection;
    outside(c, load, deflection);
    return offset - deflection.dot(pressure);
}


Foam::scalar Foam::pointFilm::cornerFilm(const columns& c, const label k, const label l) const
{
    // deflections between the columns about it, as those beside it at the edge
    auto between = [](const scalarField& faces, const label at, const label n, label& low, label& high, scalar& part)
    {
        low = max(at - 1, 0);
        high = min(at, n - 1);
        const scalar below = 0.5*(faces[low] + faces[low + 1]), above = 0.5*(faces[high] + faces[high + 1]);
        part = low == high ? 0 : (faces[at] - below)/(above - below);
    };
    label i0, i1, j0, j1;
    scalar x, y;
    between(layout_.x, k, layout_.nx(), i0, i1, x);
    between(layout_.y, l, layout_.ny(), j0, j1, y);
    auto deflected = [&](const label i, const label j)
    {
        return c.H[layout_.cell(i, j)] - gap_[layout_.cell(i, j)];
    };
    return gapAt(layout_.x[k], layout_.y[l])
      + (1 - y)*((1 - x)*deflected(i0, j0) + x*deflected(i1, j0)) + y*((1 - x)*deflected(i0, j1) + x*deflected(i1, j1));
}


Foam::scalar Foam::pointFilm::central(const vector& values) const
{
    label i = 1;
    while (layout_.centreX(i + 1) < 0) ++i;
    // a parabola along, an even one across
    const scalar a = layout_.centreX(i - 1), b = layout_.centreX(i), c = layout_.centreX(i + 1);
    const scalar w0 = b*c/((a - b)*(a - c)), w1 = a*c/((b - a)*(b - c)), w2 = a*b/((c - a)*(c - b));
    auto line = [&](const label j)
    {
        return w0*values[layout_.cell(i - 1, j)] + w1*values[layout_.cell(i, j)] + w2*values[layout_.cell(i + 1, j)];
    };
    const scalar first = sqr(layout_.centreY(0)), second = sqr(layout_.centreY(1));
    return (second*line(0) - first*line(1))/(second - first);
}
