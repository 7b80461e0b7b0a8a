"""Statement of the problem: frozen values and cited formulas, in SI units and K, without a solver.

The modules in the order in which data pass through them:

==================  ====================================================================================
solids              `Material`, `STEEL`, the reduced modulus E'
bearing             `BearingGeometry`: reduced radii, entrainment speed, the two contacts of a roller
surface             profiles of rollers (ISO 16281, arcs, tables), and `Surface`: roughness and its asperities
designations        kinds of bearings and their classes of radial clearance by designation; oils by their class
catalogue           `BearingGeometry` estimated from what a catalogue says
approach            the structural part of the approach: ISO 16281, Palmgren, half space, shipped finite elements
contact             `LineContact`, `OperatingPoint`; film and solids together, which cannot pull
isotherm            viscosity and density over pressure at one temperature, what solvers compile; `LubricantState`
viscosity           isotherms over temperature: Barus, Roelands, FVA 3, Tait-Doolittle; eta0 by ASTM D341, Vogel
own_oil             the laws of an own oil, from what its user states or correlations estimate
lubricant           `Lubricant`: its state at a temperature; oils by name
hertz               dry line contact: half-width, pressure, gap, compliance
moes                dimensionless groups and back: M and L; U, W and G
films               published formulas: film thickness, damping, rolling force
rheology            laws of shear: stress over rate, stress at the walls, traction over the slide-to-roll ratio
oil_supply          `OilSupply`: flooded, or an oil layer; the starved contact between rigid surfaces
heat                data that heat needs, reductions of the film by inlet shear heating, `inlet-heat`
solution            `FilmSolution`, `ContactSolution`, `Status`, the Protocol `ContactSolver` and its defaults
spectrum            film compliance and dynamic stiffness over frequency
closed_form         the solvers `hertz` and `formula`; how thick and how thin a film may be
point               point contacts: dry ellipses; balls
rollers             rollers by both ratings of a catalogue; needle and tapered roller bearings
==================  ====================================================================================

Nothing is imported here: take the names from their modules.
"""
