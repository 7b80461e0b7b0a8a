/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

/*-
    One lubricated line contact: the film as CFD cells between two elastic
    half-spaces, its steady state, its stiffness and its damping.

    constant/ehlProperties says what is solved; the answer goes to `results`
    (an OpenFOAM dictionary), film.dat (a table over the columns) and, if asked,
    to the fields p, U, mu, rho, liquidFraction of the time folder 1.
*/

#include "oscillation.H"
#include "response.H"
#include "columnLayout.H"
#include "thinFilm.H"
#include "positive.H"
#include "argList.H"
#include "Time.H"
#include "OFstream.H"
#include "StringStream.H"
#include "clockTime.H"
#include "interpolateXY.H"
#include <functional>
#include <memory>

using namespace Foam;


//- Hertz' pressure [-] at x [b] with its edges rounded by a film H; a hump of the film's own width if it is thick
scalar roundedHertz(const scalar x, const scalar H)
{
    if (H > 0.3)
    {
        const scalar width = Foam::sqrt(1 + 2*H);
        return sqr(max(1 - x/width, scalar(0)))/Foam::pow(1 + sqr(x/width), 2.5);
    }
    const scalar zone = Foam::pow(H, scalar(2)/3), rounding = 0.15*zone;
    if (x < -1 + rounding)
    {
        return Foam::sqrt(2*rounding)*Foam::exp(max((x + 1 - rounding)/(0.6*zone), scalar(-40)));
    }
    return Foam::sqrt(max(1 - sqr(x), scalar(0)));
}


//- Pressures [Pa] in the columns to start from: given, or those of Hertz; they carry the load
scalarField startPressure(const dictionary& dict, const lineContact& contact, const scalarField& x)
{
    scalarField middle(x.size() - 1), length(x.size() - 1), pressure(x.size() - 1);
    forAll(middle, i)
    {
        middle[i] = 0.5*(x[i] + x[i + 1]);
        length[i] = x[i + 1] - x[i];
    }
    if (dict.found("start"))
    {
        const dictionary& start = dict.subDict("start");
        const scalarField places(start.lookup("x")), values(start.lookup("pressure"));
        if (places.size() < 2 || places.size() != values.size())
        {
            FatalIOErrorInFunction(start)
                << "x, pressure: got lists of " << places.size() << " and " << values.size()
                << ", allowed are lists of the same length of at least 2" << exit(FatalIOError);
        }
        for (label i = 1; i < places.size(); ++i)
        {
            if (places[i] > places[i - 1]) continue;
            FatalIOErrorInFunction(start)
                << "x: got " << places[i] << " after " << places[i - 1]
                << ", allowed are places in rising order" << exit(FatalIOError);
        }
        pressure = interpolateXY(middle, places, values);
        forAll(middle, i)
        {
            if (middle[i] > places.last()) pressure[i] = 0;
        }
    }
    else
    {
        const scalar H = dict.subDict("mesh").get<scalar>("film");
        forAll(middle, i) pressure[i] = roundedHertz(middle[i]/contact.halfWidth, H);
    }
    // upstream the film is full, and a column at rest would not know it
    const scalar least = 1e-9*max(pressure);
    forAll(middle, i)
    {
        pressure[i] = max(pressure[i], middle[i] < 0 ? least : scalar(0));
    }
    return pressure*contact.load/sum(pressure*length);
}


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


//- Film at x = 0 of films at the faces
scalar centralFilm(const filmState& film)
{
    return interpolateXY(scalar(0), film.x, film.h);
}


word wordOf(const outcome end)
{
    return end == outcome::converged ? "converged"
         : end == outcome::stagnated ? "stagnated"
         : end == outcome::diverged ? "diverged" : "outsideValidity";
}


//- A solved film, and the equations that it solves
struct solvedFilm
{
    autoPtr<filmFlow> flow;
    std::unique_ptr<slice> contact;
    newtonResult result;
};


/*-  The steady state, by easy steps: the Newtonian thin film; its shear stress
     limited more and more; then all stresses
*/
solvedFilm steadyState
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

    auto solve = [&](const word& type, const dictionary& shearLaw)
    {
        dictionary stage(dict);
        stage.set("shear", shearLaw);
        found.contact.reset();
        found.flow = filmFlow::New(type, stage, film, contact);
        found.contact.reset(new slice(*found.flow, contact, x, filmScale));
        Info<< type << ", " << shearLaw.get<word>("type");
        if (shearLaw.found("stress")) Info<< " " << shearLaw.get<scalar>("stress") << " Pa";
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


//- The file `results`, and how a number gets into it
class resultsFile
{
    OFstream file_;

public:

    resultsFile(const Time& runTime)
    :
        file_(runTime.path()/"results")
    {
        file_.precision(15);
        IOobject::writeBanner(file_)
            << "FoamFile { version 2.0; format ascii; class dictionary; object results; }" << nl;
    }

    template<class Type>
    void write(const word& key, const Type& value)
    {
        file_ << key << ' ' << value << ';' << nl;
    }
};


//- Films and defects of the steady state; one with too large a defect counts as stagnated
void reportFilm(resultsFile& results, slice& s, newtonResult& solved)
{
    s.residual(solved.state, nullptr);
    const filmState state(s.film(solved.state));
    const scalarField flux(s.flow().columnFlux());
    scalar greatest = 0;
    forAll(state.column, i)
    {
        greatest = max(greatest, s.flow().loadPressure(state.column[i]));
    }
    results.write("centralFilm", centralFilm(state));
    results.write("minimumFilm", min(state.h));
    results.write("maximumPressure", greatest);
    results.write("filmOffset", solved.state.offset*s.filmScale() - s.solid().dry().offset);
    results.write("outletDefect", mag(flux.last()/flux[0] - 1));

    struct { word key; const char* name; scalar defect, most; } const balances[] =
    {
        {"loadDefect", "the load", mag(s.load(solved.state)/s.contact().load - 1), 1e-8},
        {"fluxDefect", "mass flux upstream of rupture", s.fluxDefect(), 1e-8},
        {"cellContinuity", "continuity of a cell", s.flow().cellContinuity(), 1e-6}
    };
    for (const auto& balance : balances)
    {
        results.write(balance.key, balance.defect);
        if (solved.end == outcome::converged && !(balance.defect <= balance.most))
        {
            OStringStream reason;
            reason << balance.name << " has a relative defect of " << balance.defect
                << ", allowed is " << balance.most;
            solved.end = outcome::stagnated;
            solved.reason = reason.str();
        }
    }
}


//- The columns as a table
void writeTable(const Time& runTime, const slice& s, const filmState& state)
{
    const scalarField flux(s.flow().columnFlux()), fraction(s.flow().columnFraction());
    const scalarField density(s.flow().columnDensity());
    OFstream table(runTime.path()/"film.dat");
    table.precision(12);
    table << "# x pressure film flux density liquid_fraction" << nl;
    forAll(state.column, i)
    {
        table
            << 0.5*(state.x[i] + state.x[i + 1]) << ' '
            << s.flow().loadPressure(state.column[i]) << ' '
            << 0.5*(state.h[i] + state.h[i + 1]) << ' '
            << flux[i + 1] << ' ' << density[i] << ' ' << fraction[i] << nl;
    }
}


//- Linear response, on a mesh that follows the pressure spike if there is one
void reportResponse
(
    resultsFile& results,
    slice& s,
    const slice::unknowns& solution,
    const scalarField& frequencies,
    const dictionary& meshDict
)
{
    const scalar place = meshDict.get<scalar>("spikePosition"), width = meshDict.get<scalar>("spikeWidth");
    const label isobar = width > 0 ? frontColumn(s, solution, place) : -1;
    if (isobar >= 0)
    {
        const scalar step = 1e-4*width;
        dictionary shifted(meshDict);
        shifted.set("spikePosition", place + step);
        s.follow(s.contact().halfWidth*columnLayout(shifted).faces(s.columns()), step);
    }
    const List<filmResponse> found(response(s, solution, frequencies, isobar));
    scalarField compliance(found.size()), loss(found.size()), residual(found.size());
    forAll(found, f)
    {
        compliance[f] = found[f].filmCompliance;
        loss[f] = found[f].lossCompliance;
        residual[f] = found[f].residual;
    }
    results.write("frequencies", frequencies);
    results.write("filmCompliance", compliance);
    results.write("lossCompliance", loss);
    results.write("responseResidual", residual);
}


int main(int argc, char* argv[])
{
    argList::addNote("Elastohydrodynamic line contact, film-resolved");
    argList::noParallel();
    const argList args(argc, argv);
    Time runTime(Time::controlDictName, args);
    const clockTime clock;

    // the problem
    const IOdictionary dict
    (
        IOobject("ehlProperties", runTime.constant(), runTime, IOobject::MUST_READ, IOobject::NO_WRITE)
    );
    const lineContact contact(dict);
    const label columns = dict.get<label>("columns"), rows = dict.get<label>("rows");
    const newtonControls controls{positive(dict, "tolerance"), dict.get<label>("maxIterations")};
    const dictionary& meshDict = dict.subDict("mesh");
    const scalarField x(contact.halfWidth*columnLayout(meshDict).faces(columns));
    const scalarField frequencies(askedFrequencies(dict));
    const scalar filmScale = positive(meshDict, "film")*contact.filmUnit();
    fvMesh mesh
    (
        IOobject(fvMesh::defaultRegion, runTime.timeName(), runTime, IOobject::MUST_READ)
    );
    filmMesh film(mesh, columns, rows, dict.lookupOrDefault<scalar>("lowerShare", 0.5));
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
    writeTable(runTime, s, s.film(solved.state));
    if (dict.lookupOrDefault<bool>("writeFields", true))
    {
        runTime.setTime(1, 1);
        mesh.setInstance(runTime.timeName());
        mesh.write();
        s.flow().write();
    }

    // how it moves: linear response, and the check in time
    if (solved.end == outcome::converged && frequencies.size())
    {
        reportResponse(results, s, solved.state, frequencies, meshDict);
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
