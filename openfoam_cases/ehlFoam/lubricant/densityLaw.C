/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "densityLaw.H"

namespace Foam
{
    defineTypeNameAndDebug(densityLaw, 0);
    defineRunTimeSelectionTable(densityLaw, dictionary);
}


Foam::autoPtr<Foam::densityLaw> Foam::densityLaw::New(const dictionary& dict)
{
    const word type(dict.get<word>("type"));
    auto law = dictionaryConstructorTablePtr_->cfind(type);
    if (!law.found())
    {
        FatalIOErrorInLookup
        (
            dict, "densityLaw", type, *dictionaryConstructorTablePtr_
        ) << exit(FatalIOError);
    }
    return autoPtr<densityLaw>(law()(dict));
}
