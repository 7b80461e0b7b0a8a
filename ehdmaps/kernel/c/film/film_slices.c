/* ---------------------------------------------------------------------------------------------------------------------
 * Slices whose films have a memory: one time step of all slices of a bearing
 *
 * The law is that of ehd_film_table. Each slice carries parabolas of p, y and G around a state and of a around a load;
 * they stand for the cubics of its cells, from which they differ in third order, and are read anew where the slice
 * leaves their reach, and every few steps, as the law follows the speed. So Newton's method for the states is arithmetic
 * alone, in vector instructions over all slices. A slice that leaves them within a step is solved from the table itself,
 * with a bracket.
 *
 * A step is begin_slices, slice_loads as often as the system asks for them, and commit_slices.
 * ------------------------------------------------------------------------------------------------------------------ */

/* How far a parabola reaches, as a part of the distance from the centre, a cell or less, and in the load. */
#define PARABOLA_PART 0.015625
#define PARABOLA_LOAD_PART 0.0625

/* A slice has its state when the last move changed its load by less than a part of the load and a small one [N/m]: what
 * is left is the square, which has to lie below what the equations of motion are solved to. */
#define SLICE_TOLERANCE 3e-7
#define SLICE_SMALL 30.0

#define SLICE_ROUNDS 12
#define SLICE_LEAST 1e-30
#define SLICE_ROWS 22 /* of the memory */

/* Rows of the memory of n slices, each n numbers: states after the last two steps, change of G over the last one and
 * fading_of it, load after it; state of the trial; where the parabolas lie and how far they reach, in the state and in
 * the load; parabolas. G counts from the last state. */
enum {
    AT_LATEST,
    AT_BEFORE,
    AT_CHANGE,
    AT_FADE,
    AT_LOAD,
    AT_TRIAL,
    AT_AROUND,
    AT_REACH,
    AT_LOADED,
    AT_LOAD_REACH,
    AT_P,
    AT_Y = 13,
    AT_G = 16,
    AT_A = 19
};

/* Parabolas of a slice around the state of the trial and the last load. */
static void read_parabolas(const ehd_film_table *film, int64_t n, double *memory, int64_t i) {
    double *m = memory + i;
    const double per = film->inverse_scale, xi = m[n * AT_TRIAL], load = m[n * AT_LOAD];
    double t;
    const double *c = film->cell[row_of((xi - film->centre) * per, &t)][0];
    const double reach = PARABOLA_PART / per * (1.0 + fabs((xi - film->centre) * per));
    m[n * AT_AROUND] = xi;
    m[n * AT_REACH] = reach;
    m[n * AT_P] = c[0] + t * (c[1] + t * (c[2] + t * c[3]));
    m[n * (AT_P + 1)] = (c[1] + t * (2.0 * c[2] + 3.0 * t * c[3])) * per;
    m[n * (AT_P + 2)] = (c[2] + 3.0 * t * c[3]) * per * per;
    m[n * AT_Y] = c[4] + t * (c[5] + t * (c[6] + t * c[7]));
    m[n * (AT_Y + 1)] = (c[5] + t * (2.0 * c[6] + 3.0 * t * c[7])) * per;
    m[n * (AT_Y + 2)] = (c[6] + 3.0 * t * c[7]) * per * per;
    const double slope = (c[9] + t * (2.0 * c[10] + 3.0 * t * c[11])) * per;
    const double bend = (c[10] + 3.0 * t * c[11]) * per * per;
    const double ahead = xi - m[n * AT_LATEST];
    m[n * AT_G] = fabs(ahead) <= reach ? ahead * (slope - ahead * bend)
                                       : c[8] + t * (c[9] + t * (c[10] + t * c[11])) - squeezing(film, m[n * AT_LATEST]);
    m[n * (AT_G + 1)] = slope;
    m[n * (AT_G + 2)] = bend;
    c = film->load_cell[cell_from(1.0 + load, EHD_LOAD_ROWS, &t)];
    const double compliance = c[1] + t * (2.0 * c[2] + 3.0 * t * c[3]);
    m[n * AT_LOADED] = load;
    m[n * AT_A] = c[0] + t * (c[1] + t * (c[2] + t * c[3]));
    m[n * (AT_A + 1)] = compliance;
    m[n * (AT_A + 2)] = c[2] + 3.0 * t * c[3];
    /* the structure matters the less, the softer the film is beside it */
    m[n * AT_LOAD_REACH] = PARABOLA_LOAD_PART * (load + 1.0) / sqrt(compliance * m[n * (AT_P + 1)] + SLICE_LEAST);
}

/* Begin a step: states are foretold, parabolas read where they are used up. growth is the length of the step by that of
 * the last one, 0 at the first; count the number of the step; kept the steps for which parabolas are kept at most. */
static void begin_slices(const ehd_film_table *film, double growth, int64_t count, int64_t kept, int64_t n,
                         double *memory) {
    const double *latest = memory + n * AT_LATEST, *before = memory + n * AT_BEFORE, *load = memory + n * AT_LOAD;
    const double *around = memory + n * AT_AROUND, *reach = memory + n * AT_REACH, *loaded = memory + n * AT_LOADED;
    const double *load_reach = memory + n * AT_LOAD_REACH;
    double *trial = memory + n * AT_TRIAL;
    for (int64_t i = 0; i < n; i++) {
        const double guess = latest[i] + growth * (latest[i] - before[i]);
        trial[i] = guess > film->lift_off ? guess : film->lift_off;
        if (2.0 * fabs(trial[i] - around[i]) > reach[i] || 2.0 * fabs(load[i] - loaded[i]) > load_reach[i] ||
            (count + i) % kept == 0)
            read_parabolas(film, n, memory, i);
    }
}

/* A Newton step for the states of all slices, with loads and tangents there; how many still move. trial is its row of the
 * memory: so compilers see that nothing that is written is read elsewhere, and make vector instructions of it. */
EHD_CLONES static int64_t round_slices(weights step, int64_t n, const double *restrict memory,
                                         double *restrict trial, const double *restrict delta, double *restrict load,
                                         double *restrict tangent, double *restrict excess) {
    const double *around = memory + n * AT_AROUND, *loaded = memory + n * AT_LOADED;
    const double *last = memory + n * AT_CHANGE, *fading = memory + n * AT_FADE;
    const double *p0 = memory + n * AT_P, *p1 = p0 + n, *p2 = p1 + n;
    const double *y0 = memory + n * AT_Y, *y1 = y0 + n, *y2 = y1 + n;
    const double *g0 = memory + n * AT_G, *g1 = g0 + n, *g2 = g1 + n;
    const double *a0 = memory + n * AT_A, *a1 = a0 + n, *a2 = a1 + n;
    int64_t left = 0;
    for (int64_t i = 0; i < n; i++) {
        const double s = trial[i] - around[i];
        const double p = p0[i] + s * (p1[i] + s * p2[i]), dp = p1[i] + 2.0 * s * p2[i];
        const double y = y0[i] + s * (y1[i] + s * y2[i]), dy = y1[i] + 2.0 * s * y2[i];
        const double g = g0[i] + s * (g1[i] + s * g2[i]), dg = g1[i] + 2.0 * s * g2[i];
        const reading x = squeeze(step, g, last[i], fading[i]);
        const double root = sqrt(x.value * x.value + p * p + SLICE_LEAST), w = x.value + root;
        const double slope = (w * x.slope * dg + p * dp) / root, v = w - loaded[i];
        const double a = a0[i] + v * (a1[i] + v * a2[i]), compliance = a1[i] + 2.0 * v * a2[i];
        const double stiff = slope / (compliance * slope + dy), gained = (delta[i] - a - y) * stiff;
        trial[i] += gained / slope;
        load[i] = w + gained;
        tangent[i] = stiff;
        excess[i] = fabs(gained) - SLICE_TOLERANCE * (w + SLICE_SMALL);
    }
    for (int64_t i = 0; i < n; i++) left += excess[i] > 0.0;
    return left;
}

/* Give the slices that Newton's steps on parabolas do not settle to the table, whose steps have a bracket. So it is where
 * a film begins to carry within a step, as on an oil layer: its parabolas are flat on one side. work: (n,). */
static void give_unsettled(weights step, int64_t n, double *memory, const double *delta, double *load, double *tangent,
                           double *work) {
    memcpy(work, load, (size_t)n * sizeof *work);
    round_slices(step, n, memory, memory + n * AT_TRIAL, delta, load, tangent, work + n);
    for (int64_t i = 0; i < n; i++)
        if (!(fabs(load[i] - work[i]) <= SLICE_TOLERANCE * (fabs(load[i]) + SLICE_SMALL)))
            memory[n * AT_TRIAL + i] = INFINITY;
}

/* Loads of all slices at the end of a step [N/m], and their derivatives by the approach [N/m2]; the states of the trial
 * are written. delta: approaches [m]; work: (n,). */
static void slice_loads(const ehd_film_table *film, weights step, int64_t n, double *memory, const double *delta,
                        double *load, double *tangent, double *work) {
    int64_t left = 1;
    for (int k = 0; k < SLICE_ROUNDS && left > 0; k++)
        left = round_slices(step, n, memory, memory + n * AT_TRIAL, delta, load, tangent, work);
    if (left > 0) give_unsettled(step, n, memory, delta, load, tangent, work);
    for (int64_t i = 0; i < n; i++) {
        double *m = memory + i;
        if (fabs(m[n * AT_TRIAL] - m[n * AT_AROUND]) <= m[n * AT_REACH] &&
            fabs(load[i] - m[n * AT_LOADED]) <= m[n * AT_LOAD_REACH])
            continue;
        if (delta[i] <= film->lift_off) { /* out of contact, as many slices on an oil layer are: what the table finds */
            load[i] = tangent[i] = 0.0;
            m[n * AT_TRIAL] = film->lift_off;
        } else {
            const double start = m[n * AT_LATEST];
            const film_end end = end_of_step(film, step, delta[i], squeezing(film, start), m[n * AT_CHANGE], start);
            load[i] = end.load;
            tangent[i] = end.tangent;
            m[n * AT_TRIAL] = end.approach;
        }
    }
}

/* Make the step: the trial becomes the state. load: what slice_loads found last [N/m]. */
static void commit_slices(const ehd_film_table *film, int64_t n, double *memory, const double *load) {
    for (int64_t i = 0; i < n; i++) {
        double *m = memory + i;
        const double trial = m[n * AT_TRIAL], latest = m[n * AT_LATEST], s = trial - m[n * AT_AROUND];
        double change = m[n * AT_G] + s * (m[n * (AT_G + 1)] + s * m[n * (AT_G + 2)]);
        m[n * AT_G] -= change;
        if (!(fabs(s) <= m[n * AT_REACH])) {
            change = trial != latest ? squeezing(film, trial) - squeezing(film, latest) : 0.0;
            m[n * AT_AROUND] = INFINITY;
        }
        m[n * AT_CHANGE] = change;
        m[n * AT_FADE] = fading_of(change);
        m[n * AT_BEFORE] = latest;
        m[n * AT_LATEST] = trial;
        m[n * AT_LOAD] = load[i];
    }
}

/* Energy that all films take up over a step, before commit_slices, for each length of a slice [J/m]. load: what
 * slice_loads found last; weights_of_slices (slices,): how many slices each slice of a roller stands for. */
static double spent_by_slices(const ehd_film_table *film, int64_t n, const double *memory, const double *load,
                              int64_t slices, const double *weights_of_slices) {
    double total = 0.0;
    for (int64_t first = 0; first < n; first += slices) {
        for (int64_t k = 0; k < slices; k++) {
            const double *m = memory + first + k, weight = weights_of_slices[k], w = load[first + k];
            const double p1 = m[n * (AT_P + 1)], p2 = m[n * (AT_P + 2)], reach = m[n * AT_REACH];
            const double s = m[n * AT_TRIAL] - m[n * AT_AROUND], t = m[n * AT_LATEST] - m[n * AT_AROUND];
            if (fabs(s) <= reach && fabs(t) <= reach) {
                const double rest = 2.0 * m[n * AT_P] + s * (p1 + s * p2) + t * (p1 + t * p2);
                total += 0.5 * weight * (w + m[n * AT_LOAD] - rest) * (s - t) *
                         (m[n * (AT_Y + 1)] + (s + t) * m[n * (AT_Y + 2)]);
            } else {
                total += weight * spent_by_film(film, m[n * AT_LATEST], m[n * AT_LOAD], m[n * AT_TRIAL], w);
            }
        }
    }
    return total;
}

/* The three parts of a step for callers elsewhere: memory (SLICE_ROWS, n), arrays (n,), work (2 n). */
void ehd_film_slices_begin(const ehd_film_table *film, double growth, int64_t count, int64_t kept, int64_t n,
                           double *memory);
void ehd_film_slices_loads(const ehd_film_table *film, double step, double last_step, int64_t n, double *memory,
                           const double *delta, double *load, double *tangent, double *work);
void ehd_film_slices_commit(const ehd_film_table *film, int64_t n, double *memory, const double *load);

void ehd_film_slices_begin(const ehd_film_table *film, double growth, int64_t count, int64_t kept, int64_t n,
                           double *memory) {
    begin_slices(film, growth, count, kept, n, memory);
}

void ehd_film_slices_loads(const ehd_film_table *film, double step, double last_step, int64_t n, double *memory,
                           const double *delta, double *load, double *tangent, double *work) {
    slice_loads(film, weights_of(step, last_step), n, memory, delta, load, tangent, work);
}

void ehd_film_slices_commit(const ehd_film_table *film, int64_t n, double *memory, const double *load) {
    commit_slices(film, n, memory, load);
}
