/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings with cylindrical rollers as Python calls them: with a row of 13 numbers, pose, velocity and angle of the cage
 * ------------------------------------------------------------------------------------------------------------------ */

/* Approaches of all slices, (rollers, slices) [m]. */
static void slice_approaches(const ehd_cylinder *bearing, const ehd_ring_motion *motion, double *approaches) {
    for (int64_t j = 0; j < bearing->rollers; j++) {
        const roller r = roller_of(bearing, motion, j);
        for (int64_t i = 0; i < bearing->slices; i++) *approaches++ = approach_of(bearing, &r, i);
    }
}

/* Force and stiffness where loads of the slices and their slopes are there, each (rollers, slices). */
static void cylinder_of_loads(const ehd_cylinder *bearing, const ehd_ring_motion *motion, const double *w,
                              const double *dw, ehd_bearing_force *answer) {
    memset(answer, 0, sizeof *answer);
    for (int64_t j = 0; j < bearing->rollers; j++) {
        const roller r = roller_of(bearing, motion, j);
        sums sum = NO_SUMS;
        for (int64_t i = 0; i < bearing->slices; i++, w++, dw++) {
            const double weight = bearing->weight ? bearing->weight[i] : 1.0, x = bearing->weight ? 0.0 : bearing->position[i];
            sum.w[0] += weight * *w;
            sum.w[1] += x * *w;
            sum.k[0] += weight * *dw;
            sum.k[1] += x * *dw;
            sum.k[2] += x * x * *dw;
        }
        add_roller(&r, &sum, answer);
    }
    finish_answer(bearing, 1.0, answer);
}

/* Forces of contacts in motion, into forces (3, count): load, stiffness, damping; states (5, count): load at rest, its
 * slope, damping, its slope, rate. */
void ehd_contact_forces(int64_t count, const double *states, double *forces) {
    for (int64_t i = 0; i < count; i++) {
        const double *at = states + i;
        ehd_force found;
        unilateral(at[0], at[count], at[2 * count], at[3 * count], at[4 * count], &found);
        forces[i] = found.load;
        forces[count + i] = found.stiffness;
        forces[2 * count + i] = found.damping;
    }
}

/* Part of the film of a law that is there at a speed [m/s], 0 to 1. */
double ehd_law_film_part(const ehd_law_data *data, double u) { return film_part(data, least(fabs(u), data->highest_speed)); }

int ehd_cylinder_force(const ehd_cylinder_call *call) {
    ehd_ring_motion motion;
    const int wrong = given_motion(call->bearing, call->state, call->state + 6, call->state[12], &motion);
    ehd_bearing_force *answer = (ehd_bearing_force *)call->answer;
    if (wrong) return wrong;
    if (call->coupling) return coupled_force(call, &motion, answer);
    return cylinder_force(call->bearing, call->law, &motion, call->work, answer);
}

int ehd_cylinder_approaches(const ehd_cylinder *bearing, const double *state, double *approaches) {
    ehd_ring_motion motion;
    const int wrong = given_motion(bearing, state, state + 6, state[12], &motion);
    if (!wrong) slice_approaches(bearing, &motion, approaches);
    return wrong;
}

int ehd_cylinder_rollers(const ehd_cylinder *bearing, const double *state, double *out) {
    ehd_ring_motion motion;
    const int wrong = given_motion(bearing, state, state + 6, state[12], &motion);
    const int64_t count = bearing->rollers;
    for (int64_t j = 0; j < count && !wrong; j++) {
        const roller r = roller_of(bearing, &motion, j);
        out[j] = r.gap;
        out[count + j] = r.tilt;
        out[2 * count + j] = r.rate;
        out[3 * count + j] = r.tilt_rate;
    }
    return wrong;
}

int ehd_cylinder_of_loads(const ehd_cylinder *bearing, const double *state, const double *loads, const double *slopes,
                          double *answer) {
    ehd_ring_motion motion;
    const int wrong = given_motion(bearing, state, state + 6, state[12], &motion);
    if (!wrong) cylinder_of_loads(bearing, &motion, loads, slopes, (ehd_bearing_force *)answer);
    return wrong;
}

EHD_SIZE_OF(ehd_cylinder_law)
EHD_SIZE_OF(ehd_cylinder)
EHD_SIZE_OF(ehd_cylinder_work)
EHD_SIZE_OF(ehd_cylinder_call)
