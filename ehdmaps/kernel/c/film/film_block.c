/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings whose films have a memory, in runs: each slice has a state, which goes on when a step is made
 *
 * The first question at the end of a new step begins it, with the states of the last step that was made, here or in
 * Python. Questions at other motions, and steps that are tried again with another length, leave these alone. Tables over
 * the speed are mixed as often as slices read them, see ehd_film_course.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Times of a run: end of the last step that was made [s]; its length [s], 0 if there was none; end of the step that is
 * tried [s], NaN before that is known; and how many were made. */
enum { CLOCK_ACCEPTED, CLOCK_LAST, CLOCK_TRIED, CLOCK_STEPS };

typedef struct ehd_film_block {
    ehd_rings rings;
    ehd_film_course course;
    int64_t nodes;          /* tables of each film */
    int64_t most;           /* slices of all rollers together, of the bearing that has most */
    const int64_t *strict;  /* (bearings): whether a law refuses loads above its map */
    double *memory;         /* (bearings, sides, SLICE_ROWS * most): see film_slices.c */
    double *states;         /* (bearings, sides, 2 * most): loads and slopes of the last answer */
    double *approaches;     /* (most): work space [m] */
    double *work;           /* (2 * most): work space */
    double *spent;          /* (bearings): what the films of each took up over the last step [J] */
    double *clock;          /* (4) */
    const ehd_film_table *tables; /* (films, nodes): over the speed */
    ehd_film_table *mixed;  /* (films): in use */
    double *in_use;         /* (films, 2): node and weight of those; negative for none, NaN to be mixed at its turn */
} ehd_film_block;

EHD_SIZE_OF(ehd_film_block)

int ehd_film_block_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers);
void ehd_film_block_accept(void *data, const ehd_moment *at);
void ehd_film_block_powers(void *data, const ehd_moment *at, const double *motion, const ehd_answers *answers,
                           double *out);

/* Bring the table in use to a place between two nodes, straight in ln of the speed, number by number. */
static void mix_film(ehd_film_block *block, int64_t film, int64_t node, double weight) {
    double *in_use = block->in_use + 2 * film, *out = (double *)(block->mixed + film);
    if (in_use[0] == (double)node && in_use[1] == weight) return;
    in_use[0] = (double)node;
    in_use[1] = weight;
    const ehd_film_table *tables = block->tables + film * block->nodes;
    const double *low = (const double *)(tables + node);
    const double *high = (const double *)(tables + (weight > 0.0 ? (node + 1) % block->nodes : node));
    const size_t count = sizeof(ehd_film_table) / sizeof(double);
    for (size_t i = 0; i < count; i++) out[i] = low[i] + weight * (high[i] - low[i]);
}

static int64_t film_slices_of(const ehd_film_block *block, int64_t b) {
    return block->rings.rollers[b] * block->rings.slices[b];
}

static double *film_memory_of(const ehd_film_block *block, int64_t b, int64_t side) {
    return block->memory + (b * block->rings.sides + side) * SLICE_ROWS * block->most;
}

/* Loads of the slices of one side, which are followed by their slopes. */
static double *film_loads_of(const ehd_film_block *block, int64_t b, int64_t side) {
    return block->states + (b * block->rings.sides + side) * 2 * block->most;
}

static int64_t film_number_of(const ehd_film_block *block, int64_t b, int64_t side) {
    return block->rings.films_of[b * block->rings.sides + side];
}

/* Begin a step: tables, and what slices start from. */
static void begin_films(ehd_film_block *block, const ehd_moment *at) {
    double *clock = block->clock;
    const ehd_film_course *course = &block->course;
    const int64_t steps = (int64_t)clock[CLOCK_STEPS], kept = course->kept[at->step], first = at->step * course->films;
    clock[CLOCK_TRIED] = at->time;
    for (int64_t f = 0; f < course->films; f++)
        if (block->in_use[2 * f] < 0.0 || steps % kept == 0)
            mix_film(block, f, course->nodes[first + f], course->weights[first + f]);
    const double growth = clock[CLOCK_LAST] > 0.0 ? (at->time - clock[CLOCK_ACCEPTED]) / clock[CLOCK_LAST] : 0.0;
    for (int64_t b = 0; b < block->rings.count; b++)
        for (int64_t side = 0; side < block->rings.sides; side++)
            begin_slices(block->mixed + film_number_of(block, b, side), growth, steps, kept, film_slices_of(block, b),
                         film_memory_of(block, b, side));
}

/* Loads and slopes of the slices of a side at their approaches; whether a load is above the map. */
static int find_loads(ehd_film_block *block, int64_t b, int64_t side, const ehd_moment *at) {
    const int64_t n = film_slices_of(block, b);
    const ehd_film_table *film = block->mixed + film_number_of(block, b, side);
    const weights step = weights_of(at->time - block->clock[CLOCK_ACCEPTED], block->clock[CLOCK_LAST]);
    double *loads = film_loads_of(block, b, side);
    slice_loads(film, step, n, film_memory_of(block, b, side), block->approaches, loads, loads + block->most,
                block->work);
    for (int64_t i = 0; i < n; i++)
        if (loads[i] > film->highest) return 1;
    return 0;
}

/* Sums over the slices of a roller, times the length of a slice; slopes as they are asked for. */
static ring_contact film_contact(const ehd_film_block *block, int64_t b, int64_t side, int64_t j, const ehd_moment *at) {
    const double *loads = film_loads_of(block, b, side) + j * block->rings.slices[b];
    const double length = ring_sizes(&block->rings, b)[RING_SLICE_LENGTH], slope = at->by_q * length;
    const ring_contact sum = sum_slices(&block->rings, b, loads, loads + block->most);
    const ring_contact found = {sum.load * length, sum.moment * length, sum.flat * slope, sum.mixed * slope,
                                sum.tilted * slope};
    return found;
}

/* Write the answer of a bearing with massless rollers; 1 with a load above the map, negative without an answer. */
static int films_on_rings(ehd_film_block *block, int64_t b, const ehd_moment *at, const double *motion,
                          ehd_answers *answers) {
    const ehd_rings *rings = &block->rings;
    const double *felt = motion + rings->firsts[b];
    const double *x = rings->positions + b * rings->most_slices, *profile = rings->profiles + b * rings->most_slices;
    const double *added = deviations_of(rings->deviations, b, at);
    double cage[2];
    ring_cage(rings, b, at->angle, cage);
    if (!ring_within(rings, b, felt, felt + answers->m, cage)) return -1;
    for (int64_t j = 0; j < rings->rollers[b]; j++) {
        ring_roller roller = massless_roller(rings, b, j, cage, felt);
        if (added) roller.approach[0] += added[4 * j] + added[4 * j + 2];
        double *row = block->approaches + j * rings->slices[b];
        for (int64_t i = 0; i < rings->slices[b]; i++) row[i] = roller.approach[0] + x[i] * roller.tilt - profile[i];
    }
    const int above = find_loads(block, b, 0, at);
    begin_massless(rings, b, answers);
    for (int64_t j = 0; j < rings->rollers[b]; j++) {
        const ring_roller roller = massless_roller(rings, b, j, cage, felt);
        const ring_contact contact = film_contact(block, b, 0, j, at);
        add_massless(rings, b, &roller, &contact, answers);
    }
    return above;
}

/* The same of a bearing whose rollers are bodies, side by side. */
static int films_on_bodies(ehd_film_block *block, int64_t b, const ehd_moment *at, const double *motion,
                           ehd_answers *answers) {
    const ehd_rings *rings = &block->rings;
    const double *x = rings->positions + b * rings->most_slices, *profile = rings->profiles + b * rings->most_slices;
    const double *added = deviations_of(rings->deviations, b, at);
    double cage[2];
    int above = 0;
    ring_cage(rings, b, at->angle, cage);
    begin_bodies(rings, b, at, answers);
    for (int64_t side = 0; side < 2; side++) {
        for (int64_t j = 0; j < rings->rollers[b]; j++) {
            ring_roller roller = body_roller(rings, b, j, cage, motion);
            if (added) roller.approach[side] += added[4 * j + 2 * side];
            double *row = block->approaches + j * rings->slices[b];
            if (!roller_within(&roller, ring_sizes(rings, b))) return -1;
            for (int64_t i = 0; i < rings->slices[b]; i++)
                row[i] = roller.approach[side] + x[i] * roller.tilt - 0.5 * profile[i];
        }
        above |= find_loads(block, b, side, at);
        for (int64_t j = 0; j < rings->rollers[b]; j++) {
            const ring_roller roller = body_roller(rings, b, j, cage, motion);
            const ring_contact contact = film_contact(block, b, side, j, at);
            add_body(rings, b, j, side, &roller, &contact, answers);
        }
    }
    return above;
}

int ehd_film_block_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    ehd_film_block *block = data;
    const ehd_rings *rings = &block->rings;
    if (block->clock[CLOCK_TRIED] != at->time) begin_films(block, at);
    for (int64_t b = 0; b < rings->count; b++) {
        int64_t status = rings->sides == 1 ? films_on_rings(block, b, at, motion, answers)
                                           : films_on_bodies(block, b, at, motion, answers);
        if (status < 0) return EHD_NO_SOLUTION;
        if (status > 0 && block->strict[b]) return EHD_IN_PYTHON;
        for (int64_t side = 0; side < rings->sides; side++) {
            const int64_t place = at->step * block->course.films + film_number_of(block, b, side);
            const int64_t outside = block->course.outside[place];
            status = outside > status ? outside : status;
        }
        answers->outside[rings->places[b]] += status;
    }
    return EHD_FOUND;
}

void ehd_film_block_accept(void *data, const ehd_moment *at) {
    ehd_film_block *block = data;
    const ehd_rings *rings = &block->rings;
    double *clock = block->clock;
    for (int64_t b = 0; b < rings->count; b++) {
        const int64_t n = film_slices_of(block, b);
        block->spent[b] = 0.0;
        for (int64_t side = 0; side < rings->sides; side++) {
            const ehd_film_table *film = block->mixed + film_number_of(block, b, side);
            double *memory = film_memory_of(block, b, side), *loads = film_loads_of(block, b, side);
            block->spent[b] += spent_by_slices(film, n, memory, loads, rings->slices[b],
                                               rings->weights + b * rings->most_slices) *
                               ring_sizes(rings, b)[RING_SLICE_LENGTH];
            commit_slices(film, n, memory, loads);
        }
    }
    clock[CLOCK_LAST] = at->time - clock[CLOCK_ACCEPTED];
    clock[CLOCK_ACCEPTED] = at->time;
    clock[CLOCK_STEPS] += 1.0;
}

/* Power that deviations bring into the films of a bearing by the loads of the last answer [W]. */
static double power_of_deviations(const ehd_film_block *block, int64_t b, const ehd_moment *at) {
    const double *added = deviations_of(block->rings.deviations, b, at);
    double total = 0.0;
    for (int64_t side = 0; added && side < block->rings.sides; side++)
        for (int64_t j = 0; j < block->rings.rollers[b]; j++) {
            const double *own = added + 4 * j, rate = block->rings.sides == 1 ? own[1] + own[3] : own[2 * side + 1];
            total += film_contact(block, b, side, j, at).load * rate;
        }
    return total;
}

void ehd_film_block_powers(void *data, const ehd_moment *at, const double *motion, const ehd_answers *answers,
                           double *out) {
    const ehd_film_block *block = data;
    const ehd_rings *rings = &block->rings;
    for (int64_t b = 0; b < rings->count; b++) {
        double *row = out + 3 * rings->places[b];
        row[0] = 0.0;
        row[1] = ring_turned_by(rings, b, motion, answers) * rings->cage_rates[b] * at->speed +
                 ring_outward_power(rings, b, at, motion, answers->m) + power_of_deviations(block, b, at);
        row[2] = block->spent[b];
    }
}
