"""Rolling bearings: geometry, contact laws, the force with its derivatives, elements, compiled runs, in this order.

=====================  ================================================================================================
`bearing`              geometry, clearance, profile, slices; spins, relative pose, forces and moments on both rings
`thermal`              fits and the clearance that they leave, the state in operation, the balance of heat
`laws`                 contact laws of rollers: Hertz, constant, points, film formula; their data for C
`films`                pressure, films and rolling force at a load: dry, by formula, by map
`speed_tables`         tables of a law over the speed of a run
`cylinder`             structs and functions of a cylindrical bearing in C; a law at one speed as a table
`force_at_point`       the force at one speed, temperature and centrifugal load; loads of the rollers
`bearing_force`        the force element, with films at once or in time
`contact_energy`       energy of its contacts, what changes of the speed bring in, the moment on its cage
`roller_spin`          how fast rollers turn in the clearance of their pockets
`roller_contacts`      rollers as bodies between two contacts
`bearing_element`      a bearing in a system, with massless rollers
`roller_element`       the same with rollers as bodies
`memory_element`       both with films that need time
`locating`             the same of bearings that carry axial load: laws, force, element, compiled runs
`balls`                their kinds: balls with two contact angles each, which set their speed
`tapered`              and tapered rollers, or rollers between ribs, in slices between cup, cone and rib
`slices_in_balance`    small motions: films with memory in linear analyses, errors of the law
`contact_report`       what the contacts feel in an equilibrium, what rolling costs, which limits are passed
`rings`                bearings of a run as arrays, and as C takes them: rings, rollers, contacts with one side or two
`bearing_block`        compiled runs with slow films or dry contacts
`memory_block`         compiled runs with films that have a memory
=====================  ================================================================================================

A contact of a roller has one side, where both contacts in series stand for a massless roller, or two, the inner and the
outer one of a roller that is a body. Elements name the law of each side (`RingElement.flat_laws`), states of films are
kept for each side, and runs have one block of slow films and one of films with memory for both.
"""
