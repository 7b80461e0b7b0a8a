/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "pointTangent.H"

namespace Foam
{

//- Largest Krylov space
static constexpr label mostVectors = 200;

} // End namespace Foam


Foam::pointTangent::pointTangent
(
    const pointFilm& film, const pointFilm::state& s, const pointFilm::columns& c
)
:
    film_(film),
    active_(s.v.unaryExpr([](const double v) { return double(pointFilm::pressureSlope(v)); })),
    load_(film.loadSlope(c).cwiseProduct(active_))
{
    film.residual(s, c, &slopes_);
    const label nx = film.layout().nx(), ny = film.layout().ny();
    const pointSolid::matrix& K = film.solid().kernel();
    lines_.reset(new blockTridiagonal(ny, nx));
    for (label j = 0; j < ny; ++j)
    {
        const label first = max(j - 1, 0), last = min(j + 1, ny - 1);
        pointSolid::matrix rows = pointSolid::matrix::Zero(nx, (last - first + 1)*nx);
        for (label i = 0; i < nx; ++i)
        {
            const label row = j*nx + i;
            for (pointFilm::sparse::InnerIterator entry(slopes_.byFilm, row); entry; ++entry)
            {
                rows.row(i) += entry.value()*K.row(entry.col()).segment(first*nx, rows.cols());
            }
        }
        rows *= active_.segment(first*nx, rows.cols()).asDiagonal();
        for (label i = 0; i < nx; ++i)
        {
            for (pointFilm::sparse::InnerIterator entry(slopes_.byUnknown, j*nx + i); entry; ++entry)
            {
                rows(i, entry.col() - first*nx) += entry.value();
            }
        }
        for (label l = first; l <= last; ++l) lines_->block(j, l) = rows.middleCols((l - first)*nx, nx);
    }
    lines_->factorise();
    bordered_ = linesSolve(slopes_.byOffset);
    pivot_ = load_.dot(bordered_);
}


Foam::pointTangent::vector Foam::pointTangent::linesSolve(const vector& right) const
{
    blockTridiagonal::rightSides sides(right);
    lines_->solve(sides);
    return sides.col(0);
}


Foam::pointTangent::vector Foam::pointTangent::product(const vector& x) const
{
    const label n = active_.size();
    const auto v = x.head(n);
    vector y(n + 1);
    const vector pressure = active_.cwiseProduct(v);
    vector film(n);
    film.noalias() = film_.solid().kernel()*pressure;
    y.head(n) = slopes_.byUnknown*v;
    y.head(n) += slopes_.byFilm*film;
    y.head(n) += x[n]*slopes_.byOffset;
    y[n] = load_.dot(v);
    return y;
}


Foam::pointTangent::vector Foam::pointTangent::preconditioned(const vector& right) const
{
    const label n = active_.size();
    vector x(n + 1);
    x.head(n) = linesSolve(right.head(n));
    x[n] = (load_.dot(x.head(n)) - right[n])/pivot_;
    x.head(n) -= x[n]*bordered_;
    return x;
}


Foam::pointTangent::unknowns Foam::pointTangent::solve
(
    const vector& right, const scalar load, const scalar tolerance
) const
{
    const label n = active_.size();
    vector b(n + 1);
    b << right, load;
    const scalar length = b.norm();
    vectors = 0;
    left = 0;
    if (length == 0) return {vector::Zero(n), 0};
    std::vector<vector> basis{b/length};
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(mostVectors + 1, mostVectors);
    vector g = vector::Zero(mostVectors + 1), cosine(mostVectors), sine(mostVectors);
    g[0] = length;
    label k = 0;
    for (; k < mostVectors; ++k)
    {
        vector w = product(preconditioned(basis[k]));
        for (label i = 0; i <= k; ++i)
        {
            H(i, k) = basis[i].dot(w);
            w -= H(i, k)*basis[i];
        }
        H(k + 1, k) = w.norm();
        basis.push_back(w/max(H(k + 1, k), VSMALL));
        for (label i = 0; i < k; ++i)
        {
            const scalar upper = H(i, k);
            H(i, k) = cosine[i]*upper + sine[i]*H(i + 1, k);
            H(i + 1, k) = -sine[i]*upper + cosine[i]*H(i + 1, k);
        }
        const scalar r = std::hypot(H(k, k), H(k + 1, k));
        cosine[k] = H(k, k)/r;
        sine[k] = H(k + 1, k)/r;
        H(k, k) = r;
        g[k + 1] = -sine[k]*g[k];
        g[k] *= cosine[k];
        left = mag(g[k + 1])/length;
        if (!(left > tolerance))
        {
            ++k;
            break;
        }
    }
    vectors = k;
    const vector y = H.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(g.head(k));
    vector x = vector::Zero(n + 1);
    for (label i = 0; i < k; ++i) x += y[i]*basis[i];
    x = preconditioned(x);
    return {x.head(n), x[n]};
}


Foam::pointTangent::vector Foam::pointTangent::filmBy(const unknowns& u) const
{
    vector film = film_.solid().kernel()*pressureBy(u);
    film.array() += u.offset;
    return film;
}


Foam::pointTangent::vector Foam::pointTangent::pressureBy(const unknowns& u) const
{
    return active_.cwiseProduct(u.v);
}
