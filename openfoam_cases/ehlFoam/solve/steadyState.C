/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "steadyState.H"
#include "startPressure.H"
#include "thinFilm.H"
#include "positive.H"
#include "interpolateXY.H"
#include "StringStream.H"

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
    const word flow(dict.get<word>("flow"));
    const scalar filmScale = dict.subDict("mesh").get<scalar>("film")*contact.filmUnit();
    scalarField pressure(startPressure(dict, contact, x));
    scalar central = dict.found("start") ? positive(dict.subDict("start"), "centralFilm") : filmScale;
    label iterations = 0;
    solvedFilm found;

    auto solve = [&](const word& type, const dictionary& shearLaw, const scalar heated = 0)
    {
        dictionary stage(dict);
        stage.set("shear", shearLaw);
        if (heated > 0) stage.subDict("heat").set("share", heated);
        else stage.remove("heat");
        found.contact.reset();
        found.flow = filmFlow::New(type, stage, film, contact);
        found.contact.reset(new slice(*found.flow, contact, x, filmScale));
        Info<< type << ", " << shearLaw.get<word>("type");
        if (shearLaw.found("stress")) Info<< " " << shearLaw.get<scalar>("stress") << " Pa";
        if (heated > 0) Info<< ", " << heated << " of the heat";
        Info<< endl;
        std::unique_ptr<linearisation> none;
        found.result = newton
        (
            *found.contact, found.contact->start(pressure, central), contact.load, controls, none
        );
        iterations += found.result.iterations;
        found.result.iterations = iterations;
        const filmState state(found.contact->film(found.result.state));
        forAll(pressure, i) pressure[i] = found.flow->loadPressure(state.column[i]);
        central = centralFilm(state);
        return found.result.end == outcome::converged;
    };

    dictionary newtonian(shear);
    newtonian.set("type", word("Newtonian"));
    newtonian.remove("stress");
    if (!solve("thinFilm", newtonian)) return found;
    if (shear.get<word>("type") != "Newtonian")
    {
        for (scalar factor = 64; factor >= 1; factor /= 4)
        {
            dictionary eased(shear);
            eased.set("stress", factor*positive(shear, "stress"));
            if (!solve("thinFilm", eased)) return found;
        }
    }
    if (dict.found("heat") && !solve(flow, shear, 1))
    {
        // a little heat first: it thins the oil where most of it is made
        for (scalar share = 1.0/64; share <= 1; share *= 4)
        {
            if (!solve(flow, shear, share)) return found;
        }
    }
    if (flow == "thinFilm") return found;

    found.contact->residual(found.result.state, nullptr);
    const scalar rise = refCast<const thinFilm>(*found.flow).stressByPressure();
    Info<< "shear stress rises by " << rise << " times the pressure at most" << endl;
    if (flow == "fullStress" && rise >= 1)
    {
        OStringStream reason;
        reason << "the shear stress of this liquid rises " << rise
            << " times as fast as pressure; from 1 on slow flow with all stresses has no elliptic"
               " equations: take thinFilm, or a shear law that limits the stress";
        found.result.end = outcome::outsideValidity;
        found.result.reason = reason.str();
        return found;
    }
    solve(flow, shear);
    return found;
}
