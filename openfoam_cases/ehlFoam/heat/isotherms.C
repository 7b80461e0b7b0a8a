/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "isotherms.H"
#include "positive.H"
#include "scalarField.H"

namespace Foam
{

//- Fewest isotherms: those of one cubic
static constexpr label fewest = 4;


//- Laws of one family, from a dictionary whose numbers are lists over the isotherms
template<class Law>
static void readLaws(PtrList<Law>& laws, const dictionary& lists)
{
    for (const entry& numbers : lists)
    {
        if (numbers.keyword() == "type") continue;
        const scalarField values(lists.lookup(numbers.keyword()));
        if (laws.empty()) laws.setSize(values.size());
        if (values.size() < fewest || values.size() != laws.size())
        {
            FatalIOErrorInFunction(lists)
                << numbers.keyword() << ": got " << values.size() << " numbers, allowed is one an isotherm, of "
                << fewest << " isotherms and more" << exit(FatalIOError);
        }
    }
    forAll(laws, k)
    {
        dictionary numbers;
        for (const entry& list : lists)
        {
            const word key(list.keyword());
            if (key == "type") numbers.set(key, lists.get<word>(key));
            else numbers.set(key, scalarField(lists.lookup(key))[k]);
        }
        laws.set(k, Law::New(numbers));
    }
}

} // End namespace Foam


Foam::isotherms::isotherms(const dictionary& dict)
:
    first_(positive(dict, "first")),
    step_(positive(dict, "step"))
{
    readLaws(viscosity_, dict.subDict("viscosity"));
    readLaws(density_, dict.subDict("density"));
    if (viscosity_.size() != density_.size() || viscosity_.empty())
    {
        FatalIOErrorInFunction(dict)
            << "viscosity, density: got " << viscosity_.size() << " and " << density_.size()
            << " isotherms, allowed are as many of both" << exit(FatalIOError);
    }
}


Foam::isotherms::stencil Foam::isotherms::about(const scalar T) const
{
    const scalar place = (min(max(T, coldest()), hottest()) - first_)/step_;
    const label first = min(max(label(place) - 1, 0), viscosity_.size() - fewest);
    const scalar t = place - first;
    stencil s;
    s.first = first;
    s.weight = {-(t - 1)*(t - 2)*(t - 3)/6, t*(t - 2)*(t - 3)/2, -t*(t - 1)*(t - 3)/2, t*(t - 1)*(t - 2)/6};
    s.slope = FixedList<scalar, 4>
    ({
        -(3*t*t - 12*t + 11)/6/step_,
        (3*t*t - 10*t + 6)/2/step_,
        -(3*t*t - 8*t + 3)/2/step_,
        (3*t*t - 6*t + 2)/6/step_
    });
    return s;
}


Foam::scalar Foam::isotherms::viscosity(const scalar p, const scalar T) const
{
    const stencil s(about(T));
    scalar log = 0;
    for (label k = 0; k < 4; ++k)
    {
        if (s.weight[k] != 0) log += s.weight[k]*Foam::log(viscosity_[s.first + k].viscosity(max(p, scalar(0))));
    }
    return Foam::exp(log);
}


Foam::scalar Foam::isotherms::density(const scalar p, const scalar T) const
{
    const stencil s(about(T));
    scalar density = 0;
    for (label k = 0; k < 4; ++k)
    {
        density += s.weight[k]*density_[s.first + k].density(max(p, scalar(0)));
    }
    return density;
}


Foam::scalar Foam::isotherms::expansion(const scalar p, const scalar T) const
{
    const stencil s(about(T));
    scalar density = 0, slope = 0;
    for (label k = 0; k < 4; ++k)
    {
        const scalar here = density_[s.first + k].density(max(p, scalar(0)));
        density += s.weight[k]*here;
        slope += s.slope[k]*here;
    }
    return -slope/density;
}
