/*---------------------------------------------------------------------------*\
  ehlFoam - film-resolved elastohydrodynamic line contacts
  Copyright (C) 2026 the ehdmaps authors
  SPDX-License-Identifier: GPL-3.0-or-later
\*---------------------------------------------------------------------------*/

#include "oscillation.H"
#include "positive.H"
#include "mathematicalConstants.H"

Foam::oscillationResult Foam::oscillation
(
    slice& s,
    const slice::unknowns& steady,
    const dictionary& dict,
    const newtonControls& controls
)
{
    const scalar omega = constant::mathematical::twoPi*positive(dict, "frequency");
    const scalar amplitude = positive(dict, "amplitude");
    const label steps = dict.get<label>("stepsPerCycle"), cycles = dict.get<label>("cycles");
    if (steps < 8 || cycles < 1)
    {
        FatalIOErrorInFunction(dict)
            << "stepsPerCycle, cycles: got " << steps << ", " << cycles
            << ", allowed are at least 8 steps and 1 cycle" << exit(FatalIOError);
    }
    if (s.flow().heat())
    {
        FatalIOErrorInFunction(dict)
            << "oscillation: got it with heat, allowed without: walls know their past by rates that are small"
            << exit(FatalIOError);
    }
    const scalar dt = constant::mathematical::twoPi/omega/steps;
    const scalar load = s.contact().load;

    slice::unknowns now(steady), old(steady), older(steady);
    std::unique_ptr<linearisation> kept;
    newtonResult solved{outcome::converged, "", 0, steady};
    label iterations = 0;
    scalar inPhase = 0, behind = 0;
    for (label step = 1; step <= steps*cycles; ++step)
    {
        // at rest before the start: the second-order formula holds from the first step
        const scalar phase = constant::mathematical::twoPi*step/steps;
        auto rateOf = [&](const slice::unknowns& u)
        {
            return u.plus(-4.0/3, old).plus(1.0/3, older).plus
            (
                0.5, u.plus(-4.0/3, old).plus(1.0/3, older)
            );
        };
        auto perSecond = [&](const slice::unknowns& u)
        {
            slice::unknowns rate(rateOf(u));
            rate.local /= dt;
            rate.column /= dt;
            rate.offset /= dt;
            return rate;
        };
        solved = newton
        (
            s, now, load*(1 + amplitude*Foam::sin(phase)), controls, kept, perSecond, 1.5/dt
        );
        iterations += solved.iterations;
        if (solved.end != outcome::converged) break;
        older = old;
        old = now = solved.state;
        if (step > steps*(cycles - 1))
        {
            const scalar moved = (now.offset - steady.offset)*s.filmScale();
            inPhase += moved*Foam::sin(phase)*2/steps;
            behind += moved*Foam::cos(phase)*2/steps;
        }
    }
    solved.iterations = iterations;
    const scalar dry = -s.solid().dry().offsetSlope;
    return
    {
        solved,
        -inPhase/(amplitude*load) - dry,
        behind/(amplitude*load*omega)
    };
}
