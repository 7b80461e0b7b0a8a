/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "movingWall.H"
#include "mathematicalConstants.H"
#include <cmath>

Foam::movingWall::movingWall(const scalarField& face, const scalar speed, const scalar effusivity)
:
    perFlux_(Eigen::MatrixXd::Zero(face.size() - 1, face.size() - 1))
{
    const scalar unit = 1/(effusivity*std::sqrt(constant::mathematical::pi*speed));
    for (Eigen::Index i = 0; i < perFlux_.rows(); ++i)
    {
        const scalar x = 0.5*(face[i] + face[i + 1]);
        for (Eigen::Index j = 0; j <= i; ++j)
        {
            const scalar far = x - face[j], near = max(x - face[j + 1], scalar(0));
            const scalar length = min(face[j + 1], x) - face[j], root = std::sqrt(far) + std::sqrt(near);
            // differences of roots, without their cancellation far away
            perFlux_(i, j) = unit*2*length/root;
        }
    }
}
