/* ---------------------------------------------------------------------------------------------------------------------
 * Load sharing of film and asperities
 * ------------------------------------------------------------------------------------------------------------------ */

#define SHARE_STEPS 60
#define SHARE_CLOSE 1e-6 /* the step after it would be its square */

/* Value of cubics through even nodes with slopes, straight beyond their ends, and its slope. */
static double along_nodes(const ehd_rough_data *of, const double *values, const double *slopes, double place,
                          double *slope) {
    const double t = (place - of->start) / of->step, inside = least(most(t, 0.0), (double)(of->nodes - 1));
    const double place_of_cell = least(floor(inside), (double)(of->nodes - 2)), r = inside - place_of_cell;
    const int64_t cell = (int64_t)place_of_cell;
    const double y0 = values[cell], y1 = values[cell + 1], s0 = slopes[cell] * of->step, s1 = slopes[cell + 1] * of->step;
    const double bend = 3.0 * (y1 - y0) - 2.0 * s0 - s1, high = s0 + s1 - 2.0 * (y1 - y0);
    const double value = y0 + r * (s0 + r * (bend + r * high));
    *slope = (s0 + r * (2.0 * bend + 3.0 * r * high)) / of->step;
    return value + (t - inside) * of->step * *slope;
}

/* ln(1 + e^s). */
static double softplus(double s) { return s > 0.0 ? s + log1p(exp(-s)) : log1p(exp(s)); }

void ehd_rough_moes(double log_load, double log_oil, double found[3]) {
    const double rigid = log(3.0) - log_load, elastic = log(2.621) - 0.2 * log_load;
    const double rigid_oil = log(1.287) + 2.0 / 3.0 * log_oil;
    const double elastic_oil = log(1.311) - 0.125 * log_load + 0.75 * log_oil;
    const double ratio = exp(elastic - rigid), power = pow(ratio, 7.0 / 3.0);
    const double log_q = rigid + 3.0 / 7.0 * log1p(power), slope_q = -1.0 + 0.8 * power / (1.0 + power);
    const double bend = exp(3.5 * (elastic_oil - rigid_oil)), part = bend / (1.0 + bend);
    const double log_p = elastic_oil - 2.0 / 7.0 * log1p(bend);
    const double slope_p = -0.125 * (1.0 - part), oil_slope_p = 0.75 - part / 12.0;
    const double blend = exp(-2.0 * ratio), s = (7.0 + 8.0 * blend) / 5.0, slope_s = -(16.0 / 5.0) * 0.8 * ratio * blend;
    const double log_quotient = log_p - log_q, size = s * log_quotient, log_sum = softplus(size);
    const double weight = exp(size - log_sum);
    found[0] = log_q + log_sum / s;
    found[1] = slope_q + weight * (slope_p - slope_q) + slope_s * (weight * log_quotient / s - log_sum / (s * s));
    found[2] = weight * oil_slope_p;
}

void ehd_rough_scaled(const ehd_rough_data *data, double log_load, double log_oil, double whole, double whole_slope,
                      double log_share, double found[3]) {
    double shared[3];
    ehd_rough_moes(log_load + 0.5 * log_share, log_oil + 0.75 * log_share, shared);
    const double square = exp(least(2.0 * log_load, 600.0)), half = data->full_from * data->full_from;
    const double exponent = data->oil_exponent * square / (square + half);
    const double by_load = 2.0 * exponent * half / (square + half);
    found[0] = shared[0] - whole - (0.5 + exponent) * log_share;
    found[1] = 0.5 * shared[1] + 0.75 * shared[2] - 0.5 - exponent;
    found[2] = shared[1] - whole_slope - by_load * log_share;
}

/* Balance of film and asperities: s = ln(g/(1 - g)), and its derivatives by ln p along w ~ p^2, and by ln h. At s, ln of
 * the gap is above that of the scaled film by an excess, which rises with s: Newton's method within a bracket. */
static double share_balance(const ehd_rough_data *data, double log_film, double log_pressure, double log_load,
                            double log_oil, double first, double *by_pressure, double *by_film) {
    double whole[3], left = -INFINITY, right = INFINITY, s = first, by_s = 1.0, by_p = 1.0, reach = 1.0;
    ehd_rough_moes(log_load, log_oil, whole);
    for (int n = 0; n < SHARE_STEPS; n++) {
        double film[3];
        const double log_share = -softplus(-s), log_rest = -softplus(s), share = exp(log_share);
        const double gap = along_nodes(data, data->log_gap, data->log_gap_slope, log_pressure + log_rest, &by_p);
        ehd_rough_scaled(data, log_load, log_oil, whole[0], whole[1], log_share, film);
        const double excess = gap - log_film - film[0];
        by_s = -by_p * share - film[1] * (1.0 - share);
        by_p -= 2.0 * film[2];
        if (excess > 0.0)
            right = s;
        else
            left = s;
        double following = s - excess / by_s;
        if (!(left <= following && following <= right)) {
            if (left > -INFINITY && right < INFINITY) {
                following = 0.5 * (left + right);
            } else {
                following = excess > 0.0 ? s - reach : s + reach;
                reach *= 2.0;
            }
        }
        const double moved = fabs(following - s);
        s = following;
        if (moved <= SHARE_CLOSE * (1.0 + fabs(s))) break;
    }
    *by_pressure = -by_p / by_s;
    *by_film = 1.0 / by_s;
    return s;
}

void ehd_rough_share(const ehd_rough_data *data, int64_t n, int64_t lines, const double *roots,
                     const double *log_pressures, const double *pressure_slopes, const double *log_loads,
                     const double *log_oils, const double *films, const double *slopes, double *room, double *out) {
    const double sigma = data->sigma;
    /* where the sample before found the balance, and how it changes with the root */
    double *last = room, *change = room + lines, *offset = out, *slope = out + n * lines, *share_of = out + 2 * n * lines;
    for (int64_t m = 0; m < 2 * lines; m++) room[m] = 0.0;
    for (int64_t i = 0; i < n; i++) {
        for (int64_t j = 0; j < lines; j++) {
            const int64_t at = i * lines + j;
            const double h = films[at], log_p = log_pressures[at], by_root = pressure_slopes[at];
            offset[at] = h;
            slope[at] = slopes[at];
            share_of[at] = 1.0;
            if (h > data->thick * sigma) continue;
            double s_slope = 0.0, share = 0.0, log_rest = 0.0, by_log;
            if (h > 0.0) { /* without a film asperities carry everything */
                double by_p, by_h;
                const double first = last[j] + (i > 0 ? change[j] * (roots[at] - roots[at - lines]) : 0.0);
                const double s = share_balance(data, log(h / sigma), log_p, log_loads[j] + 2.0 * log_p, log_oils[j],
                                               first, &by_p, &by_h);
                s_slope = by_p * by_root + by_h * slopes[at] / h;
                share = 1.0 / (1.0 + exp(-s));
                log_rest = -softplus(s);
                last[j] = s;
                change[j] = s_slope;
            }
            const double x = along_nodes(data, data->distance, data->distance_slope, log_p + log_rest, &by_log);
            offset[at] = sigma * x;
            slope[at] = sigma * by_log * (by_root - share * s_slope);
            share_of[at] = share;
        }
    }
}
