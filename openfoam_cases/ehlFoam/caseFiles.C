/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "caseFiles.H"
#include "OSspecific.H"

namespace Foam
{

//- Schemes that are fixed: their default may be told, as none or as what it is
static void refuseSchemes(const dictionary& schemes, const word& group, const word& fixed)
{
    if (!schemes.found(group)) return;
    const dictionary& given = schemes.subDict(group);
    for (const entry& scheme : given)
    {
        ITstream& text = scheme.stream();
        const bool one = text.size() == 1 && text[0].isWord();
        if (scheme.keyword() != "default" || !one || (text[0].wordToken() != fixed && text[0].wordToken() != "none"))
        {
            FatalIOErrorInFunction(given)
                << group << ", " << scheme.keyword() << ": got " << text.toString()
                << ", allowed is default " << fixed
                << ": ehlFoam takes gradSchemes and snGradSchemes only" << exit(FatalIOError);
        }
    }
}

} // End namespace Foam


void Foam::refuseUnread
(
    const Time& runTime, const fvSchemes& schemes, const fvSolution& solution, const bool written
)
{
    const fileName start(runTime.path()/runTime.timeName());
    const fileNameList fields(readDir(start, fileName::FILE));
    if (fields.size())
    {
        FatalErrorInFunction
            << "fields of the start: got " << start/fields[0]
            << ", allowed are none: the boundary conditions are those of the contact, in constant/ehlProperties."
            << nl << "    Remove the file; a film to start from is the entry start there" << exit(FatalError);
    }
    if (!written && runTime.controlDict().found("functions"))
    {
        FatalIOErrorInFunction(runTime.controlDict())
            << "functions: got them with writeFields false, allowed are function objects with writeFields true, in "
            << "constant/ehlProperties: they run on the fields that are written" << exit(FatalIOError);
    }
    refuseSchemes(schemes.schemesDict(), "ddtSchemes", "steadyState");
    refuseSchemes(schemes.schemesDict(), "divSchemes", "none");
    refuseSchemes(schemes.schemesDict(), "laplacianSchemes", "none");
    refuseSchemes(schemes.schemesDict(), "interpolationSchemes", "linear");
    for (const entry& given : solution)
    {
        if (given.keyword() != "FoamFile")
        {
            FatalIOErrorInFunction(solution)
                << given.keyword() << ": ehlFoam solves all equations of a contact together and takes no entry of "
                << "fvSolution; tolerance and maxIterations are in constant/ehlProperties" << exit(FatalIOError);
        }
    }
}
