/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory
 * ------------------------------------------------------------------------------------------------------------------ */

size_t ehd_films_size(void) { return sizeof(ehd_films); }

/* Bring memory to the end of a step for which rollers are in balance, and to springs and times there. */
static void go_on(const ehd_law *law, const ehd_rollers *rollers, double *memory) {
    const double *inner = &law->inner.springs[0][0], *outer = &law->outer.springs[0][0];
    const ehd_pair_law pair[2] = {pair_of(&law->inner), pair_of(&law->outer)};
    const ehd_pair_springs springs = {EHD_SPRINGS, TIMES, {inner, outer}, {inner, outer}, 0.0};
    double approaches[EHD_SLICES];
    ehd_taper_go_on(&DATA, pair, &springs, (const ehd_taper_roller *)rollers->own, approaches, memory);
}

void ehd_films_begin(const ehd_law *law, const ehd_rollers *rollers, ehd_films *films) {
    memset(films, 0, sizeof *films);
    go_on(law, rollers, &films->memory[0][0][0][0]);
}

int ehd_films_look(const ehd_bearing *bearing, const ehd_law *law, ehd_rollers *rollers, const ehd_films *films,
                   double step, const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result) {
    if (!result) return EHD_BAD_ARGUMENT;
    if (!films || !rollers || !(step >= 0.0)) return no_force(result, EHD_BAD_ARGUMENT);
    memcpy(rollers->held, films->memory, sizeof rollers->held);
    ehd_pair_hold(2 * EHD_ROLLERS, EHD_SLICES, EHD_SPRINGS, TIMES, step, &rollers->held[0][0][0][0]);
    return bearing_at(bearing, law, rollers, pose, NULL, cage_angle, inner_speed, outer_speed,
                      &rollers->held[0][0][0][0], result);
}

int ehd_films_step(const ehd_bearing *bearing, const ehd_law *law, ehd_rollers *rollers, ehd_films *films, double step,
                   const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result) {
    const int status =
        ehd_films_look(bearing, law, rollers, films, step, pose, cage_angle, inner_speed, outer_speed, result);
    if (EHD_REFUSES(status)) return status;
    memcpy(films->memory, rollers->held, sizeof films->memory);
    go_on(law, rollers, &films->memory[0][0][0][0]);
    return status;
}
