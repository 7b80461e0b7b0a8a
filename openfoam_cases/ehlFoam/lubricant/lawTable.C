/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "lawTable.H"
#include "isotherms.H"
#include "IFstream.H"
#include "OFstream.H"
#include "scalarField.H"

namespace Foam
{

//- The isotherms of a case with heat as a table
static void writeIsotherms
(
    const dictionary& dict,
    const scalarField& pressure,
    const scalarField& temperature,
    const fileName& table
)
{
    const isotherms oil(dict.subDict("heat").subDict("isotherms"));
    OFstream laws(table);
    laws.precision(17);
    laws << "# pressure temperature viscosity density expansion" << nl;
    for (const scalar p : pressure)
    {
        for (const scalar T : temperature)
        {
            laws << p << ' ' << T << ' ' << oil.viscosity(p, T) << ' ' << oil.density(p, T) << ' '
                << oil.expansion(p, T) << nl;
        }
    }
}

} // End namespace Foam


void Foam::writeLaws(const dictionary& dict, const fileName& points, const fileName& table)
{
    // in Pa, so that the unknown of the film is the pressure itself
    const lubricant oil(dict, 1);
    IFstream file(points);
    if (!file.good())
    {
        FatalErrorInFunction
            << "-laws: cannot read " << points
            << "; allowed is a dictionary with the lists pressure and rate" << exit(FatalError);
    }
    const dictionary asked(file);
    const scalarField pressure(asked.lookup("pressure"));
    if (pressure.size() && !(min(pressure) >= 0))
    {
        FatalIOErrorInFunction(asked)
            << "pressure: got " << min(pressure) << ", allowed are numbers from 0 on" << exit(FatalIOError);
    }
    if (asked.found("temperature"))
    {
        writeIsotherms(dict, pressure, scalarField(asked.lookup("temperature")), table);
        return;
    }
    const scalarField rate(asked.lookup("rate"));
    OFstream laws(table);
    laws.precision(17);
    laws << "# pressure rate viscosity density stress" << nl;
    for (const scalar p : pressure)
    {
        const scalar mu = oil.viscosity(p);
        for (const scalar gamma : rate)
        {
            laws << p << ' ' << gamma << ' ' << mu << ' ' << oil.density(p) << ' '
                << oil.sheared(mu, gamma, p)*gamma << nl;
        }
    }
}
