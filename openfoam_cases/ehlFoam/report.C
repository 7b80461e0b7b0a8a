/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "report.H"
#include "response.H"
#include "steadyState.H"
#include "StringStream.H"

Foam::word Foam::wordOf(const outcome end)
{
    return end == outcome::converged ? "converged"
         : end == outcome::stagnated ? "stagnated" : "diverged";
}


void Foam::reportFilm(resultsFile& results, slice& s, newtonResult& solved)
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

    const scalarField fraction(s.flow().columnFraction());
    scalar largest = 0, traction = 0, rolling = 0;
    for (label i = 0; i < s.columns(); ++i)
    {
        const scalar lower = s.flow().wallStress(0)[i], upper = s.flow().wallStress(1)[i];
        const scalar length = state.x[i + 1] - state.x[i];
        largest = max(largest, max(mag(lower), mag(upper)));
        // behind the exit, as by the Reynolds equation, nothing is counted
        if (fraction[i] < 1) continue;
        traction += 0.5*(lower + upper)*length;
        rolling += (upper - lower)*length;
    }
    results.write("wallStress", largest);
    results.write("traction", traction);
    results.write("rollingForce", rolling);

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


void Foam::writeTable(const fileName& path, const slice& s, const filmState& state)
{
    const scalarField flux(s.flow().columnFlux()), fraction(s.flow().columnFraction());
    const scalarField density(s.flow().columnDensity());
    OFstream table(path);
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


void Foam::reportResponse
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
