/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory
 *
 * Beside the load p(approach) at rest act three springs K_r in series with dampers, whose forces f_r are the states:
 *
 *     f_r' = K_r approach' - f_r/theta_r,    load = p + f where f = sum f_r >= 0, else f + sqrt(f^2 + p^2).
 *
 * Over a step h in which the approach goes evenly f_r goes to exp(-a) f_r + K_r (1 - exp(-a))/a times the change of the
 * approach, a = h/theta_r. Between steps K_r follows the load: where it falls f_r falls in proportion, where it rises f_r
 * stays. Both take energy away.
 * ------------------------------------------------------------------------------------------------------------------ */

size_t ehd_films_size(void) { return sizeof(ehd_films); }

/* Springs at an approach, straight between the nodes and held beyond, and the longest of their times. */
static void springs_at(const ehd_contact *law, double approach, double spring[4]) {
    const double place = (asinh((approach - law->centre) / law->scale) - law->first) / law->step;
    const double held = least(most(place, 0.0), EHD_ROWS - 1.0);
    const int cell = held < EHD_ROWS - 2 ? (int)held : EHD_ROWS - 2;
    const double t = held - cell;
    for (int r = 0; r < 4; r++)
        spring[r] = law->springs[cell][r] + t * (law->springs[cell + 1][r] - law->springs[cell][r]);
}

static double approach_at(const ehd_ball *ball, int side) { return side ? ball->outer_approach : ball->inner_approach; }

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
    double held[EHD_BALLS][2][3];
    if (!films || !(step >= 0.0)) return no_force(result, EHD_BAD_ARGUMENT);
    for (int j = 0; j < EHD_BALLS; j++)
        for (int side = 0; side < 2; side++) {
            const double *spring = films->spring[j][side];
            double *own = held[j][side];
            own[0] = own[1] = 0.0;
            own[2] = films->approach[j][side];
            for (int r = 0; r < 3; r++) {
                const double a = step / (spring[3] * TIMES[r]);
                own[0] += exp(-a) * films->force[j][side][r];
                own[1] += spring[r] * (a > 0.0 ? -expm1(-a) / a : 1.0);
            }
        }
    return bearing_at(bearing, law, balls, pose, NULL, cage_angle, inner_speed, outer_speed, NULL,
                      (const double (*)[2][3])held, result);
}

int ehd_films_step(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, ehd_films *films, double step,
                   const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result) {
    const int status =
        ehd_films_look(bearing, law, balls, films, step, pose, cage_angle, inner_speed, outer_speed, result);
    if (EHD_REFUSES(status)) return status;
    for (int j = 0; j < EHD_BALLS; j++)
        for (int side = 0; side < 2; side++) {
            double *spring = films->spring[j][side], after[4];
            const double approach = approach_at(&balls->ball[j], side), moved = approach - films->approach[j][side];
            springs_at(side ? &law->outer : &law->inner, approach, after);
            for (int r = 0; r < 3; r++) {
                const double a = step / (spring[3] * TIMES[r]);
                double *force = &films->force[j][side][r];
                *force = exp(-a) * *force + spring[r] * (a > 0.0 ? -expm1(-a) / a : 1.0) * moved;
                if (after[r] < spring[r]) *force *= after[r] / spring[r];
                spring[r] = after[r];
            }
            spring[3] = after[3];
            films->approach[j][side] = approach;
        }
    return status;
}
