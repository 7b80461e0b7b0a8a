/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "lawTable.H"
#include "IFstream.H"
#include "OFstream.H"
#include "scalarField.H"

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
    const scalarField pressure(asked.lookup("pressure")), rate(asked.lookup("rate"));
    if (pressure.size() && !(min(pressure) >= 0))
    {
        FatalIOErrorInFunction(asked)
            << "pressure: got " << min(pressure) << ", allowed are numbers from 0 on" << exit(FatalIOError);
    }
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
