/* ---------------------------------------------------------------------------------------------------------------------
 * The contact law at many places
 * ------------------------------------------------------------------------------------------------------------------ */

/* Causes in counts. */
enum { COUNT_LOAD, COUNT_SPEED, COUNT_TEMPERATURE, COUNT_NOT_FINITE };

/* Nearest nodes of a block along an axis, and the weights of the quadratic B-splines there. */
typedef struct block_nodes {
    double low[MANY], middle[MANY], high[MANY];
    int32_t first[MANY];
} block_nodes;

/* Forces from splines and their slopes, as unilateral has them. */
static inline void block_forces(int n, const law_block *restrict of, const double *restrict rate, double *restrict w,
                                double *restrict k, double *restrict c) {
    for (int i = 0; i < n; i++) {
        const contact_state at = splined(of->g[i], of->dg[i], of->q[i], of->dq[i], of->scale[i]);
        const double load = at.w, slope = at.dw, bend = at.dc, damping = load * at.ratio, part = damping * rate[i];
        const int parting = part < -0.5 * load;
        const double by = load / chosen(parting, part, 1.0);
        const double near_load = load + part, far_load = -0.25 * load * by;
        const double near_slope = slope + bend * rate[i], far_slope = 0.25 * by * (by * bend * rate[i] - 2.0 * slope);
        const double far_damping = 0.25 * by * by * damping;
        w[i] = chosen(parting, far_load, near_load);
        k[i] = chosen(parting, far_slope, near_slope);
        c[i] = chosen(parting, far_damping, damping);
    }
}

/* Whether the line alone answers all places of a block, none of them above the map. */
static inline int line_answers(int n, const double *restrict approach, const double *restrict rate,
                               const double *restrict g, double held_approach, double limit) {
    int64_t others = 0;
    for (int i = 0; i < n; i++)
        others |= !((fabs(rate[i]) <= DBL_MAX) & (-DBL_MAX <= approach[i]) & (approach[i] <= held_approach) &
                    !(g[i] * g[i] * g[i] > limit));
    return !others;
}

/* Force at one place of a point, counted. */
static void count_force(const ehd_law_point *point, double approach, double rate, ehd_force *force, int64_t *counts) {
    no_force(force);
    if (!(is_finite(approach) && is_finite(rate)))
        counts[COUNT_NOT_FINITE]++;
    else if (point_force(point, approach, rate, force))
        counts[COUNT_LOAD]++;
}

/* Forces of a block; whether all of them stand, see line_answers. */
EHD_CLONES static int line_block(const ehd_law_point *point, double limit, int n, const double *approach,
                                 const double *rate, law_block *of, double *w, double *k, double *c) {
    line_places(&point->own, n, approach, of->place, of->scale);
    line_splines(&point->own, n, 1, of);
    block_forces(n, of, rate, w, k, c);
    return line_answers(n, approach, rate, of->g, point->held_approach, limit);
}

void ehd_law_force_many(const ehd_law_point *point, int64_t count, const double *approach, const double *rate,
                        double *forces, int64_t *counts) {
    double *w = forces, *k = forces + count, *c = forces + 2 * count;
    const int plain = point->film == 1.0 && point->centrifugal_load == 0.0;
    const double limit = point->highest_load * (1.0 + LOAD_TOLERANCE);
    law_block of;
    ehd_force force;
    for (int64_t first = 0; first < count; first += MANY) {
        const int n = count - first < MANY ? (int)(count - first) : MANY;
        if (plain && line_block(point, limit, n, approach + first, rate + first, &of, w + first, k + first, c + first))
            continue;
        for (int i = 0; i < n; i++) {
            const int64_t at = first + i;
            if (plain && is_finite(rate[at]) && -DBL_MAX <= approach[at] && approach[at] <= point->held_approach) {
                if (of.g[i] > 0.0 && of.g[i] * of.g[i] * of.g[i] > limit) counts[COUNT_LOAD]++;
                continue;
            }
            count_force(point, approach[at], rate[at], &force, counts);
            w[at] = force.load;
            k[at] = force.stiffness;
            c[at] = force.damping;
        }
    }
}

/* Nearest nodes of places along an axis with so many coefficients. */
static inline void block_axis(int n, const double *restrict x, double start, double step, int64_t coefficients,
                              block_nodes *restrict found) {
    const double last = (double)(coefficients - 3);
    for (int i = 0; i < n; i++) {
        const double place = (x[i] - start) * step, above = place > 0.0 ? place : 0.0;
        const double held = above < last ? above : last;
        const int32_t first = (int32_t)(held + 0.5);
        const double t = held - (double)first, low = 0.5 - t, high = 0.5 + t;
        found->first[i] = first;
        found->low[i] = 0.5 * low * low;
        found->middle[i] = 0.75 - t * t;
        found->high[i] = 0.5 * high * high;
    }
}

/* Means of `count` neighbouring numbers of a table from number m on, by the weights of 3 x 3 speeds and temperatures. */
static inline void block_means(const double *values, int64_t temperatures, int64_t numbers, const block_nodes *speed,
                               const block_nodes *heat, int i, int64_t m, int count, double *restrict sums) {
    const double *row = values + ((int64_t)speed->first[i] * temperatures + heat->first[i]) * numbers + m;
    const double *next = row + temperatures * numbers, *last = next + temperatures * numbers;
    const double u0 = speed->low[i], u1 = speed->middle[i], u2 = speed->high[i];
    const double t0 = heat->low[i], t1 = heat->middle[i], t2 = heat->high[i];
    for (int n = 0; n < count; n++)
        sums[n] = u0 * (t0 * row[n] + t1 * row[numbers + n] + t2 * row[2 * numbers + n]) +
                  u1 * (t0 * next[n] + t1 * next[numbers + n] + t2 * next[2 * numbers + n]) +
                  u2 * (t0 * last[n] + t1 * last[numbers + n] + t2 * last[2 * numbers + n]);
}

EHD_CLONES static void table_block(const ehd_law_data *D, int n, const double *approach, const double *rate,
                                   const double *u, const double *T, law_block *of, double *w, double *k, double *c) {
    const ehd_law_table *table = &D->own;
    const int64_t numbers = 2 * table->places, temperatures = table->temperatures;
    const double last = (double)(table->places > 4 ? table->places - 4 : 0);
    const double start = table->start, step = table->step, cells = (double)(table->places - 3);
    double axis[MANY], offset[MANY], inverse_scale[MANY];
    block_nodes speed, heat;
    for (int i = 0; i < n; i++) {
        const double size = fabs(u[i]);
        axis[i] = plain_log(size > D->lowest_speed ? size : D->lowest_speed);
    }
    block_axis(n, axis, table->log_speed_start, table->log_speed_step, table->speeds, &speed);
    for (int i = 0; i < n; i++) axis[i] = 1.0 / (T[i] - COLDEST);
    block_axis(n, axis, table->temperature_start, table->temperature_step, temperatures, &heat);
    for (int i = 0; i < n; i++) {
        double sums[2];
        block_means(table->place, temperatures, 2, &speed, &heat, i, 0, 2, sums);
        offset[i] = sums[0];
        inverse_scale[i] = sums[1];
    }
    for (int i = 0; i < n; i++) {
        double root;
        of->place[i] = stretched_place((approach[i] - offset[i]) * inverse_scale[i], start, step, cells, &root);
        of->scale[i] = step * inverse_scale[i] / root;
    }
    for (int i = 0; i < n; i++) {
        double sums[8];
        const double place = of->place[i];
        const int cell = (int)(place < last ? place : last);
        const double t = place - cell, r = 1.0 - t, tt = t * t, rr = r * r;
        const double b0 = rr * r / 6.0, b1 = 2.0 / 3.0 - tt * (1.0 - 0.5 * t), b2 = 2.0 / 3.0 - rr * (1.0 - 0.5 * r);
        const double b3 = tt * t / 6.0;
        const double d0 = -0.5 * rr, d1 = t * (1.5 * t - 2.0), d2 = -r * (1.5 * r - 2.0), d3 = 0.5 * tt;
        block_means(table->coefficients, temperatures, numbers, &speed, &heat, i, 2 * cell, 8, sums);
        of->g[i] = b0 * sums[0] + b1 * sums[2] + b2 * sums[4] + b3 * sums[6];
        of->dg[i] = d0 * sums[0] + d1 * sums[2] + d2 * sums[4] + d3 * sums[6];
        of->q[i] = b0 * sums[1] + b1 * sums[3] + b2 * sums[5] + b3 * sums[7];
        of->dq[i] = d0 * sums[1] + d1 * sums[3] + d2 * sums[5] + d3 * sums[7];
    }
    block_forces(n, of, rate, w, k, c);
}

/* Whether the table alone answers a place. */
static int answered(const ehd_law_data *D, double approach, double rate, double u, double T, double q, double g) {
    const double speed = fabs(u);
    return D->film_speed <= speed && D->lowest_speed <= speed && speed <= D->counted_speed && D->counted_cold <= T &&
           T <= D->counted_hot && q == 0.0 && is_finite(approach) && is_finite(rate) &&
           (g <= 0.0 || g * g * g <= D->known_load);
}

/* Make a point where it is not that of the last place; its status is counted. */
static void count_point(const ehd_law_data *D, double u, double T, double q, ehd_law_point *room, int *made,
                        double asked[3], int64_t *counts) {
    if (!(*made && asked[0] == u && asked[1] == T && asked[2] == q)) {
        ehd_law_make(D, u, T, q, room);
        asked[0] = u;
        asked[1] = T;
        asked[2] = q;
        *made = 1;
    }
    counts[COUNT_LOAD] += (room->status & EHD_BAD_CENTRIFUGAL) != 0;
    counts[COUNT_SPEED] += (room->status & EHD_ABOVE_SPEED) != 0;
    counts[COUNT_TEMPERATURE] += (room->status & EHD_OUTSIDE_TEMPERATURE) != 0;
}

void ehd_law_call_many(const ehd_law_data *D, int64_t count, const double *approach, const double *rate, const double *u,
                       const double *T, const double *q, ehd_law_point *room, double *forces, int64_t *counts) {
    double *w = forces, *k = forces + count, *c = forces + 2 * count, asked[3] = {0.0, 0.0, 0.0};
    law_block of;
    int made = 0;
    for (int64_t first = 0; first < count; first += MANY) {
        const int n = count - first < MANY ? (int)(count - first) : MANY;
        table_block(D, n, approach + first, rate + first, u + first, T + first, &of, w + first, k + first, c + first);
        for (int i = 0; i < n; i++) {
            const int64_t at = first + i;
            ehd_force force;
            if (answered(D, approach[at], rate[at], u[at], T[at], q[at], of.g[i])) continue;
            no_force(&force);
            if (is_finite(approach[at]) && is_finite(rate[at]) && is_finite(u[at]) && is_finite(T[at]) &&
                is_finite(q[at])) {
                count_point(D, u[at], T[at], q[at], room, &made, asked, counts);
                count_force(room, approach[at], rate[at], &force, counts);
            } else {
                counts[COUNT_NOT_FINITE]++;
            }
            w[at] = force.load;
            k[at] = force.stiffness;
            c[at] = force.damping;
        }
    }
}

int ehd_law_run(ehd_law_errand *of) {
    return ehd_law_call(of->data, of->approach, of->rate, of->u, of->T, of->q, of->room, &of->force);
}
