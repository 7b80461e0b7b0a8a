/* ---------------------------------------------------------------------------------------------------------------------
 * The bearing with the data of this file
 * ------------------------------------------------------------------------------------------------------------------ */

size_t ehd_bearing_size(void) { return sizeof(ehd_bearing); }

size_t ehd_prepared_size(void) { return sizeof(ehd_prepared); }

int ehd_bearing_make(ehd_bearing *bearing, double clearance, int count, const double *profile) {
    return ehd_cylinder_make(&CYLINDER, clearance, count, profile, bearing);
}

int ehd_prepare(ehd_prepared *law, double u, double T, double q) {
    return law ? ehd_cylinder_prepare(&LAW, u, T, q, &law->law) : EHD_BAD_ARGUMENT;
}

int ehd_bearing_at(const ehd_bearing *bearing, const ehd_prepared *law, const double pose[6], const double velocity[6],
                   double cage_angle, ehd_bearing_force *result) {
    return ehd_cylinder_at(bearing, law ? &law->law : NULL, pose, velocity, cage_angle, result);
}

int ehd_bearing_call(const ehd_bearing *bearing, ehd_prepared *law, const double pose[6], const double velocity[6],
                     double cage_angle, double u, double T, double q, ehd_bearing_force *result) {
    return ehd_cylinder_call(bearing, law ? &law->law : NULL, pose, velocity, cage_angle, u, T, q, result);
}

int ehd_bearing_settled(const ehd_bearing *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                        ehd_film_state states[]) {
    return ehd_cylinder_settled(bearing, film, pose, cage_angle, states);
}

int ehd_bearing_advance(const ehd_bearing *bearing, const ehd_film *film, double step, double last_step,
                        const double pose[6], double cage_angle, const ehd_film_state before[], ehd_film_state after[],
                        ehd_bearing_force *result) {
    return ehd_cylinder_advance(bearing, film, step, last_step, pose, cage_angle, before, after, result);
}

int ehd_bearing_rates(const ehd_bearing *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                      const double states[], ehd_film_rates rates[], ehd_bearing_force *result) {
    return ehd_cylinder_rates(bearing, film, pose, cage_angle, states, rates, result);
}

void ehd_bearing_direction(const ehd_bearing *bearing, double cage_angle, int j, int i, double column[4]) {
    ehd_cylinder_direction(bearing, cage_angle, j, i, column);
}
