/* ---------------------------------------------------------------------------------------------------------------------
 * Laws of contacts over the entrainment speed
 *
 * Between speeds that are even in ln u all is a polynomial through the four nearest ones; beyond the ends that of the end.
 * Parts of the damping that springs of films with memory have are straight between two speeds.
 * ------------------------------------------------------------------------------------------------------------------ */

#define PAIR_NEIGHBOURS 4
#define PAIR_SAME_SPEED 1e-5 /* part of a speed within which it is that of the table: as typed with six digits */

/* Neighbours of a place x in steps from the first speed: the first one; how many, and the weights of the polynomial. */
static int64_t pair_weights(int64_t speeds, double x, int64_t *count, double weight[PAIR_NEIGHBOURS]) {
    *count = speeds < PAIR_NEIGHBOURS ? speeds : PAIR_NEIGHBOURS;
    const int64_t last = speeds - *count, wanted = (int64_t)floor(x) - (*count / 2 - 1);
    const int64_t first = wanted < 0 ? 0 : wanted > last ? last : wanted;
    for (int64_t i = 0; i < *count; i++) {
        weight[i] = 1.0;
        for (int64_t k = 0; k < *count; k++)
            if (k != i) weight[i] *= (x - (double)(first + k)) / (double)(i - k);
    }
    return first;
}

/* Law of a contact at a speed u >= 0 [m/s], side 0 the inner one: its centre, scale and table (rows, 4), which is written,
 * as are the springs (rows, springs + 1) of films with memory [N/m] and the longest of their times [s]. Returns 0 or
 * EHD_PAIR_OUTSIDE_SPEED. */
int ehd_pair_law_at(const ehd_pair_speeds *of, int side, double u, ehd_pair_law *law, double *table, double *springs) {
    const double held = least(most(u, of->lowest), of->highest);
    const double steps = of->speeds > 1 ? (log(held) - of->first_log) * of->per_log : 0.0;
    const double x = least(most(steps, 0.0), (double)of->speeds - 1.0);
    const int64_t size = 4 * of->rows, columns = of->springs + 1;
    double weight[PAIR_NEIGHBOURS];
    int64_t count;
    const int64_t first = pair_weights(of->speeds, x, &count, weight);
    law->centre = law->scale = 0.0;
    law->table = table;
    for (int64_t n = 0; n < size; n++) table[n] = 0.0;
    for (int64_t i = 0; i < count; i++) {
        const double *place = of->places[side] + 2 * (first + i), *from = of->tables[side] + size * (first + i);
        law->centre += weight[i] * place[0];
        law->scale += weight[i] * place[1];
        for (int64_t n = 0; n < size; n++) table[n] += weight[i] * from[n];
    }
    if (of->springs > 0) {
        const int64_t low = x < (double)of->speeds - 1.0 ? (int64_t)x : of->speeds - 1;
        const int64_t high = low + 1 < of->speeds ? low + 1 : low;
        for (int64_t row = 0; row < of->rows; row++) {
            const double *slow = of->shares[side] + columns * (of->rows * low + row);
            const double *fast = of->shares[side] + columns * (of->rows * high + row);
            double *out = springs + columns * row, time = 0.0;
            for (int64_t i = 0; i < count; i++)
                time += weight[i] * of->shares[side][columns * (of->rows * (first + i) + row) + of->springs];
            time = exp(time);
            for (int64_t r = 0; r < of->springs; r++) {
                const double share = slow[r] + (x - (double)low) * (fast[r] - slow[r]);
                out[r] = share * exp(table[4 * row + 2]) / (of->times[r] * time);
            }
            out[of->springs] = time;
        }
    }
    return fabs(u - held) > PAIR_SAME_SPEED * held ? EHD_PAIR_OUTSIDE_SPEED : 0;
}
