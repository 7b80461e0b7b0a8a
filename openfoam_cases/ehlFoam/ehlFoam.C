/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

/*-
    One lubricated line contact: the film as CFD cells between two elastic
    half-spaces, its steady state, its stiffness and its damping. With a
    transverseRadius it is a point contact, see solvePoint.

    constant/ehlProperties says what is solved; the answer goes to `results`
    (an OpenFOAM dictionary), film.dat (a table over the columns) and, if asked,
    to the fields p, U, mu, rho, liquidFraction, wallShear (and T with heat) of the
    time folder 1.

    ehlFoam -laws FILE solves nothing and writes the oil as a table, laws.dat;
    ehlFoam -walls FILE the surfaces under sources of heat, walls.dat.
*/

#include "report.H"
#include "steadyState.H"
#include "solvePoint.H"
#include "oscillation.H"
#include "caseFiles.H"
#include "lawTable.H"
#include "wallTable.H"
#include "columnLayout.H"
#include "positive.H"
#include "argList.H"
#include "sigFpe.H"
#include "Time.H"
#include "clockTime.H"
#include <malloc.h>

using namespace Foam;


//- Longest inlet with all stresses [reduced radii]
static constexpr scalar longestInlet = 0.5;


//- Frequencies [Hz] of the linear response that is asked for
scalarField askedFrequencies(const dictionary& dict)
{
    if (!dict.found("response")) return scalarField();
    const dictionary& asked = dict.subDict("response");
    const scalarField frequencies(asked.lookup("frequencies"));
    for (const scalar frequency : frequencies)
    {
        if (!(frequency >= 0) || frequency > GREAT)
        {
            FatalIOErrorInFunction(asked)
                << "frequencies: got " << frequency << ", allowed are numbers from 0 to " << GREAT
                << exit(FatalIOError);
        }
    }
    return frequencies;
}


//- A number of cells of at least so many
label numberOf(const dictionary& dict, const word& cells, const label least)
{
    const label number = dict.get<label>(cells);
    if (number < least)
    {
        FatalIOErrorInFunction(dict)
            << cells << ": got " << number << ", allowed are " << least << " and more" << exit(FatalIOError);
    }
    return number;
}


int main(int argc, char* argv[])
{
    argList::addNote("Elastohydrodynamic contact of a line or a point, film-resolved");
    argList::noParallel();
    argList::addOption("laws", "file", "write the oil at the pressures and rates of a file to laws.dat, solve nothing");
    argList::addOption("walls", "file", "write surface temperatures under the heat of a file to walls.dat, solve nothing");
    const argList args(argc, argv);
    Time runTime(Time::controlDictName, args);
    // a number that overflows, or a pivot that is zero, ends a solve with a status
    const sigFpe::ignore withoutTraps;
    // matrices come and go: their pages are kept, not fetched anew from the system each time
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    const clockTime clock;

    // the problem
    const IOdictionary dict
    (
        IOobject("ehlProperties", runTime.constant(), runTime, IOobject::MUST_READ, IOobject::NO_WRITE)
    );
    if (args.found("laws"))
    {
        writeLaws(dict, args["laws"], runTime.path()/"laws.dat");
        return 0;
    }
    if (dict.found("transverseRadius"))
    {
        const bool written = dict.lookupOrDefault<bool>("writeFields", true);
        refuseUnread(runTime, fvSchemes(runTime), fvSolution(runTime), written);
        return solvePoint(dict, runTime, written);
    }
    const lineContact contact(dict);
    if (args.found("walls"))
    {
        writeWalls(dict, contact, args["walls"], runTime.path()/"walls.dat");
        return 0;
    }
    const label columns = numberOf(dict, "columns", 10), rows = numberOf(dict, "rows", 2);
    const newtonControls controls{positive(dict, "tolerance"), dict.get<label>("maxIterations")};
    dictionary meshDict(dict.subDict("mesh"));
    if (dict.get<word>("flow") == "fullStress")
    {
        // a parabola farther out is no gap between rollers, and its slopes are no matter of a film
        meshDict.set("longestInlet", longestInlet*contact.radius/contact.halfWidth);
    }
    const scalarField x(contact.halfWidth*columnLayout(meshDict).faces(columns));
    const scalarField frequencies(askedFrequencies(dict));
    const scalar filmScale = positive(meshDict, "film")*contact.filmUnit();
    filmMesh film(runTime, columns, rows, dict.lookupOrDefault<scalar>("lowerShare", 0.5));
    const bool written = dict.lookupOrDefault<bool>("writeFields", true);
    refuseUnread(runTime, film.mesh(), film.mesh(), written);
    Info<< "b " << contact.halfWidth << " m, p_H " << contact.pressure << " Pa, film expected "
        << filmScale << " m, " << columns << " x " << rows << " cells" << nl << endl;

    // the steady state
    solvedFilm found(steadyState(dict, contact, film, x, controls));
    newtonResult& solved = found.result;
    slice& s = *found.contact;
    label iterations = solved.iterations;

    // what it is
    resultsFile results(runTime);
    reportFilm(results, s, solved);
    reportHeat(runTime, results, s, solved);
    writeTable(runTime.path()/"film.dat", s, s.film(solved.state));
    if (written)
    {
        runTime.setTime(1, 1);
        film.write();
        s.flow().write();
        s.flow().writeWallStress();
        // those of controlDict, on these fields
        runTime.functionObjects().execute();
        runTime.functionObjects().end();
    }

    // how it moves: linear response, and the check in time
    if (solved.end == outcome::converged && frequencies.size())
    {
        reportResponse(results, s, solved.state, frequencies, meshDict, found.tangent);
    }
    if (solved.end == outcome::converged && dict.found("oscillation"))
    {
        const oscillationResult moved(oscillation(s, solved.state, dict.subDict("oscillation"), controls));
        iterations += moved.last.iterations;
        solved.end = moved.last.end;
        solved.reason = moved.last.reason;
        results.write("oscillationFilmCompliance", moved.filmCompliance);
        results.write("oscillationLossCompliance", moved.lossCompliance);
    }

    results.write("status", wordOf(solved.end));
    results.write("reason", solved.reason);
    results.write("iterations", iterations);
    results.write("seconds", clock.elapsedTime());
    Info<< nl << wordOf(solved.end) << " " << solved.reason << " in " << iterations << " steps, "
        << clock.elapsedTime() << " s" << nl << "End" << endl;
    return 0;
}
