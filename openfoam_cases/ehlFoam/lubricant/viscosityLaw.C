/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "viscosityLaw.H"

namespace Foam
{
    defineTypeNameAndDebug(viscosityLaw, 0);
    defineRunTimeSelectionTable(viscosityLaw, dictionary);
}


Foam::autoPtr<Foam::viscosityLaw> Foam::viscosityLaw::New(const dictionary& dict)
{
    const word type(dict.get<word>("type"));
    auto law = dictionaryConstructorTablePtr_->cfind(type);
    if (!law.found())
    {
        FatalIOErrorInLookup
        (
            dict, "viscosityLaw", type, *dictionaryConstructorTablePtr_
        ) << exit(FatalIOError);
    }
    return autoPtr<viscosityLaw>(law()(dict));
}
