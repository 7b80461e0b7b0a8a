/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "linearisation.H"

namespace Foam
{

//- Columns in a block of the inner system: as many as a residual reaches
static constexpr label group = 2;

//- How far column unknowns and films reach, in columns
static constexpr label columnReach = 2, filmReach = 3;

//- Steps of the difference quotients, of pressures in Hertz pressures, relative to the film, of walls in T_b
static constexpr scalar pressureStep = 1e-7, filmStep = 1e-7, wallStep = 1e-7;

} // End namespace Foam


Foam::linearisation::linearisation
(
    slice& s,
    const slice::unknowns& state,
    const slice::unknowns* rate,
    const scalar rateFactor
)
:
    slice_(s),
    state_(state),
    inner_((s.columns() + group - 1)/group, group*s.flow().blockSize()),
    outer_
    (
        blockTridiagonal::rightSides::Zero
        (
            (s.columns() + group - 1)/group*group*s.flow().blockSize(),
            s.columns() + 1 + s.wallSize()
        )
    )
{
    const filmState film(s.film(state));
    filmState filmRate;
    if (rate) filmRate = s.filmRate(state, *rate);
    else if (rateFactor != 0)
    {
        slice::unknowns still(state);
        filmRate = s.filmRate(state, still.plus(-1, state));
    }
    const filmState* base = (rate || rateFactor != 0) ? &filmRate : nullptr;
    const List<scalarField> here(s.flow().residual(film, base));

    addCellUnknowns(film, base, rateFactor, here);
    addColumnUnknowns(film, base, rateFactor, here);
    addFilms(film, base, rateFactor, here);
    if (s.wallSize()) addWalls(film, base, here);
    // a last column without a partner
    for (label i = s.columns(); i % group != 0; ++i)
    {
        block(i, i).setIdentity();
    }
    reduce();
}


Eigen::Block<Eigen::MatrixXd> Foam::linearisation::block(const label row, const label column)
{
    const label size = slice_.flow().blockSize();
    return inner_.block(row/group, column/group)
        .block(row % group*size, column % group*size, size, size);
}


Eigen::VectorXd Foam::linearisation::difference
(
    const List<scalarField>& there,
    const List<scalarField>& here,
    const label column,
    const label firstRow,
    const label lastRow,
    const scalar step
) const
{
    const filmFlow& flow = slice_.flow();
    const label size = flow.cellSize();
    Eigen::VectorXd change = Eigen::VectorXd::Zero(flow.blockSize());
    for (label j = max(firstRow, 0); j <= min(lastRow, flow.film().rows() - 1); ++j)
    {
        const label c = flow.film().cell(column, j);
        for (label equation = 0; equation < size; ++equation)
        {
            change[j*size + equation] = (there[equation][c] - here[equation][c])/step;
        }
        change[size*flow.film().rows()] += (there[size][c] - here[size][c])/step;
    }
    for (label side = 0; side < 2 && flow.heat(); ++side)
    {
        // the rows moved belong to this unknown only where they reach the wall
        if (side == 0 ? firstRow > 0 : lastRow + 1 < flow.film().rows()) continue;
        const label wall = side*slice_.columns() + column;
        change[size*flow.film().rows() + 1 + side] = -(there[size + 1][wall] - here[size + 1][wall])/step;
    }
    return change;
}


void Foam::linearisation::addCellUnknowns
(
    const filmState& film,
    const filmState* rate,
    const scalar rateFactor,
    const List<scalarField>& here
)
{
    filmFlow& flow = slice_.flow();
    const label rows = flow.film().rows(), size = flow.cellSize(), n = slice_.columns();
    const label across = flow.rowReach();

    for (label kind = 0; kind < size; ++kind)
    {
        const label along = flow.columnReach(kind);
        for (label firstColumn = 0; firstColumn <= 2*along; ++firstColumn)
        {
            for (label firstRow = 0; firstRow <= 2*across; ++firstRow)
            {
                filmState moved(film), movedRate(rate ? *rate : film);
                for (label i = firstColumn; i < n; i += 2*along + 1)
                {
                    for (label j = firstRow; j < rows; j += 2*across + 1)
                    {
                        const label place = flow.place(i, j, kind);
                        const scalar step = flow.cellStep(film, kind, i, j);
                        moved.local[place] += step;
                        movedRate.local[place] += rateFactor*step;
                    }
                }
                const List<scalarField> there(flow.residual(moved, rate ? &movedRate : nullptr));
                for (label i = firstColumn; i < n; i += 2*along + 1)
                {
                    for (label j = firstRow; j < rows; j += 2*across + 1)
                    {
                        const scalar step = flow.cellStep(film, kind, i, j);
                        for (label row = max(i - along, 0); row <= min(i + along, n - 1); ++row)
                        {
                            block(row, i).col(j*size + kind) =
                                difference(there, here, row, j - across, j + across, step);
                        }
                    }
                }
            }
        }
    }
    for (label i = 0; i < n; ++i)
    {
        flow.exactDerivatives(film, i, block(i, i));
        const label source = size*rows;
        for (label j = 0; j < rows; ++j)
        {
            for (label equation = 0; equation < size; ++equation)
            {
                block(i, i)(j*size + equation, source) = flow.sourceInCell(j, equation);
            }
        }
        block(i, i)(source, source) = flow.sourceInColumn();
        for (label flux = source + 1; flux < flow.blockSize(); ++flux) block(i, i)(flux, flux) = 1;
    }
}


void Foam::linearisation::addColumnUnknowns
(
    const filmState& film,
    const filmState* rate,
    const scalar rateFactor,
    const List<scalarField>& here
)
{
    filmFlow& flow = slice_.flow();
    const label n = slice_.columns(), size = flow.blockSize(), stride = 2*columnReach + 1;
    for (label i = 0; i < n; ++i)
    {
        outer_(flow.sourcePlace(i), i) += flow.columnInColumn();
    }
    if (!flow.columnInResidual()) return;

    for (label first = 0; first < stride; ++first)
    {
        filmState moved(film), movedRate(rate ? *rate : film);
        for (label i = first; i < n; i += stride)
        {
            moved.column[i] += pressureStep;
            movedRate.column[i] += rateFactor*pressureStep;
        }
        const List<scalarField> there(flow.residual(moved, rate ? &movedRate : nullptr));
        for (label i = first; i < n; i += stride)
        {
            for (label row = max(i - columnReach, 0); row <= min(i + columnReach, n - 1); ++row)
            {
                outer_.block(row*size, i, size, 1) +=
                    difference(there, here, row, 0, flow.film().rows(), pressureStep);
            }
        }
    }
}


void Foam::linearisation::addFilms
(
    const filmState& film,
    const filmState* rate,
    const scalar rateFactor,
    const List<scalarField>& here
)
{
    filmFlow& flow = slice_.flow();
    const label n = slice_.columns(), size = flow.blockSize(), stride = 2*filmReach;
    const Eigen::MatrixXd byUnknowns = slice_.filmByUnknowns(state_);
    // by the films that a column sees, from face row - filmReach + 1 on
    std::vector<Eigen::MatrixXd> byFilms(n, Eigen::MatrixXd::Zero(size, 2*filmReach));

    for (label first = 0; first < stride; ++first)
    {
        filmState moved(film), movedRate(rate ? *rate : film);
        for (label k = first; k <= n; k += stride)
        {
            moved.h[k] += filmStep*film.h[k];
            movedRate.h[k] += rateFactor*filmStep*film.h[k];
        }
        const List<scalarField> there(flow.residual(moved, rate ? &movedRate : nullptr));
        for (label k = first; k <= n; k += stride)
        {
            for (label row = max(k - filmReach, 0); row < min(k + filmReach, n); ++row)
            {
                byFilms[row].col(k - row + filmReach - 1) =
                    difference(there, here, row, 0, flow.film().rows(), filmStep*film.h[k]);
            }
        }
    }
    for (label row = 0; row < n; ++row)
    {
        const label first = max(row - filmReach + 1, 0), last = min(row + filmReach, n);
        outer_.block(row*size, 0, size, n + 1).noalias() +=
            byFilms[row].middleCols(first - (row - filmReach + 1), last - first + 1)
           *byUnknowns.middleRows(first, last - first + 1);
    }
}


void Foam::linearisation::follow(const label isobar)
{
    filmFlow& flow = slice_.flow();
    const List<scalarField> here(flow.residual(slice_.film(state_), nullptr));
    const List<scalarField> there(flow.residual(slice_.shiftedFilm(state_), nullptr));
    const label size = flow.blockSize(), n = slice_.columns();
    isobar_ = isobar;
    blockTridiagonal::rightSides inner = blockTridiagonal::rightSides::Zero(outer_.rows(), 1);
    for (label row = 0; row < n; ++row)
    {
        inner.block(row*size, 0, size, 1) =
            difference(there, here, row, 0, flow.film().rows(), slice_.shiftStep());
    }
    inner_.solve(inner);
    shift_ = inner.col(0);
    Eigen::VectorXd column = sources(inner);
    column[n] = slice_.loadByShift(state_)/slice_.contact().load;
    for (label side = 0; side < 2 && slice_.wallSize(); ++side)
    {
        column.segment(firstWall() + side*n, n) =
            wallByFlux_[side]*wallFlux(inner, side) - slice_.wallByShift(state_, side);
    }
    outerByShift_ = reduced_.solve(rowScale_.cwiseProduct(column));
}


Eigen::VectorXd Foam::linearisation::sources(const blockTridiagonal::rightSides& inner) const
{
    Eigen::VectorXd reduced = Eigen::VectorXd::Zero(outer_.cols());
    for (label i = 0; i < slice_.columns(); ++i) reduced[i] = inner(slice_.flow().sourcePlace(i), 0);
    return reduced;
}


Eigen::VectorXd Foam::linearisation::wallFlux(const blockTridiagonal::rightSides& inner, const label side) const
{
    Eigen::VectorXd flux(slice_.columns());
    for (label i = 0; i < slice_.columns(); ++i) flux[i] = inner(slice_.flow().fluxPlace(i, side), 0);
    return flux;
}


void Foam::linearisation::addWalls
(
    const filmState& film,
    const filmState* rate,
    const List<scalarField>& here
)
{
    filmFlow& flow = slice_.flow();
    const label n = slice_.columns(), size = flow.blockSize();
    for (label side = 0; side < 2; ++side)
    {
        // a wall's temperature is felt by its own column only
        filmState moved(film);
        for (label i = 0; i < n; ++i) moved.wall[side*n + i] += wallStep;
        const List<scalarField> there(flow.residual(moved, rate));
        for (label i = 0; i < n; ++i)
        {
            outer_.block(i*size, firstWall() + side*n + i, size, 1) =
                difference(there, here, i, 0, flow.film().rows(), wallStep);
        }
        wallByFlux_[side] = slice_.wallByFlux(side);
    }
}


// d(local) = A^-1 (residual - B d(outer)); its rows of the sources have to be what is asked of them
void Foam::linearisation::reduce()
{
    const filmFlow& flow = slice_.flow();
    const label n = slice_.columns();
    inner_.factorise();
    inner_.solve(outer_);

    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(outer_.cols(), outer_.cols());
    for (label i = 0; i < n; ++i)
    {
        matrix.row(i) = outer_.row(flow.sourcePlace(i));
    }
    for (label side = 0; side < 2 && slice_.wallSize(); ++side)
    {
        const label first = firstWall() + side*n;
        Eigen::MatrixXd flux(n, outer_.cols());
        for (label i = 0; i < n; ++i) flux.row(i) = outer_.row(flow.fluxPlace(i, side));
        // heat goes downstream in the walls
        matrix.middleRows(first, n) = wallByFlux_[side].triangularView<Eigen::Lower>()*flux;
        matrix.block(first, first, n, n).diagonal().array() += 1;
    }
    matrix.row(n).head(n) = slice_.loadByColumn(state_)/slice_.contact().load;
    rowScale_ = matrix.cwiseAbs().rowwise().maxCoeff().cwiseMax(VSMALL).cwiseInverse();
    reduced_.compute(rowScale_.asDiagonal()*matrix);
}


Foam::slice::unknowns Foam::linearisation::solve
(
    const Eigen::VectorXd& residual,
    const Eigen::VectorXd& source,
    const scalar load,
    const Eigen::VectorXd& wall
) const
{
    const label n = slice_.columns();
    blockTridiagonal::rightSides inner = blockTridiagonal::rightSides::Zero(outer_.rows(), 1);
    inner.col(0).head(residual.size()) = residual;
    inner_.solve(inner);

    Eigen::VectorXd reduced = sources(inner);
    reduced.head(n) -= source;
    reduced[n] = load;
    for (label side = 0; side < 2 && slice_.wallSize(); ++side)
    {
        reduced.segment(firstWall() + side*n, n) = wall.segment(side*n, n) + wallByFlux_[side]*wallFlux(inner, side);
    }
    Eigen::VectorXd outer = reduced_.solve(rowScale_.cwiseProduct(reduced));

    slice::unknowns change;
    if (isobar_ >= 0)
    {
        // the shift that leaves the pressure of its column
        change.shift = outer[isobar_]/outerByShift_[isobar_];
        outer -= change.shift*outerByShift_;
    }
    change.column = outer.head(n);
    change.offset = outer[n];
    change.wall = outer.tail(slice_.wallSize());
    inner.noalias() -= outer_*outer;
    if (isobar_ >= 0) inner.col(0) -= change.shift*shift_;
    change.local = inner.col(0).head(residual.size());
    return change;
}
