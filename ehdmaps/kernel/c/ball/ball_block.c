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

/* Ball bearings, one row each. */
typedef struct ehd_ball_block {
    ehd_pair_block all;
    const double *spins;                    /* (count, 2): speeds of the rings by that of the system */
    const ehd_ball_shape *lengths;          /* (count,) */
    const ehd_ball_drive *drives;           /* (count,): at rest */
    const double *cosine, *sine;            /* (count, longest) */
    const double *ways;                     /* (count, longest, 4): rows of ehd_ball_data */
    ehd_ball_start *centres;                /* (count, longest) */
    ehd_ball_found *rows;                   /* the same: of the last answer */
    double *rests;                          /* (count,): approach under the centrifugal load alone [m] */
} ehd_ball_block;

EHD_SIZE_OF(ehd_ball_block)

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
    const int64_t first = of->all.firsts[b], row = b * of->all.longest;
    double pose[6], force[6], stiffness[36], damping[36], loads[4];
    ehd_ball_data data;
    data.shape = of->lengths[b];
    pair_read_pose(first, of->all.offsets[b], motion, pose);
    data.inner = pair_law_of(of->all.films, of->all.films_of[b], 0);
    data.outer = pair_law_of(of->all.films, of->all.films_of[b], 1);
    data.drive = of->drives[b];
    data.drive.inner = of->spins[2 * b] * at->speed;
    data.drive.outer = of->spins[2 * b + 1] * at->speed;
    ball_loads(&data.drive, of->all.turns[b] * at->speed, loads);
    data.rest = of->rests[b] = ehd_pair_approach(&data.outer, loads[0], of->rests[b]);
    if (data.inner.rows == 0 && data.rest < BALL_NEGLIGIBLE) data.drive.inner = data.drive.outer = 0.0;
    data.cage_angle = of->all.starts[b] + of->all.turns[b] * at->angle;
    data.balls = of->all.counts[b];
    data.rows = of->ways + 4 * row;
    if (ball_beyond(&data, pose[0])) return EHD_BALL_TOO_FAR;
    data.cosine = of->cosine + row;
    data.sine = of->sine + row;
    data.held = pair_memory_of(&of->all, b);
    double by_rates[EHD_PAIR_BY_RATES];
    data.added = deviations_of(of->all.deviations, b, at);
    data.by_rates = data.added ? by_rates : NULL;
    const int found =
        ehd_ball_force_surely(&data, pose, of->centres + row, of->rows + row, force, stiffness, damping);
    if (found >= 0)
        pair_answer_port(first, of->all.turns[b], at, motion, pose, force, stiffness, damping, data.by_rates, answers,
                         of->all.powers + 2 * b);
    return found;
}

int ehd_ball_block_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    const ehd_ball_block *of = data;
    pair_begin(&of->all, at);
    for (int64_t b = 0; b < of->all.count; b++) {
        const int found = ball_on_ring(of, b, at, motion, answers);
        if (found < 0) return found == EHD_BALL_TOO_FAR ? EHD_IN_PYTHON : EHD_NO_SOLUTION;
        const ehd_ball_found *row = of->rows + b * of->all.longest;
        double largest = 0.0;
        for (int64_t j = 0; j < of->all.counts[b]; j++) largest = most(largest, most(row[j].load[0], row[j].load[1]));
        if (largest > of->all.films->highest[of->all.films_of[b]]) answers->outside[of->all.places[b]] += 1;
    }
    return EHD_FOUND;
}

/* Bring the memory of all contacts to the end of the step over which they held; by how much the energy of their springs
 * rises [J]. found: balls in balance at that end. */
double ehd_ball_go_on(int64_t balls, const ehd_pair_law law[2], const ehd_pair_springs *springs,
                      const ehd_ball_found *found, double *memory) {
    double rise = 0.0;
    for (int64_t j = 0; j < balls; j++)
        for (int side = 0; side < 2; side++, memory += EHD_BALL_MEMORY)
            rise += pair_go_on(law + side, springs, EHD_BALL_SPRINGS, side, 1, found[j].approach + side, memory);
    return rise;
}

/* Works since the last call [J], by the trapezoidal rule: of the centrifugal loads and tractions on balls, and of what memory
 * adds to the loads of contacts; works (2,), written. added: of ehd_ball_data; last (balls, EHD_PAIR_LAST): centres v,
 * -(d - v) [m], and the forces then on each [N]; approaches [m] and what is added to the loads [N]; written. Traction at the
 * inner raceway is a force on the ring, too, whose work is counted there: what is left of it goes with d - v. */
void ehd_ball_works(int64_t balls, const ehd_ball_found *found, const ehd_ball_shape *shape, const double *added,
                    double *last, double *works) {
    works[0] = works[1] = 0.0;
    for (int64_t j = 0; j < balls; j++, last += EHD_PAIR_LAST) {
        const ehd_ball_found *of = &found[j];
        const double inner = added ? added[4 * j] : 0.0, outer = added ? added[4 * j + 2] : 0.0;
        const double reach = shape->outer_arm + of->approach[1] - outer, back = -(shape->inner_arm + of->approach[0] - inner);
        const double now[12] = {reach * of->outer[0],
                                reach * of->outer[1],
                                back * of->inner[0],
                                back * of->inner[1],
                                -of->traction * of->outer[1],
                                of->centrifugal + of->traction * of->outer[0],
                                of->inner_traction * of->inner[1],
                                -of->inner_traction * of->inner[0],
                                of->approach[0],
                                of->approach[1],
                                of->held[0],
                                of->held[1]};
        for (int i = 0; i < 4; i++) works[0] += 0.5 * (now[4 + i] + last[4 + i]) * (now[i] - last[i]);
        for (int i = EHD_PAIR_CONTACTS; i < EHD_PAIR_CONTACTS + 2; i++)
            works[1] += 0.5 * (now[2 + i] + last[2 + i]) * (now[i] - last[i]);
        memcpy(last, now, sizeof now);
    }
}

/* Bring contacts with memory to the end of the step that was made, and note its works. */
void ehd_ball_block_accept(void *data, const ehd_moment *at) {
    const ehd_ball_block *of = data;
    for (int64_t b = 0; b < of->all.count; b++) {
        const ehd_ball_found *rows = of->rows + b * of->all.longest;
        double works[2], rise = 0.0;
        ehd_ball_works(of->all.counts[b], rows, of->lengths + b, deviations_of(of->all.deviations, b, at),
                       of->all.last + EHD_PAIR_LAST * b * of->all.longest, works);
        if (of->all.memories[b] >= 0) {
            const int64_t film = of->all.films_of[b];
            const ehd_pair_springs springs = pair_springs_of(of->all.films, film);
            const ehd_pair_law law[2] = {pair_law_of(of->all.films, film, 0), pair_law_of(of->all.films, film, 1)};
            rise = ehd_ball_go_on(of->all.counts[b], law, &springs, rows, pair_memory_of(&of->all, b));
        }
        pair_note(&of->all, b, at, works, rise);
    }
    pair_made(&of->all, at);
}

void ehd_ball_block_powers(void *data, const ehd_moment *at, const double *motion, const ehd_answers *answers,
                           double *out) {
    (void)at;
    (void)motion;
    (void)answers;
    pair_powers(&((const ehd_ball_block *)data)->all, out);
}
