/* ---------------------------------------------------------------------------------------------------------------------
 * The bearing
 * ------------------------------------------------------------------------------------------------------------------ */

#define NEGLIGIBLE 1e-11   /* approach of a dry contact under a centrifugal load that is left out [m] */

size_t ehd_bearing_size(void) { return sizeof(ehd_bearing); }

size_t ehd_balls_size(void) { return sizeof(ehd_balls); }

int ehd_bearing_make(ehd_bearing *bearing, double clearance, int mirrored) {
    const double two_pi = 6.283185307179586476925, apart = GROOVE_DISTANCE * cos(EHD_CONTACT_ANGLE);
    if (!bearing || !(fabs(clearance) < apart)) return EHD_BAD_ARGUMENT;
    bearing->clearance = clearance;
    bearing->mirrored = mirrored != 0;
    bearing->axial = (mirrored ? -1.0 : 1.0) * GROOVE_DISTANCE * sin(EHD_CONTACT_ANGLE);
    bearing->radial = apart - 0.5 * clearance;
    /* the inner groove's centre at the free contact angle */
    bearing->arm = 0.5 * EHD_PITCH_DIAMETER + INNER_ARM * least(bearing->radial / GROOVE_DISTANCE, 1.0);
    bearing->most_travel = GROOVE_DISTANCE;
    bearing->most_tilt = GROOVE_DISTANCE / bearing->arm;
    for (int j = 0; j < EHD_BALLS; j++) {
        bearing->cosine[j] = cos(two_pi * j / EHD_BALLS);
        bearing->sine[j] = sin(two_pi * j / EHD_BALLS);
    }
    return EHD_OK;
}

/* What is wrong about a pose, a velocity, which may be a null pointer, and an angle of the cage. */
static int problem_of(const ehd_bearing *bearing, const double *pose, const double *velocity, double cage_angle) {
    int near = 1;
    if (!is_finite(cage_angle) || !finite_motion(pose, velocity)) return EHD_NOT_FINITE;
    for (int i = 0; i < 3; i++) near = near && fabs(pose[i]) <= bearing->most_travel;
    for (int i = 4; i < 6; i++) near = near && fabs(pose[i]) <= bearing->most_tilt;
    return near && bearing->axial * (bearing->axial + pose[0]) >= 0.0 ? EHD_OK : EHD_TOO_FAR;
}

/* Add row^T matrix column of a ball to a matrix of the bearing. way: of each displacement of the ring, the axial and the
 * radial one of the inner groove's centre. */
static void add_matrix(double sum[6][6], const double m[4], const double way[6][2]) {
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++)
            sum[i][k] += way[i][0] * (m[0] * way[k][0] + m[1] * way[k][1]) +
                         way[i][1] * (m[2] * way[k][0] + m[3] * way[k][1]);
}

/* The force at speeds of the rings; cage: speed of a cage that holds the balls, or null; held: what the films of the inner
 * and the outer contact of each ball hold over a step, or null. */
static int bearing_at(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, const double pose[6],
                      const double velocity[6], double cage_angle, double inner_speed, double outer_speed,
                      const double *cage, const double (*held)[2][3], ehd_bearing_force *result) {
    if (!result) return EHD_BAD_ARGUMENT;
    if (!bearing || !law || !law->made || !balls || !pose || !(fabs(inner_speed) <= FASTEST) ||
        !(fabs(outer_speed) <= FASTEST) || (cage && !(fabs(*cage) <= FASTEST)))
        return no_force(result, EHD_BAD_ARGUMENT);
    const int problem = problem_of(bearing, pose, velocity, cage_angle);
    if (problem) return no_force(result, problem);
    given of = {{0.0, 0.0}, inner_speed, outer_speed, 0.0, cage, &law->inner, &law->outer, NULL, NULL};
    const double nominal = cage ? *cage : ehd_cage(inner_speed, outer_speed);
    of.rest = balls->rest = approach_of(&law->outer, CENTRIFUGAL * nominal * nominal, balls->rest);
    if (DRY && of.rest < NEGLIGIBLE) {
        of.inner_speed = of.outer_speed = 0.0;
        of.cage = NULL;
    }
    const double turn_c = cos(cage_angle), turn_s = sin(cage_angle);
    double largest = 0.0, load = 0.0, speed = 0.0;
    memset(result, 0, sizeof *result);
    for (int j = 0; j < EHD_BALLS; j++) {
        ehd_ball *ball = &balls->ball[j];
        const double c = turn_c * bearing->cosine[j] - turn_s * bearing->sine[j];
        const double s = turn_s * bearing->cosine[j] + turn_c * bearing->sine[j];
        const double way[6][2] = {{1.0, 0.0}, {0.0, c}, {0.0, s}, {0.0, 0.0}, {bearing->arm * s, 0.0},
                                  {-bearing->arm * c, 0.0}};
        of.d[0] = bearing->axial + pose[0] + bearing->arm * (pose[4] * s - pose[5] * c);
        of.d[1] = bearing->radial + pose[1] * c + pose[2] * s;
        if (held) {
            of.held_inner = held[j][0];
            of.held_outer = held[j][1];
        }
        int found = place_ball(&of, ball);
        if (!found) { /* once more, from nothing */
            memset(ball, 0, sizeof *ball);
            found = place_ball(&of, ball);
        }
        if (!found) {
            memset(balls, 0, sizeof *balls);
            return no_force(result, EHD_NO_BALANCE);
        }
        largest = most(largest, most(ball->inner_load, ball->outer_load));
        if (ball->inner_load <= 0.0) continue;
        load += ball->inner_load;
        speed += ball->inner_load * ball->speed;
        for (int i = 0; i < 6; i++) result->force[i] -= way[i][0] * ball->force[0] + way[i][1] * ball->force[1];
        add_matrix(result->stiffness, ball->stiffness, way);
        add_matrix(result->damping, ball->damping, way);
    }
    for (int i = 0; velocity && i < 6; i++)
        for (int k = 0; k < 6; k++) result->force[i] -= result->damping[i][k] * velocity[k];
    result->cage_speed = load > 0.0 ? speed / load : nominal;
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
