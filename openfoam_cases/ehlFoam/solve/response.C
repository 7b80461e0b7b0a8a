/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "response.H"
#include "mathematicalConstants.H"
#include <complex>
#include <vector>

namespace Foam
{

//- Largest Krylov space, and residual at which it is large enough
static constexpr label mostVectors = 120;
static constexpr scalar smallResidual = 1e-8;


//- Distance of a linearisation from the solution, in the unknowns, at which it is that of the solution
static constexpr scalar atSolution = 1e-6;


//- Largest difference of an unknown
static scalar distance(const slice::unknowns& a, const slice::unknowns& b)
{
    const slice::unknowns d(a.plus(-1, b));
    const scalar walls = d.wall.size() ? d.wall.cwiseAbs().maxCoeff() : 0;
    return max(max(d.local.cwiseAbs().maxCoeff(), d.column.cwiseAbs().maxCoeff()), max(walls, mag(d.offset)));
}


//- All unknowns in one vector
static Eigen::VectorXd packed(const slice::unknowns& u)
{
    Eigen::VectorXd v(u.local.size() + u.column.size() + 2 + u.wall.size());
    v << u.local, u.column, u.offset, u.shift, u.wall;
    return v;
}


static slice::unknowns unpacked(const Eigen::VectorXd& v, const slice& s)
{
    slice::unknowns u;
    const label locals = s.localSize(), n = s.columns();
    u.local = v.head(locals);
    u.column = v.segment(locals, n);
    u.offset = v[locals + n];
    u.shift = v[locals + n + 1];
    u.wall = v.tail(s.wallSize());
    return u;
}

} // End namespace Foam


Foam::label Foam::frontColumn
(
    const slice& s,
    const slice::unknowns& solution,
    const scalar spikePosition
)
{
    // the steepest fall of pressure near the place where the mesh is finest
    const scalarField& x = s.flow().film().x();
    label front = -1;
    scalar steepest = 0;
    for (label i = 0; i + 1 < s.columns(); ++i)
    {
        const scalar place = x[i + 1]/s.contact().halfWidth;
        const scalar fall = (solution.column[i] - solution.column[i + 1])/(x[i + 2] - x[i]);
        if (mag(place - spikePosition) < 0.1 && fall > steepest)
        {
            steepest = fall;
            front = i;
        }
    }
    return front;
}


Foam::List<Foam::filmResponse> Foam::response
(
    slice& s,
    const slice::unknowns& solution,
    const scalarField& frequencies,
    const label isobar,
    std::unique_ptr<linearisation>& tangent
)
{
    const label n = s.columns(), locals = s.localSize();
    if (!tangent || !(distance(tangent->state(), solution) < atSolution)) tangent.reset(new linearisation(s, solution));
    linearisation& linear = *tangent;
    if (isobar >= 0) linear.follow(isobar);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    const Eigen::VectorXd atRest = s.residual(solution, nullptr);
    const scalar halfWidthTime = s.contact().halfWidth/s.contact().entrainment();

    // time in b/u, so that the Krylov vectors keep their size
    auto T = [&](const Eigen::VectorXd& z)
    {
        slice::unknowns rate(unpacked(z, s));
        rate.local /= halfWidthTime;
        rate.column /= halfWidthTime;
        rate.offset /= halfWidthTime;
        rate.shift /= halfWidthTime;
        rate.wall /= halfWidthTime;
        return packed
        (
            linear.solve
            (
                s.residual(solution, &rate) - atRest, none, 0,
                s.wallDefect(solution, &rate) - s.wallDefect(solution, nullptr)
            )
        );
    };
    const Eigen::VectorXd first = packed
    (
        linear.solve(Eigen::VectorXd::Zero(locals), none, 1, Eigen::VectorXd::Zero(s.wallSize()))
    );
    const label offset = locals + n;
    const scalar unit = s.filmScale()/s.contact().load;
    const scalar dry = -s.solid().dry().offsetSlope;

    const scalar size = first.norm();
    std::vector<Eigen::VectorXd> basis(1, first/size);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(mostVectors + 1, mostVectors);
    List<filmResponse> result(frequencies.size());
    label vectors = 0;
    auto extend = [&]()
    {
        Eigen::VectorXd next = T(basis[vectors]);
        for (label pass = 0; pass < 2; ++pass)
        {
            for (label k = 0; k <= vectors; ++k)
            {
                const scalar along = basis[k].dot(next);
                H(k, vectors) += along;
                next -= along*basis[k];
            }
        }
        H(vectors + 1, vectors) = next.norm();
        basis.push_back(next/max(next.norm(), VSMALL));
        ++vectors;
    };
    extend();
    forAll(frequencies, f)
    {
        const scalar Omega = constant::mathematical::twoPi*frequencies[f]*halfWidthTime;
        if (Omega == 0)
        {
            // z = J^-1 e - i omega T J^-1 e
            scalar moved = 0;
            for (label k = 0; k <= 1; ++k) moved += size*H(k, 0)*basis[k][offset];
            result[f] = {-first[offset]*unit - dry, -moved*unit*halfWidthTime, 0};
            continue;
        }
        while (true)
        {
            const Eigen::MatrixXcd reduced =
                Eigen::MatrixXcd::Identity(vectors, vectors)
              + std::complex<double>(0, Omega)*H.topLeftCorner(vectors, vectors);
            Eigen::VectorXcd right = Eigen::VectorXcd::Zero(vectors);
            right[0] = size;
            const Eigen::VectorXcd y = reduced.partialPivLu().solve(right);
            const scalar residual = Omega*H(vectors, vectors - 1)*std::abs(y[vectors - 1])/size;
            if (residual < smallResidual || vectors == mostVectors)
            {
                std::complex<double> moved = 0;
                for (label k = 0; k < vectors; ++k) moved += y[k]*basis[k][offset];
                result[f] =
                {
                    -moved.real()*unit - dry,
                    moved.imag()*unit*halfWidthTime/Omega,
                    residual
                };
                break;
            }
            extend();
        }
    }
    return result;
}
