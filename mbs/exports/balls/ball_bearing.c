/* ---------------------------------------------------------------------------------------------------------------------
 * The bearing
 * ------------------------------------------------------------------------------------------------------------------ */

#define NEGLIGIBLE 1e-11   /* approach of a dry contact under a centrifugal load that is left out [m] */
#define CAGE_ERROR 1e-8    /* of the speed of the cage, over the faster ring's */
#define MOST_TURNS 40      /* until it is found */

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

/* Mean contact angles of both sides, by the loads of the balls; zero without load. */
static void mean_angles(const ehd_balls *balls, double angle[2]) {
    double load_i = 0.0, load_o = 0.0, angle_i = 0.0, angle_o = 0.0;
    for (int j = 0; j < EHD_BALLS; j++) {
        const ehd_ball *ball = &balls->ball[j];
        load_i += ball->inner_load;
        load_o += ball->outer_load;
        angle_i += ball->inner_load * ball->inner_angle;
        angle_o += ball->outer_load * ball->outer_angle;
    }
    angle[0] = load_i > 0.0 ? angle_i / load_i : 0.0;
    angle[1] = load_o > 0.0 ? angle_o / load_o : 0.0;
}

/* Speed of the cage of pure rolling at the mean contact angles of both sides. */
static double rolling(const double angle[2], double inner, double outer) {
    const double ratio = EHD_BALL_DIAMETER / EHD_PITCH_DIAMETER;
    const double at_inner = 1.0 - ratio * cos(angle[0]), at_outer = 1.0 + ratio * cos(angle[1]);
    return (inner * at_inner + outer * at_outer) / (at_inner + at_outer);
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

/* ehd_bearing_at; held: what the films of the inner and the outer contact of each ball hold over a step, or null. */
static int bearing_at(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, const double pose[6],
                      const double velocity[6], double cage_angle, double cage_speed, double outer_speed,
                      const double (*held)[2][3], ehd_bearing_force *result) {
    if (!result) return EHD_BAD_ARGUMENT;
    if (!bearing || !law || !law->made || !balls || !pose || !(fabs(cage_speed) <= FASTEST) ||
        !(fabs(outer_speed) <= FASTEST))
        return no_force(result, EHD_BAD_ARGUMENT);
    const int problem = problem_of(bearing, pose, velocity, cage_angle);
    if (problem) return no_force(result, problem);
    given of = {{0.0, 0.0}, 0.0, 0.0, 0.0, &law->inner, &law->outer, NULL, NULL};
    of.centrifugal = CENTRIFUGAL * cage_speed * cage_speed;
    /* traction of rings that turn against each other would drive an idle ball out of its groove: G >= -F_c Dw/4 */
    const double moment = most(GYROSCOPIC * cage_speed * (cage_speed - outer_speed),
                               -0.25 * EHD_BALL_DIAMETER * of.centrifugal);
    of.rest = balls->rest = approach_of(&law->outer, of.centrifugal, balls->rest);
    of.traction = 2.0 * moment / EHD_BALL_DIAMETER;
    if (DRY && of.rest < NEGLIGIBLE) of.centrifugal = of.traction = 0.0;
    const double turn_c = cos(cage_angle), turn_s = sin(cage_angle);
    double largest = 0.0;
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
        for (int i = 0; i < 6; i++) result->force[i] -= way[i][0] * ball->force[0] + way[i][1] * ball->force[1];
        add_matrix(result->stiffness, ball->stiffness, way);
        add_matrix(result->damping, ball->damping, way);
    }
    for (int i = 0; velocity && i < 6; i++)
        for (int k = 0; k < 6; k++) result->force[i] -= result->damping[i][k] * velocity[k];
    result->cage_speed = cage_speed;
    return law->status | (largest > law->highest ? EHD_ABOVE_LOAD : EHD_OK);
}

int ehd_bearing_at(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, const double pose[6],
                   const double velocity[6], double cage_angle, double cage_speed, double outer_speed,
                   ehd_bearing_force *result) {
    return bearing_at(bearing, law, balls, pose, velocity, cage_angle, cage_speed, outer_speed, NULL, result);
}

int ehd_bearing_call(const ehd_bearing *bearing, ehd_law *law, ehd_balls *balls, const double pose[6],
                     const double velocity[6], double cage_angle, double inner_speed, double outer_speed,
                     ehd_bearing_force *result) {
    const double fastest = most(fabs(inner_speed), fabs(outer_speed));
    double cage = ehd_cage(inner_speed, outer_speed);
    if (!result) return EHD_BAD_ARGUMENT;
    if (!law || !balls || !(fabs(inner_speed) <= FASTEST) || !(fabs(outer_speed) <= FASTEST))
        return no_force(result, EHD_BAD_ARGUMENT);
    ehd_prepare(law, EHD_ENTRAINMENT * (inner_speed - outer_speed));
    for (int turn = 0; turn < MOST_TURNS; turn++) {
        const int status =
            ehd_bearing_at(bearing, law, balls, pose, velocity, cage_angle, cage, outer_speed, result);
        if (EHD_REFUSES(status)) return status;
        const double before = cage;
        double angle[2];
        mean_angles(balls, angle);
        cage = rolling(angle, inner_speed, outer_speed);
        if (fabs(cage - before) <= CAGE_ERROR * fastest) return status;
    }
    return no_force(result, EHD_NO_BALANCE);
}
