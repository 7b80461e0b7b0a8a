/* ---------------------------------------------------------------------------------------------------------------------
 * Films of balls with memory
 *
 * Beside the load p(approach) at rest act three springs K_r in series with dampers, whose forces f_r are the states:
 *
 *     f_r' = K_r approach' - f_r/theta_r,    load = p + f where f = sum f_r >= 0, else f + sqrt(f^2 + p^2).
 *
 * Over a step in which the approach goes evenly p gets a constant force and a spring, see pair_memory.c and pair_law.c.
 * ------------------------------------------------------------------------------------------------------------------ */

#define BALL_SPRINGS 3

/* Springs at a place on a table (rows, springs + 1), straight between rows and held beyond the ends: stiffness [N/m], and
 * the longest of their times [s]. */
EHD_INLINE void ball_springs(const double *table, int64_t rows, double place, double *out) {
    const double held = least(most(place, 0.0), (double)rows - 1.0);
    const int64_t cell = held < (double)rows - 2.0 ? (int64_t)held : rows - 2;
    const double t = held - (double)cell, *low = table + (BALL_SPRINGS + 1) * cell, *high = low + BALL_SPRINGS + 1;
    for (int r = 0; r < BALL_SPRINGS + 1; r++) out[r] = low[r] + t * (high[r] - low[r]);
}

/* What a contact holds against an approach over a step [s]: passed (springs, 2), the part of each force that is left and
 * its spring of the end of the step; held (3,), see pair_law.c. shorter: times of the springs over the longest one. */
EHD_INLINE void ball_hold(const double *shorter, double step, double approach, const double *spring, const double *force,
                           double *passed, double *held) {
    held[0] = held[1] = 0.0;
    held[2] = approach;
    for (int r = 0; r < BALL_SPRINGS; r++) {
        pair_over_step(step, spring[r], spring[BALL_SPRINGS] * shorter[r], passed + 2 * r);
        held[0] += passed[2 * r] * force[r];
        held[1] += passed[2 * r + 1];
    }
}

/* Bring the forces to the end of a step in which the approach moved, and to the springs there. */
EHD_INLINE void ball_go_on(double moved, double *spring, const double *after, const double *passed, double *force) {
    for (int r = 0; r < BALL_SPRINGS; r++)
        force[r] = pair_gone_on(force[r], passed[2 * r], passed[2 * r + 1] * moved, spring[r], after[r]);
    memcpy(spring, after, (BALL_SPRINGS + 1) * sizeof *spring);
}
