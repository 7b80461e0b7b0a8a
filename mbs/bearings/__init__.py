"""Rolling bearings, in the order of their data: geometry, laws, force, element, compiled runs, what is told of them.

A bearing has Z rolling elements with J contacts each. A kind says how a ring moves an element, which freedoms the
element has of its own, how it comes into balance (in C, `ehdmaps.kernel`), and by which law its contacts carry. Kinds
are columns here. Cylindrical rollers and needles stand in this folder, balls in `balls`, tapered rollers and rollers
between ribs in `tapered`; what the last two share is in `locating`.

===================  =======================  ========================  ======================  ======================
what                 cylindrical, needles     balls                     tapered, ribbed         balls and ribbed alike
===================  =======================  ========================  ======================  ======================
moved by the ring    1: radial                2: axial, radial          3: and tilt             `locating_force`
its own freedoms     none, or 1 as a body     2                         3
geometry             `bearing`, `thermal`     `ball_data`               `kernel_structs`
law of a contact     `laws`                   `laws`                    `line_film`             `normal_law`
its films            `films`                  `films`, `response`       `line_film`
force                `force_at_point`,        `ball_bearing`            `tapered_bearing`       `locating_force`
                     `bearing_force`
as bodies            `roller_contacts`
speeds, energy       `roller_spin`,           `ball_speed`,             `tapered_bearing`
                     `contact_energy`         `ball_motion`
element              `bearing_element`,       as ribbed                 as balls                `locating_element`
                     `roller_element`
films with memory    `bearing_element`,       as ribbed                 as balls                `film_memory`
                     `roller_element`
small motions        `slices_in_balance`      `balls_in_balance`        `rollers_in_balance`
laws over speed      `speed_tables`           as ribbed                 as balls                `film_tables`
compiled runs        `cylinder`, `rings`,     `ball_block`              `tapered_block`         `locating_block`
                     `bearing_block`,
                     `memory_block`
findings             `bearing_element`        `ball_findings`           `roller_findings`
what contacts feel   `contact_report`         `ball_report`             `roller_report`
one at a point       `contact_report`         `ball_point`              `tapered_point`         `locating_point`
===================  =======================  ========================  ======================  ======================

A contact of a roller has one side, where both contacts in series stand for a massless roller, or two, the inner and the
outer one of a roller that is a body. Elements name the law of each side (`RingElement.flat_laws`), states of films are
kept for each side, and runs have one block of slow films and one of films with memory for both.
"""
