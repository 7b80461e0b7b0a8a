/* Calls the library with tables of many sizes, each in memory of exactly its size, and with numbers of any kind, as many
 * times as the first argument says: whatever is refused must be NaN, whatever is not must be finite, and no load may be
 * negative. Returns the number of a check that fails. */
#include "kernel.c"

#include "hostile_numbers.h"

#include "hostile_balls.h"

/* A table whose loads rise with the approach from nothing; free its arrays. */
static ehd_law_table table_of(double scale) {
    ehd_law_table table = {2 + up_to(5), 2 + up_to(5), 4 + up_to(40), log(0.1), 0.0, 1.0 / 170.0, 0.0, -4.0, 0.0, 0, 0};
    const int64_t rows = table.speeds * table.temperatures;
    double *coefficients = room(2 * rows * table.places), *place = room(2 * rows);
    table.log_speed_step = (double)(table.speeds - 2) / log(100.0);
    table.temperature_step = -(double)(table.temperatures - 2) / (1.0 / 170.0 - 1.0 / 230.0);
    table.temperature_start = 1.0 / (300.0 + 40.0 - 170.0);
    table.step = (double)(table.places - 3) / 12.0;
    for (int64_t row = 0; row < rows; row++) {
        place[2 * row] = scale * (part() - 0.5);
        place[2 * row + 1] = 10.0 / scale;
        double g = -1.0 - part();
        for (int64_t k = 0; k < table.places; k++) {
            g += 200.0 / (double)table.places * part() + 1e-3;
            coefficients[2 * (row * table.places + k)] = g;
            coefficients[2 * (row * table.places + k) + 1] = -8.0 - 2.0 * part();
        }
    }
    table.coefficients = coefficients;
    table.place = place;
    return table;
}

static void free_table(const ehd_law_table *table) {
    free((void *)(uintptr_t)table->coefficients);
    free((void *)(uintptr_t)table->place);
}

static ehd_law_data law_of(void) {
    static const int64_t refused[] = {EHD_NOT_FINITE | EHD_BAD_CENTRIFUGAL | EHD_TOO_FAR | EHD_BAD_ARGUMENT, 127};
    ehd_law_data law = {0};
    const int64_t contacts = up_to(2);
    double *structure = room(3 * contacts), *ends;
    law.refused = refused[any() % 2];
    law.contacts = contacts;
    law.centrifugal = (int64_t)(any() % 2);
    law.film_speed = any() % 2 ? 0.0 : 0.2;
    law.lowest_speed = 0.1;
    law.highest_speed = law.counted_speed = 10.0;
    law.lowest_temperature = law.counted_cold = 310.0;
    law.highest_temperature = law.counted_hot = 390.0;
    law.highest_load = 1e6;
    law.known_load = 1e5;
    law.held_load = 2e6;
    for (int64_t i = 0; i < contacts; i++) {
        structure[3 * i] = (double)(any() % 2);
        structure[3 * i + 1] = 1e-11;
        structure[3 * i + 2] = structure[3 * i] != 0.0 ? 20.0 : 0.9;
    }
    law.structure = structure;
    law.end_rows = 1 + up_to(4);
    law.end_columns = 1 + up_to(4);
    ends = room(law.end_rows * law.end_columns);
    for (int64_t i = 0; i < law.end_rows * law.end_columns; i++) ends[i] = law.highest_load * (0.5 + 0.5 * part());
    for (int64_t j = 0; j < law.end_columns; j++) ends[j] = 300.0 + 20.0 * (double)j;
    for (int64_t i = 1; i < law.end_rows; i++) ends[i * law.end_columns] = log(0.1) + (double)i;
    law.ends = ends;
    law.own = table_of(1e-6);
    law.inner = table_of(1e-6);
    law.outer = table_of(1e-6);
    return law;
}

static void free_law(const ehd_law_data *law) {
    free((void *)(uintptr_t)law->structure);
    free((void *)(uintptr_t)law->ends);
    free_table(&law->own);
    free_table(&law->inner);
    free_table(&law->outer);
}

static int sound(const ehd_law_data *law, int status, const double *values, int count) {
    for (int i = 0; i < count; i++)
        if (refuses(law, status) ? !isnan(values[i]) : !isfinite(values[i])) return 0;
    return 1;
}

/* The law of a point and of a call. */
static int laws(void) {
    const ehd_law_data law = law_of();
    ehd_law_point *point = malloc(ehd_law_point_size(&law)), *made = malloc(ehd_law_point_size(&law));
    int failed = 0;
    for (int n = 0; n < 40 && !failed; n++) {
        ehd_force force;
        const double u = number(5.0), T = 350.0 + number(60.0), q = any() % 4 ? 0.0 : number(1e4);
        int status = ehd_law_call(&law, number(1e-5), number(1e-3), u, T, q, point, &force);
        if (!sound(&law, status, &force.load, 3) || force.load < 0.0) failed = 1;
        ehd_law_make(&law, u, T, q, made);
        status = ehd_law_force(made, number(1e-5), number(1e-3), &force);
        if (!sound(&law, status, &force.load, 3) || force.load < 0.0) failed = 2;
    }
    free(made);
    free(point);
    free_law(&law);
    return failed;
}

/* A bearing with cylindrical rollers of any shape; free its arrays. Rings tilt, or slices have weights. */
static ehd_cylinder cylinder_of(void) {
    const int64_t rollers = up_to(20), slices = up_to(50);
    const int level = any() % 4 == 0, alike = any() % 2 == 0;
    double *position = room(slices + 1), *profile = room(slices + 1), *cosine = room(rollers), *sine = room(rollers);
    double *weight = level ? room(slices) : NULL;
    ehd_cylinder bearing = {rollers, slices, !level && alike, 2e-6 * (part() - 0.5), 0.01 / (double)slices, 0.01, 0.5,
                            0.005, DBL_MAX, 0.0, position, profile, cosine, sine, weight, NULL, NULL};
    position[slices] = profile[slices] = 0.0;
    for (int64_t i = 0; i < slices; i++) {
        position[i] = (double)(2 * i + 1 - slices) / (2.0 * (double)slices) * 0.01;
        profile[i] = alike && 2 * i >= slices ? profile[slices - 1 - i] : 2e-6 * part();
        bearing.least_profile = least(bearing.least_profile, profile[i]);
        bearing.most_profile = most(bearing.most_profile, profile[i]);
        if (level) weight[i] = (double)up_to(2);
    }
    for (int64_t j = 0; j < rollers; j++) {
        cosine[j] = cos(2.0 * FILM_PI * (double)j / (double)rollers);
        sine[j] = sin(2.0 * FILM_PI * (double)j / (double)rollers);
    }
    return bearing;
}

static void free_cylinder(const ehd_cylinder *bearing) {
    free((void *)(uintptr_t)bearing->position);
    free((void *)(uintptr_t)bearing->profile);
    free((void *)(uintptr_t)bearing->cosine);
    free((void *)(uintptr_t)bearing->sine);
    free((void *)(uintptr_t)bearing->weight);
}

/* Pose, velocity and angle of the cage, most of them within reason. */
static void moved(double state[13]) {
    const int steady = any() % 4 == 0, odd = any() % 2;
    for (int i = 0; i < 12; i++) {
        const double size = i < 3 ? 1e-5 : i >= 6 || any() % 3 ? 1e-3 : 0.0;
        state[i] = odd ? number(size) : size * (2.0 * part() - 1.0);
        if (steady && i >= 6) state[i] = 0.0;
    }
    state[12] = number(10.0);
}

/* Bearings with cylindrical rollers: all kinds of laws, made at once or as slices need them; slices may be coupled. */
static int cylinders(void) {
    const ehd_law_data law = law_of();
    const ehd_cylinder bearing = cylinder_of();
    const int64_t rollers = bearing.rollers, slices = bearing.slices, whole = (int64_t)(any() % 2);
    const int coupled = !bearing.weight && any() % 4 == 0;
    ehd_cylinder_numbers numbers;
    ehd_cylinder_law prepared = {&numbers, room(16 * EHD_ROWS), room(2 * EHD_ROWS), room(16 * EHD_ROWS),
                                 room(4 * EHD_NODES), malloc(2 * EHD_NODES), malloc(ehd_law_point_size(&law)), 0, 0, 0};
    ehd_cylinder_work work = {room(4 * slices * (whole ? rollers : 1)), room(slices + 1),
                              malloc((size_t)(slices + 1) * sizeof *work.row), whole ? 4 * slices : 0, whole};
    double state[13], *coupling = coupled ? room(slices * slices) : NULL, *values = room(4 * rollers * slices);
    double *own = room(rollers * slices), *scratch = room(slices * (slices + 9));
    int failed = 0;
    for (int64_t i = 0; coupled && i < slices * slices; i++)
        coupling[i] = 1e-12 * exp(-fabs((double)(i / slices) - (double)(i % slices)));
    for (int n = 0; n < 3 && !failed; n++) {
        const int64_t asked = coupled ? EHD_WITHOUT_KNOTS : (int64_t)(any() % 4);
        const double u = any() % 3 ? number(5.0) : any() % 2 ? number(0.4) : 0.0, q = any() % 4 ? 0.0 : number(1e4);
        const int made = ehd_cylinder_prepare(&law, u, 350.0 + number(60.0), q, asked, &prepared);
        for (int k = 0; k < 4 && !failed && !refuses(&law, made); k++) {
            ehd_bearing_force answer;
            const ehd_cylinder_call call = {&bearing, &prepared, &work, state, (double *)&answer, coupling, own,
                                            scratch};
            moved(state);
            memset(&answer, 0, sizeof answer);
            int status = ehd_cylinder_force(&call);
            if (status & EHD_NO_LOADS) continue;
            status = settled_force(&law, status, &answer);
            if (!sound(&law, status, answer.force, 6) || !sound(&law, status, answer.stiffness[0], 36)) failed = 3;
            if (!sound(&law, status, answer.damping[0], 36)) failed = 3;
            for (int64_t i = 0; whole && !coupled && numbers.kind != EHD_BY_SLICES && !refuses(&law, status) &&
                                i < 4 * slices * rollers; i++)
                if (!isfinite(work.states[i])) failed = 9;
            if (ehd_cylinder_rollers(&bearing, state, values)) continue;
            for (int64_t i = 0; i < 4 * rollers; i++)
                if (!isfinite(values[i])) failed = 14;
            ehd_cylinder_approaches(&bearing, state, values);
            ehd_cylinder_of_loads(&bearing, state, values, values, (double *)&answer);
        }
    }
    free(prepared.cells);
    free(prepared.knots);
    free(prepared.film);
    free(prepared.nodes);
    free(prepared.marks);
    free(prepared.point);
    free(work.states);
    free(work.place);
    free(work.row);
    free(coupling);
    free(values);
    free(own);
    free(scratch);
    free_law(&law);
    free_cylinder(&bearing);
    return failed;
}

/* Numbers of films with memory of a law, with any number of factors; free these. */
static ehd_film_data films_of(const ehd_law_data *law) {
    const int64_t speeds = up_to(4), temperatures = up_to(4), loads = up_to(6);
    double *factors = room(speeds * temperatures * loads);
    for (int64_t i = 0; i < speeds * temperatures * loads; i++) factors[i] = 0.5 + part();
    const ehd_film_data data = {law, {1.0 + part(), 5e-3, 2e11}, 0.1, speeds, temperatures, loads, log(0.1),
                                (double)(speeds - 1) / log(100.0), 1.0 / 220.0,
                                -(double)(temperatures - 1) / (1.0 / 140.0 - 1.0 / 220.0), log(1e2), 1.0, factors};
    return data;
}

/* Films with memory, alone and in a bearing: what is not refused is finite, and no load is negative. */
static int films(void) {
    const ehd_law_data law = law_of();
    const ehd_film_data data = films_of(&law);
    ehd_cylinder bearing = cylinder_of();
    const int64_t count = bearing.rollers * bearing.slices;
    ehd_law_point *point = malloc(ehd_law_point_size(&law));
    ehd_film *film = calloc(1, sizeof *film);
    ehd_film_state *begun = calloc((size_t)count, sizeof *begun), *ended = calloc((size_t)count, sizeof *ended);
    ehd_film_rates *rates = calloc((size_t)count, sizeof *rates);
    double *states = room(count), pose[13];
    int failed = 0;
    ehd_film_make(&data, number(5.0), 350.0 + number(60.0), point, film);
    for (int n = 0; n < 20 && !failed; n++) {
        const double approach = number(1e-5);
        ehd_film_state state = {number(1e-5), number(1.0), number(1e5)};
        ehd_film_rates rate;
        ehd_force force;
        int status = any() % 2 ? EHD_OK : ehd_film_settled(film, number(1e-5), &state);
        status = ehd_film_advance(film, number(1e-4), number(1e-4), approach, &state, &state, &force);
        if (film_refuses(film, status) ? !isnan(force.load) : !(isfinite(force.load) && force.load >= 0.0)) failed = 15;
        if (!film_refuses(film, status) && !(isfinite(force.stiffness) && isfinite(state.approach))) failed = 15;
        status = ehd_film_rate(film, approach, number(1e-5), &rate);
        if (film_refuses(film, status) ? !isnan(rate.load) : !(isfinite(rate.load) && rate.load >= 0.0)) failed = 16;
        if (n % 10) continue;
        moved(pose);
        status = ehd_cylinder_settled(&bearing, film, pose, pose[12], begun);
        for (int64_t i = 0; i < count; i++) {
            if (film_refuses(film, status)) begun[i].approach = begun[i].change = begun[i].load = 0.0;
            states[i] = begun[i].approach + number(1e-6);
        }
        ehd_bearing_force answer;
        const double *all = (const double *)&answer;
        status = ehd_cylinder_advance(&bearing, film, 1e-4 * part(), number(1e-4), pose, pose[12], begun, ended,
                                      &answer);
        if (film_refuses(film, status) ? !isnan(all[1]) : !sound(&law, status, all, 78)) failed = 17;
        status = ehd_cylinder_rates(&bearing, film, pose, pose[12], states, rates, &answer);
        if (film_refuses(film, status) ? !isnan(all[1]) : !sound(&law, status, all, 78)) failed = 18;
    }
    free((void *)(uintptr_t)data.factors);
    free(point);
    free(film);
    free(begun);
    free(ended);
    free(rates);
    free(states);
    free_cylinder(&bearing);
    free_law(&law);
    return failed;
}

/* Gear meshes and connections by matrices in a run: where all that is given is finite, so are forces. */
static int elements(void) {
    const int64_t count = up_to(4), harmonics = up_to(6) - 1, longest = up_to(5), m = 8 * count;
    int64_t *firsts = malloc((size_t)count * sizeof *firsts), *places = malloc((size_t)count * sizeof *places);
    int64_t *counts = malloc((size_t)count * sizeof *counts), *outside = calloc((size_t)count, sizeof *outside);
    double *constants = room(5 * count), *series = room(4 * harmonics * count + 1), *speeds = room(count * longest);
    double *tables = room(72 * count * longest), *motion = room(2 * m), *force = room(m), *slopes = room(m * m);
    double *powers = room(3 * count);
    int failed = 0, finite = 1;
    for (int64_t i = 0; i < count; i++) {
        firsts[i] = 8 * i;
        places[i] = i;
        counts[i] = up_to(longest);
        for (int j = 0; j < 5; j++) constants[5 * i + j] = (j == 0 ? 1e8 : j == 1 ? 1e3 : j == 2 ? 1e-4 : 1.0) * part();
    }
    for (int64_t i = 0; i < 4 * harmonics * count; i++) series[i] = 1e-3 * part();
    for (int64_t i = 0; i < count * longest; i++) speeds[i] = 10.0 * (double)(i % longest) + 5.0 * part();
    for (int64_t i = 0; i < 72 * count * longest; i++) tables[i] = 1e6 * (part() - 0.3);
    for (int64_t i = 0; i < 2 * m; i++) finite &= fabs(motion[i] = number(1e-4)) < 1e100;
    ehd_moment at = {0, 0.0, number(30.0), number(100.0), 1e-10, 1e-5};
    finite &= fabs(at.speed) < 1e100 && fabs(at.angle) < 1e100;
    ehd_answers answers = {force, slopes, outside, m};
    ehd_gear_block gears = {count, harmonics, firsts, places, constants, series};
    ehd_matrix_block matrices = {count, longest, firsts, places, counts, speeds, tables};
    if (ehd_gear_block_answer(&gears, &at, motion, &answers) != EHD_FOUND) failed = 4;
    for (int64_t i = 0; i < count; i++)
        if (finite && (!isfinite(force[8 * i]) || force[8 * i] > 0.0 || force[8 * i + 1] > 0.0)) failed = 5;
    ehd_gear_block_powers(&gears, &at, motion, &answers, powers);
    if (ehd_matrix_block_answer(&matrices, &at, motion, &answers) != EHD_FOUND) failed = 6;
    for (int64_t i = 0; i < 6 * count; i++)
        if (finite && !isfinite(force[8 * (i / 6) + i % 6])) failed = 7;
    ehd_matrix_block_powers(&matrices, &at, motion, &answers, powers);
    free(firsts);
    free(places);
    free(counts);
    free(outside);
    free(constants);
    free(series);
    free(speeds);
    free(tables);
    free(motion);
    free(force);
    free(slopes);
    free(powers);
    return failed;
}

/* An element of a user: a hardening spring at each port, which refuses a motion now and then. */
static int spring_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    const int64_t m = answers->m;
    const double stiffness = *(const double *)data;
    if (any() % 256 == 0) return any() % 2 ? EHD_NO_SOLUTION : EHD_STOPPED;
    for (int64_t i = 0; i < m; i++) {
        const double x = motion[i], bend = 1.0 + 1e8 * x * x;
        answers->force[i] -= stiffness * x * bend;
        answers->slopes[i * m + i] += stiffness * (1.0 + 3e8 * x * x) * at->by_q;
    }
    return EHD_FOUND;
}

/* What a block that is asked before the springs has to do: their forces are sums. */
static int nothing_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    (void)data, (void)at, (void)motion;
    memset(answers->force, 0, sizeof(double) * (size_t)answers->m);
    memset(answers->slopes, 0, sizeof(double) * (size_t)(answers->m * answers->m));
    return EHD_FOUND;
}

/* Steps of a run with arrays of exactly their sizes: a step that fails leaves the state as it was, one that is made from
 * finite numbers under finite loads is finite. */
static int runs(void) {
    const int64_t n = up_to(6), m = up_to(4), elements = m, outputs = up_to(3), rows = 12, stride = up_to(3);
    const int64_t samples = (rows + stride - 1) / stride, kept = (int64_t)(any() % 2), loads = up_to(3) - 1, starts[2] = {0, n};
    const double h = 1e-5, by_q = 0.3 * h * h, by_v = 0.6 * h;
    double stiffness = 1e6 * part(), error, *all[24], *zero;
    int64_t status, taken = 0, counter = 0, *orders = calloc((size_t)outputs, sizeof *orders);
    int64_t *outside = calloc((size_t)elements, sizeof *outside), *diagonal = calloc((size_t)n, sizeof *diagonal);
    int failed = 0;
#define TAKE(count) (all[taken] = zero = calloc((size_t)(count) + 1, sizeof(double)), taken++, zero)
    double *lambda = TAKE(n), *damping = TAKE(n * n), *turning = TAKE(n * n), *inverse = TAKE(3 * n * n), *ports = TAKE(m * n);
    double *reach = TAKE(3 * m * n), *receptance = TAKE(3 * m * m), *size = TAKE(m * m), *physical = TAKE(n), *motion = TAKE(4 * n);
    double *forces = TAKE(3 * m), *seen = TAKE(outputs * n), *output = TAKE(rows * outputs), *sampled = TAKE(samples * m);
    double *moved = TAKE(3 * samples * n), *load = TAKE(n), *felt = TAKE(2 * m), *powers = TAKE(3 * elements), *sums = TAKE(3 + m);
    double *exchanged = TAKE(2 * elements), *values = TAKE(n), *steady = TAKE(n), *varying = TAKE(loads * n);
    double *work = TAKE(ehd_run_room(n, m, elements));
#undef TAKE
    for (int64_t i = 0; i < n; i++) {
        lambda[i] = 1e6 * part();
        damping[i * n + i] = values[i] = 100.0 * part();
        inverse[i * n + i] = 1.0 / (1.0 + by_v * damping[i * n + i] + by_q * lambda[i]);
        physical[i] = part();
        diagonal[i] = i;
        steady[i] = number(100.0);
        for (int64_t k = 0; k < loads; k++) varying[k * n + i] = number(10.0);
        for (int64_t k = 0; k < m; k++) ports[k * n + i] = part() - 0.5;
        for (int64_t k = 0; k < outputs; k++) seen[k * n + i] = part() - 0.5;
    }
    for (int64_t k = 0; k < m; k++)
        for (int64_t i = 0; i < n; i++) {
            reach[k * n + i] = ports[k * n + i] * inverse[i * n + i];
            for (int64_t l = 0; l < m; l++) {
                receptance[k * m + l] += reach[k * n + i] * ports[l * n + i];
                size[k * m + l] += ports[k * n + i] * ports[l * n + i];
            }
        }
    for (int64_t k = 0; k < outputs; k++) orders[k] = (int64_t)(any() % 3);
    const ehd_linear linear = {n, m, 1, 0, (int64_t)(any() % 2), 0.0, lambda, damping, turning, inverse, ports, reach,
                               receptance, size, physical};
    const ehd_numbers numbers = {h, by_q, by_v, 0.2, 0.4, 0.3, 0.6, 0.5, 1e-10, any() % 2 ? INFINITY : 1e-3, 1e-10, 12};
    const ehd_run run = {n, m, elements, motion, forces, outputs, stride, kept, seen, orders, output, sampled, moved, load,
                         felt, powers, sums, sums + 2, exchanged, 1, sums + 2 + m, starts, diagonal, diagonal, values,
                         outside, &counter, work};
    const ehd_block blocks[2] = {{nothing_answer, NULL, NULL, NULL}, {spring_answer, NULL, NULL, &stiffness}};
    for (int64_t step = 0; step < rows && !failed; step++) {
        double before[24], factors[2], time = h * (double)step, speed = number(10.0), angle = number(10.0);
        int finite = fabs(speed) < 1e30;
        for (int64_t k = 0; k < loads; k++) finite &= fabs(factors[k] = number(1.0)) < 1e30;
        for (int64_t i = 0; i < n; i++) finite &= fabs(steady[i]) < 1e30 && fabs(motion[i]) < 1e-3;
        for (int64_t i = 0; i < loads * n; i++) finite &= fabs(varying[i]) < 1e30;
        memcpy(before, motion, sizeof(double) * (size_t)(4 * n));
        const ehd_course course = {1, loads, &time, &speed, &angle, steady, varying, factors, &step};
        const int64_t made = ehd_advance(&run, &linear, &numbers, blocks, 2, &course, &error, &status);
        if (made != (status == EHD_FOUND)) failed = 9;
        if (status != EHD_FOUND && memcmp(before, motion, sizeof(double) * (size_t)(4 * n)) != 0) failed = 10;
        for (int64_t i = 0; i < 4 * n; i++)
            if (status == EHD_FOUND && finite && !isfinite(motion[i])) failed = 11;
    }
    for (int64_t i = 0; i < taken; i++) free(all[i]);
    free(orders);
    free(outside);
    free(diagonal);
    return failed;
}

/* Rollers between ribs with lines of any number of slices, dry, with films, with memory: what is found is finite. */
static int tapered(void) {
    const int64_t rollers = up_to(6), slices = 1 + up_to(70), ribs = up_to(EHD_TAPER_RIBS + 1) - 1;
    const int64_t rows = any() % 3 ? 1 + up_to(40) : 0, size = 2 * EHD_TAPER_MEMORY * slices;
    double *lever = room(slices), *profile = room(slices), *cosine = room(rollers), *sine = room(rollers);
    double *rib = room(6 * ribs + 1), *table = room(4 * rows + 1), *springs = room(2 * rows + 1);
    double *memory = any() % 2 ? calloc((size_t)(rollers * size), sizeof(double)) : NULL, g = -8.0;
    ehd_taper_roller *found = calloc((size_t)rollers, sizeof *found);
    int failed = 0;
    for (int64_t i = 0; i < slices; i++) {
        lever[i] = 1.5e-2 * (((double)i + 0.5) / (double)slices - 0.5);
        profile[i] = 1e-6 * part();
    }
    for (int64_t j = 0; j < rollers; j++) {
        cosine[j] = cos(2.0 * FILM_PI * (double)j / (double)rollers);
        sine[j] = sin(2.0 * FILM_PI * (double)j / (double)rollers);
    }
    for (int64_t m = 0; m < ribs; m++) {
        const double angle = 6.3 * part(), own[6] = {cos(angle), sin(angle), 5e-3 * part(), 1e-5 * part(), 1e9,
                                                     (double)(any() % 2)};
        memcpy(rib + 6 * m, own, sizeof own);
    }
    for (int64_t i = 0; i < rows; i++) {
        const double rise = 20.0 / (double)rows * part() + 1e-3, own[4] = {g += rise, rise, 8.0 + part(), 0.1 * part()};
        memcpy(table + 4 * i, own, sizeof own);
        springs[2 * i] = 1e8 * part();
        springs[2 * i + 1] = 1e-4 * part();
    }
    for (int64_t n = 0; memory && n < 2 * rollers; n++)
        for (int64_t i = 0; i < slices; i++) memory[(n * EHD_TAPER_MEMORY + EHD_PAIR_TIME) * slices + i] = 1.0;
    const int64_t held = (int64_t)((uint64_t)any() % (uint64_t)(rollers + 1));
    const ehd_taper_data data = {rollers, slices, ribs, held, {-5e-3 * part(), 5e-3 * part()}, 0.03, {0.24, 0.97},
                                 {0.18, 0.98}, 1e-6 * part(), 1e-3, 3e-2, 1e9, any() % 2 ? 10.0 : 0.0, 1e-5, rib, lever,
                                 profile, cosine, sine, NULL, NULL};
    const double step = 10.0 / (double)(rows + 1);
    const ehd_pair_law line = {rows ? 1.0 : 5e8, data.damping, 1e-5, 0.0, 3e-7, -3.0, step, rows, table};
    const ehd_pair_law law[2] = {line, line};
    const double shorter[EHD_TAPER_SPRINGS] = {1.0};
    const ehd_pair_springs both = {EHD_TAPER_SPRINGS, shorter, {springs, springs}, {springs, springs}, part()};
    double *approaches = room(slices);
    for (int n = 0; n < 6 && !failed; n++) {
        const double loads[3] = {0.0, number(100.0), number(1.0)};
        ehd_taper_answer answer;
        double pose[6];
        for (int i = 0; i < 6; i++) pose[i] = number(i < 3 ? 3e-5 : 1e-3);
        if (memory) ehd_pair_hold(2 * rollers, slices, EHD_TAPER_SPRINGS, shorter, 1e-4 * part(), memory);
        if (ehd_taper_force(&data, law, pose, number(3.0), loads, memory, found, &answer) < 0) continue;
        if (memory) ehd_taper_go_on(&data, law, &both, found, approaches, memory);
        for (int i = 0; i < 6; i++)
            if (!isfinite(answer.force[i])) failed = 8;
    }
    free(approaches);
    free(lever);
    free(profile);
    free(cosine);
    free(sine);
    free(rib);
    free(table);
    free(springs);
    free(memory);
    free(found);
    return failed;
}

int main(int count, char **arguments) {
    const long calls = count > 1 ? atol(arguments[1]) : 100;
    for (long n = 0; n < calls; n++) {
        int failed = laws();
        if (!failed) failed = cylinders();
        if (!failed) failed = films();
        if (!failed) failed = elements();
        if (!failed) failed = runs();
        if (!failed) failed = tapered();
        if (!failed && (failed = balls())) failed += 100;
        if (failed) {
            printf("check %d, round %ld\n", failed, n);
            return failed;
        }
    }
    return 0;
}
