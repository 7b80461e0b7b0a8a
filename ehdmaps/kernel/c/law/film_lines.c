/* ---------------------------------------------------------------------------------------------------------------------
 * Films of a table, read at many points
 * ------------------------------------------------------------------------------------------------------------------ */

void ehd_table_sums(const double *coefficients, int64_t sizes, int64_t oils, int64_t fields, int64_t n,
                    const int64_t *first, const double *by_zeta, const double *by_size, const double *by_oil,
                    double *room, double *sums) {
    const int64_t width = oils * fields;
    for (int64_t i = 0; i < n; i++) {
        double *sum = sums + i * fields;
        for (int64_t k = 0; k < width; k++) room[k] = 0.0;
        for (int64_t p = 0; p < 4; p++) {
            for (int64_t q = 0; q < 4; q++) {
                const double *near = coefficients + ((first[2 * i] + p) * sizes + first[2 * i + 1] + q) * width;
                const double weight = by_zeta[4 * i + p] * by_size[4 * i + q];
                for (int64_t k = 0; k < width; k++) room[k] += weight * near[k]; /* long enough for vectors */
            }
        }
        for (int64_t field = 0; field < fields; field++) {
            sum[field] = 0.0;
            for (int64_t oil = 0; oil < oils; oil++) sum[field] += by_oil[i * oils + oil] * room[oil * fields + field];
        }
    }
}

void ehd_table_lines(const double *lattice, int64_t nodes, double first, double spacing, int64_t count,
                     const int64_t *lines, const double *weights, int64_t n, const double *zeta, double *out) {
    for (int64_t i = 0; i < n; i++) {
        const double place = (zeta[i] - first) / spacing, last = (double)(nodes - 2);
        const double cell = least(most(floor(place), 0.0), last), t = least(most(place - cell, 0.0), 1.0), s = 1.0 - t;
        const double beyond = (place - cell - t) * spacing;
        const double value_0 = s * s * (1.0 + 2.0 * t), value_1 = t * t * (3.0 - 2.0 * t);
        const double slope_0 = t * s * s * spacing, slope_1 = -t * t * s * spacing;
        double film = 0.0, rate = 0.0, loss = 0.0;
        for (int64_t m = 0; m < count; m++) {
            const double *a = lattice + (lines[m] * nodes + (int64_t)cell) * 5, *b = a + 5, weight = weights[m];
            const double here = value_0 * a[1] + value_1 * b[1] + slope_0 * a[2] + slope_1 * b[2];
            const double end = (t == 1.0 ? b[4] : a[4]) * beyond;
            film += weight * (value_0 * a[0] + value_1 * b[0] + slope_0 * a[1] + slope_1 * b[1] + here * beyond);
            rate += weight * here;
            loss += weight * (value_0 * a[3] + value_1 * b[3] + slope_0 * a[4] + slope_1 * b[4] + end);
        }
        out[i] = film;
        out[n + i] = rate;
        out[2 * n + i] = loss;
    }
}
