/* ---------------------------------------------------------------------------------------------------------------------
 * What bearings of five freedoms answer in runs: x, y, z, theta_y, theta_z of the inner ring against the outer one
 * ------------------------------------------------------------------------------------------------------------------ */

#define PAIR_FELT 5

/* Displacements that a bearing feels. */
static const int PAIR_PLACE[PAIR_FELT] = {0, 1, 2, 4, 5};

/* Pose (6,) of an inner ring by what its bearing feels. */
static void pair_read_pose(int64_t first, double offset, const double *motion, double *pose) {
    pose[3] = 0.0;
    for (int p = 0; p < PAIR_FELT; p++) pose[PAIR_PLACE[p]] = motion[first + p];
    pose[0] += offset;
}

/* Moment that a bearing asks of its cage [N m], by pose and force at rest. */
static double pair_turned_by(const double *pose, const double *force) {
    return pose[1] * force[2] - pose[2] * force[1] + (pose[4] * force[5] - pose[5] * force[4]);
}

/* Write the answer of a bearing by its force at rest, stiffness and damping (6, 6), and both powers (2,): what it
 * dissipates, and what deviations and its cage bring in, which turns by `turn` of the system. by_rates: of
 * EHD_PAIR_BY_RATES, or null without deviations. */
static void pair_answer_port(int64_t first, double turn, const ehd_moment *at, const double *motion, const double *pose,
                             const double *force, const double *stiffness, const double *damping,
                             const double *by_rates, ehd_answers *answers, double *powers) {
    const double *rate = motion + answers->m + first;
    double dissipated = 0.0;
    for (int p = 0; p < PAIR_FELT; p++) {
        const int row = PAIR_PLACE[p];
        double total = force[row], *slopes = answers->slopes + (first + p) * answers->m + first;
        for (int q = 0; q < PAIR_FELT; q++) {
            const int at_column = 6 * row + PAIR_PLACE[q];
            const double slowed = damping[at_column] * rate[q];
            total -= slowed;
            dissipated += rate[p] * slowed;
            slopes[q] = at->by_q * stiffness[at_column] + at->by_v * damping[at_column];
        }
        answers->force[first + p] = total;
    }
    powers[0] = dissipated;
    powers[1] = pair_turned_by(pose, force) * turn * at->speed;
    if (by_rates) {
        double taken = 0.0;
        for (int p = 0; p < PAIR_FELT; p++) {
            answers->force[first + p] += by_rates[PAIR_PLACE[p]];
            taken -= rate[p] * by_rates[PAIR_PLACE[p]];
        }
        powers[0] += 2.0 * taken + by_rates[EHD_PAIR_OWN];
        powers[1] += by_rates[EHD_PAIR_AT_REST] + taken + by_rates[EHD_PAIR_OWN];
    }
}

/* Numbers that are kept of a rolling element over a step: places and forces for the work of speed, and of each contact
 * approaches and what its memory adds to the load, two numbers each of lines. */
enum { EHD_PAIR_CONTACTS = 8, EHD_PAIR_LAST = 16 };

/* Bearings of a kind, one row each; rows of rolling elements are as long as the longest. The blocks of kinds begin with
 * it. */
typedef struct ehd_pair_block {
    int64_t count, longest;
    const int64_t *firsts, *places, *films_of; /* (count,): first felt, place among elements, film */
    const int64_t *counts, *slices;            /* (count,): rolling elements; slices of a contact, 1 of points */
    const double *starts, *turns, *offsets; /* angle of the first one [rad], cage by system, axial offset [m] */
    double *powers;                         /* (count, 2): what it dissipates, what the turning cage brings in [W] */
    double *last;                           /* (count, longest, EHD_PAIR_LAST): of the last step, see the work of a kind */
    double *times, *works;                  /* (count,): its time [s], power of speed by then [W] */
    double *spent;                          /* (count,): what films with memory took up over the last step [J] */
    const int64_t *memories;                /* (count,): where a bearing's memory begins; < 0 without one */
    double *memory;                         /* memory of the contacts of all bearings, see pair_law.h */
    double *clock;                          /* (2,): end of the last step, and of that for which they hold [s] */
    const ehd_pair_films *films;
    const ehd_deviations *deviations;       /* (count,): from the form; null where no bearing has any */
} ehd_pair_block;

EHD_SIZE_OF(ehd_pair_block)

/* Memory of the contacts of a bearing; null without one. */
static double *pair_memory_of(const ehd_pair_block *all, int64_t b) {
    return all->memories[b] < 0 ? NULL : all->memory + all->memories[b];
}

/* Bring laws in use to the place of a step, and write what contacts with memory hold over it. */
static void pair_begin(const ehd_pair_block *all, const ehd_moment *at) {
    const ehd_pair_films *films = all->films;
    for (int64_t film = 0; film < films->films; film++) pair_blend(films, film, at->step);
    if (all->clock[1] == at->time) return;
    all->clock[1] = at->time;
    for (int64_t b = 0; b < all->count; b++)
        if (all->memories[b] >= 0)
            ehd_pair_hold(2 * all->counts[b], all->slices[b], films->columns - 1, films->shorter,
                          at->time - all->clock[0], pair_memory_of(all, b));
}

/* Note the works of a step of a bearing: of speed, and of what memory adds to loads, of which springs hold `rise` [J]. */
static void pair_note(const ehd_pair_block *all, int64_t b, const ehd_moment *at, const double works[2], double rise) {
    const double step = at->time - all->times[b];
    all->times[b] = at->time;
    all->works[b] = step > 0.0 ? works[0] / step : 0.0;
    all->spent[b] = step > 0.0 ? works[1] - rise : 0.0;
}

/* Write what bearings dissipate, and what cage, deviations and speed bring in. */
static void pair_powers(const ehd_pair_block *all, double *out) {
    for (int64_t b = 0; b < all->count; b++) {
        double *row = out + 3 * all->places[b];
        row[0] = all->powers[2 * b];
        row[1] = all->powers[2 * b + 1] + all->works[b];
        row[2] = all->spent[b];
    }
}

/* Note the end of a step that was made. */
static void pair_made(const ehd_pair_block *all, const ehd_moment *at) {
    all->clock[0] = at->time;
    all->clock[1] = NAN;
}
