"""Multibody consumer of the contact maps: from the bearing force to a machine and its Campbell diagram.

::

    from mbs import Bearing, BearingForce

    force = BearingForce(Bearing.named("NU308", clearance=20e-6), law)
    f, K, C = force(pose, velocity, entrainment_speed=1.0, temperature=330.0)

and of a whole scene::

    from mbs import assemble, read_scene, statics

    model = assemble(read_scene("nu308_rigid"), emap="nu308.nc", clearance=20e-6)
    found = statics(model)
    found.dataset, found.plot()

What is where, in the order of the data:

==================  ====================================================================================
scene file          `scene`: reader -> specs -> scene -> assembly; `kinds`: the machine elements; `choices`; `settings`
the system          `model`: bodies, elements, what is prescribed; the system and its equilibrium
what bodies are     `flexible` (beams, finite elements, reduction)
what connects them  `bearings` (the bearing force; `life`, `passes`, `electrics` of a bearing), `gears`
linear              `linearised` (modes, responses, excitation by bearings); `modal` (modes of hammer hits);
                    `identification` (unknowns of a machine from what is measured)
in time             `transient` (method, runs in C); `spectral` (levels over speed and order); `timedata` (files)
analyses            `analyses`: statics, modes, lsa, sweep, runup, campbell, hammer; `planning`: what a scene requires;
                    `one_bearing`: one without a scene; `library`: what needs no model; `vibration`: on a test spindle
laboratory          `laboratory`: tradeoff, variants, stability
for people          `output` (datasets, figures), `report` (a page to send), `commands`, `cli`; `systems`: scenes
==================  ====================================================================================

Names of the package are loaded when they are first used, so that importing it is quick.
"""

from __future__ import annotations

from ehdmaps.extras import public_names

__all__, __getattr__, __dir__ = public_names(__name__, __file__)
