/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "report.H"
#include "response.H"
#include "steadyState.H"
#include "StringStream.H"

namespace Foam
{

//- Largest defect of the energy, over what shear dissipates
static constexpr scalar mostEnergyDefect = 1e-4;

} // End namespace Foam


Foam::word Foam::wordOf(const outcome end)
{
    return end == outcome::converged ? "converged"
         : end == outcome::stagnated ? "stagnated" : "diverged";
}


void Foam::reportFilm(resultsFile& results, slice& s, newtonResult& solved)
{
    // a state that went astray has no numbers
    if (solved.end == outcome::diverged) return;
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
    results.write("filmOffset", solved.state.offset*s.filmScale() + s.upstreamOffset(state) - s.solid().dry().offset);
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


void Foam::reportHeat(const Time& runTime, resultsFile& results, slice& s, newtonResult& solved)
{
    const filmHeat* heat = s.flow().heat();
    if (!heat) return;
    const scalar made = heat->dissipated() + heat->compressed();
    const scalar defect = mag(heat->ledIntoWalls() + heat->carriedOut() - made)/heat->dissipated();
    results.write("filmTemperature", heat->hottest());
    results.write("surfaceTemperature", heat->hottestWall());
    results.write("dissipatedHeat", heat->dissipated());
    results.write("compressionHeat", heat->compressed());
    results.write("carriedHeat", heat->carriedOut());
    results.write("wallHeat", heat->ledIntoWalls());
    results.write("energyDefect", defect);
    Info<< "heat per length: " << heat->dissipated() << " W/m of shear, " << heat->compressed()
        << " W/m of compression; " << heat->ledIntoWalls() << " W/m into the walls, " << heat->carriedOut()
        << " W/m carried out; defect " << defect << nl
        << "highest temperature: " << heat->hottest() << " K in the film, " << heat->hottestWall()
        << " K of a wall" << endl;
    OStringStream reason;
    if (solved.end == outcome::converged && !(defect <= mostEnergyDefect))
    {
        solved.end = outcome::stagnated;
        reason << "the energy of the film has a relative defect of " << defect << ", allowed is "
            << mostEnergyDefect;
    }
    if (solved.end == outcome::converged && !(heat->hottest() < heat->oil().hottest()))
    {
        solved.end = outcome::stagnated;
        reason << "the film has " << heat->hottest() << " K, the oil has laws up to " << heat->oil().hottest()
            << " K";
    }
    if (!reason.str().empty()) solved.reason = reason.str();

    const filmState state(s.film(solved.state));
    const label n = s.columns();
    OFstream table(runTime.path()/"heat.dat");
    table.precision(12);
    table << "# x lower_temperature upper_temperature lower_flux upper_flux" << nl;
    for (label i = 0; i < n; ++i)
    {
        table << 0.5*(state.x[i] + state.x[i + 1]) << ' '
            << heat->temperature(state.wall[i]) << ' ' << heat->temperature(state.wall[n + i]) << ' '
            << heat->fluxUnit()*state.local[s.flow().fluxPlace(i, 0)] << ' '
            << heat->fluxUnit()*state.local[s.flow().fluxPlace(i, 1)] << nl;
    }

    // across each column, from the lower surface to the upper one
    OFstream temperatures(runTime.path()/"temperature.dat");
    temperatures.precision(12);
    const label rows = s.flow().film().rows();
    temperatures << "# lower";
    for (label j = 0; j < rows; ++j) temperatures << ' ' << j;
    temperatures << " upper" << nl;
    for (label i = 0; i < n; ++i)
    {
        temperatures << heat->temperature(state.wall[i]);
        for (label j = 0; j < rows; ++j)
        {
            temperatures << ' ' << heat->temperature(state.local[s.flow().place(i, j, s.flow().warmthKind())]);
        }
        temperatures << ' ' << heat->temperature(state.wall[n + i]) << nl;
    }
}


void Foam::reportResponse
(
    resultsFile& results,
    slice& s,
    const slice::unknowns& solution,
    const scalarField& frequencies,
    const dictionary& meshDict,
    std::unique_ptr<linearisation>& tangent
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
    const List<filmResponse> found(response(s, solution, frequencies, isobar, tangent));
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
