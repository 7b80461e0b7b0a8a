/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "steadyState.H"
#include "report.H"
#include "startPressure.H"
#include "positive.H"
#include "interpolateXY.H"

namespace Foam
{

/*-  Where a film is not met at once: from the one of an oil whose ln(viscosity)
     rises with pressure so small a part as much, in stages of so many times
     more, less where one fails. Stages before the last are solved roughly.

     Such an oil has no spike. A law that bounds the stress, and heat, are there
     from the first stage on: a film without them has a front far steeper, and
     at a higher pressure, than the one that is asked for.
*/
static constexpr scalar firstStiffness = 1.0/16, stiffening = 2, leastStiffening = 1.01, roughly = 1e-3;
static constexpr label roughIterations = 30;

/*-  Where the film that slides is not met at once: from the one that rolls,
     sliding by so large a part more, less where a stage fails
*/
static constexpr scalar firstSlide = 0.25, leastSlide = 1.0/256;

/*-  From a start with temperatures, which is near the film: most that a step
     changes pressures [Hertz pressures]. Longer ones leave the neighbourhood
     where the front of a spike stands between other columns.
*/
static constexpr scalar nearPressure = 0.08;


//- Temperatures of the case's start, if it has them: over its places x, one level across the film after the other
static void putWarmth(const dictionary& dict, const slice& s, slice::unknowns& u)
{
    if (!dict.found("start") || !dict.subDict("start").found("temperatures")) return;
    const dictionary& start = dict.subDict("start");
    const filmFlow& flow = s.flow();
    const scalar bulk = flow.heat()->bulk();
    const scalarField places(start.lookup("x")), levels(start.lookup("levels")), all(start.lookup("temperatures"));
    if (levels.size() < 2 || all.size() != levels.size()*places.size())
    {
        FatalIOErrorInFunction(start)
            << "temperatures: got " << all.size() << " at " << levels.size() << " levels of " << places.size()
            << " places, allowed is one for each of at least 2 levels of each place" << exit(FatalIOError);
    }
    const label n = s.columns(), rows = flow.film().rows();
    // the mesh itself does not stand there yet
    const scalarField faces(s.film(u).x);
    for (label i = 0; i < n; ++i)
    {
        const scalar middle = 0.5*(faces[i] + faces[i + 1]);
        scalarField across(levels.size());
        forAll(levels, k)
        {
            const scalarField along(SubList<scalar>(all, places.size(), k*places.size()));
            across[k] = interpolateXY(middle, places, along)/bulk - 1;
        }
        auto at = [&](const scalar level) { return interpolateXY(level, levels, across); };
        for (label j = 0; j < rows; ++j) u.local[flow.place(i, j, flow.warmthKind())] = at(flow.film().middle(j));
        u.wall[i] = at(0);
        u.wall[n + i] = at(1);
    }
}


//- What flows across a film whose velocities and temperatures are known: mass through the upper faces of its cells, as
//  continuity asks for, and heat into its walls
static void putFluxes(slice& s, slice::unknowns& u)
{
    const filmFlow& flow = s.flow();
    const Eigen::VectorXd lack = s.residual(u, nullptr);
    const label across = flow.warmthKind() - 1;
    for (label i = 0; i < s.columns(); ++i)
    {
        scalar leaves = 0;
        for (label j = 0; j < flow.film().rows(); ++j)
        {
            leaves -= lack[flow.place(i, j, across)];
            u.local[flow.place(i, j, across)] += leaves;
        }
        for (label side = 0; side < 2; ++side)
        {
            const label place = flow.fluxPlace(i, side);
            u.local[place] -= lack[place];
        }
    }
}

} // End namespace Foam


Foam::scalar Foam::centralFilm(const filmState& film)
{
    return interpolateXY(scalar(0), film.x, film.h);
}


Foam::solvedFilm Foam::steadyState
(
    const dictionary& dict,
    const lineContact& contact,
    filmMesh& film,
    const scalarField& x,
    const newtonControls& controls
)
{
    const dictionary& shear = dict.subDict("shear");
    const bool newtonian = shear.get<word>("type") == "Newtonian";
    const word flow(dict.get<word>("flow"));
    const scalar filmScale = dict.subDict("mesh").get<scalar>("film")*contact.filmUnit();

    // what a stage starts from: the case's own start, or the stage before
    struct
    {
        scalarField pressure;
        scalar central;
        Eigen::VectorXd local, wall;
        // of the thin film: what pressure adds to the velocities of the cells, their temperatures, fluxes into the walls
        scalarField velocity, warmth, flux;
    } from;
    from.pressure = startPressure(dict, contact, x);
    from.central = dict.found("start") ? positive(dict.subDict("start"), "centralFilm") : filmScale;
    const auto first(from);
    // without the spike that a start may have
    auto dry(first);
    dictionary withoutStart(dict);
    withoutStart.remove("start");
    dry.pressure = startPressure(withoutStart, contact, x);
    dry.central = filmScale;
    label iterations = 0;
    // the part of the sliding of a stage, and its contact, which outlives what is found on it; the part of the stiffening
    scalar slid = 1, stiffness = 1;
    std::unique_ptr<lineContact> slower;
    solvedFilm found;

    auto solve = [&](const word& type, const newtonControls& stageControls, const bool heated = false)
    {
        dictionary stage(dict);
        if (!heated) stage.remove("heat");
        if (stiffness < 1)
        {
            const word key("pressureViscosity");
            dictionary& oil = stage.subDict("viscosity");
            oil.set(key, stiffness*oil.get<scalar>(key));
            if (heated)
            {
                dictionary& oils = stage.subDict("heat").subDict("isotherms").subDict("viscosity");
                oils.set(key, scalarField(stiffness*scalarField(oils.lookup(key))));
            }
        }
        found.tangent.reset();
        found.contact.reset();
        found.flow.reset();
        slower.reset();
        if (slid < 1)
        {
            dictionary speeds(dict);
            const scalar half = 0.5*slid*(contact.upperSpeed - contact.lowerSpeed);
            speeds.set("lowerSpeed", contact.entrainment() - half);
            speeds.set("upperSpeed", contact.entrainment() + half);
            slower.reset(new lineContact(speeds));
        }
        const lineContact& here = slower ? *slower : contact;
        found.flow = filmFlow::New(type, stage, film, here);
        found.contact.reset(new slice(*found.flow, here, x, filmScale));
        Info<< type;
        if (heated) Info<< " with heat";
        if (stiffness < 1) Info<< ", " << stiffness << " of the stiffening";
        if (slid < 1) Info<< ", " << slid << " of the sliding";
        Info<< endl;
        slice::unknowns start(found.contact->start(from.pressure, from.central));
        if (from.local.size() == start.local.size())
        {
            slice::unknowns before(start);
            before.local = from.local;
            before.wall = from.wall;
            start = found.contact->settled(before, before);
        }
        else if (from.velocity.size())
        {
            // what the thin film before knows of this one
            for (label c = 0; c < from.velocity.size(); ++c)
            {
                const label i = c/film.rows(), j = c % film.rows();
                start.local[found.flow->place(i, j, 0)] += from.velocity[c];
                if (heated && from.warmth.size())
                {
                    start.local[found.flow->place(i, j, found.flow->warmthKind())] = from.warmth[c];
                }
            }
            if (heated && from.warmth.size())
            {
                start.wall = from.wall;
                for (label k = 0; k < from.flux.size(); ++k)
                {
                    start.local[found.flow->fluxPlace(k/2, k % 2)] = from.flux[k];
                }
            }
        }
        else
        {
            if (heated) putWarmth(dict, *found.contact, start);
            if (!newtonian || heated) start = found.contact->balanced(start);
            if (heated) putFluxes(*found.contact, start);
        }
        found.result = newton(*found.contact, start, contact.load, stageControls, found.tangent);
        iterations += found.result.iterations;
        found.result.iterations = iterations;
        const bool converged = found.result.end == outcome::converged;
        if (converged)
        {
            const filmState state(found.contact->film(found.result.state));
            forAll(from.pressure, i) from.pressure[i] = found.flow->loadPressure(state.column[i]);
            from.central = centralFilm(state);
            from.local = found.result.state.local;
            from.wall = found.result.state.wall;
            if (type != "thinFilm") return converged;
            const label cells = film.columns()*film.rows();
            from.velocity.setSize(cells);
            from.warmth.setSize(heated ? cells : 0);
            from.flux.setSize(heated ? 2*film.columns() : 0);
            for (label c = 0; c < cells; ++c)
            {
                auto unknown = [&](const label kind)
                {
                    return from.local[found.flow->place(c/film.rows(), c % film.rows(), kind)];
                };
                from.velocity[c] = unknown(0);
                if (heated) from.warmth[c] = unknown(found.flow->warmthKind());
            }
            forAll(from.flux, k) from.flux[k] = from.local[found.flow->fluxPlace(k/2, k % 2)];
        }
        return converged;
    };
    const bool heated = dict.found("heat");
    // the film without its heat, and from there with it
    auto both = [&](const newtonControls& own)
    {
        return solve("thinFilm", own) && (!heated || solve("thinFilm", own, heated));
    };
    auto thin = [&]()
    {
        if (both(controls)) return true;
        from = dry;
        const newtonControls begun{roughly, controls.maxIterations};
        const newtonControls rough{roughly, min(controls.maxIterations, roughIterations)};
        scalar reached = 0, ratio = stiffening;
        while (reached < 1)
        {
            stiffness = reached > 0 ? ratio*reached : firstStiffness;
            if (stiffness > 0.999) stiffness = 1;
            if
            (
                reached == 0 ? both(begun)
              : solve("thinFilm", rough, heated) && (stiffness < 1 || solve("thinFilm", controls, heated))
            )
            {
                reached = stiffness;
            }
            else if (reached == 0 || ratio < leastStiffening)
            {
                found.result.reason = "no film of an oil that stiffens " + name(stiffness) + " as much by pressure as it does, from "
                  + name(reached) + " on: " + found.result.reason;
                break;
            }
            else
            {
                ratio = Foam::sqrt(ratio);
            }
        }
        stiffness = 1;
        return reached == 1;
    };
    // up from the film that rolls, which is far from the one that slides
    auto slide = [&]()
    {
        slid = 0;
        if (!thin()) return false;
        scalar reached = 0, step = firstSlide;
        while (reached < 1)
        {
            slid = min(scalar(1), reached + step);
            if (solve("thinFilm", controls, heated))
            {
                reached = slid;
                step *= 1.5;
            }
            else
            {
                step *= 0.5;
                if (step < leastSlide) return false;
            }
        }
        return true;
    };
    const bool slides = contact.upperSpeed != contact.lowerSpeed;
    // a start with temperatures is near the film with all of its heat; who gives it has others where it leads nowhere
    const bool warm = heated && dict.found("start") && dict.subDict("start").found("temperatures");
    const newtonControls near{controls.tolerance, controls.maxIterations, nearPressure};
    if (warm && !solve("thinFilm", near, heated)) return found;
    bool met = warm || (slides && both(controls));
    if (slides && !met)
    {
        from = first;
        met = slide();
        if (!met) from = first;
        slid = 1;
    }
    if (!met && !thin()) return found;
    if (flow == "thinFilm") return found;

    // where all stresses have no solution to be found, the thin film shows whether the law of shear is admissible
    found.contact->residual(found.result.state, nullptr);
    writeTable(film.mesh().time().path()/"thinFilm.dat", *found.contact, found.contact->film(found.result.state));
    solve(flow, controls, heated);
    return found;
}
