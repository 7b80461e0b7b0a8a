/* ---------------------------------------------------------------------------------------------------------------------
 * Deviations of a bearing from its form; see deviations.h
 * ------------------------------------------------------------------------------------------------------------------ */

#define DEVIATIONS_TURN 6.283185307179586476925

/* Place of an angle on a table, within 0 to nodes. */
static double deviation_place(const ehd_deviations *of, double angle) {
    const double turns = angle / DEVIATIONS_TURN;
    return (turns - floor(turns)) * (double)of->nodes;
}

/* Weights of values and changes by a node of two nodes, left and right in turn, in a cubic at a part t of the way between
 * them, and in its slope. */
EHD_INLINE void deviation_weights(double t, double value[4], double slope[4]) {
    const double r = 1.0 - t, tr = t * r;
    value[2] = t * t * (3.0 - 2.0 * t);
    value[0] = 1.0 - value[2];
    value[1] = tr * r;
    value[3] = -tr * t;
    slope[2] = 6.0 * tr;
    slope[0] = -slope[2];
    slope[1] = r * (r - 2.0 * t);
    slope[3] = t * (t - 2.0 * r);
}

void ehd_deviations_by(const ehd_deviations *of, const double *angles, const double *speeds, double *added) {
    const double per_angle = (double)of->nodes / DEVIATIONS_TURN, half = 0.5 * (double)of->nodes;
    const double spin = deviation_place(of, angles[3]);
    const int64_t last = of->nodes - 1, row = 2 * of->owned;
    for (int side = 0; side < 2; side++) {
        const double ring = deviation_place(of, angles[0] - angles[1 + side]), own = side ? spin : spin + half;
        const double rate = per_angle * (speeds[0] - speeds[1 + side]), own_rate = per_angle * speeds[3];
        const int64_t own_cell = (int64_t)own, of_ring = of->tables[side];
        const double *before = of->own + row * (own_cell & last), *after = of->own + row * ((own_cell + 1) & last);
        double v[4], k[4];
        deviation_weights(own - (double)own_cell, v, k); /* all elements have turned alike */
        for (int64_t j = 0; j < of->elements; j++) {
            const int64_t of_own = 2 * of->tables[3 * j + 2];
            double value = of->sizes[j], change = 0.0;
            if (of_ring >= 0) {
                const double place = ring + of->places[j];
                const int64_t cell = (int64_t)place;
                const double *table = of->table + 2 * of_ring * of->nodes;
                const double *left = table + 2 * (cell & last), *right = table + 2 * ((cell + 1) & last);
                const double t = place - (double)cell, rise = right[0] - left[0];
                const double both = left[1] + right[1] - 2.0 * rise, bend = rise - left[1] - both;
                value += left[0] + t * (left[1] + t * (bend + t * both));
                change = rate * (left[1] + t * (2.0 * bend + 3.0 * t * both));
            }
            if (of_own >= 0) {
                const double *left = before + of_own, *right = after + of_own;
                value += v[0] * left[0] + v[1] * left[1] + v[2] * right[0] + v[3] * right[1];
                change += own_rate * (k[0] * left[0] + k[1] * left[1] + k[2] * right[0] + k[3] * right[1]);
            }
            added[2 * (2 * j + side)] = value;
            added[2 * (2 * j + side) + 1] = change;
        }
    }
}

#ifdef EHD_NUMBER /* runs in Python's library; exports have angles and speeds of each ring */

const double *ehd_deviations_at(const ehd_deviations *of, double angle, double speed) {
    double angles[4], speeds[4];
    if (!of || of->elements == 0) return NULL;
    if (of->moment[0] == angle && of->moment[1] == speed) return of->added;
    of->moment[0] = angle;
    of->moment[1] = speed;
    for (int i = 0; i < 4; i++) {
        angles[i] = of->turns[i] * angle + (i ? 0.0 : of->start);
        speeds[i] = of->turns[i] * speed;
    }
    ehd_deviations_by(of, angles, speeds, of->added);
    return of->added;
}

/* What deviations add to a bearing of several, or null where none has any. */
static const double *deviations_of(const ehd_deviations *all, int64_t b, const ehd_moment *at) {
    return all ? ehd_deviations_at(all + b, at->angle, at->speed) : NULL;
}

EHD_SIZE_OF(ehd_deviations)

#endif
