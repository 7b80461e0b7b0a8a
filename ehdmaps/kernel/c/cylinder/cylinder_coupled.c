/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings with slices that know of their neighbours
 *
 * The raceways overlap by a_i at slice i, of which the law takes s_i; the rest is what all slices of the roller press
 * away at i:
 *
 *     s = a - C w(s)
 *
 * Newton's method finds s for each roller at rest, by a Cholesky factor of 1 + sqrt(k) C sqrt(k), k the slopes of the law.
 * Stiffness and damping follow from the same factor: with B = d a/d pose and G = (1 + C k)^-1,
 *
 *     K = B^T k G B,    c = (G B)^T c (G B)
 *
 * The rate of s is G times that of a, as for motion slow against the films; the change of G with the pose is left out of
 * the stiffness of a bearing in motion, and at rest nothing is.
 * ------------------------------------------------------------------------------------------------------------------ */

#define COUPLED_STEPS 60
#define COUPLED_HALVINGS 8
#define COUPLED_CLOSE 1e-10
#define COUPLED_SCALE 1e-9 /* approaches are found to COUPLED_CLOSE of themselves and of this [m] */
#define COUPLED_WEAK 1e-4  /* product of coupling and slope below which one step of a series is exact to its square */

/* A roller and its work space: arrays of so many slices. */
typedef struct coupled_roller {
    int64_t size;
    const double *coupling;                     /* (size, size) */
    double *own, *overlap;                      /* approaches that the law takes, and of the raceways [m] */
    double *root, *factor;                      /* roots of the slopes; (size, size), lower half */
    double *left, *step, *tried, *held, *ones, *flat, *tilted;
    slices states;
    int weak;
} coupled_roller;

/* States of the slices at rest by the approaches that the law takes, with whole slopes. */
static int read_coupled(const ehd_cylinder_law *law, const coupled_roller *c) {
    const ehd_cylinder_numbers *numbers = law->numbers;
    const slices *s = &c->states;
    int status = EHD_OK;
    for (int64_t i = 0; i < c->size; i++) {
        const double approach = c->own[i];
        double *value = s->value[i], *slope = s->slope[i];
        value[0] = value[1] = slope[0] = slope[1] = 0.0;
        if (numbers->kind == EHD_BY_SLICES) {
            ehd_force found;
            status |= ehd_law_force(law->point, approach, 0.0, &found);
            value[0] = found.load;
            slope[0] = found.stiffness;
            value[1] = found.damping;
        } else if (numbers->kind == EHD_CELLS) {
            s->row[i] = (uint64_t)row_of((approach - numbers->centre) * numbers->inverse_scale, &s->place[i]);
        } else if (approach > 0.0) {
            const double b = numbers->exponent, k = numbers->coefficient * b * slice_power(approach, b - 1.0);
            value[0] = k * approach / b;
            slope[0] = k;
            value[1] = numbers->damping + numbers->damping_time * k;
            slope[1] = numbers->damping_time * (b - 1.0) * k / approach;
        }
    }
    if (numbers->kind == EHD_CELLS) {
        read_cells(law->cells, s);
        for (int64_t i = 0; i < c->size; i++) {
            s->slope[i][0] *= numbers->slope;
            s->slope[i][1] *= numbers->slope;
        }
    }
    return status & EHD_ABOVE_LOAD;
}

/* Cholesky factor of 1 + root C root, in the lower half; 0 where there is none. */
static int factor_coupled(const coupled_roller *c) {
    const double *root = c->root;
    for (int64_t i = 0; i < c->size; i++) {
        double *row = c->factor + i * c->size;
        for (int64_t k = 0; k <= i; k++) {
            const double *other = c->factor + k * c->size;
            double total = c->coupling[i * c->size + k] * root[i] * root[k] + (i == k ? 1.0 : 0.0);
            for (int64_t m = 0; m < k; m++) total -= row[m] * other[m];
            if (i > k) {
                row[k] = total / other[k];
            } else {
                if (!(total > 0.0)) return 0;
                row[i] = sqrt(total);
            }
        }
    }
    return 1;
}

/* given - C vector, into out. */
static void less_coupled(const coupled_roller *c, const double *given, const double *vector, double *out) {
    for (int64_t i = 0; i < c->size; i++) {
        double total = given[i];
        for (int64_t m = 0; m < c->size; m++) total -= c->coupling[i * c->size + m] * vector[m];
        out[i] = total;
    }
}

/* (1 + C k)^-1 times a vector, k = root^2, by the factor; by its series where that is as good. */
static void relieved(const coupled_roller *c, const double *given, double *out) {
    const double *root = c->root, *factor = c->factor;
    const int64_t size = c->size;
    double *held = c->held;
    if (c->weak) {
        for (int64_t i = 0; i < size; i++) held[i] = root[i] * root[i] * given[i];
        less_coupled(c, given, held, out);
        return;
    }
    for (int64_t i = 0; i < size; i++) {
        double total = root[i] * given[i];
        for (int64_t m = 0; m < i; m++) total -= factor[i * size + m] * held[m];
        held[i] = total / factor[i * size + i];
    }
    for (int64_t i = size - 1; i >= 0; i--) {
        double total = held[i];
        for (int64_t m = i + 1; m < size; m++) total -= factor[m * size + i] * held[m];
        held[i] = total / factor[i * size + i];
    }
    for (int64_t i = 0; i < size; i++) held[i] *= root[i];
    less_coupled(c, given, held, out);
}

/* Find what approaches miss, overlap - own - C w, and the largest of it; states are read anew. */
static double missing_of(const ehd_cylinder_law *law, const coupled_roller *c, int *status) {
    double largest = 0.0;
    *status |= read_coupled(law, c);
    for (int64_t i = 0; i < c->size; i++) {
        double total = c->overlap[i] - c->own[i];
        for (int64_t m = 0; m < c->size; m++) total -= c->coupling[i * c->size + m] * c->states.value[m][0];
        c->left[i] = total;
        largest = most(largest, fabs(total));
    }
    return largest;
}

/* Approaches that the law takes, with states, roots of the slopes and factor. EHD_NO_LOADS where there are none. */
static int settle_coupled(const ehd_cylinder_law *law, coupled_roller *c) {
    double strength = 0.0;
    int status = EHD_OK;
    for (int64_t i = 0; i < c->size; i++) {
        double total = 0.0;
        for (int64_t m = 0; m < c->size; m++) total += fabs(c->coupling[i * c->size + m]);
        strength = most(strength, total);
        c->own[i] = c->overlap[i];
    }
    double missing = missing_of(law, c, &status);
    for (int n = 0; n < COUPLED_STEPS; n++) {
        double stiffest = 0.0, largest = 0.0;
        for (int64_t i = 0; i < c->size; i++) {
            const double slope = c->states.slope[i][0];
            c->root[i] = sqrt(most(slope, 0.0));
            stiffest = most(stiffest, slope);
            largest = most(largest, fabs(c->own[i]));
        }
        c->weak = stiffest * strength < COUPLED_WEAK;
        if (!c->weak && !factor_coupled(c)) return EHD_NO_LOADS;
        if (missing <= COUPLED_CLOSE * (largest + COUPLED_SCALE)) return status;
        relieved(c, c->left, c->step);
        const double before = missing;
        double share = 1.0;
        memcpy(c->tried, c->own, (size_t)c->size * sizeof(double));
        for (int k = 0; k < COUPLED_HALVINGS; k++) {
            for (int64_t i = 0; i < c->size; i++) c->own[i] = c->tried[i] + share * c->step[i];
            missing = missing_of(law, c, &status);
            if (missing < before) break;
            share *= 0.5;
        }
    }
    return EHD_NO_LOADS;
}

/* Add what the slices of a roller bear at its rates to its sums. */
static void coupled_sums(const ehd_cylinder *bearing, const roller *r, const coupled_roller *c, sums *sum) {
    const double *x = bearing->position;
    *sum = NO_SUMS;
    for (int64_t i = 0; i < c->size; i++) {
        const double *value = c->states.value[i], *slope = c->states.slope[i], flat = c->flat[i], tilted = c->tilted[i];
        ehd_force moving;
        unilateral(value[0], slope[0], value[1], slope[1], flat * r->rate + tilted * r->tilt_rate, &moving);
        const double more = moving.load - value[0], stiffer = moving.stiffness - slope[0];
        sum->w[0] += value[0] + flat * more;
        sum->w[1] += value[0] * x[i] + tilted * more;
        sum->k[0] += slope[0] * flat + stiffer * flat * flat;
        sum->k[1] += slope[0] * flat * x[i] + stiffer * flat * tilted;
        sum->k[2] += slope[0] * tilted * x[i] + stiffer * tilted * tilted;
        sum->c[0] += moving.damping * flat * flat;
        sum->c[1] += moving.damping * flat * tilted;
        sum->c[2] += moving.damping * tilted * tilted;
    }
}

/* Arrays of a roller within the work space of a call, (slices, slices + 9). */
static coupled_roller coupled_of(const ehd_cylinder_call *call) {
    coupled_roller c;
    const int64_t n = call->bearing->slices;
    double *at = call->scratch, **arrays[] = {&c.overlap, &c.root, &c.left, &c.step,   &c.tried,
                                              &c.held,    &c.ones, &c.flat, &c.tilted, &c.factor};
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++, at += n) *arrays[k] = at;
    c.size = n;
    c.coupling = call->coupling;
    c.weak = 0;
    for (int64_t i = 0; i < n; i++) c.ones[i] = 1.0;
    return c;
}

/* Force, stiffness and damping of a bearing with coupled slices at a motion that is not wrong. */
static int coupled_force(const ehd_cylinder_call *call, const ehd_ring_motion *motion, ehd_bearing_force *answer) {
    const ehd_cylinder *bearing = call->bearing;
    coupled_roller c = coupled_of(call);
    int status = EHD_OK;
    memset(answer, 0, sizeof *answer);
    for (int64_t j = 0; j < bearing->rollers; j++) {
        const roller r = roller_of(bearing, motion, j);
        sums sum;
        c.own = call->own + j * c.size;
        c.states = roller_slices(bearing, call->work, j);
        for (int64_t i = 0; i < c.size; i++) c.overlap[i] = approach_of(bearing, &r, i);
        if (r.deepest <= call->law->numbers->lift_off) {
            memcpy(c.own, c.overlap, (size_t)c.size * sizeof(double));
            fill_states(bearing, &c.states, 0);
            continue;
        }
        status |= settle_coupled(call->law, &c);
        if (status & EHD_NO_LOADS) return status;
        relieved(&c, c.ones, c.flat);
        relieved(&c, bearing->position, c.tilted);
        coupled_sums(bearing, &r, &c, &sum);
        add_roller(&r, &sum, answer);
        for (int64_t i = 0; i < c.size; i++)
            if (c.states.value[i][0] > call->law->numbers->highest) status |= EHD_ABOVE_LOAD;
    }
    finish_answer(bearing, 1.0, answer);
    return status;
}
