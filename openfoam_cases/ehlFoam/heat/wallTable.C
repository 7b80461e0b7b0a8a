/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "wallTable.H"
#include "movingWall.H"
#include "filmHeat.H"
#include "IFstream.H"
#include "OFstream.H"

void Foam::writeWalls
(
    const dictionary& dict,
    const lineContact& contact,
    const fileName& points,
    const fileName& table
)
{
    IFstream file(points);
    if (!file.good())
    {
        FatalErrorInFunction
            << "-walls: cannot read " << points
            << "; allowed is a dictionary with the lists face and flux" << exit(FatalError);
    }
    const dictionary asked(file);
    const scalarField face(asked.lookup("face")), flux(asked.lookup("flux"));
    if (flux.empty() || face.size() != flux.size() + 1)
    {
        FatalIOErrorInFunction(asked)
            << "face, flux: got lists of " << face.size() << " and " << flux.size()
            << ", allowed are a flux for each column and one face more" << exit(FatalIOError);
    }
    const movingWall wall(face, contact.lowerSpeed, filmHeat::effusivityOf(dict.subDict("heat")));
    OFstream walls(table);
    walls.precision(17);
    walls << "# x warmer" << nl;
    forAll(flux, i)
    {
        scalar warmer = 0;
        for (label j = 0; j <= i; ++j) warmer += wall.perFlux()(i, j)*flux[j];
        walls << 0.5*(face[i] + face[i + 1]) << ' ' << warmer << nl;
    }
}
