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

/* Bearings, one row each; rows of rollers are as long as the longest, `longest`. */
typedef struct ehd_taper_block {
    int64_t count, longest;
    const ehd_taper_data *bearings;            /* (count,) */
    const int64_t *firsts, *places, *films_of; /* first felt, place among elements, film */
    const double *starts, *turns, *offsets;    /* angle of the first roller [rad], cage by system, axial offset [m] */
    const double *fastest;                     /* (count,): largest speed of the system [rad/s] */
    const double *lines;                       /* (count, 2): C of dry cone and cup [N/m^(10/9)] */
    const double *loads;                       /* (count, 2): F over the square of the speed [N s2], [N m s2] */
    ehd_taper_roller *rollers;                 /* (count, longest): of the last answer */
    double *powers;          /* (count, 2): what it dissipates, what its turning cage brings in [W] */
    double *last;            /* (count, longest, 4): see ehd_taper_speed_work */
    double *times, *works;   /* (count,): time of the last step [s], work of speed by then [W] */
    const int64_t *memories; /* (count,): where a bearing's memory begins; < 0 without one */
    double *memory;          /* memory of the slices of all bearings, see taper.h */
    double *clock;           /* (2,): end of the last step, and of that for which they hold [s] */
    const ehd_pair_films *films;
} ehd_taper_block;

EHD_SIZE_OF(ehd_taper_block)

/* Work of centrifugal loads and gyroscopic moments (2,) on rollers since the last call [J], by the trapezoidal rule;
 * last (rollers, 4): places of that call, radial [m] and turned [rad], and its loads [N], [N m]; written. */
double ehd_taper_speed_work(int64_t count, const ehd_taper_roller *rollers, const double *loads, double *last) {
    double work = 0.0;
    for (int64_t j = 0; j < count; j++, last += 4)
        for (int i = 0; i < 2; i++) {
            const double place = rollers[j].place[1 + i];
            work += 0.5 * (loads[i] + last[2 + i]) * (place - last[i]);
            last[i] = place;
            last[2 + i] = loads[i];
        }
    return work;
}

/* Memory of the slices of a bearing; null without one. */
static double *taper_memory_of(const ehd_taper_block *of, int64_t b) {
    return of->memories[b] < 0 ? NULL : of->memory + of->memories[b];
}

/* Laws of cone and cup at the speed of the step. */
static void taper_laws_of(const ehd_taper_block *of, int64_t b, ehd_pair_law law[2]) {
    for (int side = 0; side < 2; side++) {
        law[side] = pair_law_of(of->films, of->films_of[b], side);
        if (law[side].rows > 0) continue;
        law[side].coefficient = of->lines[2 * b + side];
        law[side].damping = of->bearings[b].damping;
        law[side].damping_time = of->bearings[b].damping_time;
    }
}

/* Springs of films with memory at the speed of the step. */
static ehd_taper_springs taper_springs_of(const ehd_pair_films *films, int64_t film) {
    const int64_t node = (int64_t)films->in_use[2 * film], size = films->rows * films->columns;
    const double weight = films->in_use[2 * film + 1];
    const double *slow = films->springs + 2 * size * (film * films->slots + node);
    const double *fast = films->springs + 2 * size * (film * films->slots + pair_after(films, node, weight));
    const ehd_taper_springs found = {{slow, slow + size}, {fast, fast + size}, weight};
    return found;
}

/* Write the answer of a bearing; what ehd_taper_force returns. */
static int taper_on_port(const ehd_taper_block *of, int64_t b, const ehd_moment *at, const double *motion,
                         ehd_answers *answers) {
    const int64_t first = of->firsts[b];
    const double square = at->speed * at->speed, angle = of->starts[b] + of->turns[b] * at->angle;
    const double loads[3] = {0.0, of->loads[2 * b] * square, of->loads[2 * b + 1] * square};
    double pose[6];
    ehd_pair_law law[2];
    ehd_taper_answer own;
    if (!(fabs(at->speed) <= of->fastest[b])) return EHD_TAPER_TOO_FAR;
    pair_read_pose(first, of->offsets[b], motion, pose);
    taper_laws_of(of, b, law);
    const int found = ehd_taper_force(of->bearings + b, law, pose, angle, loads, taper_memory_of(of, b),
                                      of->rollers + b * of->longest, &own);
    if (found >= 0)
        pair_answer_port(first, of->turns[b], at, motion, pose, own.force, own.stiffness[0], own.damping[0], answers,
                         of->powers + 2 * b);
    return found;
}

int ehd_taper_block_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    const ehd_taper_block *of = data;
    for (int64_t film = 0; film < of->films->films; film++) pair_blend(of->films, film, at->step);
    if (of->clock[1] != at->time) {
        of->clock[1] = at->time;
        for (int64_t b = 0; b < of->count; b++)
            if (of->memories[b] >= 0)
                ehd_taper_hold(of->bearings[b].rollers, of->bearings[b].slices, at->time - of->clock[0],
                               taper_memory_of(of, b));
    }
    for (int64_t b = 0; b < of->count; b++) {
        ehd_taper_roller *rollers = of->rollers + b * of->longest;
        const int found = taper_on_port(of, b, at, motion, answers);
        if (found < 0) {
            memset(rollers, 0, (size_t)of->longest * sizeof *rollers);
            return found == EHD_TAPER_TOO_FAR ? EHD_IN_PYTHON : EHD_NO_SOLUTION;
        }
        if (ehd_taper_largest(of->bearings[b].rollers, rollers) > of->films->highest[of->films_of[b]])
            answers->outside[of->places[b]] += 1;
    }
    return EHD_FOUND;
}

/* Take note of a step that was made: places of the rollers for the work of their loads, films with memory. */
void ehd_taper_block_accept(void *data, const ehd_moment *at) {
    const ehd_taper_block *of = data;
    for (int64_t b = 0; b < of->count; b++) {
        const ehd_taper_data *bearing = of->bearings + b;
        const ehd_taper_roller *rollers = of->rollers + b * of->longest;
        const double square = at->speed * at->speed, step = at->time - of->times[b];
        const double loads[2] = {of->loads[2 * b] * square, of->loads[2 * b + 1] * square};
        const double work = ehd_taper_speed_work(bearing->rollers, rollers, loads, of->last + 4 * b * of->longest);
        of->times[b] = at->time;
        of->works[b] = step > 0.0 ? work / step : 0.0;
        if (of->memories[b] >= 0) {
            const ehd_taper_springs springs = taper_springs_of(of->films, of->films_of[b]);
            ehd_pair_law law[2];
            taper_laws_of(of, b, law);
            ehd_taper_go_on(bearing, law, &springs, rollers, taper_memory_of(of, b));
        }
    }
    of->clock[0] = at->time;
    of->clock[1] = NAN;
}

/* Write what contacts dissipate, and what cage and speed bring in. */
void ehd_taper_block_powers(void *data, const ehd_moment *at, const double *motion, const ehd_answers *answers,
                            double *out) {
    const ehd_taper_block *of = data;
    (void)at;
    (void)motion;
    (void)answers;
    for (int64_t b = 0; b < of->count; b++) {
        out[3 * of->places[b]] = of->powers[2 * b];
        out[3 * of->places[b] + 1] = of->powers[2 * b + 1] + of->works[b];
    }
}
