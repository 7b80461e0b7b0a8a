/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "solvePoint.H"
#include "pointMesh.H"
#include "positive.H"
#include "report.H"
#include "clockTime.H"

namespace Foam
{

//- H from which on a start is no longer Hertz' pressure but a hump as wide as the film
static constexpr scalar thickPoint = 0.3;

//- Least pressure ahead of the contact, in a start, over the largest
static constexpr scalar pointTrace = 1e-9;

//- Loads that lead to one whose start from the dry contact fails
static constexpr scalar pointLoads[] = {0.25, 0.4, 0.6, 0.8};

//- Least film of a start from another mesh, over the least one there
static constexpr scalar startLeast = 0.5;

//- Films of starts from the dry contact, over the expected one
static constexpr scalar startFilms[] = {1, 1.8, 0.6};

//- Part by which the film of a mesh may differ from that for which it is laid
static constexpr scalar otherFilm = 0.15;

//- Cells each way of the coarse mesh over those of the fine one
static constexpr scalar coarsePart = scalar(2)/3;


//- Least columns along and across the motion, and most in all
static constexpr label leastColumns = 24, leastLines = 12, mostColumns = 8000;


//- A number of cells of at least so many
static label pointNumber(const dictionary& dict, const word& cells, const label least)
{
    const label number = dict.get<label>(cells);
    if (number < least || number > mostColumns)
    {
        FatalIOErrorInFunction(dict)
            << cells << ": got " << number << ", allowed are " << least << " to " << mostColumns << exit(FatalIOError);
    }
    return number;
}


//- A contact on one mesh
struct pointCase
{
    const pointContact contact;
    const lubricant oil;
    const pointLayout layout;
    const pointSolid solid;
    const pointFilm film;
    pointResult found;

    static dictionary withMixture(const dictionary& dict)
    {
        // the mixture of a point stands at ambient pressure: its range is not used
        dictionary whole(dict), range;
        range.set("pressureRange", 1);
        whole.set("cavitation", range);
        return whole;
    }

    pointCase(const dictionary& dict, const scalar expected, const label nx, const label ny)
    :
        contact(dict),
        oil(withMixture(dict), contact.pressure),
        layout(contact, expected, positive(dict.subDict("mesh"), "inletLength"), nx, ny),
        solid(contact, layout),
        film(contact, layout, oil, solid)
    {}

    //- From the dry contact, or a hump, with a central film
    pointFilm::state start(const scalar central) const
    {
        pointFilm::vector P(layout.cells());
        for (label j = 0; j < layout.ny(); ++j)
        {
            for (label i = 0; i < layout.nx(); ++i)
            {
                const scalar x = layout.centreX(i), y = layout.centreY(j);
                scalar& p = P[layout.cell(i, j)];
                if (central > thickPoint)
                {
                    const scalar width = 1 + 2*central;
                    const scalar s = sqr(x)/width + contact.ratio*sqr(y)/width;
                    p = sqr(max(1 - x/Foam::sqrt(width), scalar(0)))/Foam::pow(1 + s, 2.5);
                }
                else
                {
                    p = Foam::sqrt(max(1 - sqr(x) - sqr(y/contact.ellipticity), scalar(0)));
                }
            }
        }
        scalar sum = 0;
        for (label j = 0; j < layout.ny(); ++j)
        {
            for (label i = 0; i < layout.nx(); ++i) sum += 2*layout.area(i, j)*P[layout.cell(i, j)];
        }
        P *= contact.unitLoad()/sum;
        for (label j = 0; j < layout.ny(); ++j)
        {
            for (label i = 0; i < layout.nx(); ++i)
            {
                scalar& p = P[layout.cell(i, j)];
                if (layout.centreX(i) < 0) p = max(p, pointTrace);
            }
        }
        pointFilm::state s{P, 0};
        s.offset = central - film.central(film.columnsOf(s).H);
        return s;
    }

    //- From the columns of another mesh
    pointFilm::state start(const pointCase& other) const
    {
        const pointLayout& from = other.layout;
        pointFilm::state s{pointFilm::vector(layout.cells()), 0};
        const pointFilm::vector& v = other.found.state.v;
        auto place = [](const scalar at, const label n, const std::function<scalar(label)>& centre, label& k, scalar& part)
        {
            k = 0;
            while (k + 2 < n && centre(k + 1) < at) ++k;
            part = min(max((at - centre(k))/(centre(k + 1) - centre(k)), scalar(0)), scalar(1));
        };
        for (label j = 0; j < layout.ny(); ++j)
        {
            label l;
            scalar up;
            place(layout.centreY(j), from.ny(), [&](const label k) { return from.centreY(k); }, l, up);
            for (label i = 0; i < layout.nx(); ++i)
            {
                label k;
                scalar on;
                place(layout.centreX(i), from.nx(), [&](const label m) { return from.centreX(m); }, k, on);
                scalar P = 0, theta = 0;
                for (label side = 0; side < 4; ++side)
                {
                    const scalar weight = (side % 2 ? on : 1 - on)*(side/2 ? up : 1 - up);
                    const scalar here = v[from.cell(k + side % 2, l + side/2)];
                    P += weight*max(here, scalar(0));
                    theta += weight*min(here, scalar(0));
                }
                // full where it is so for the most part
                s.v[layout.cell(i, j)] = theta > -0.02 && P > 0 ? P : theta;
            }
        }
        // the same film at the centre, and nowhere much less
        s.offset = 0;
        const pointFilm::vector H(film.columnsOf(s).H);
        const scalar least = other.film.columnsOf(other.found.state).H.minCoeff();
        s.offset = max(other.centralFilm() - film.central(H), startLeast*least - H.minCoeff());
        return s;
    }

    bool solve(const pointFilm::state& s, const newtonControls& controls)
    {
        Info<< "load " << contact.load << " N, " << layout.nx() << " x " << layout.ny() << " columns" << endl;
        found = pointNewton(film, s, controls);
        return found.end == outcome::converged;
    }

    //- Approach of the bodies far away, negative
    scalar offset() const
    {
        const pointFilm::columns c(film.columnsOf(found.state));
        return film.approach(c, found.state.offset, c.P);
    }

    scalar centralFilm() const { return film.central(film.columnsOf(found.state).H); }
};


//- A solved case of a load: from another mesh if there is one, from the dry contact, from lower loads
static std::unique_ptr<pointCase> pointSolved
(
    const dictionary& dict, const scalar expected, const label nx, const label ny, const newtonControls& controls,
    label& iterations, const pointCase* other = nullptr
)
{
    std::unique_ptr<pointCase> solved(new pointCase(dict, expected, nx, ny));
    auto met = [&](pointCase& here, const pointFilm::state& start)
    {
        const bool converged = here.solve(start, controls);
        iterations += here.found.iterations;
        return converged;
    };
    if (other && met(*solved, solved->start(*other))) return solved;
    for (const scalar film : startFilms)
    {
        if (met(*solved, solved->start(film*expected))) return solved;
    }
    std::unique_ptr<pointCase> before;
    for (const scalar part : pointLoads)
    {
        dictionary lighter(dict);
        lighter.set("load", part*dict.get<scalar>("load"));
        const scalar film = expected*Foam::pow(part, -scalar(0.72));
        std::unique_ptr<pointCase> next(new pointCase(lighter, film, nx, ny));
        if (met(*next, before ? next->start(*before) : next->start(film))) before = std::move(next);
    }
    if (before) met(*solved, solved->start(*before));
    return solved;
}


//- The columns as a table
static void writePointTable(const fileName& path, const pointCase& solved)
{
    const pointLayout& layout = solved.layout;
    const pointFilm::columns c(solved.film.columnsOf(solved.found.state));
    OFstream table(path);
    table.precision(12);
    table << "# x y pressure film liquid_fraction" << nl;
    for (label j = 0; j < layout.ny(); ++j)
    {
        for (label i = 0; i < layout.nx(); ++i)
        {
            const label m = layout.cell(i, j);
            table
                << solved.contact.halfWidth*layout.centreX(i) << ' ' << solved.contact.halfWidth*layout.centreY(j) << ' '
                << solved.contact.pressure*c.P[m] << ' ' << solved.contact.filmUnit()*c.H[m] << ' ' << c.theta[m] << nl;
        }
    }
}

} // End namespace Foam


int Foam::solvePoint(const dictionary& dict, Time& runTime, const bool written)
{
    const clockTime clock;
    const pointContact contact(dict);
    const label nx = pointNumber(dict, "columns", leastColumns), ny = pointNumber(dict, "lines", leastLines);
    const label rows = pointNumber(dict, "rows", 2);
    if (nx*ny > mostColumns)
    {
        FatalIOErrorInFunction(dict)
            << "columns, lines: got " << nx << " x " << ny << ", allowed are " << mostColumns << " columns in all: "
            << "each deflects each" << exit(FatalIOError);
    }
    for (const word key : {"heat", "response", "oscillation", "start"})
    {
        if (!dict.found(key)) continue;
        FatalIOErrorInFunction(dict)
            << key << ": is one of line contacts, allowed for a point are none: it is isothermal, starts from the dry "
            << "contact and has stiffness and damping of slow motion" << exit(FatalIOError);
    }
    for (const word key : {"shear", "flow"})
    {
        const word only(key == "flow" ? "thinFilm" : "Newtonian");
        const word got(key == "flow" ? dict.get<word>(key) : dict.subDict(key).get<word>("type"));
        if (got == only) continue;
        FatalIOErrorInFunction(dict)
            << key << ": got " << got << ", allowed for a point is " << only << exit(FatalIOError);
    }
    const newtonControls controls{positive(dict, "tolerance"), dict.get<label>("maxIterations")};
    Info<< "a " << contact.halfWidth << " m, kappa " << contact.ellipticity << ", p_H " << contact.pressure
        << " Pa, " << nx << " x " << ny << " columns" << nl << endl;
    scalar film = positive(dict.subDict("mesh"), "film");
    label iterations = 0;
    const label nxc = label(coarsePart*nx + 0.5), nyc = label(coarsePart*ny + 0.5);
    std::unique_ptr<pointCase> coarse(pointSolved(dict, film, nxc, nyc, controls, iterations));
    std::unique_ptr<pointCase> fine;
    pointResult last(coarse->found);
    for (label again = 0; again < 3 && last.end == outcome::converged; ++again)
    {
        const scalar central = coarse->centralFilm();
        if (mag(central/film - 1) < otherFilm) break;
        film = central;
        coarse = pointSolved(dict, film, nxc, nyc, controls, iterations, coarse.get());
        last = coarse->found;
    }
    if (last.end == outcome::converged)
    {
        fine = pointSolved(dict, film, nx, ny, controls, iterations, coarse.get());
        last = fine->found;
    }

    resultsFile results(runTime);
    if (last.end == outcome::converged)
    {
        auto pair = [&](const word& key, const std::function<scalar(const pointCase&)>& value)
        {
            OStringStream both;
            both.precision(15);
            both << '(' << value(*coarse) << ' ' << value(*fine) << ')';
            results.write(key, both.str().c_str());
        };
        const scalar unit = contact.filmUnit();
        pair("centralFilm", [&](const pointCase& c) { return unit*c.centralFilm(); });
        pair("minimumFilm", [&](const pointCase& c) { return unit*c.film.columnsOf(c.found.state).H.minCoeff(); });
        pair("maximumPressure", [&](const pointCase& c) { return contact.pressure*c.found.state.v.maxCoeff(); });
        pair("filmOffset", [&](const pointCase& c) { return unit*(contact.dryApproach + c.offset()); });
        pair("compliance", [&](const pointCase& c) { return unit/contact.load*c.found.compliance; });
        pair("lossCompliance", [&](const pointCase& c)
        {
            return unit/contact.load*contact.halfWidth/contact.entrainment()*c.found.loss;
        });
        results.write("massDefect", fine->found.massDefect);
        results.write("loadDefect", fine->found.loadDefect);
        writePointTable(runTime.path()/"film.dat", *fine);
        if (written)
        {
            runTime.setTime(1, 1);
            results.write("cellContinuity", writePointFields(runTime, fine->film, fine->found.state, fine->oil, rows));
        }
    }
    results.write("status", wordOf(last.end));
    results.write("reason", last.reason);
    results.write("iterations", iterations);
    results.write("seconds", clock.elapsedTime());
    Info<< nl << wordOf(last.end) << " " << last.reason << " in " << iterations << " steps, "
        << clock.elapsedTime() << " s" << nl << "End" << endl;
    return 0;
}
