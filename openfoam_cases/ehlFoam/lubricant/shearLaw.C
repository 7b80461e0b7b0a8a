/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "shearLaw.H"

namespace Foam
{
    defineTypeNameAndDebug(shearLaw, 0);
    defineRunTimeSelectionTable(shearLaw, dictionary);
}


Foam::autoPtr<Foam::shearLaw> Foam::shearLaw::New(const dictionary& dict)
{
    const word type(dict.get<word>("type"));
    auto law = dictionaryConstructorTablePtr_->cfind(type);
    if (!law.found())
    {
        FatalIOErrorInLookup
        (
            dict, "shearLaw", type, *dictionaryConstructorTablePtr_
        ) << exit(FatalIOError);
    }
    return autoPtr<shearLaw>(law()(dict));
}
