/* ---------------------------------------------------------------------------------------------------------------------
 * Many steps of a run: the linear part by its own inverse, Newton on the forces of the elements
 *
 * The steps are those of mbs.transient.stepping. Coordinates are M-orthonormal modes of the linear part, so that mass
 * is the unit matrix and stiffness a diagonal lambda; damping and gyroscopic terms stay whole. With the acceleration a
 * at the end of a step as unknown the equation of motion is
 *
 *     L a = loads - B v0 - lambda p0 + T^T f,  L = 1 + by_v B + by_q lambda,  B = D + speed G,
 *
 * where T are the rows of the ports and f the forces of the elements. So the motion of the ports is linear in f, by the
 * receptance R = T L^-1 T^T, and Newton has as few unknowns as the elements have ports:
 *
 *     f - F(x0 + by_q R f, y0 + by_v R f) = 0.
 *
 * The inverse follows the speed by its expansion to second order about a reference; the caller moves the reference
 * before the third order matters. Energies are summed as mbs.transient.energy says.
 *
 * Source: J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375; M. Arnold, O. Bruels, Multibody Syst. Dyn. 18
 * (2007) 185-202.
 * ------------------------------------------------------------------------------------------------------------------ */

/* The linear part at one size of steps, about a reference speed [rad/s]. */
typedef struct ehd_linear {
    int64_t n, m;        /* modes; what the elements feel */
    int64_t coordinates; /* rows of physical: 0 if errors of steps are not asked for */
    int64_t alone;       /* how many ports at the beginning move only by their own forces: R couples them with none */
    int64_t turning;     /* whether there are gyroscopic terms */
    double reference;
    const double *eigenvalues;          /* (n,), lambda */
    const double *damping, *gyroscopic; /* (n, n): D + reference G, and G */
    const double *inverse;              /* (3, n, n): coefficients of L^-1 in powers of speed - reference */
    const double *ports;                /* (m, n): T */
    const double *reach;                /* (3, m, n): transposed L^-1 T^T, likewise */
    const double *receptance;           /* (3, m, m): T L^-1 T^T, likewise */
    const double *size;                 /* (m, m): T T^T */
    const double *physical;             /* (coordinates, n): coordinates of the system by the modes */
} ehd_linear;

/* Numbers of the method at one size of steps; see mbs.transient.stepping.Method. */
typedef struct ehd_numbers {
    double h, by_q, by_v, alpha_m, alpha_f, beta, gamma, ratio, error_weight, tolerance, residual;
    int64_t iterations;
} ehd_numbers;

/* Values at the end of each step: times [s], speeds [rad/s], angles [rad]; loads by mode, steady (n,) + factors (steps,
 * loads) varying (loads, n); rows to record in, negative for not at all. */
typedef struct ehd_course {
    int64_t steps, loads;
    const double *times, *speeds, *angles, *steady, *varying, *factors;
    const int64_t *rows;
} ehd_course;

/* A run: its state, what it records, its energies; all is overwritten. */
typedef struct ehd_run {
    int64_t n, m, elements;
    double *motion; /* (4, n): displacement, velocity, acceleration and carried acceleration of the modes */
    double *forces; /* (3, m): forces of the elements after the last steps, the latest first */

    int64_t outputs, stride, motions_kept; /* stride: rows from sample to sample; whether motions are recorded */
    const double *seen;                    /* (outputs, n): what is seen of the modes */
    const int64_t *orders;                 /* (outputs,): whether of displacement, velocity or acceleration */
    double *output, *sampled_forces, *sampled_motions; /* (rows, outputs), (samples, m), (samples, 3, n) */

    double *load;      /* (n,): loads at the end of the last step, by mode */
    double *felt;      /* (2, m): what the elements felt there, and its rate */
    double *powers;    /* (elements, 3): powers of the elements there */
    double *sums;      /* (2,): work of the loads, and what the method took [J] */
    double *works;     /* (m,): work of the forces of the elements, by what they feel [J] */
    double *exchanged; /* (elements, 2): what elements dissipated, and what their courses brought in [J] */
    int64_t parts;
    double *lost;                  /* (parts,): what parts of the linear system dissipated [J] */
    const int64_t *starts;         /* (parts + 1,): first entry of each part, and the number of all */
    const int64_t *rows, *columns; /* (entries,): entries of the damping of all parts by the modes, on and above the */
    const double *values;          /* diagonal; those above it doubled */

    int64_t *outside; /* (elements,): evaluations outside the map, counted up */
    int64_t *counter; /* (1,): Newton iterations, counted up */
    double *room;     /* (ehd_run_room(n, m, elements),): work space */
} ehd_run;

EHD_SIZE_OF(ehd_linear)
EHD_SIZE_OF(ehd_numbers)
EHD_SIZE_OF(ehd_course)
EHD_SIZE_OF(ehd_run)
EHD_SIZE_OF(ehd_block)

int64_t ehd_run_room(int64_t n, int64_t m, int64_t elements) {
    return 8 * n + 7 * m + 3 * m * m + m * n + 3 * elements;
}

/* Work space of a step. */
typedef struct step_room {
    double *p0, *v0, *known, *right, *free, *mean, *found, *load;
    double *unmoved, *motion, *force, *unknown, *short_of;
    double *slopes, *jacobian, *receptance, *reach, *powers;
} step_room;

static step_room room_of(const ehd_run *run) {
    const int64_t n = run->n, m = run->m;
    double *next = run->room;
    step_room r;
#define TAKE(name, size) r.name = next, next += (size)
    TAKE(p0, n);
    TAKE(v0, n);
    TAKE(known, n);
    TAKE(right, n);
    TAKE(free, n);
    TAKE(mean, n);
    TAKE(found, n);
    TAKE(load, n);
    TAKE(unmoved, 2 * m);
    TAKE(motion, 2 * m);
    TAKE(force, m);
    TAKE(unknown, m);
    TAKE(short_of, m);
    TAKE(slopes, m * m);
    TAKE(jacobian, m * m);
    TAKE(receptance, m * m);
    TAKE(reach, m * n);
    r.powers = next;
#undef TAKE
    return r;
}

/* M0 + by M1 + by^2 M2, of so many numbers each. */
static void expanded(int64_t size, const double *matrices, double by, double *restrict out) {
    for (int64_t i = 0; i < size; i++)
        out[i] = matrices[i] + by * (matrices[size + i] + by * matrices[2 * size + i]);
}

/* Add the energies of a step before its state is overwritten. */
static void account_step(const ehd_run *run, const ehd_linear *linear, const ehd_numbers *numbers, const step_room *r) {
    const int64_t n = run->n, m = run->m;
    const double h = numbers->h, *p = run->motion, *v = p + n, *a = v + n, *latest = run->forces;
    double work = 0.0, taken = 0.0, *x = run->felt, *rate = run->felt + m;
    for (int64_t i = 0; i < n; i++) {
        const double p1 = r->p0[i] + numbers->by_q * r->found[i], v1 = r->v0[i] + numbers->by_v * r->found[i];
        const double moved = p1 - p[i], middle = 0.5 * (v[i] + v1), pull = 0.5 * (run->load[i] + r->load[i]);
        work += pull * moved;
        taken -= middle * (v1 - v[i] - 0.5 * h * (a[i] + r->found[i]));
        taken -= (h * middle - moved) * (pull - 0.5 * linear->eigenvalues[i] * (p[i] + p1));
        r->mean[i] = middle;
        run->load[i] = r->load[i];
    }
    for (int64_t i = 0; i < m; i++) {
        const double middle = 0.5 * (latest[i] + r->unknown[i]), moved = r->motion[i] - x[i];
        run->works[i] += middle * moved;
        taken -= (0.5 * h * (rate[i] + r->motion[m + i]) - moved) * middle;
        x[i] = r->motion[i];
        rate[i] = r->motion[m + i];
    }
    run->sums[0] += work;
    run->sums[1] += taken;
    for (int64_t part = 0; part < run->parts; part++) {
        double power = 0.0;
        for (int64_t e = run->starts[part]; e < run->starts[part + 1]; e++)
            power += run->values[e] * r->mean[run->rows[e]] * r->mean[run->columns[e]];
        run->lost[part] += h * power;
    }
}

/* 1 + (by_q K + by_v C) R; slopes are zero but for the elements' own, R is diagonal for what is alone. */
static void ports_jacobian(int64_t m, int64_t alone, const double *slopes, const double *receptance, double *out) {
    for (int64_t i = 0; i < m; i++) {
        double *restrict row = out + i * m;
        const double *own = slopes + i * m;
        for (int64_t j = 0; j < m; j++) row[j] = 0.0;
        row[i] = 1.0;
        for (int64_t k = 0; k < alone; k++) row[k] += own[k] * receptance[k * (m + 1)];
        for (int64_t k = alone; k < m; k++) {
            const double slope = own[k], *by = receptance + k * m;
            if (slope == 0.0) continue;
            for (int64_t j = alone; j < m; j++) row[j] += slope * by[j];
        }
    }
}

/* Record the state in a row of outputs. */
void ehd_observe(const ehd_run *run, int64_t row) {
    const int64_t n = run->n, m = run->m;
    for (int64_t i = 0; i < run->outputs; i++)
        run->output[row * run->outputs + i] = dense_dot(n, run->seen + i * n, run->motion + run->orders[i] * n);
    if (row % run->stride != 0) return;
    const int64_t sample = row / run->stride;
    memcpy(run->sampled_forces + sample * m, run->forces, sizeof(double) * (size_t)m);
    if (run->motions_kept)
        memcpy(run->sampled_motions + 3 * sample * n, run->motion, sizeof(double) * (size_t)(3 * n));
}

/* Where coordinates come to without forces of elements at the end of the step: displacement p0 + by_q a, velocity v0 +
 * by_v a, with the acceleration a in free; what the ports feel of it in unmoved. */
static void begin_step(const ehd_run *run, const ehd_linear *linear, const ehd_numbers *numbers,
                       const ehd_course *course, int64_t step, const step_room *r) {
    const int64_t n = run->n, m = run->m;
    const double h = numbers->h, by = course->speeds[step] - linear->reference;
    const double *p = run->motion, *v = p + n, *a = v + n, *carried = a + n;
    memcpy(r->load, course->steady, sizeof(double) * (size_t)n);
    for (int64_t i = 0; i < course->loads; i++) {
        const double factor = course->factors[step * course->loads + i], *varying = course->varying + i * n;
        for (int64_t j = 0; j < n; j++) r->load[j] += factor * varying[j];
    }
    for (int64_t i = 0; i < n; i++) {
        r->known[i] = (numbers->alpha_f * a[i] - numbers->alpha_m * carried[i]) / (1.0 - numbers->alpha_m);
        r->p0[i] = p[i] + h * v[i] + h * h * ((0.5 - numbers->beta) * carried[i] + numbers->beta * r->known[i]);
        r->v0[i] = v[i] + h * ((1.0 - numbers->gamma) * carried[i] + numbers->gamma * r->known[i]);
    }
    dense_times(n, n, linear->damping, r->v0, r->right);
    for (int64_t i = 0; i < n; i++) r->right[i] = r->load[i] - r->right[i] - linear->eigenvalues[i] * r->p0[i];
    if (linear->turning && by != 0.0) {
        dense_times(n, n, linear->gyroscopic, r->v0, r->free);
        for (int64_t i = 0; i < n; i++) r->right[i] -= by * r->free[i];
        dense_expanded_times(n, linear->inverse, by, r->right, r->free);
    } else {
        dense_times(n, n, linear->inverse, r->right, r->free);
    }
    if (linear->turning) {
        expanded(m * n, linear->reach, by, r->reach);
        expanded(m * m, linear->receptance, by, r->receptance);
    }
    for (int64_t i = 0; i < n; i++) r->right[i] = r->p0[i] + numbers->by_q * r->free[i];
    dense_times(m, n, linear->ports, r->right, r->unmoved);
    for (int64_t i = 0; i < n; i++) r->right[i] = r->v0[i] + numbers->by_v * r->free[i];
    dense_times(m, n, linear->ports, r->right, r->unmoved + m);
}

/* Where the forces of the elements in unknown bring ports and modes: motion, found. */
static void move_step(const ehd_run *run, const ehd_numbers *numbers, const step_room *r) {
    const int64_t n = run->n, m = run->m;
    dense_times(m, m, r->receptance, r->unknown, r->short_of);
    for (int64_t i = 0; i < m; i++) {
        r->motion[i] = r->unmoved[i] + numbers->by_q * r->short_of[i];
        r->motion[m + i] = r->unmoved[m + i] + numbers->by_v * r->short_of[i];
    }
    memcpy(r->found, r->free, sizeof(double) * (size_t)n);
    for (int64_t i = 0; i < m; i++) {
        const double pull = r->unknown[i], *row = r->reach + i * n;
        for (int64_t j = 0; j < n; j++) r->found[j] += pull * row[j];
    }
}

/* Newton on the forces of the elements; its status. The forces are in unknown, the acceleration in found. What is left of
 * the forces falls at least as it fell the last time: where that is enough the last change is made without a look at it. */
static int solve_step(const ehd_run *run, const ehd_linear *linear, const ehd_numbers *numbers, const ehd_block *blocks,
                      int64_t count, const ehd_moment *at, const step_room *r, ehd_answers *answers) {
    const int64_t n = run->n, m = run->m;
    double *u = r->unknown, largest = dense_norm(n, r->load), before = 0.0;
    for (int64_t k = 0; k < numbers->iterations; k++) {
        ++*run->counter;
        move_step(run, numbers, r);
        for (int64_t e = 0; e < count; e++) {
            const int reached = blocks[e].answer(blocks[e].data, at, r->motion, answers);
            if (reached != EHD_FOUND) return reached;
        }
        for (int64_t i = 0; i < m; i++) r->short_of[i] = u[i] - r->force[i];
        const double forces = dense_size(m, linear->size, r->force), inertia = dense_norm(n, r->found);
        const double left = dense_size(m, linear->size, r->short_of);
        largest = forces > largest ? forces : largest;
        largest = inertia > largest ? inertia : largest;
        if (left <= numbers->residual * largest) return EHD_FOUND;
        const int last = left * left <= numbers->residual * largest * before;
        ports_jacobian(m, linear->alone, r->slopes, r->receptance, r->jacobian);
        if (!ehd_eliminate(m, r->jacobian, r->short_of)) break;
        for (int64_t i = 0; i < m; i++) u[i] -= r->short_of[i];
        if (last) {
            move_step(run, numbers, r);
            return EHD_FOUND;
        }
        before = left;
    }
    return EHD_NO_SOLUTION;
}

/* Estimated error of the step: the largest of all coordinates [m or rad]. */
static double error_of_step(const ehd_run *run, const ehd_linear *linear, const ehd_numbers *numbers,
                            const step_room *r) {
    const int64_t n = run->n;
    const double *a = run->motion + 2 * n;
    double largest = 0.0;
    for (int64_t i = 0; i < n; i++) r->right[i] = r->found[i] - a[i];
    for (int64_t i = 0; i < linear->coordinates; i++) {
        const double change = fabs(dense_dot(n, linear->physical + i * n, r->right));
        if (change > largest || change != change) largest = change;
    }
    return numbers->error_weight * largest;
}

/* Make a step that was solved: its state, and what elements exchanged. */
static void finish_step(const ehd_run *run, const ehd_numbers *numbers, const ehd_block *blocks, int64_t count,
                        const ehd_moment *at, const step_room *r, const ehd_answers *answers) {
    const int64_t n = run->n, m = run->m;
    double *p = run->motion, *v = p + n, *a = v + n, *carried = a + n;
    double *latest = run->forces, *before = latest + m, *earlier = before + m;
    for (int64_t i = 0; i < n; i++) {
        p[i] = r->p0[i] + numbers->by_q * r->found[i];
        v[i] = r->v0[i] + numbers->by_v * r->found[i];
        carried[i] = r->known[i] + numbers->ratio * r->found[i];
        a[i] = r->found[i];
    }
    for (int64_t i = 0; i < m; i++) {
        earlier[i] = before[i];
        before[i] = latest[i];
        latest[i] = r->unknown[i];
    }
    for (int64_t e = 0; e < count; e++)
        if (blocks[e].accept) blocks[e].accept(blocks[e].data, at);
    for (int64_t e = 0; e < count; e++)
        if (blocks[e].powers) blocks[e].powers(blocks[e].data, at, r->motion, answers, r->powers);
    for (int64_t i = 0; i < run->elements; i++) {
        run->exchanged[2 * i] += r->powers[3 * i + 2];
        for (int64_t k = 0; k < 2; k++) {
            run->exchanged[2 * i + k] += 0.5 * numbers->h * (run->powers[3 * i + k] + r->powers[3 * i + k]);
            run->powers[3 * i + k] = r->powers[3 * i + k];
        }
    }
}

/* Make the steps of a course; how many were made. How it ended goes into status; the estimated error of the last step
 * into error, infinite where there is no solution. The step that failed has left no trace in the state. */
int64_t ehd_advance(const ehd_run *run, const ehd_linear *linear, const ehd_numbers *numbers, const ehd_block *blocks,
                    int64_t count, const ehd_course *course, double *error, int64_t *status) {
    const int64_t n = run->n, m = run->m;
    const step_room r = room_of(run);
    const double *latest = run->forces, *before = latest + m, *earlier = before + m;
    ehd_answers answers = {r.force, r.slopes, run->outside, m};
    *error = 0.0;
    *status = EHD_FOUND;
    for (int64_t i = 0; i < m; i++) r.force[i] = 0.0;
    for (int64_t i = 0; i < m * m; i++) r.slopes[i] = 0.0;
    memcpy(r.reach, linear->reach, sizeof(double) * (size_t)(m * n));
    memcpy(r.receptance, linear->receptance, sizeof(double) * (size_t)(m * m));
    memcpy(r.powers, run->powers, sizeof(double) * (size_t)(3 * run->elements));
    for (int64_t step = 0; step < course->steps; step++) {
        const ehd_moment at = {step, course->times[step], course->speeds[step], course->angles[step], numbers->by_q,
                               numbers->by_v};
        begin_step(run, linear, numbers, course, step, &r);
        for (int64_t i = 0; i < m; i++) r.unknown[i] = 3.0 * (latest[i] - before[i]) + earlier[i];
        *status = solve_step(run, linear, numbers, blocks, count, &at, &r, &answers);
        if (*status != EHD_FOUND) {
            *error = INFINITY;
            return step;
        }
        *error = 0.0;
        if (numbers->tolerance < INFINITY) {
            *error = error_of_step(run, linear, numbers, &r);
            if (!(*error <= numbers->tolerance)) {
                *status = EHD_TOO_LARGE;
                return step;
            }
        }
        account_step(run, linear, numbers, &r);
        finish_step(run, numbers, blocks, count, &at, &r, &answers);
        if (course->rows[step] >= 0) ehd_observe(run, course->rows[step]);
    }
    return course->steps;
}
