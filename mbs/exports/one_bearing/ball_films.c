/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory
 * ------------------------------------------------------------------------------------------------------------------ */

size_t ehd_films_size(void) { return sizeof(ehd_films); }

static double approach_at(const ehd_ball *ball, int side) { return side ? ball->outer_approach : ball->inner_approach; }

/* Springs at an approach, and the longest of their times. */
static void springs_at(const ehd_contact *law, double approach, double spring[4]) {
    const ehd_pair_law pair = pair_of(law);
    ball_springs(&law->springs[0][0], EHD_ROWS, pair_place(&pair, approach), spring);
}

void ehd_films_begin(const ehd_law *law, const ehd_balls *balls, ehd_films *films) {
    memset(films, 0, sizeof *films);
    for (int j = 0; j < EHD_BALLS; j++)
        for (int side = 0; side < 2; side++) {
            films->approach[j][side] = approach_at(&balls->ball[j], side);
            springs_at(side ? &law->outer : &law->inner, films->approach[j][side], films->spring[j][side]);
        }
}

int ehd_films_look(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, const ehd_films *films, double step,
                   const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result) {
    double held[EHD_BALLS][2][3], passed[6];
    if (!films || !(step >= 0.0)) return no_force(result, EHD_BAD_ARGUMENT);
    for (int j = 0; j < EHD_BALLS; j++)
        for (int side = 0; side < 2; side++)
            ball_hold(TIMES, step, films->approach[j][side], films->spring[j][side], films->force[j][side], passed,
                      held[j][side]);
    return bearing_at(bearing, law, balls, pose, NULL, cage_angle, inner_speed, outer_speed, NULL, &held[0][0][0],
                      result);
}

int ehd_films_step(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, ehd_films *films, double step,
                   const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result) {
    const int status =
        ehd_films_look(bearing, law, balls, films, step, pose, cage_angle, inner_speed, outer_speed, result);
    if (EHD_REFUSES(status)) return status;
    for (int j = 0; j < EHD_BALLS; j++)
        for (int side = 0; side < 2; side++) {
            double *spring = films->spring[j][side], *force = films->force[j][side], after[4], passed[6], held[3];
            const double approach = approach_at(&balls->ball[j], side);
            ball_hold(TIMES, step, films->approach[j][side], spring, force, passed, held);
            springs_at(side ? &law->outer : &law->inner, approach, after);
            ball_go_on(approach - films->approach[j][side], spring, after, passed, force);
            films->approach[j][side] = approach;
        }
    return status;
}
