/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "viscosityLaw.H"
#include "densityLaw.H"
#include "shearLaw.H"

namespace Foam
{

//- The law named by the entry "type"; a FatalIOError lists the known names of its family
template<class Family>
static autoPtr<Family> lawOf(const dictionary& dict)
{
    const word type(dict.get<word>("type"));
    auto law = Family::dictionaryConstructorTablePtr_->cfind(type);
    if (!law.found())
    {
        FatalIOErrorInLookup
        (
            dict, Family::typeName, type, *Family::dictionaryConstructorTablePtr_
        ) << exit(FatalIOError);
    }
    return autoPtr<Family>(law()(dict));
}

} // End namespace Foam


//- A family of laws: its table of known laws, and the selection from it
#define defineOilLaws(family)                                                 \
                                                                              \
    namespace Foam                                                            \
    {                                                                         \
        defineTypeNameAndDebug(family, 0);                                    \
        defineRunTimeSelectionTable(family, dictionary);                      \
    }                                                                         \
                                                                              \
    Foam::autoPtr<Foam::family> Foam::family::New(const dictionary& dict)     \
    {                                                                         \
        return lawOf<family>(dict);                                           \
    }

defineOilLaws(viscosityLaw)
defineOilLaws(densityLaw)
defineOilLaws(shearLaw)
