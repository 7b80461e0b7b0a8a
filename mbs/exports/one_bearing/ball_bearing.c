/* ---------------------------------------------------------------------------------------------------------------------
 * The bearing
 * ------------------------------------------------------------------------------------------------------------------ */

#define NEGLIGIBLE 1e-11   /* approach of a dry contact under a centrifugal load that is left out [m] */

size_t ehd_bearing_size(void) { return sizeof(ehd_bearing); }

size_t ehd_balls_size(void) { return sizeof(ehd_balls); }

int ehd_bearing_make(ehd_bearing *bearing, double clearance, int mirrored) {
    const double two_pi = 6.283185307179586476925, apart = GROOVE_DISTANCE * cos(EHD_CONTACT_ANGLE);
    const double axial = AXIAL_PLAY ? clearance : 0.0;
    if (!bearing || !(fabs(clearance) < apart)) return EHD_BAD_ARGUMENT;
    bearing->clearance = clearance;
    bearing->mirrored = mirrored != 0;
    bearing->added = NULL;
    bearing->axial = (mirrored ? -1.0 : 1.0) * GROOVE_DISTANCE * sin(EHD_CONTACT_ANGLE);
    bearing->radial = THRUST ? 0.0 : apart - 0.5 * (clearance - axial);
    /* the inner groove's centre at the free contact angle */
    bearing->arm = 0.5 * EHD_PITCH_DIAMETER + INNER_ARM * least(bearing->radial / GROOVE_DISTANCE, 1.0);
    bearing->most_travel = MOST_TRAVEL;
    bearing->most_tilt = SPHERE ? 0.1 : GROOVE_DISTANCE / bearing->arm;
    if (SPHERE) bearing->arm = 0.0;
    for (int j = 0; j < EHD_BALLS; j++) {
        const double *row = row_of[j / EHD_ROW_BALLS], turned = mirrored ? -1.0 : 1.0;
        bearing->cosine[j] = cos(two_pi * (j % EHD_ROW_BALLS) / EHD_ROW_BALLS);
        bearing->sine[j] = sin(two_pi * (j % EHD_ROW_BALLS) / EHD_ROW_BALLS);
        bearing->row[j][0] = row[0];
        bearing->row[j][1] = turned * row[1];
        bearing->row[j][2] = turned * (row[2] - 0.5 * axial);
        bearing->row[j][3] = row[3];
        bearing->most_tilt = least(bearing->most_tilt, GROOVE_DISTANCE / most(fabs(row[1]), 1e-300));
    }
    return EHD_OK;
}

/* What callers may read of a ball. */
static void tell(const ehd_ball_found *found, const ehd_ball_start *start, ehd_ball *ball) {
    memcpy(ball->centre, start->centre, sizeof ball->centre);
    memcpy(ball->force, found->force, sizeof ball->force);
    memcpy(ball->stiffness, found->stiffness, sizeof ball->stiffness);
    memcpy(ball->damping, found->damping, sizeof ball->damping);
    ball->inner_load = found->load[0];
    ball->outer_load = found->load[1];
    ball->inner_angle = found->angle[0];
    ball->outer_angle = found->angle[1];
    ball->inner_approach = found->approach[0];
    ball->outer_approach = found->approach[1];
    ball->speed = found->speed;
}

/* The force at speeds of the rings; cage: speed of a cage that holds the balls, or null; held: what the films of the inner
 * and the outer contact of each ball hold over a step, or null. */
static int bearing_at(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, const double pose[6],
                      const double velocity[6], double cage_angle, double inner_speed, double outer_speed,
                      const double *cage, const double *held, ehd_bearing_force *result) {
    if (!result) return EHD_BAD_ARGUMENT;
    if (!bearing || !law || !law->made || !balls || !pose || !(fabs(inner_speed) <= FASTEST) ||
        !(fabs(outer_speed) <= FASTEST) || (cage && !(fabs(*cage) <= FASTEST)))
        return no_force(result, EHD_BAD_ARGUMENT);
    if (!is_finite(cage_angle) || !finite_motion(pose, velocity)) return no_force(result, EHD_NOT_FINITE);
    for (int j = 0; j < EHD_BALLS; j += EHD_ROW_BALLS)
        if (!(bearing->axial * (bearing->axial + bearing->row[j][0] * pose[0]) >= 0.0))
            return no_force(result, EHD_TOO_FAR);
    const double nominal = cage ? *cage : ehd_cage(inner_speed, outer_speed);
    const ehd_pair_law inner = pair_of(&law->inner), outer = pair_of(&law->outer);
    const double rest = balls->rest = ehd_pair_approach(&outer, CENTRIFUGAL * nominal * nominal, balls->rest);
    const int still = DRY && rest < NEGLIGIBLE;
    double by_rates[EHD_PAIR_BY_RATES];
    const ehd_ball_data data = {
        {bearing->axial, bearing->radial, bearing->arm, INNER_ARM, OUTER_ARM, bearing->most_travel, bearing->most_tilt},
        {still ? 0.0 : inner_speed, still ? 0.0 : outer_speed, still || !cage ? NAN : *cage,
         EHD_BALL_DIAMETER / EHD_PITCH_DIAMETER, CENTRIFUGAL, GYROSCOPIC, BALL_AXIS},
        cage_angle, rest, EHD_BALLS, bearing->cosine, bearing->sine, bearing->row[0], held, inner, outer,
        bearing->added, by_rates};
    ehd_ball_start *start = (ehd_ball_start *)balls->start;
    ehd_ball_found found[EHD_BALLS];
    const int loaded =
        ehd_ball_force_surely(&data, pose, start, found, result->force, result->stiffness[0], result->damping[0]);
    if (loaded < 0) {
        if (loaded == EHD_BALL_NO_BALANCE) memset(balls, 0, sizeof *balls);
        return no_force(result, loaded == EHD_BALL_NO_BALANCE ? EHD_NO_BALANCE : EHD_TOO_FAR);
    }
    double largest = 0.0;
    ehd_ball_angles(EHD_BALLS, found);
    for (int j = 0; j < EHD_BALLS; j++) {
        tell(&found[j], &start[j], &balls->ball[j]);
        largest = most(largest, most(found[j].load[0], found[j].load[1]));
    }
    for (int i = 0; velocity && i < 6; i++)
        for (int k = 0; k < 6; k++) result->force[i] -= result->damping[i][k] * velocity[k];
    for (int i = 0; bearing->added && i < 6; i++) result->force[i] += by_rates[i];
    result->cage_speed = ehd_ball_mean_speed(EHD_BALLS, found, nominal);
    return law->status | (largest > law->highest ? EHD_ABOVE_LOAD : EHD_OK);
}

int ehd_bearing_at(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, const double pose[6],
                   const double velocity[6], double cage_angle, double cage_speed, double outer_speed,
                   ehd_bearing_force *result) {
    return bearing_at(bearing, law, balls, pose, velocity, cage_angle, 0.0, outer_speed, &cage_speed, NULL, result);
}

int ehd_bearing_call(const ehd_bearing *bearing, ehd_law *law, ehd_balls *balls, const double pose[6],
                     const double velocity[6], double cage_angle, double inner_speed, double outer_speed,
                     ehd_bearing_force *result) {
    if (!result) return EHD_BAD_ARGUMENT;
    if (!law || !(fabs(inner_speed) <= FASTEST) || !(fabs(outer_speed) <= FASTEST))
        return no_force(result, EHD_BAD_ARGUMENT);
    ehd_prepare(law, EHD_ENTRAINMENT * (inner_speed - outer_speed));
    return bearing_at(bearing, law, balls, pose, velocity, cage_angle, inner_speed, outer_speed, NULL, NULL, result);
}
