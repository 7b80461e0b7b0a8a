/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings with cylindrical rollers and films that have a memory
 * ------------------------------------------------------------------------------------------------------------------ */

static const double AT_REST[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

/* Motion of a ring at rest, and what refuses a call before it is begun. */
static int films_status(const ehd_cylinder *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                        ehd_ring_motion *motion) {
    if (!bearing || !film || !pose) return EHD_BAD_ARGUMENT;
    return film_status(film) | given_motion(bearing, pose, AT_REST, cage_angle, motion);
}

/* Add the load of a slice and its stiffness to those of its roller. */
static void add_slice(double x, double load, double stiffness, sums *sum) {
    sum->w[0] += load;
    sum->w[1] += load * x;
    sum->k[0] += stiffness;
    sum->k[1] += stiffness * x;
    sum->k[2] += stiffness * x * x;
}

int ehd_cylinder_settled(const ehd_cylinder *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                         ehd_film_state states[]) {
    if (!states) return EHD_BAD_ARGUMENT;
    ehd_ring_motion motion;
    const int status = films_status(bearing, film, pose, cage_angle, &motion);
    if (!film || film_refuses(film, status)) return status;
    for (int64_t j = 0; j < bearing->rollers; j++) {
        const roller r = roller_of(bearing, &motion, j);
        for (int64_t i = 0; i < bearing->slices; i++)
            ehd_film_settled(film, approach_of(bearing, &r, i), &states[j * bearing->slices + i]);
    }
    return status;
}

int ehd_cylinder_advance(const ehd_cylinder *bearing, const ehd_film *film, double step, double last_step,
                         const double pose[6], double cage_angle, const ehd_film_state before[], ehd_film_state after[],
                         ehd_bearing_force *result) {
    if (!result) return EHD_BAD_ARGUMENT;
    no_bearing_force(result);
    if (!before || !after) return EHD_BAD_ARGUMENT;
    ehd_ring_motion motion;
    int status = films_status(bearing, film, pose, cage_angle, &motion);
    if (!film || film_refuses(film, status)) return status;
    memset(result, 0, sizeof *result);
    for (int64_t j = 0; j < bearing->rollers; j++) {
        const roller r = roller_of(bearing, &motion, j);
        sums sum = NO_SUMS;
        for (int64_t i = 0; i < bearing->slices; i++) {
            const int64_t n = j * bearing->slices + i;
            ehd_force force;
            const double approach = approach_of(bearing, &r, i);
            status |= ehd_film_advance(film, step, last_step, approach, &before[n], &after[n], &force);
            if (!film_refuses(film, status)) add_slice(bearing->position[i], force.load, force.stiffness, &sum);
        }
        add_roller(&r, &sum, result);
    }
    finish_answer(bearing, 1.0, result);
    return settled_force(film->law, status, result);
}

int ehd_cylinder_rates(const ehd_cylinder *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                       const double states[], ehd_film_rates rates[], ehd_bearing_force *result) {
    if (!result) return EHD_BAD_ARGUMENT;
    no_bearing_force(result);
    if (!states || !rates) return EHD_BAD_ARGUMENT;
    ehd_ring_motion motion;
    int status = films_status(bearing, film, pose, cage_angle, &motion);
    if (!film || film_refuses(film, status)) return status;
    memset(result, 0, sizeof *result);
    for (int64_t j = 0; j < bearing->rollers; j++) {
        const roller r = roller_of(bearing, &motion, j);
        sums sum = NO_SUMS;
        for (int64_t i = 0; i < bearing->slices; i++) {
            const int64_t n = j * bearing->slices + i;
            status |= ehd_film_rate(film, approach_of(bearing, &r, i), states[n], &rates[n]);
            if (!film_refuses(film, status)) add_slice(bearing->position[i], rates[n].load, rates[n].stiffness, &sum);
        }
        add_roller(&r, &sum, result);
    }
    finish_answer(bearing, 1.0, result);
    return settled_force(film->law, status, result);
}

void ehd_cylinder_direction(const ehd_cylinder *bearing, double cage_angle, int j, int i, double column[4]) {
    const ehd_ring_motion motion = ring_motion_of(AT_REST, AT_REST, cage_angle);
    const roller r = roller_of(bearing, &motion, j);
    column[0] = r.cosine;
    column[1] = r.sine;
    column[2] = -(r.row + bearing->position[i]) * r.sine;
    column[3] = (r.row + bearing->position[i]) * r.cosine;
}
