/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory
 *
 * Beside the load p(approach) at rest of a slice acts a spring K in series with a damper, whose force f is its state:
 *
 *     f' = K approach' - f/theta,    load = p + f where f >= 0, else f + sqrt(f^2 + p^2).
 *
 * Over a step h in which the approach goes evenly f goes to exp(-a) f + K (1 - exp(-a))/a times the change of the
 * approach, a = h/theta. Between steps K follows the load: where it falls f falls in proportion, where it rises f stays.
 * Both take energy away.
 * ------------------------------------------------------------------------------------------------------------------ */

size_t ehd_films_size(void) { return sizeof(ehd_films); }

/* Spring and time at an approach, straight between the nodes; beyond them the spring stays, and the time follows the
 * damping. */
static void springs_at(const ehd_contact *law, double approach, double *spring, double *time) {
    const double place = (asinh((approach - law->centre) / law->scale) - law->first) / law->step;
    const double held = least(most(place, 0.0), EHD_ROWS - 1.0);
    const int cell = held < EHD_ROWS - 2 ? (int)held : EHD_ROWS - 2;
    const double t = held - cell, *low = law->springs[cell], *high = law->springs[cell + 1];
    const double follows = law->table[place < 0.0 ? 0 : EHD_ROWS - 1][3] * (place - held);
    *spring = low[0] + t * (high[0] - low[0]);
    *time = most((low[1] + t * (high[1] - low[1])) * exp(follows), 1e-30);
}

/* Approach of a slice of the cone, 0, or the cup, 1. */
static double approach_at(const ehd_roller *roller, int side, int i) {
    const double *normal = side ? CUP : CONE;
    double moved[3];
    for (int k = 0; k < 3; k++) moved[k] = side ? roller->place[k] : roller->ring[k] - roller->place[k];
    return normal[0] * moved[0] + normal[1] * moved[1] + LEVER[i] * moved[2] - PROFILE[i] - roller->play;
}

void ehd_films_begin(const ehd_law *law, const ehd_rollers *rollers, ehd_films *films) {
    memset(films, 0, sizeof *films);
    for (int j = 0; j < EHD_ROLLERS; j++)
        for (int side = 0; side < 2; side++)
            for (int i = 0; i < EHD_SLICES; i++) {
                films->approach[j][side][i] = approach_at(&rollers->roller[j], side, i);
                springs_at(side ? &law->outer : &law->inner, films->approach[j][side][i], &films->spring[j][side][i],
                           &films->time[j][side][i]);
            }
}

/* Part of a force that is left after a step, and what of the spring acts at its end. */
static double left_after(double step, double time, double *passed) {
    const double a = step / time;
    *passed = a > 0.0 ? -expm1(-a) / a : 1.0;
    return exp(-a);
}

int ehd_films_look(const ehd_bearing *bearing, const ehd_law *law, ehd_rollers *rollers, const ehd_films *films,
                   double step, const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result) {
    double held[EHD_ROLLERS][2][EHD_SLICES][3];
    if (!result) return EHD_BAD_ARGUMENT;
    if (!films || !(step >= 0.0)) return no_force(result, EHD_BAD_ARGUMENT);
    for (int j = 0; j < EHD_ROLLERS; j++)
        for (int side = 0; side < 2; side++)
            for (int i = 0; i < EHD_SLICES; i++) {
                double *own = held[j][side][i], passed;
                own[0] = left_after(step, films->time[j][side][i], &passed) * films->force[j][side][i];
                own[1] = passed * films->spring[j][side][i];
                own[2] = films->approach[j][side][i];
            }
    return bearing_at(bearing, law, rollers, pose, NULL, cage_angle, inner_speed, outer_speed,
                      (const double (*)[2][EHD_SLICES][3])held, result);
}

int ehd_films_step(const ehd_bearing *bearing, const ehd_law *law, ehd_rollers *rollers, ehd_films *films, double step,
                   const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result) {
    const int status =
        ehd_films_look(bearing, law, rollers, films, step, pose, cage_angle, inner_speed, outer_speed, result);
    if (EHD_REFUSES(status)) return status;
    for (int j = 0; j < EHD_ROLLERS; j++)
        for (int side = 0; side < 2; side++)
            for (int i = 0; i < EHD_SLICES; i++) {
                double *force = &films->force[j][side][i], *spring = &films->spring[j][side][i], passed, after;
                const double approach = approach_at(&rollers->roller[j], side, i);
                const double left = left_after(step, films->time[j][side][i], &passed);
                *force = left * *force + passed * *spring * (approach - films->approach[j][side][i]);
                springs_at(side ? &law->outer : &law->inner, approach, &after, &films->time[j][side][i]);
                if (after < *spring) *force *= after / *spring;
                *spring = after;
                films->approach[j][side][i] = approach;
            }
    return status;
}
