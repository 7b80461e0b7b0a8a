/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "newton.H"
#include "clockTime.H"

namespace Foam
{

//- A linearisation is renewed when a step is not below this part of the one before
static constexpr scalar slow = 0.3;

//- Most that one step changes ln(viscosity), least it leaves of a film
static constexpr scalar mostViscosity = 5, leastFilm = 0.4;

//- Most that one step changes temperatures [T_b]
static constexpr scalar mostWarmth = 0.08;

//- Defect of the mass flux upstream of rupture that counts as none, beside the tolerance of a rough film; that of a cell
//  may be a hundred times as large
static constexpr scalar leastDefect = 1e-8;

//- Steps that are cut one after another, and full steps of no length beside balances that are not met (a step by a
//  tangent that is new may come between, with its noise), before it is given up; and full steps in which none
//  is half as long as the shortest before
static constexpr label mostCuts = 25, mostIdle = 3, mostLost = 15;

//- Length of a step up to which the law of shear is as good as its tangent
static constexpr scalar straight = 1e-3;

//- Last change of a wall's temperature over the largest one, beside the tolerance of a rough film: a light film warms
//  walls by less than other steps tell
static constexpr scalar sameWarmth = 1e-5;

//- Length of a step that is none
static constexpr scalar noLength = 1e-12;

//- v of a column that a step takes from film to mixture, or back: just past the edge,
//  since the derivatives on one side say nothing of the other
static constexpr scalar intoMixture = -0.01, intoFilm = 1e-7;


//- v after a step from film to mixture or back: beyond its edge the step means nothing
static scalar edged(const scalar before, const scalar after)
{
    const scalar least = -1 + 2*lubricant::leastFraction;
    if (before >= 0) return max(after, intoMixture);
    return after > 0 ? min(after, intoFilm) : max(after, least);
}


//- The unknowns after part of a step
static slice::unknowns stepped
(
    const slice& s,
    const slice::unknowns& u,
    const scalar part,
    const slice::unknowns& step
)
{
    const filmFlow& flow = s.flow();
    slice::unknowns next(u.plus(part, step));
    for (label i = 0; i < s.columns(); ++i)
    {
        if (flow.columnInResidual())
        {
            next.column[i] = edged(u.column[i], next.column[i]);
            continue;
        }
        for (label j = 0; j < flow.film().rows(); ++j)
        {
            const label place = flow.place(i, j, flow.pressureKind());
            next.local[place] = edged(u.local[place], next.local[place]);
        }
    }
    return next;
}


//- Whether a step takes oil from film to mixture or back
static bool crossed(const slice& s, const slice::unknowns& before, const slice::unknowns& after)
{
    const filmFlow& flow = s.flow();
    for (label i = 0; i < s.columns(); ++i)
    {
        if (flow.columnInResidual())
        {
            if ((before.column[i] > 0) != (after.column[i] > 0)) return true;
            continue;
        }
        for (label j = 0; j < flow.film().rows(); ++j)
        {
            const label place = flow.place(i, j, flow.pressureKind());
            if ((before.local[place] > 0) != (after.local[place] > 0)) return true;
        }
    }
    return false;
}


//- Largest change of a temperature [T_b] by a step; none where the film is isothermal
static scalar warmed(const slice& s, const slice::unknowns& step)
{
    const filmFlow& flow = s.flow();
    scalar most = 0;
    if (!flow.heat()) return most;
    for (label i = 0; i < s.columns(); ++i)
    {
        for (label j = 0; j < flow.film().rows(); ++j)
        {
            most = max(most, mag(step.local[flow.place(i, j, flow.warmthKind())]));
        }
    }
    return max(most, step.wall.cwiseAbs().maxCoeff());
}


//- Part of a step that may be taken, of which pressures may change by so many Hertz pressures
static scalar allowedPart
(
    const slice& s,
    const slice::unknowns& u,
    const slice::unknowns& step,
    const scalar mostPressure
)
{
    const filmFlow& flow = s.flow();
    auto v = [&](const scalar column) { return flow.oil().unknown(flow.loadPressure(column)); };
    auto pressureChange = [&](const slice::unknowns& next)
    {
        scalar most = 0;
        for (label i = 0; i < s.columns(); ++i)
        {
            most = max(most, mag(max(v(next.column[i]), scalar(0)) - max(v(u.column[i]), scalar(0))));
        }
        return most;
    };
    scalar part = min(scalar(1), mostPressure/max(pressureChange(stepped(s, u, 1, step)), VSMALL));

    const filmState before(s.film(u)), after(s.film(stepped(s, u, part, step)));
    scalar keep = 1;
    forAll(before.h, k)
    {
        const scalar fall = before.h[k] - after.h[k];
        if (fall > (1 - leastFilm)*before.h[k])
        {
            keep = min(keep, (1 - leastFilm)*before.h[k]/fall);
        }
    }
    part *= keep;
    const slice::unknowns next(stepped(s, u, part, step));
    scalar most = 0;
    for (label i = 0; i < s.columns(); ++i)
    {
        most = max
        (
            most,
            mag(Foam::log(flow.oil().viscosity(v(next.column[i]))/flow.oil().viscosity(v(u.column[i]))))
        );
    }
    if (most > mostViscosity) part *= mostViscosity/most;
    return min(part, mostWarmth/max(warmed(s, step), VSMALL));
}

} // End namespace Foam


Foam::newtonResult Foam::newton
(
    slice& s,
    const slice::unknowns& start,
    const scalar load,
    const newtonControls& controls,
    std::unique_ptr<linearisation>& kept,
    const std::function<slice::unknowns(const slice::unknowns&)>& rateOf,
    const scalar rateFactor
)
{
    const clockTime clock;
    slice::unknowns u(start);
    const label n = s.columns();
    scalar previous = GREAT;
    label backAndForth = 0, cuts = 0, idle = 0, lost = 0;
    scalar shortest = GREAT;
    const scalar mostDefect = max(leastDefect, controls.tolerance), warmth = max(sameWarmth, controls.tolerance);
    for (label iteration = 1; iteration <= controls.maxIterations; ++iteration)
    {
        slice::unknowns rate;
        if (rateOf) rate = rateOf(u);
        auto step = [&]()
        {
            Eigen::VectorXd source(n);
            for (label i = 0; i < n; ++i) source[i] = -u.local[s.flow().sourcePlace(i)];
            return kept->solve
            (
                -s.residual(u, rateOf ? &rate : nullptr),
                source,
                (load - s.load(u))/s.contact().load,
                -s.wallDefect(u, rateOf ? &rate : nullptr)
            );
        };
        auto length = [&](const slice::unknowns& after)
        {
            const scalar walls = s.wallSize() ? (after.wall - u.wall).cwiseAbs().maxCoeff() : 0;
            return max(max((after.column - u.column).cwiseAbs().maxCoeff(), mag(after.offset - u.offset)), walls);
        };

        bool fresh = false;
        if (!kept)
        {
            kept.reset(new linearisation(s, u, rateOf ? &rate : nullptr, rateFactor));
            fresh = true;
        }
        slice::unknowns change(step());
        slice::unknowns next(stepped(s, u, 1, change));
        if (!fresh && !(length(next) < slow*previous))
        {
            kept.reset(new linearisation(s, u, rateOf ? &rate : nullptr, rateFactor));
            fresh = true;
            change = step();
            next = stepped(s, u, 1, change);
        }
        if (!(change.column.allFinite() && change.local.allFinite() && mag(change.offset) < GREAT))
        {
            return {outcome::diverged, "Newton's step has no finite length", iteration, u};
        }
        scalar part = allowedPart(s, u, change, controls.mostPressure);
        // a column at the edge of the mixture that goes back and forth is met half-way
        if (backAndForth > 2) part *= 0.5;
        if (part < 1) next = stepped(s, u, part, change);
        const scalar moved = length(next);
        const bool warm = s.wallSize() == 0
          || (next.wall - u.wall).cwiseAbs().maxCoeff() <= max(warmth*next.wall.cwiseAbs().maxCoeff(), noLength);
        Eigen::Index most = 0;
        (next.column - u.column).cwiseAbs().maxCoeff(&most);
        const bool edge = crossed(s, u, next);
        // short steps are met by the tangent itself
        u = part == 1 && moved < straight ? next : s.settled(u, next);
        Info<< "  " << (fresh ? "Newton" : "chord ") << " step " << iteration
            << ": length " << moved << ", part taken " << part
            << ", most at x/b " << s.flow().film().x()[most]/s.contact().halfWidth
            << ", " << clock.elapsedTime() << " s" << endl;
        // the balances, before this step; in time the flux is not the same everywhere
        const bool balanced = (rateOf || s.fluxDefect() < mostDefect)
          && s.flow().cellContinuity() < 100*mostDefect;
        if (part == 1 && moved < controls.tolerance && balanced && warm)
        {
            return {outcome::converged, "", iteration, u};
        }
        if (!(part >= 1e-6))
        {
            return {outcome::stagnated, "Newton's steps are cut to nothing", iteration, u};
        }
        cuts = part < 1 ? cuts + 1 : 0;
        if (part == 1 && moved < noLength) ++idle;
        if (moved < 0.5*shortest) lost = 0;
        else if (part == 1) ++lost;
        shortest = min(shortest, moved);
        const bool last = iteration == controls.maxIterations;
        if (cuts >= mostCuts || idle >= mostIdle || lost >= mostLost || last)
        {
            return
            {
                outcome::stagnated,
                cuts >= mostCuts ? "the last " + std::to_string(cuts) + " of Newton's steps had to be cut"
              : idle >= mostIdle && !balanced
              ? "Newton's steps end at a length of " + name(shortest) + " where the mass flux upstream of rupture varies"
                " by " + name(s.fluxDefect()) + ", continuity of a cell by " + name(s.flow().cellContinuity())
              : last ? "no convergence in " + std::to_string(iteration) + " steps"
              : "Newton's steps have not become shorter for " + std::to_string(lost) + " steps",
                iteration,
                u
            };
        }
        backAndForth = edge && moved > slow*previous ? backAndForth + 1 : 0;
        // a step that was cut, or took columns from film to mixture, says nothing about how fast steps shrink
        previous = moved;
        if (part < 1 || edge) kept.reset();
    }
    return {outcome::stagnated, "no step of Newton's method is allowed", 0, u};
}
