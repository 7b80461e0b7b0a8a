"""The film tables that come with ehdmaps, made anew: in ten to fifteen minutes of one core each.

==============================  ======================================================================================
`examples.tables.lines`         the table of line contacts: nodes, and the middles of cells, by `reynolds`
`examples.tables.points`        the table of point contacts: nodes, the middles of cells, finer points
`examples.tables.point_lines`   films of points along loads, solved from light to heavy, in the forms of the table
`examples.tables.point_heavy`   numbers beyond the loads that grids resolve, and by how much they may be wrong
`examples.tables.point_errors`  what is read between nodes against what is solved; errors scaled by finer solutions
`examples.tables.files`         the files as they are written, values and errors as they hold them
==============================  ======================================================================================

From the root of a clone ``python -m examples.tables lines`` or ``points`` makes a shipped file. `ehdmaps table show`
tells what one holds.
"""
