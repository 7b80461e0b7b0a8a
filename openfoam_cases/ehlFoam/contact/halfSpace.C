/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "halfSpace.H"
#include "mathematicalConstants.H"
#include "error.H"
#include <vector>

using Foam::constant::mathematical::pi;

namespace
{

//- Columns within the dry contact from which on its pressure is resolved
constexpr std::size_t leastTouching = 12;


//- Integral of ln|t|
double logIntegral(const double t)
{
    return t == 0 ? 0 : t*std::log(std::abs(t)) - t;
}


//- Film at places x per pressure in the columns between faces
Eigen::MatrixXd columnKernel
(
    const Foam::scalarField& x,
    const Foam::scalarField& face,
    const double modulus,
    const double length
)
{
    Eigen::MatrixXd K(x.size(), face.size() - 1);
    const double unit = -4*length/(pi*modulus);
    for (Eigen::Index j = 0; j < K.cols(); ++j)
    {
        for (Eigen::Index i = 0; i < K.rows(); ++i)
        {
            K(i, j) = unit
               *(
                    logIntegral((x[i] - face[j])/length)
                  - logIntegral((x[i] - face[j + 1])/length)
                );
        }
    }
    return K;
}

} // End anonymous namespace


Foam::halfSpace::halfSpace(const lineContact& contact, const scalarField& face)
:
    contact_(contact),
    face_(face),
    middle_(face.size() - 1)
{
    const label n = middle_.size();
    forAll(middle_, i)
    {
        middle_[i] = 0.5*(face[i] + face[i + 1]);
    }
    middleKernel_ = columnKernel(middle_, face, contact.modulus, contact.halfWidth);
    faceKernel_ = columnKernel(face, face, contact.modulus, contact.halfWidth);
    for (label k = 2; k < n; ++k)
    {
        const scalar a = middle_[k - 2], b = middle_[k - 1], c = middle_[k], x = face[k];
        faceKernel_.row(k) =
            (x - b)*(x - c)/((a - b)*(a - c))*middleKernel_.row(k - 2)
          + (x - a)*(x - c)/((b - a)*(b - c))*middleKernel_.row(k - 1)
          + (x - a)*(x - b)/((c - a)*(c - b))*middleKernel_.row(k);
    }
}


Eigen::VectorXd Foam::halfSpace::film
(
    const Eigen::VectorXd& pressure,
    const scalar offset
) const
{
    Eigen::VectorXd h = faceKernel_*pressure;
    forAll(face_, k)
    {
        h[k] += offset + sqr(face_[k])/(2*contact_.radius);
    }
    return h;
}


Foam::scalar Foam::halfSpace::offsetOf
(
    const Eigen::VectorXd& pressure,
    const scalar centralFilm
) const
{
    const Eigen::VectorXd h = film(pressure, 0);
    label k = 0;
    while (face_[k + 1] < 0) ++k;
    const scalar part = -face_[k]/(face_[k + 1] - face_[k]);
    return centralFilm - ((1 - part)*h[k] + part*h[k + 1]);
}


Foam::halfSpace::dryContact Foam::halfSpace::dry() const
{
    std::vector<label> touching;
    forAll(middle_, i)
    {
        if (mag(middle_[i]) < contact_.halfWidth) touching.push_back(i);
    }

    // Where columns are longer than the contact, the film is far thicker than
    // what they miss: the exact values of the operator
    if (touching.size() < leastTouching)
    {
        const scalar unit = 4*contact_.load/(pi*contact_.modulus);
        return {-unit*(Foam::log(2.0) + 0.5), -unit*Foam::log(2.0)/contact_.load};
    }

    // The set of touching columns: drop those that pull, add those that overlap
    for (label sweep = 0; sweep < 50; ++sweep)
    {
        const label m = touching.size();
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(m + 1, m + 1);
        Eigen::VectorXd right(m + 1);
        for (label i = 0; i < m; ++i)
        {
            for (label j = 0; j < m; ++j)
            {
                A(i, j) = middleKernel_(touching[i], touching[j])*contact_.pressure/contact_.filmUnit();
            }
            A(i, m) = 1;
            A(m, i) = (face_[touching[i] + 1] - face_[touching[i]])/contact_.halfWidth;
            right[i] = -sqr(middle_[touching[i]])/(2*contact_.radius)/contact_.filmUnit();
        }
        right[m] = contact_.load/(contact_.pressure*contact_.halfWidth);
        const Eigen::VectorXd solution = A.partialPivLu().solve(right);
        Eigen::VectorXd pressure = Eigen::VectorXd::Zero(middle_.size());
        for (label i = 0; i < m; ++i) pressure[touching[i]] = solution[i]*contact_.pressure;
        const scalar offset = solution[m]*contact_.filmUnit();

        const Eigen::VectorXd gap = middleKernel_*pressure;
        std::vector<label> next;
        forAll(middle_, i)
        {
            const scalar h = offset + sqr(middle_[i])/(2*contact_.radius) + gap[i];
            const bool pressed = pressure[i] > 0;
            if (pressed || (pressure[i] == 0 && h < -1e-9*contact_.filmUnit())) next.push_back(i);
        }
        if (next == touching)
        {
            // A mesh that grows with the half-width carries the same solution
            // to the next load: h0 = (4 w/(pi E'))(constant + ln(b/b_fixed))
            return {offset, offset/contact_.load + 2/(pi*contact_.modulus)};
        }
        touching = next;
    }
    FatalErrorInFunction
        << "the dry contact on " << middle_.size() << " columns has no stable set of touching columns"
        << exit(FatalError);
    return {0, 0};
}
