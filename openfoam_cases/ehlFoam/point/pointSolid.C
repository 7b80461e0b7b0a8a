/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "pointSolid.H"
#include "mathematicalConstants.H"

namespace
{

//- Double integral of 1/r from the corner (0, 0) to (x, y)
double corner(const double x, const double y)
{
    const double u = std::abs(x), v = std::abs(y);
    if (u == 0 || v == 0) return 0;
    const double r = std::sqrt(u*u + v*v);
    const double value = u*std::log((v + r)/u) + v*std::log((u + r)/v);
    return (x < 0) != (y < 0) ? -value : value;
}

} // End anonymous namespace


Foam::pointSolid::pointSolid(const pointContact& contact, const pointLayout& layout)
:
    kernel_(layout.cells(), layout.cells())
{
    const label nx = layout.nx(), ny = layout.ny();
    const scalar unit = contact.pressureFactor/constant::mathematical::pi;
    // over the differences in x of one pair of lines
    Eigen::MatrixXd above(nx, nx + 1), below(nx, nx + 1);
    for (label j = 0; j < ny; ++j)
    {
        for (label l = 0; l <= ny; ++l)
        {
            // both mirror images of the face l of the lines
            Eigen::MatrixXd& here = above;
            for (label i = 0; i < nx; ++i)
            {
                const scalar x = layout.centreX(i), y = layout.centreY(j);
                for (label k = 0; k <= nx; ++k)
                {
                    here(i, k) = corner(layout.x[k] - x, layout.y[l] - y) + corner(layout.x[k] - x, layout.y[l] + y);
                }
            }
            if (l > 0)
            {
                for (label i = 0; i < nx; ++i)
                {
                    for (label k = 0; k < nx; ++k)
                    {
                        kernel_(layout.cell(i, j), layout.cell(k, l - 1)) =
                            unit*(above(i, k + 1) - above(i, k) - below(i, k + 1) + below(i, k));
                    }
                }
            }
            below.swap(above);
        }
    }
}
