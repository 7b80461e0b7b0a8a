/* ---------------------------------------------------------------------------------------------------------------------
 * Ball bearings in runs: what they answer to a motion, films with memory, powers
 *
 * A bearing feels x, y, z, theta_y, theta_z of its inner ring against the outer one. Contacts at rest store U, the sum of
 * the integrals of their loads over the approaches; with the balance of each ball
 *
 *     dU/dt = Q_i e_i . dd/dt + (F_c (0, 1) + T) . dv/dt,
 *
 * T the traction: the first part is the work of the ring and of the turning cage, the second one that of speed.
 * ------------------------------------------------------------------------------------------------------------------ */

#define BALL_NEGLIGIBLE 1e-11 /* approach of a dry contact under a centrifugal load that is left out [m] */

/* Ball bearings, one row each; rows of balls are as long as the longest, `longest`. */
typedef struct ehd_ball_block {
    int64_t count, longest;
    const int64_t *firsts, *places, *films_of, *counts; /* first felt, place among elements, film, number of balls */
    const double *starts, *turns, *offsets; /* angle of the first ball [rad], cage by system, axial offset [m] */
    const double *spins;                    /* (count, 2): speeds of the rings by that of the system */
    const ehd_ball_shape *lengths;          /* (count,) */
    const ehd_ball_drive *drives;           /* (count,): at rest */
    const double *cosine, *sine;            /* (count, longest) */
    const double *ways;                     /* (count, longest, 4): rows of ehd_ball_data */
    ehd_ball_start *centres;                /* (count, longest) */
    ehd_ball_found *rows;                   /* the same: of the last answer */
    double *rests;                          /* (count,): approach under the centrifugal load alone [m] */
    double *powers;                         /* (count, 2): what it dissipates, what the turning cage brings in [W] */
    double *last;                           /* (count, longest, 4): centres [m] and forces [N] of the last step */
    double *times, *works;                  /* (count,): its time [s], work of speed by then [W] */
    const int64_t *relaxes;                 /* (count,): whether films have a memory */
    double *held, *passed;                  /* (count, longest, 2, 3), (..., 3, 2): over the step, see ball_hold */
    double *forces, *springs, *approaches;  /* (count, longest, 2, 3), (..., 4), (count, longest, 2): after the last one */
    double *clock;                          /* (2,): end of the last step, and of that for which they hold [s] */
    const double *shorter;                  /* (3,): times of springs over the longest one */
    const ehd_pair_films *films;
} ehd_ball_block;

EHD_SIZE_OF(ehd_ball_block)

/* Write what the contacts with memory hold over a step [s]. */
static void ball_hold_all(const ehd_ball_block *of, double step) {
    for (int64_t b = 0; b < of->count; b++) {
        if (!of->relaxes[b]) continue;
        for (int64_t n = 2 * b * of->longest; n < 2 * (b * of->longest + of->counts[b]); n++)
            ball_hold(of->shorter, step, of->approaches[n], of->springs + 4 * n, of->forces + 3 * n, of->passed + 6 * n,
                      of->held + 3 * n);
    }
}

/* Whether a row of angular contact is beyond its middle, where it has no raceway. */
static int ball_beyond(const ehd_ball_data *of, double x) {
    for (int64_t j = 0; j < of->balls; j++) {
        const double way = of->rows ? of->rows[4 * j] : 1.0;
        if (of->shape.axial * (of->shape.axial + way * x) < 0.0) return 1;
        if (!of->rows) break;
    }
    return 0;
}

/* Write the answer of a bearing; what ehd_ball_force returns. */
static int ball_on_ring(const ehd_ball_block *of, int64_t b, const ehd_moment *at, const double *motion,
                        ehd_answers *answers) {
    const int64_t first = of->firsts[b], row = b * of->longest;
    double pose[6], force[6], stiffness[36], damping[36], loads[4];
    ehd_ball_data data;
    data.shape = of->lengths[b];
    pair_read_pose(first, of->offsets[b], motion, pose);
    data.inner = pair_law_of(of->films, of->films_of[b], 0);
    data.outer = pair_law_of(of->films, of->films_of[b], 1);
    data.drive = of->drives[b];
    data.drive.inner = of->spins[2 * b] * at->speed;
    data.drive.outer = of->spins[2 * b + 1] * at->speed;
    ball_loads(&data.drive, of->turns[b] * at->speed, loads);
    data.rest = of->rests[b] = ehd_pair_approach(&data.outer, loads[0], of->rests[b]);
    if (data.inner.rows == 0 && data.rest < BALL_NEGLIGIBLE) data.drive.inner = data.drive.outer = 0.0;
    data.cage_angle = of->starts[b] + of->turns[b] * at->angle;
    data.balls = of->counts[b];
    data.rows = of->ways + 4 * row;
    if (ball_beyond(&data, pose[0])) return EHD_BALL_TOO_FAR;
    data.cosine = of->cosine + row;
    data.sine = of->sine + row;
    data.held = of->relaxes[b] ? of->held + 6 * row : NULL;
    const int found =
        ehd_ball_force_surely(&data, pose, of->centres + row, of->rows + row, force, stiffness, damping);
    if (found >= 0)
        pair_answer_port(first, of->turns[b], at, motion, pose, force, stiffness, damping, answers, of->powers + 2 * b);
    return found;
}

int ehd_ball_block_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    const ehd_ball_block *of = data;
    for (int64_t film = 0; film < of->films->films; film++) pair_blend(of->films, film, at->step);
    if (of->clock[1] != at->time) {
        of->clock[1] = at->time;
        ball_hold_all(of, at->time - of->clock[0]);
    }
    for (int64_t b = 0; b < of->count; b++) {
        const int found = ball_on_ring(of, b, at, motion, answers);
        if (found < 0) return found == EHD_BALL_TOO_FAR ? EHD_IN_PYTHON : EHD_NO_SOLUTION;
        const ehd_ball_found *row = of->rows + b * of->longest;
        double largest = 0.0;
        for (int64_t j = 0; j < of->counts[b]; j++) largest = most(largest, most(row[j].load[0], row[j].load[1]));
        if (largest > of->films->highest[of->films_of[b]]) answers->outside[of->places[b]] += 1;
    }
    return EHD_FOUND;
}

/* Bring contacts with memory to the end of the step that was made. */
void ehd_ball_block_accept(void *data, const ehd_moment *at) {
    const ehd_ball_block *of = data;
    for (int64_t b = 0; b < of->count; b++) {
        if (!of->relaxes[b]) continue;
        for (int64_t j = b * of->longest; j < b * of->longest + of->counts[b]; j++)
            for (int side = 0; side < 2; side++) {
                const int64_t n = 2 * j + side;
                const double approach = of->rows[j].approach[side];
                double after[BALL_SPRINGS + 1];
                pair_springs_of(of->films, of->films_of[b], side, of->rows[j].place[side], after);
                ball_go_on(approach - of->approaches[n], of->springs + 4 * n, after, of->passed + 6 * n,
                           of->forces + 3 * n);
                of->approaches[n] = approach;
            }
    }
    of->clock[0] = at->time;
    of->clock[1] = NAN;
}

/* Work of the centrifugal loads and tractions on balls since the last call [J], by the trapezoidal rule; arm: of the outer
 * groove's centre and that of a ball that touches it; last (balls, 4): centres [m] and forces [N] then, written. */
double ehd_ball_speed_work(int64_t balls, const ehd_ball_found *found, double arm, double *last) {
    double work = 0.0;
    for (int64_t j = 0; j < balls; j++, last += 4) {
        const double reach = arm + found[j].approach[1], sine = found[j].outer[0], t = found[j].traction;
        const double x = reach * sine, r = reach * found[j].outer[1];
        const double along = -t * sine * found[j].outer[1], outward = found[j].centrifugal + t * sine * sine;
        work += 0.5 * ((along + last[2]) * (x - last[0]) + (outward + last[3]) * (r - last[1]));
        last[0] = x;
        last[1] = r;
        last[2] = along;
        last[3] = outward;
    }
    return work;
}

void ehd_ball_block_powers(void *data, const ehd_moment *at, const double *motion, const ehd_answers *answers,
                           double *out) {
    const ehd_ball_block *of = data;
    (void)motion;
    (void)answers;
    for (int64_t b = 0; b < of->count; b++) {
        const int64_t row = b * of->longest;
        const double step = at->time - of->times[b];
        const double work =
            ehd_ball_speed_work(of->counts[b], of->rows + row, of->lengths[b].outer_arm, of->last + 4 * row);
        of->times[b] = at->time;
        of->works[b] = step > 0.0 ? work / step : 0.0;
        out[3 * of->places[b]] = of->powers[2 * b];
        out[3 * of->places[b] + 1] = of->powers[2 * b + 1] + of->works[b];
    }
}

/* What n contacts with memory hold over a step, see ball_hold: approaches (n,), springs (n, 4), forces (n, 3); passed
 * (n, 3, 2) and held (n, 3) are written. */
void ehd_ball_hold(int64_t n, const double *shorter, double step, const double *approaches, const double *springs,
                   const double *forces, double *passed, double *held) {
    for (int64_t i = 0; i < n; i++)
        ball_hold(shorter, step, approaches[i], springs + 4 * i, forces + 3 * i, passed + 6 * i, held + 3 * i);
}

/* Bring n contacts with memory to the end of a step, see ball_go_on: ways of the approaches moved (n,). */
void ehd_ball_go_on(int64_t n, const double *moved, double *springs, const double *after, const double *passed,
                    double *forces) {
    for (int64_t i = 0; i < n; i++)
        ball_go_on(moved[i], springs + 4 * i, after + 4 * i, passed + 6 * i, forces + 3 * i);
}
