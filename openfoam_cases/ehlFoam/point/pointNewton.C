/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "pointNewton.H"
#include "clockTime.H"

namespace Foam
{

//- Most that one step changes pressures [Hertz pressures] and ln(viscosity), least it leaves of a film
static constexpr scalar mostPointPressure = 0.25, mostPointViscosity = 5, leastPointFilm = 0.4;

//- What GMRES leaves of the right side of a step, and of the response
static constexpr scalar stepLeft = 1e-4, responseLeft = 1e-8;

//- v of a column that a step takes from film to mixture, or back
static constexpr scalar intoPointMixture = -0.01, intoPointFilm = 1e-7;

//- Defect of mass and of load that counts as none
static constexpr scalar mostPointDefect = 1e-8;

//- Steps in which none is half as long as the shortest before, and steps cut one after another, before it is given up
static constexpr label mostPointLost = 15, mostPointCuts = 20;


//- The unknowns after part of a step
static pointFilm::state pointStepped
(
    const pointFilm::state& s, const scalar part, const pointTangent::unknowns& step
)
{
    pointFilm::state next{s.v + part*step.v, s.offset + part*step.offset};
    const scalar least = -1 + 2*lubricant::leastFraction;
    for (label i = 0; i < s.v.size(); ++i)
    {
        if (s.v[i] > 0) next.v[i] = max(next.v[i], intoPointMixture);
        else next.v[i] = next.v[i] > 0 ? min(next.v[i], intoPointFilm) : max(next.v[i], least);
    }
    return next;
}


//- Part of a step that may be taken
static scalar pointPart
(
    const pointFilm& film, const pointFilm::state& s, const pointFilm::columns& c, const pointTangent::unknowns& step
)
{
    scalar part = 1;
    for (label i = 0; i < s.v.size(); ++i)
    {
        const scalar change = s.v[i] > 0 ? mag(max(s.v[i] + step.v[i], scalar(0)) - s.v[i]) : 0;
        part = min(part, mostPointPressure/max(change, VSMALL));
    }
    for (label tries = 0; tries < 30; ++tries)
    {
        const pointFilm::columns after(film.columnsOf(pointStepped(s, part, step)));
        scalar keep = 1, viscosity = 0;
        for (label i = 0; i < s.v.size(); ++i)
        {
            const scalar fall = c.H[i] - after.H[i], most = (1 - leastPointFilm)*c.H[i];
            if (fall > most) keep = min(keep, most/fall);
            viscosity = max(viscosity, mag(after.logEta[i] - c.logEta[i]));
        }
        keep = min(keep, mostPointViscosity/max(viscosity, VSMALL));
        if (keep >= 1) break;
        part *= max(keep, scalar(0.1));
    }
    return part;
}

} // End namespace Foam


Foam::pointResult Foam::pointNewton
(
    const pointFilm& film, const pointFilm::state& start, const newtonControls& controls
)
{
    const clockTime clock;
    pointFilm::state s(start);
    pointResult found{outcome::stagnated, "", 0, start, GREAT, GREAT, 0, 0};
    scalar previous = GREAT, shortest = GREAT;
    label cuts = 0, lost = 0, backAndForth = 0;
    for (label iteration = 1; iteration <= controls.maxIterations; ++iteration)
    {
        found.iterations = iteration;
        const pointFilm::columns c(film.columnsOf(s));
        const pointTangent tangent(film, s, c);
        const pointFilm::vector lack = film.residual(s, c);
        const pointTangent::unknowns step(tangent.solve(-lack, 1 - film.load(c), stepLeft));
        if (!(step.v.allFinite() && mag(step.offset) < GREAT))
        {
            found.end = outcome::diverged;
            found.reason = "Newton's step has no finite length";
            return found;
        }
        scalar part = pointPart(film, s, c, step);
        if (backAndForth > 2) part *= 0.5;
        const pointFilm::state next(pointStepped(s, part, step));
        label crossed = 0;
        for (label i = 0; i < s.v.size(); ++i) crossed += (s.v[i] > 0) != (next.v[i] > 0);
        const scalar moved = max
        (
            (next.v - s.v).cwiseAbs().maxCoeff(),
            mag(next.offset - s.offset)/film.central(c.H)
        );
        s = next;
        found.state = s;
        Info<< "  Newton step " << iteration << ": length " << moved << ", part taken " << part << ", "
            << crossed << " columns to mixture or back, " << tangent.vectors << " vectors leave " << tangent.left
            << ", " << clock.elapsedTime() << " s" << endl;
        if (part == 1 && moved < controls.tolerance)
        {
            const pointFilm::columns last(film.columnsOf(s));
            found.massDefect = film.residual(s, last).cwiseAbs().maxCoeff()/film.central(last.H);
            found.loadDefect = mag(film.load(last) - 1);
            if (found.massDefect < mostPointDefect && found.loadDefect < mostPointDefect)
            {
                found.end = outcome::converged;
                const pointTangent response(film, s, last);
                const pointFilm::vector none = pointFilm::vector::Zero(s.v.size());
                const pointTangent::unknowns slow(response.solve(none, 1, responseLeft));
                scalar left = response.left;
                const pointFilm::vector stored = film.storage(last, slow.v, response.filmBy(slow));
                const pointTangent::unknowns lagging(response.solve(stored, 0, responseLeft));
                left = max(left, response.left);
                found.compliance = -film.approach(last, slow.offset, response.pressureBy(slow));
                found.loss = -film.approach(last, lagging.offset, response.pressureBy(lagging));
                if (!(left <= responseLeft))
                {
                    found.end = outcome::stagnated;
                    found.reason = "GMRES does not solve the linear response";
                }
                return found;
            }
        }
        if (!(part >= 1e-6))
        {
            found.reason = "Newton's steps are cut to nothing";
            return found;
        }
        cuts = part < 1 ? cuts + 1 : 0;
        lost = moved < 0.5*shortest ? 0 : lost + 1;
        shortest = min(shortest, moved);
        if (cuts >= mostPointCuts || lost >= mostPointLost)
        {
            found.reason = cuts >= mostPointCuts
              ? "the last " + std::to_string(cuts) + " of Newton's steps had to be cut"
              : "Newton's steps have not become shorter for " + std::to_string(lost) + " steps";
            return found;
        }
        backAndForth = crossed && moved > 0.3*previous ? backAndForth + 1 : 0;
        previous = moved;
    }
    found.reason = "no convergence in " + std::to_string(controls.maxIterations) + " steps";
    return found;
}
