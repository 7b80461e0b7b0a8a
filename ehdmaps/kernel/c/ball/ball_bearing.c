/* ---------------------------------------------------------------------------------------------------------------------
 * The sums over the balls of a bearing
 *
 * Frame O sits in the middle of the outer groove, x along its axis. A pose is x y z theta_x theta_y theta_z of the inner
 * ring in O [m], [rad], tilts theta_y = -n_z, theta_z = n_y by the axis n of the ring; theta_x has no force.
 *
 * A row of balls carries +x, way 1, or -x, way -1: its balls are seen in a mirror. It stands at a place p along x, and its
 * inner groove's centre is shifted by what presses (> 0) or loosens the row. Of arm r the inner groove's centre of a ball in
 * the direction (c, s) moves by
 *
 *     axial   way (x + r (theta_y s - theta_z c)) + shift,        radial   y c + z s + p (theta_z c - theta_y s).
 *
 * The ball of a four-point contact bearing is one in each of two rows, the other one `other` places further. It has its
 * mass where its contacts are: half of it in each row where the grooves of both press it, all of it where those of one do.
 * ------------------------------------------------------------------------------------------------------------------ */

EHD_SIZE_OF(ehd_ball_data)

static const double one_row[4] = {1.0, 0.0, 0.0, 0.0};

/* Add what a ball has by d to a matrix (6, 6); d by pose: axial (1, 0, 0, 0, y, z), radial (0, c, s, 0, 0, 0). */
EHD_INLINE void ball_add(const double m[4], double c, double s, double y, double z, double *out) {
    const double xx = m[0], xr = m[1], rx = m[2], rr = m[3];
    out[0] += xx;
    out[1] += xr * c;
    out[2] += xr * s;
    out[4] += xx * y;
    out[5] += xx * z;
    out[6] += rx * c;
    out[7] += rr * c * c;
    out[8] += rr * c * s;
    out[10] += rx * c * y;
    out[11] += rx * c * z;
    out[12] += rx * s;
    out[13] += rr * s * c;
    out[14] += rr * s * s;
    out[16] += rx * s * y;
    out[17] += rx * s * z;
    out[24] += xx * y;
    out[25] += xr * y * c;
    out[26] += xr * y * s;
    out[28] += xx * y * y;
    out[29] += xx * y * z;
    out[30] += xx * z;
    out[31] += xr * z * c;
    out[32] += xr * z * s;
    out[34] += xx * z * y;
    out[35] += xx * z * z;
}

/* The same of what a place p along the axis adds to the radial motion of a ball: t = (0, ..., -p s, p c). */
static void ball_add_place(const double m[4], double c, double s, double y, double z, double p, double *out) {
    const double a[6] = {1.0, 0.0, 0.0, 0.0, y, z}, b[6] = {0.0, c, s, 0.0, 0.0, 0.0}, t[2] = {-p * s, p * c};
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 2; j++) {
            out[6 * i + 4 + j] += (a[i] * m[1] + b[i] * m[3]) * t[j];
            out[6 * (4 + j) + i] += t[j] * (m[2] * a[i] + m[3] * b[i]);
        }
    for (int i = 0; i < 4; i++) out[6 * (4 + i / 2) + 4 + i % 2] += m[3] * t[i / 2] * t[i % 2];
}

/* d of a ball in the direction (c, s), and its row. */
static const double *ball_groove(const ehd_ball_data *of, int64_t j, const double *pose, double c, double s, double *dx,
                                 double *dr) {
    const double *row = of->rows ? of->rows + 4 * j : one_row;
    *dx = of->shape.axial + row[0] * (pose[0] + of->shape.arm * (pose[4] * s - pose[5] * c)) + row[2];
    *dr = of->shape.radial + pose[1] * c + pose[2] * s;
    if (row[1] != 0.0) *dr += row[1] * (pose[5] * c - pose[4] * s);
    return row;
}

/* Add what rates of deviations of a ball do to those of the bearing, EHD_PAIR_BY_RATES; see ehd_ball_force. */
static void ball_add_rates(const double own[4], double way, double y, double z, double c, double s, double place,
                           double *out) {
    const double along = way * own[0];
    out[0] -= along;
    out[1] -= c * own[1];
    out[2] -= s * own[1];
    out[4] -= y * along - place * s * own[1];
    out[5] -= z * along + place * c * own[1];
    out[EHD_PAIR_OWN] += own[2];
    out[EHD_PAIR_AT_REST] += own[3];
}

#define BALL_PRESSED 1e-6 /* overlap of grooves from which a ball is pressed by them [m] */

/* Whether a ball between two grooves at d is pressed: 0 to 1. */
static double ball_pressed(const ehd_ball_data *of, double dx, double dr) {
    const double overlap = sqrt(dx * dx + dr * dr) - of->shape.inner_arm - of->shape.outer_arm;
    return least(most(overlap / BALL_PRESSED, 0.0), 1.0);
}

/* What is wrong about a pose: 0, EHD_BALL_NOT_FINITE or EHD_BALL_TOO_FAR. */
static int ball_problem(const ehd_ball_data *of, const double *pose) {
    const double far = of->shape.most_travel, tilt = of->shape.most_tilt;
    double total = fabs(of->cage_angle) + fabs(of->drive.inner) + fabs(of->drive.outer);
    for (int i = 0; i < 6; i++) total += fabs(pose[i]);
    if (!(total <= DBL_MAX)) return EHD_BALL_NOT_FINITE;
    if (!(fabs(pose[0]) <= far && fabs(pose[1]) <= far && fabs(pose[2]) <= far)) return EHD_BALL_TOO_FAR;
    return fabs(pose[4]) <= tilt && fabs(pose[5]) <= tilt ? 0 : EHD_BALL_TOO_FAR;
}

/* Force on the inner ring at rest [N], [N m], and -df/dpose, -df/dvelocity by rows (6, 6); starts and found (balls,) of
 * all balls. Returns the number of loaded balls, or what is wrong, EHD_BALL_... */
int ehd_ball_force(const ehd_ball_data *of, const double *pose, ehd_ball_start *start, ehd_ball_found *found,
                   double *force, double *stiffness, double *damping) {
    const int problem = ball_problem(of, pose);
    if (problem) return problem;
    const double turn_c = cos(of->cage_angle), turn_s = sin(of->cage_angle), arm = of->shape.arm;
    const int dry = of->inner.rows == 0 && of->outer.rows == 0;
    const int still = of->drive.inner == 0.0 && of->drive.outer == 0.0 && !(fabs(of->drive.cage) > 0.0);
    const double share = dry && still ? ball_share(&of->inner, &of->outer) : -1.0;
    ball_given on = {0.0, 0.0, of->shape.inner_arm, of->shape.outer_arm, of->rest, of->drive, &of->inner, &of->outer,
                     1.0 / of->inner.scale, 1.0 / of->inner.step, 1.0 / of->outer.scale, 1.0 / of->outer.step,
                     NULL, NULL, NULL, NULL, of->shape.radial > 0.0};
    double by_rates[4];
    int loaded = 0;
    memset(force, 0, 6 * sizeof *force);
    memset(stiffness, 0, 36 * sizeof *stiffness);
    memset(damping, 0, 36 * sizeof *damping);
    if (of->added) memset(of->by_rates, 0, EHD_PAIR_BY_RATES * sizeof *of->by_rates);
    for (int64_t j = 0; j < of->balls; j++) {
        const double c = turn_c * of->cosine[j] - turn_s * of->sine[j];
        const double s = turn_s * of->cosine[j] + turn_c * of->sine[j];
        ehd_ball_found *ball = &found[j];
        const double *row = ball_groove(of, j, pose, c, s, &on.dx, &on.dr), way = row[0], place = row[1];
        if (row[3] != 0.0) {
            double x, r;
            ball_groove(of, j + (int64_t)row[3], pose, c, s, &x, &r);
            const double own = ball_pressed(of, on.dx, on.dr), part = own / most(own + ball_pressed(of, x, r), 1.0);
            on.drive.centrifugal = part * of->drive.centrifugal;
            on.drive.gyroscopic = part * of->drive.gyroscopic;
        }
        if (of->held) {
            on.held_inner = of->held + 2 * EHD_BALL_MEMORY * j;
            on.held_outer = of->held + (2 * j + 1) * EHD_BALL_MEMORY;
        }
        if (of->added) {
            on.added = of->added + 4 * j;
            on.inner_arm = of->shape.inner_arm - on.added[0];
            on.outer_arm = of->shape.outer_arm - on.added[2];
            on.by_rates = memset(by_rates, 0, sizeof by_rates);
        }
        if (!ball_place(&on, share, &start[j], ball)) return EHD_BALL_NO_BALANCE;
        if (of->added) ball_add_rates(by_rates, way, arm * s, -arm * c, c, s, place, of->by_rates);
        if (ball->load[0] <= 0.0) continue;
        const double y = arm * s, z = -arm * c, along = way * ball->force[0];
        loaded++;
        force[0] -= along;
        force[1] -= c * ball->force[1];
        force[2] -= s * ball->force[1];
        force[4] -= y * along;
        force[5] -= z * along;
        const double *k = ball->stiffness, *d = ball->damping;
        const double spring[4] = {k[0], way * k[1], way * k[2], k[3]}, damper[4] = {d[0], way * d[1], way * d[2], d[3]};
        ball_add(spring, c, s, y, z, stiffness);
        ball_add(damper, c, s, y, z, damping);
        if (place == 0.0) continue;
        force[4] += place * s * ball->force[1];
        force[5] -= place * c * ball->force[1];
        ball_add_place(spring, c, s, y, z, place, stiffness);
        ball_add_place(damper, c, s, y, z, place, damping);
    }
    return loaded;
}

/* The same, once more from nothing where no balance was found; balls start from nothing after a failure. */
int ehd_ball_force_surely(const ehd_ball_data *of, const double *pose, ehd_ball_start *start, ehd_ball_found *found,
                          double *force, double *stiffness, double *damping) {
    int loaded = ehd_ball_force(of, pose, start, found, force, stiffness, damping);
    if (loaded == EHD_BALL_NO_BALANCE) {
        memset(start, 0, (size_t)of->balls * sizeof *start);
        loaded = ehd_ball_force(of, pose, start, found, force, stiffness, damping);
    }
    if (loaded < 0) memset(start, 0, (size_t)of->balls * sizeof *start);
    return loaded;
}

/* Write the contact angles, by the directions of the contacts. */
void ehd_ball_angles(int64_t balls, ehd_ball_found *found) {
    for (int64_t j = 0; j < balls; j++) {
        found[j].angle[0] = atan2(found[j].inner[0], found[j].inner[1]);
        found[j].angle[1] = atan2(found[j].outer[0], found[j].outer[1]);
    }
}

/* Speed of the cage [rad/s]: that of the balls by their loads at the inner raceway; idle: of a bearing without load. */
double ehd_ball_mean_speed(int64_t balls, const ehd_ball_found *found, double idle) {
    double load = 0.0, total = 0.0;
    for (int64_t j = 0; j < balls; j++) {
        load += found[j].load[0];
        total += found[j].load[0] * found[j].speed;
    }
    return load > 0.0 ? total / load : idle;
}

/* F_c and t of a ball at a speed around the axis [N], and their derivatives by it [N s]; out (4,). */
void ehd_ball_loads(const ehd_ball_drive *drive, double speed, double *out) { ball_loads(drive, speed, out); }
