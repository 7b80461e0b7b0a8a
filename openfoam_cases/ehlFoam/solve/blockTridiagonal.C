/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "blockTridiagonal.H"

Foam::blockTridiagonal::blockTridiagonal(const Eigen::Index count, const Eigen::Index size)
:
    size_(size),
    lower_(count, Eigen::MatrixXd::Zero(size, size)),
    diagonal_(count, Eigen::MatrixXd::Zero(size, size)),
    upper_(count, Eigen::MatrixXd::Zero(size, size))
{}


Eigen::MatrixXd& Foam::blockTridiagonal::block(const Eigen::Index row, const Eigen::Index column)
{
    return column < row ? lower_[row] : column > row ? upper_[row] : diagonal_[row];
}


void Foam::blockTridiagonal::factorise()
{
    factor_.clear();
    factor_.reserve(diagonal_.size());
    for (std::size_t i = 0; i < diagonal_.size(); ++i)
    {
        if (i > 0)
        {
            // upper_ holds D^-1 U from here on
            diagonal_[i].noalias() -= lower_[i]*upper_[i - 1];
        }
        factor_.emplace_back(diagonal_[i]);
        upper_[i] = factor_[i].solve(upper_[i]).eval();
    }
    diagonal_.clear();
}


void Foam::blockTridiagonal::solve(rightSides& right) const
{
    const Eigen::Index count = factor_.size();
    for (Eigen::Index i = 0; i < count; ++i)
    {
        auto here = right.middleRows(i*size_, size_);
        if (i > 0)
        {
            here.noalias() -= lower_[i]*right.middleRows((i - 1)*size_, size_);
        }
        here = factor_[i].solve(here).eval();
    }
    for (Eigen::Index i = count - 2; i >= 0; --i)
    {
        right.middleRows(i*size_, size_).noalias() -= upper_[i]*right.middleRows((i + 1)*size_, size_);
    }
}
