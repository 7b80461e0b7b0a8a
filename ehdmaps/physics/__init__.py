"""What the problem is: frozen values and cited formulas, in SI units and K, without a solver.

The modules in the order in which data pass through them:

==================  ====================================================================================
solids              `Material`, `STEEL`, the reduced modulus E'
bearing             `BearingGeometry`: reduced radii, entrainment speed, the two contacts of a roller
profiles            profiles of rollers: ISO 16281, arcs, tables
catalogue           `BearingGeometry` estimated from what a catalogue says
approach            the structural part of the approach: ISO 16281, Palmgren, half space
fe_shipped          approaches by finite elements of the shipped bearings
contact             `LineContact`: one contact, and its structural approach and compliance
isotherm            viscosity and density over pressure at one temperature; what solvers compile
pressure_viscosity  isotherms over temperature: Barus, Roelands, the law of FVA 3, Tait-Doolittle
viscosity           eta0 over temperature: constant, ASTM D341, Vogel
correlations        alpha estimated from the viscosity at ambient pressure: So and Klaus, Gold
own_oil             the laws of an own oil, from what its user states
lubricant           `Lubricant`, and `LubricantState` at a temperature
operating_point     `OperatingPoint`: load, entrainment speed, temperature
hertz               dry line contact: half-width, pressure, gap, compliance
moes                dimensionless groups and back: M and L; U, W and G
sensitivity         what an error of alpha makes of the film
films               published film formulas: rigid, Dowson-Higginson, Pan-Hamrock, Moes
unilateral          how damping acts in a contact that cannot pull; what kernels compile
damping             published damping formulas: rolling film, squeeze film, Dietl
rolling             rolling force: its integral, the rigid film, Matsuyama's fit
rheology            laws of shear: stress over rate, and rate over stress
traction            traction over the slide-to-roll ratio by laws of shear stress
peak                what the largest of sampled pressures lacks to the peak
oil_supply          `OilSupply`: flooded, or an oil layer before the contact
starved             the starved contact between rigid surfaces: film, damping, rolling force, pressure
roughness           `Surface`: roughness of both surfaces, and their asperities
film_limits         how thick and how thin a film may be
wall_stress         shear stress at the walls over pressure: where no oil is Newtonian
heat                data that heat in a contact needs besides the laws of oil and solids
thermal             thermal loading, and a published reduction of the film by inlet shear heating
inlet_heat          heat in the inlet as a layer over isothermal films
structure           film and solids together: approach, stiffness, damping
solution            `FilmSolution`, `ContactSolution`, `Status`, the Protocol `ContactSolver` and its defaults
spectrum            film compliance and dynamic stiffness over frequency
closed_form         the solvers `hertz` and `formula`
==================  ====================================================================================

Nothing is imported here: take the names from their modules.
"""
