/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "slice.H"
#include "upstream.H"
#include "mathematicalConstants.H"

namespace
{

Foam::scalarField toField(const Eigen::VectorXd& v)
{
    Foam::scalarField f(v.size());
    forAll(f, i) f[i] = v[i];
    return f;
}

} // End anonymous namespace


Foam::slice::unknowns Foam::slice::unknowns::plus(const scalar factor, const unknowns& other) const
{
    unknowns sum(*this);
    sum.local += factor*other.local;
    sum.column += factor*other.column;
    if (other.wall.size()) sum.wall += factor*other.wall;
    sum.offset += factor*other.offset;
    sum.shift += factor*other.shift;
    return sum;
}


Foam::slice::slice
(
    filmFlow& flow,
    const lineContact& contact,
    const scalarField& x,
    const scalar filmScale
)
:
    flow_(flow),
    contact_(contact),
    solid_(contact, x),
    x_(x),
    filmScale_(filmScale),
    upstreamLoad_(upstreamLoad(filmScale + sqr(x[0])/(2*contact.radius))),
    faceShift_(x.size(), Zero),
    shiftStep_(0),
    wallUnit_(flow.heat() ? flow.heat()->fluxUnit()/flow.heat()->bulk() : 0)
{
    if (flow.heat()) wall_ = walls(x);
}


Foam::FixedList<Foam::movingWall, 2> Foam::slice::walls(const scalarField& faces) const
{
    const scalar effusivity = flow_.heat()->effusivity();
    return FixedList<movingWall, 2>
    ({
        movingWall(faces, contact_.lowerSpeed, effusivity),
        movingWall(faces, contact_.upperSpeed, effusivity)
    });
}


Eigen::VectorXd Foam::slice::wallFlux(const Eigen::VectorXd& local, const label side) const
{
    Eigen::VectorXd flux(columns());
    for (label i = 0; i < columns(); ++i) flux[i] = local[flow_.fluxPlace(i, side)];
    return flux;
}


Eigen::MatrixXd Foam::slice::wallByFlux(const label side) const
{
    return wallUnit_*wall_[side].perFlux();
}


Eigen::VectorXd Foam::slice::wallByShift(const unknowns& u, const label side) const
{
    return wallUnit_/shiftStep_
       *((shiftedWall_[side].perFlux() - wall_[side].perFlux())*wallFlux(u.local, side));
}


Eigen::VectorXd Foam::slice::wallDefect(const unknowns& u, const unknowns* rate) const
{
    const label n = columns();
    Eigen::VectorXd defect(wallSize());
    for (label side = 0; side < 2 && flow_.heat(); ++side)
    {
        const Eigen::VectorXd flux = wallFlux(u.local, side);
        defect.segment(side*n, n) = u.wall.segment(side*n, n) - wallUnit_*(wall_[side].perFlux()*flux);
        if (!rate) continue;
        // what the wall remembers, of its temperature at places that stand, on a mesh that moves
        const scalar speed = side ? contact_.upperSpeed : contact_.lowerSpeed;
        auto wall = [&](const label i) { return u.wall[side*n + min(max(i, 0), n - 1)]; };
        scalar remembered = 0;
        for (label i = 0; i < n; ++i)
        {
            const scalar length = x_[i + 1] - x_[i];
            const scalar meshSpeed = 0.5*rate->shift*(faceShift_[i] + faceShift_[i + 1]);
            const scalar apart = 0.5*(x_[min(i + 2, n)] + x_[i + 1] - x_[i] - x_[max(i - 1, 0)]);
            const scalar wallRate = rate->wall[side*n + i] - meshSpeed*(wall(i + 1) - wall(i - 1))/apart;
            defect[side*n + i] += (remembered + 0.5*length*wallRate)/(2*speed);
            remembered += length*wallRate;
        }
    }
    return defect;
}


void Foam::slice::follow(const scalarField& shiftedFaces, const scalar shiftStep)
{
    shiftStep_ = shiftStep;
    faceShift_ = (shiftedFaces - x_)/shiftStep;
    shifted_.reset(new halfSpace(contact_, shiftedFaces));
    if (flow_.heat()) shiftedWall_ = walls(shiftedFaces);
}


Eigen::VectorXd Foam::slice::pressure(const unknowns& u) const
{
    Eigen::VectorXd p(columns());
    for (label i = 0; i < columns(); ++i) p[i] = flow_.loadPressure(u.column[i]);
    return p;
}


Foam::slice::unknowns Foam::slice::start
(
    const scalarField& pressure,
    const scalar centralFilm
) const
{
    unknowns u;
    u.column.resize(columns());
    Eigen::VectorXd p(columns());
    forAll(pressure, i)
    {
        u.column[i] = flow_.columnUnknown(pressure[i]);
        p[i] = pressure[i];
    }
    u.offset = solid_.offsetOf(p, centralFilm)/filmScale_;
    const scalarField local
    (
        flow_.start(x_, toField(solid_.film(p, u.offset*filmScale_)), toField(u.column))
    );
    u.local.resize(local.size());
    forAll(local, i) u.local[i] = local[i];
    u.wall = Eigen::VectorXd::Zero(wallSize());
    return u;
}


Foam::scalar Foam::slice::load(const unknowns& u) const
{
    scalar sum = upstreamLoad_;
    for (label i = 0; i < columns(); ++i)
    {
        sum += flow_.loadPressure(u.column[i])*(x_[i + 1] - x_[i]);
    }
    return sum;
}


Foam::scalar Foam::slice::upstreamLoad(const scalar film) const
{
    const scalar drag = flow_.oil().viscosity(0)*contact_.entrainment();
    return upstreamFilm(drag, contact_.radius, -x_[0], film, filmScale_).load;
}


Foam::scalar Foam::slice::upstreamOffset(const filmState& state) const
{
    const scalar unit = 4/(constant::mathematical::pi*contact_.modulus);
    return unit*upstreamLoad(state.h[0])*(Foam::log(-x_[0]/contact_.halfWidth) + 0.5);
}


Eigen::RowVectorXd Foam::slice::loadByColumn(const unknowns& u) const
{
    Eigen::RowVectorXd slope(columns());
    for (label i = 0; i < columns(); ++i)
    {
        slope[i] = flow_.loadPressureSlope(u.column[i])*(x_[i + 1] - x_[i]);
    }
    return slope;
}


Foam::scalar Foam::slice::loadByShift(const unknowns& u) const
{
    scalar sum = 0;
    for (label i = 0; i < columns(); ++i)
    {
        sum += flow_.loadPressure(u.column[i])*(faceShift_[i + 1] - faceShift_[i]);
    }
    return sum;
}


Eigen::MatrixXd Foam::slice::filmByUnknowns(const unknowns& u) const
{
    const label n = columns();
    Eigen::MatrixXd H(n + 1, n + 1);
    for (label j = 0; j < n; ++j)
    {
        H.col(j) = flow_.loadPressureSlope(u.column[j])*solid_.kernel().col(j);
    }
    H.col(n).setConstant(filmScale_);
    return H;
}


Foam::filmState Foam::slice::film(const unknowns& u) const
{
    return
    {
        x_,
        toField(solid_.film(pressure(u), u.offset*filmScale_)),
        toField(u.column),
        toField(u.local),
        toField(u.wall)
    };
}


Foam::filmState Foam::slice::shiftedFilm(const unknowns& u) const
{
    return
    {
        x_ + shiftStep_*faceShift_,
        toField(shifted_->film(pressure(u), u.offset*filmScale_)),
        toField(u.column),
        toField(u.local),
        toField(u.wall)
    };
}


Foam::filmState Foam::slice::filmRate(const unknowns& u, const unknowns& rate) const
{
    Eigen::VectorXd pressureRate(columns());
    for (label i = 0; i < columns(); ++i)
    {
        pressureRate[i] = flow_.loadPressureSlope(u.column[i])*rate.column[i];
    }
    Eigen::VectorXd hRate = solid_.kernel()*pressureRate;
    hRate.array() += rate.offset*filmScale_;
    if (rate.shift != 0)
    {
        const Eigen::VectorXd p = pressure(u);
        hRate += rate.shift/shiftStep_
           *(shifted_->film(p, u.offset*filmScale_) - solid_.film(p, u.offset*filmScale_));
    }
    return {rate.shift*faceShift_, toField(hRate), toField(rate.column), toField(rate.local), toField(rate.wall)};
}


Eigen::VectorXd Foam::slice::assembled(const List<scalarField>& raw, const unknowns& u) const
{
    const label rows = flow_.film().rows(), size = flow_.cellSize();
    Eigen::VectorXd result(localSize());
    for (label i = 0; i < columns(); ++i)
    {
        const scalar source = u.local[flow_.sourcePlace(i)];
        scalar column = flow_.sourceInColumn()*source + flow_.columnInColumn()*u.column[i];
        for (label j = 0; j < rows; ++j)
        {
            const label c = flow_.film().cell(i, j);
            for (label equation = 0; equation < size; ++equation)
            {
                result[flow_.place(i, j, equation)] =
                    raw[equation][c] + flow_.sourceInCell(j, equation)*source;
            }
            column += raw[size][c];
        }
        result[flow_.sourcePlace(i)] = column;
        for (label side = 0; side < 2 && flow_.heat(); ++side)
        {
            const label place = flow_.fluxPlace(i, side);
            result[place] = u.local[place] - raw[size + 1][side*columns() + i];
        }
    }
    return result;
}


Eigen::VectorXd Foam::slice::residual(const unknowns& u, const unknowns* rate)
{
    if (rate)
    {
        const filmState filmRates(filmRate(u, *rate));
        return assembled(flow_.residual(film(u), &filmRates), u);
    }
    return assembled(flow_.residual(film(u), nullptr), u);
}


Foam::slice::unknowns Foam::slice::balanced(const unknowns& u)
{
    const filmState still(film(u));
    filmState state(still);
    flow_.balance(state);
    flow_.settle(still, state);
    unknowns next(u);
    forAll(state.local, k) next.local[k] = state.local[k];
    return next;
}


Foam::slice::unknowns Foam::slice::settled(const unknowns& before, const unknowns& after)
{
    filmState state(film(after));
    flow_.settle(film(before), state);
    unknowns u(after);
    forAll(state.local, k) u.local[k] = state.local[k];
    return u;
}


Foam::scalar Foam::slice::fluxDefect() const
{
    const scalarField flux(flow_.columnFlux()), fraction(flow_.columnFraction());
    // up to where the film behind the contact's centre ruptures, islands of mixture before it too; what is farther down
    // has no say in the film, and a start far away can leave a full column there
    label last = 0;
    while (last + 1 < columns() && x_[last + 1] <= 0) ++last;
    if (fraction[last] < 1) return 1;
    while (last + 1 < columns() && fraction[last + 1] >= 1) ++last;
    scalar defect = 0;
    for (label i = 1; i <= last; ++i) defect = max(defect, mag(flux[i]/flux[0] - 1));
    return defect;
}
