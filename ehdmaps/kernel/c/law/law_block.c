/* ---------------------------------------------------------------------------------------------------------------------
 * The contact law at rest at a block of places, in loops that compilers put into vector instructions
 *
 * Numbers of a place do not depend on its neighbours, nor on the processor.
 * ------------------------------------------------------------------------------------------------------------------ */

#define MANY 64          /* places in a block */
#define ROUNDS 4         /* of Newton's method for a whole block */

/* Splines of a block, their slopes, and what they are made from. */
typedef struct law_block {
    double place[MANY], scale[MANY], g[MANY], dg[MANY], q[MANY], dq[MANY];
} law_block;

/* States of a block, as contact_state has them, and second derivatives of the load by the approach. */
typedef struct block_states {
    double w[MANY], dw[MANY], ratio[MANY], dc[MANY], curvature[MANY];
} block_states;

/* One of two numbers: compilers make no branch of it. */
static inline double chosen(int first, double yes, double no) {
    const uint64_t mask = UINT64_C(0) - (uint64_t)first;
    return number_of_bits((bits_of(yes) & mask) | (bits_of(no) & ~mask));
}

/* x within -700 to 700. */
static inline double held_exponent(double x) {
    x = chosen(x > -700.0, x, -700.0);
    return chosen(x < 700.0, x, 700.0);
}

/* Place of z = (approach - offset)/scale in cells of a line, and sqrt(1 + z^2). */
EHD_INLINE double stretched_place(double z, double start, double step, double cells, double *root) {
    *root = sqrt(1.0 + z * z);
    const double size = plain_log(fabs(z) + *root), s = z >= 0.0 ? size : -size, x = (s - start) * step;
    const double above = x > 0.0 ? x : 0.0;
    return above < cells ? above : cells;
}

/* State of a contact from splines and their slopes, as state_of has it. */
EHD_INLINE contact_state splined(double g, double dg, double q, double dq, double scale) {
    contact_state found;
    g = chosen(g > 0.0, g, 0.0);
    found.w = g * g * g;
    found.dw = 3.0 * g * g * (dg * scale);
    found.ratio = plain_exp(held_exponent(q));
    found.dc = found.ratio * (found.dw + found.w * (dq * scale));
    return found;
}

/* Places in cells of a line, and their derivatives by the approach. */
static inline void line_places(const ehd_line *line, int n, const double *restrict approach, double *restrict place,
                               double *restrict scale) {
    const double offset = line->offset, inverse = line->inverse_scale, start = line->start, step = line->step;
    const double cells = (double)line->cells, by = step * inverse;
    for (int i = 0; i < n; i++) {
        double root;
        place[i] = stretched_place((approach[i] - offset) * inverse, start, step, cells, &root);
        scale[i] = by / root;
    }
}

/* Cell of a place. */
EHD_INLINE int block_cell(double place, double last) { return (int)(place < last ? place : last); }

static inline double last_cell(const ehd_line *line) { return (double)(line->cells > 1 ? line->cells - 1 : 0); }

/* Splines of a line and their slopes: those of the load alone, or of the damping as well. */
EHD_INLINE void line_splines(const ehd_line *line, int n, int all, law_block *of) {
    double(*cells)[2][4] = line_cells(line);
    const double last = last_cell(line);
    for (int i = 0; i < n; i++) {
        const int cell = block_cell(of->place[i], last);
        const double t = of->place[i] - cell, *a = cells[cell][0], *b = cells[cell][1];
        of->g[i] = a[0] + t * (a[1] + t * (a[2] + t * a[3]));
        of->dg[i] = a[1] + t * (2.0 * a[2] + 3.0 * t * a[3]);
        if (!all) continue;
        of->q[i] = b[0] + t * (b[1] + t * (b[2] + t * b[3]));
        of->dq[i] = b[1] + t * (2.0 * b[2] + 3.0 * t * b[3]);
    }
}

/* States of a line. */
EHD_INLINE void line_states(const ehd_line *line, int n, const double *restrict approach,
                            block_states *restrict found) {
    double(*cells)[2][4] = line_cells(line);
    const double last = last_cell(line), offset = line->offset, inverse = line->inverse_scale, step = line->step;
    double bend[MANY];
    law_block of;
    line_places(line, n, approach, of.place, of.scale);
    line_splines(line, n, 1, &of);
    for (int i = 0; i < n; i++) {
        const int cell = block_cell(of.place[i], last);
        const double *a = cells[cell][0];
        bend[i] = 2.0 * a[2] + 6.0 * (of.place[i] - cell) * a[3];
    }
    for (int i = 0; i < n; i++) {
        const contact_state state = splined(of.g[i], of.dg[i], of.q[i], of.dq[i], of.scale[i]);
        const double g = chosen(of.g[i] > 0.0, of.g[i], 0.0), slope = of.dg[i] * of.scale[i];
        const double per_s = of.scale[i] / step, z = (approach[i] - offset) * inverse;
        const double change = bend[i] * of.scale[i] * of.scale[i] - slope * z * (per_s / inverse) * per_s;
        found->w[i] = state.w;
        found->dw[i] = state.dw;
        found->ratio[i] = state.ratio;
        found->dc[i] = state.dc;
        found->curvature[i] = 3.0 * g * (2.0 * slope * slope + g * change);
    }
}

/* A step of Newton's method towards the equilibria of a block that are not found; returns how many are left. */
EHD_CLONES static int64_t approach_balance(const ehd_law_point *point, int n, const double *restrict approach,
                                           double *restrict inner, int64_t *restrict done) {
    const double q = point->centrifugal_load;
    double outer[MANY];
    law_block i, o;
    int64_t left = 0;
    for (int k = 0; k < n; k++) outer[k] = approach[k] - inner[k];
    line_places(&point->inner, n, inner, i.place, i.scale);
    line_places(&point->outer, n, outer, o.place, o.scale);
    line_splines(&point->inner, n, 0, &i);
    line_splines(&point->outer, n, 0, &o);
    for (int k = 0; k < n; k++) {
        const double x = chosen(i.g[k] > 0.0, i.g[k], 0.0), y = chosen(o.g[k] > 0.0, o.g[k], 0.0);
        const double wi = x * x * x + q, wo = y * y * y, excess = plain_log(wi / wo);
        const double slope = 3.0 * (x * x * (i.dg[k] * i.scale[k]) / wi + y * y * (o.dg[k] * o.scale[k]) / wo);
        const double next = inner[k] - excess / slope;
        const int64_t before = done[k];
        inner[k] = chosen(before != 0, inner[k], next);
        done[k] = before | (fabs(excess) <= CLOSE_LOADS);
        left += !done[k];
    }
    return left;
}

/* States of a block between both contacts, from the division of their approaches. */
EHD_CLONES static void joined_states(const ehd_law_point *point, int n, const double *restrict approach,
                                     double *restrict inner, block_states *restrict found) {
    const double lowest = point->inner_lift_off, start = point->outer_start;
    double outer[MANY];
    block_states i, o;
    for (int k = 0; k < n; k++) { /* the bracket is exact but for the rounding of the lines */
        const double highest = approach[k] - start, a = chosen(inner[k] > lowest, inner[k], lowest);
        inner[k] = chosen(a < highest, a, highest);
        outer[k] = approach[k] - inner[k];
    }
    line_states(&point->inner, n, inner, &i);
    line_states(&point->outer, n, outer, &o);
    for (int k = 0; k < n; k++) {
        division divided;
        const contact_state one = {i.w[k], i.dw[k], i.ratio[k], i.dc[k]}, other = {o.w[k], o.dw[k], o.ratio[k], o.dc[k]};
        const contact_state both = joined(&one, i.curvature[k], &other, o.curvature[k], &divided);
        const int loaded = (one.w >= LEAST_LOAD) & (other.w >= LEAST_LOAD);
        found->w[k] = chosen(loaded, both.w, 0.0);
        found->dw[k] = chosen(loaded, both.dw, 0.0);
        found->ratio[k] = chosen(loaded, both.ratio, 0.0);
        found->dc[k] = chosen(loaded, both.dc, 0.0);
    }
}

EHD_CLONES static void own_states(const ehd_law_point *point, int n, const double *approach, block_states *found) {
    line_states(&point->own, n, approach, found);
}

/* States with the whole film at approaches above lift-off; with a centrifugal load from what is known of how they divide,
 * which is overwritten. */
static void full_states(const ehd_law_point *point, int n, const double *approach, double *inner, block_states *found) {
    int64_t done[MANY] = {0}, left = n;
    if (point->centrifugal_load == 0.0) {
        own_states(point, n, approach, found);
        return;
    }
    for (int round = 0; round < ROUNDS && left > 0; round++) left = approach_balance(point, n, approach, inner, done);
    for (int k = 0; k < n && left > 0; k++) {
        division divided = {inner[k], 1.0, 0.0};
        if (done[k]) continue;
        balanced_state(point, approach[k], &divided);
        if (divided.part > 0.0) inner[k] = divided.inner;
    }
    joined_states(point, n, approach, inner, found);
}
