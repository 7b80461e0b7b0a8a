/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory
 * ------------------------------------------------------------------------------------------------------------------ */

size_t ehd_films_size(void) { return sizeof(ehd_films); }

static double approach_at(const ehd_ball *ball, int side) { return side ? ball->outer_approach : ball->inner_approach; }

/* Bring memory to the end of a step for which balls are in balance, and to springs and times there. */
static void go_on(const ehd_law *law, const ehd_balls *balls, double *memory) {
    const double *inner = &law->inner.springs[0][0], *outer = &law->outer.springs[0][0];
    const ehd_pair_law pair[2] = {pair_of(&law->inner), pair_of(&law->outer)};
    const ehd_pair_springs springs = {EHD_SPRINGS, TIMES, {inner, outer}, {inner, outer}, 0.0};
    for (int j = 0; j < EHD_BALLS; j++)
        for (int side = 0; side < 2; side++, memory += EHD_BALL_MEMORY) {
            const double approach = approach_at(&balls->ball[j], side);
            pair_go_on(pair + side, &springs, EHD_SPRINGS, side, 1, &approach, memory);
        }
}

void ehd_films_begin(const ehd_law *law, const ehd_balls *balls, ehd_films *films) {
    memset(films, 0, sizeof *films);
    go_on(law, balls, &films->memory[0][0][0]);
}

/* The same step with what films hold over it, which is written. */
static int look(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, const ehd_films *films, double step,
                const double pose[6], double cage_angle, double inner_speed, double outer_speed, ehd_films *held,
                ehd_bearing_force *result) {
    if (!films || !(step >= 0.0)) return no_force(result, EHD_BAD_ARGUMENT);
    *held = *films;
    ehd_pair_hold(2 * EHD_BALLS, 1, EHD_SPRINGS, TIMES, step, &held->memory[0][0][0]);
    return bearing_at(bearing, law, balls, pose, NULL, cage_angle, inner_speed, outer_speed, NULL,
                      &held->memory[0][0][0], result);
}

int ehd_films_look(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, const ehd_films *films, double step,
                   const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result) {
    ehd_films held;
    return look(bearing, law, balls, films, step, pose, cage_angle, inner_speed, outer_speed, &held, result);
}

int ehd_films_step(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, ehd_films *films, double step,
                   const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result) {
    ehd_films held;
    const int status =
        look(bearing, law, balls, films, step, pose, cage_angle, inner_speed, outer_speed, &held, result);
    if (EHD_REFUSES(status)) return status;
    go_on(law, balls, &held.memory[0][0][0]);
    *films = held;
    return status;
}
