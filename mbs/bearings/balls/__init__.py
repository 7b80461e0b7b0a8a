"""Ball bearings, deep groove and angular contact: five freedoms, quasi-static, with the speed of their balls.

The balance of the balls and the sums over them are in C: `ehdmaps/kernel/c/ball` and `pair`. What
balls share with rollers with ribs is in `mbs.bearings.locating`.

=====================  ================================================================================================
`laws`                 contact laws of both raceways: Hertz, with a damper, or a film over it
`ball_data`            a bearing and its balls as C has them
`ball_bearing`         the force element; loads and contact angles of the balls
`ball_speed`           speed of the cage by contact angles, loads of the balls by that, their work
`ball_block`           ball bearings in compiled runs
`balls_in_balance`     small motions: films with memory in linear analyses, errors of the film table
`films`                films of both contacts at one speed, solved at some loads, and the law that they make
`ball_report`          pressures and films of the contacts at rest, the cost of rolling
`ball_point`           an operating point: equilibrium, speed of the cage, pressures, films
=====================  ================================================================================================
"""
