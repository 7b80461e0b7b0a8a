/* ---------------------------------------------------------------------------------------------------------------------
 * Films of a table, read at many points, and the nodes of a law's table
 * ------------------------------------------------------------------------------------------------------------------ */

void ehd_spline_weights(const double *knots, int64_t count, int64_t n, const double *x, int64_t *first, double *weights,
                        double *slopes) {
    for (int64_t i = 0; i < n; i++) {
        int64_t low = 3, high = count - 4; /* knots[low] <= x[i] < knots[high], but at the ends */
        while (high - low > 1) {
            const int64_t middle = (low + high) / 2;
            if (x[i] < knots[middle])
                high = middle;
            else
                low = middle;
        }
        double *basis = weights + 4 * i, *slope = slopes + 4 * i, lower[3];
        basis[0] = 1.0;
        for (int degree = 1; degree <= 3; degree++) {
            double before = 0.0;
            for (int r = 0; r < degree; r++) {
                const double right = knots[low + r + 1], left = knots[low + 1 - degree + r];
                const double share = basis[r] / (right - left);
                if (degree == 3) lower[r] = share;
                basis[r] = before + (right - x[i]) * share;
                before = (x[i] - left) * share;
            }
            basis[degree] = before;
        }
        slope[0] = -3.0 * lower[0]; /* of N(i, 3): 3 (N(i, 2)/(t(i+3) - t(i)) - N(i+1, 2)/(t(i+4) - t(i+1))) */
        slope[1] = 3.0 * (lower[0] - lower[1]);
        slope[2] = 3.0 * (lower[1] - lower[2]);
        slope[3] = 3.0 * lower[2];
        first[i] = low - 3;
    }
}

void ehd_lagrange_weights(const double *nodes, int64_t count, int64_t n, const double *x, double *weights) {
    for (int64_t k = 0; k < count; k++) {
        double unit = 1.0;
        for (int64_t m = 0; m < count; m++)
            if (m != k) unit *= nodes[k] - nodes[m];
        for (int64_t i = 0; i < n; i++) {
            double product = 1.0;
            for (int64_t m = 0; m < count; m++)
                if (m != k) product *= x[i] - nodes[m];
            weights[i * count + k] = product / unit;
        }
    }
}

EHD_CLONES void ehd_table_sums(const double *coefficients, int64_t sizes, int64_t oils, int64_t fields, int64_t n,
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

#define ABREAST 8 /* lines that are taken from memory at once */

void ehd_film_columns(int64_t lines, int64_t cells, const double *breaks, const double *quartic, const double *bend,
                      const double *valley, const double *cubic, int64_t n, const double *places, int64_t *room,
                      double *values, double *slopes, double *cubics) {
    const int64_t width = cells * lines;
    for (int64_t line = 0; line < lines; line++) room[line] = 0;
    for (int64_t i = 0; i < n; i++) {
        for (int64_t line = 0; line < lines; line++) {
            const int64_t at = i * lines + line;
            const double x = least(most(places[at], breaks[0]), breaks[cells]), beyond = places[at] - x;
            const double light = least(x - valley[0], 0.0), heavy = most(x - valley[1], 0.0);
            int64_t cell = room[line]; /* places rise along a line, mostly */
            while (cell > 0 && x < breaks[cell]) cell--;
            while (cell < cells - 1 && x >= breaks[cell + 1]) cell++;
            room[line] = cell;
            const double t = x - breaks[cell], *a = quartic + cell * lines + line, *b = cubic + cell * lines + line;
            const double *c = bend + line;
            double value = 0.0, slope = 0.0, share = 0.0, rate = 0.0;
            for (int k = 0; k < 5; k++) {
                slope = slope * t + value;
                value = value * t + a[k * width];
            }
            for (int k = 0; k < 4; k++) {
                rate = rate * t + share;
                share = share * t + b[k * width];
            }
            value += c[0] + light * light * (c[lines] + light * c[2 * lines]) +
                     heavy * heavy * (c[3 * lines] + heavy * c[4 * lines]);
            slope += light * (2.0 * c[lines] + 3.0 * light * c[2 * lines]) +
                     heavy * (2.0 * c[3 * lines] + 3.0 * heavy * c[4 * lines]);
            values[at] = value + slope * beyond;
            slopes[at] = slope;
            cubics[at] = share + rate * beyond;
        }
    }
}

/* Slopes at its n >= 4 nodes of a cubic spline, not-a-knot. */
static void spline_slopes(int64_t n, const double *x, const double *y, double *upper, double *slopes) {
    const int64_t last = n - 1;
    const double first_step = x[1] - x[0], second_step = x[2] - x[1], both = first_step + second_step;
    upper[0] = both / second_step;
    slopes[0] = ((first_step + 2.0 * both) * second_step * ((y[1] - y[0]) / first_step) +
                 first_step * first_step * ((y[2] - y[1]) / second_step)) / (both * second_step);
    for (int64_t i = 1; i < last; i++) {
        const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
        const double right = 3.0 * (after * ((y[i] - y[i - 1]) / before) + before * ((y[i + 1] - y[i]) / after));
        const double pivot = 2.0 * (before + after) - after * upper[i - 1];
        upper[i] = before / pivot;
        slopes[i] = (right - after * slopes[i - 1]) / pivot;
    }
    const double before = x[last - 1] - x[last - 2], after = x[last] - x[last - 1], end = before + after;
    const double right = (after * after * ((y[last - 1] - y[last - 2]) / before) +
                          (2.0 * end + after) * before * ((y[last] - y[last - 1]) / after)) / end;
    slopes[last] = (right - end * slopes[last - 1]) / (before - end * upper[last - 1]);
    for (int64_t i = last; i-- > 0;) slopes[i] -= upper[i] * slopes[i + 1];
}

/* Cubic between two samples with slopes, at the part t of their distance. */
static double cubic_between(const double *y, const double *slope, double step, double t) {
    const double rise = (y[1] - y[0]) / step;
    const double square = 3.0 * rise - 2.0 * slope[0] - slope[1], cube = slope[0] + slope[1] - 2.0 * rise;
    return y[0] + step * t * (slope[0] + t * (square + t * cube));
}

/* The nodes of one line. */
static void line_nodes(int64_t samples, const double *s, const double *root, const double *slope, const double *logs,
                       const double *rates, int64_t held, int64_t nodes, const double *node, double *values) {
    const int64_t last = samples - 1;
    const double growth = slope[last] / root[last];
    int64_t piece = 0;
    for (int64_t i = 0; i < nodes; i++) {
        const double x = least(most(node[i], s[0]), s[last]), beyond = node[i] - x;
        while (piece < last - 1 && s[piece + 1] < x) piece++;
        const double step = s[piece + 1] - s[piece], t = (x - s[piece]) / step;
        double g = cubic_between(root + piece, slope + piece, step, t);
        double log_ratio = cubic_between(logs + piece, rates + piece, step, t);
        if (beyond < 0.0) g = root[0] + slope[0] * beyond;
        if (beyond > 0.0) g = root[last] * exp(growth * beyond);
        log_ratio += beyond * (beyond < 0.0 ? rates[0] : rates[last]);
        if (held >= 0 && node[i] < s[held]) log_ratio = logs[held];
        values[2 * i] = g;
        values[2 * i + 1] = log_ratio;
    }
}

void ehd_law_nodes(int64_t samples, int64_t lines, const double *s, const double *root, const double *slope,
                   const double *logs, int64_t held, int64_t nodes, const double *node, double *room, double *values) {
    const double *const from[4] = {s, root, slope, logs};
    double *rates = room + 4 * ABREAST * samples, *upper = rates + samples;
    for (int64_t first = 0; first < lines; first += ABREAST) {
        const int64_t count = lines - first < ABREAST ? lines - first : ABREAST;
        for (int part = 0; part < 4; part++) /* lines abreast share what is read from memory */
            for (int64_t i = 0; i < samples; i++)
                for (int64_t k = 0; k < count; k++)
                    room[(part * ABREAST + k) * samples + i] = from[part][i * lines + first + k];
        for (int64_t k = 0; k < count; k++) {
            const double *x = room + k * samples, *y = x + 3 * ABREAST * samples;
            spline_slopes(samples, x, y, upper, rates);
            line_nodes(samples, x, x + ABREAST * samples, x + 2 * ABREAST * samples, y, rates, held, nodes, node,
                       values + (first + k) * nodes * 2);
        }
    }
}
