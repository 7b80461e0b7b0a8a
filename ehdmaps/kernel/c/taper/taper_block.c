/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings of tapered rollers, or of cylindrical ones between ribs, in runs: what they answer to a motion, films with
 * memory, powers
 *
 * A bearing feels x, y, z, theta_y, theta_z of its inner ring against the outer one. Contacts at rest store U, the sum
 * of the integrals of their loads over the approaches. With the balance of each roller
 *
 *     dU/dt = f . dD/dt + F . dV/dt,
 *
 * f the forces of the ring on its rollers: the first part is the work of the ring and of the turning cage, the second
 * one that of speed.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Bearings, one row each. */
typedef struct ehd_taper_block {
    ehd_pair_block all;
    const ehd_taper_data *bearings; /* (count,) */
    const double *fastest;          /* (count,): largest speed of the system [rad/s] */
    const double *loads;            /* (count, 2): F over the square of the speed [N s2], [N m s2] */
    ehd_taper_roller *rollers;      /* (count, longest): of the last answer */
    double *approaches;             /* (slices of a roller at most,): work space [m] */
} ehd_taper_block;

EHD_SIZE_OF(ehd_taper_block)

/* Works since the last call [J], by the trapezoidal rule: of centrifugal loads and gyroscopic moments, loads (2,), and of what
 * memory adds to the loads of lines; works (2,), written. last (rollers, EHD_PAIR_LAST): places, radial [m] and turned [rad],
 * and their loads [N], [N m]; of both lines approaches [m], turns [rad], and what is added to the loads; written. */
void ehd_taper_works(const ehd_taper_data *data, const ehd_taper_roller *rollers, const double *loads, double *last,
                     double *works) {
    works[0] = works[1] = 0.0;
    for (int64_t j = 0; j < data->rollers; j++, last += EHD_PAIR_LAST) {
        double now[EHD_PAIR_LAST] = {rollers[j].place[1], rollers[j].place[2], loads[0], loads[1]};
        for (int side = 0; side < 2; side++) {
            double *line = now + EHD_PAIR_CONTACTS + 2 * side;
            line[0] = taper_approach(data, rollers + j, side, line + 1);
            memcpy(line + 4, rollers[j].held[side], sizeof rollers[j].held[side]);
        }
        for (int i = 0; i < 2; i++) works[0] += 0.5 * (now[2 + i] + last[2 + i]) * (now[i] - last[i]);
        for (int i = EHD_PAIR_CONTACTS; i < EHD_PAIR_CONTACTS + 4; i++)
            works[1] += 0.5 * (now[4 + i] + last[4 + i]) * (now[i] - last[i]);
        memcpy(last, now, sizeof now);
    }
}

/* Write the answer of a bearing; what ehd_taper_force returns. */
static int taper_on_port(const ehd_taper_block *of, int64_t b, const ehd_moment *at, const double *motion,
                         ehd_answers *answers) {
    const int64_t first = of->all.firsts[b];
    const double square = at->speed * at->speed, angle = of->all.starts[b] + of->all.turns[b] * at->angle;
    const double loads[3] = {0.0, of->loads[2 * b] * square, of->loads[2 * b + 1] * square};
    double pose[6];
    const ehd_pair_law law[2] = {pair_law_of(of->all.films, of->all.films_of[b], 0),
                                 pair_law_of(of->all.films, of->all.films_of[b], 1)};
    ehd_taper_answer own;
    ehd_taper_data data = of->bearings[b];
    double by_rates[EHD_PAIR_BY_RATES];
    data.added = deviations_of(of->all.deviations, b, at);
    data.by_rates = data.added ? by_rates : NULL;
    if (!(fabs(at->speed) <= of->fastest[b])) return EHD_TAPER_TOO_FAR;
    pair_read_pose(first, of->all.offsets[b], motion, pose);
    const int found = ehd_taper_force(&data, law, pose, angle, loads, pair_memory_of(&of->all, b),
                                      of->rollers + b * of->all.longest, &own);
    if (found >= 0)
        pair_answer_port(first, of->all.turns[b], at, motion, pose, own.force, own.stiffness[0], own.damping[0],
                         data.by_rates, answers, of->all.powers + 2 * b);
    return found;
}

int ehd_taper_block_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    const ehd_taper_block *of = data;
    pair_begin(&of->all, at);
    for (int64_t b = 0; b < of->all.count; b++) {
        ehd_taper_roller *rollers = of->rollers + b * of->all.longest;
        const int found = taper_on_port(of, b, at, motion, answers);
        if (found < 0) {
            memset(rollers, 0, (size_t)of->all.longest * sizeof *rollers);
            return found == EHD_TAPER_TOO_FAR ? EHD_IN_PYTHON : EHD_NO_SOLUTION;
        }
        if (ehd_taper_largest(of->bearings[b].rollers, rollers) > of->all.films->highest[of->all.films_of[b]])
            answers->outside[of->all.places[b]] += 1;
    }
    return EHD_FOUND;
}

/* Take note of a step that was made: its works, films with memory. */
void ehd_taper_block_accept(void *data, const ehd_moment *at) {
    const ehd_taper_block *of = data;
    for (int64_t b = 0; b < of->all.count; b++) {
        const ehd_taper_data *bearing = of->bearings + b;
        const ehd_taper_roller *rollers = of->rollers + b * of->all.longest;
        const double square = at->speed * at->speed, loads[2] = {of->loads[2 * b] * square, of->loads[2 * b + 1] * square};
        double works[2], rise = 0.0;
        ehd_taper_works(bearing, rollers, loads, of->all.last + EHD_PAIR_LAST * b * of->all.longest, works);
        if (of->all.memories[b] >= 0) {
            const ehd_pair_springs springs = pair_springs_of(of->all.films, of->all.films_of[b]);
            const ehd_pair_law law[2] = {pair_law_of(of->all.films, of->all.films_of[b], 0),
                                         pair_law_of(of->all.films, of->all.films_of[b], 1)};
            rise = ehd_taper_go_on(bearing, law, &springs, rollers, of->approaches, pair_memory_of(&of->all, b));
        }
        pair_note(&of->all, b, at, works, rise);
    }
    pair_made(&of->all, at);
}

void ehd_taper_block_powers(void *data, const ehd_moment *at, const double *motion, const ehd_answers *answers,
                            double *out) {
    (void)at;
    (void)motion;
    (void)answers;
    pair_powers(&((const ehd_taper_block *)data)->all, out);
}
