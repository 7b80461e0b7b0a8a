/* ---------------------------------------------------------------------------------------------------------------------
 * Deviations of a bearing from its form; see deviations.h
 * ------------------------------------------------------------------------------------------------------------------ */

#define DEVIATIONS_TURN 6.283185307179586476925

/* Place of an angle on a table, within 0 to nodes. */
static double deviation_place(const ehd_deviations *of, double angle) {
    const double turns = angle / DEVIATIONS_TURN;
    return (turns - floor(turns)) * (double)of->nodes;
}

/* Add the value of a cubic between two nodes at a part t of the way, and its change by a node times rate, to out (2,). */
EHD_INLINE void add_deviation(const double *left, const double *right, double t, double rate, double *out) {
    const double rise = right[0] - left[0], both = left[1] + right[1] - 2.0 * rise, bend = rise - left[1] - both;
    out[0] += left[0] + t * (left[1] + t * (bend + t * both));
    out[1] += rate * (left[1] + t * (2.0 * bend + 3.0 * t * both));
}

void ehd_deviations_by(const ehd_deviations *of, const double *angles, const double *speeds, double *added) {
    const double per_angle = (double)of->nodes / DEVIATIONS_TURN, half = 0.5 * (double)of->nodes;
    const double spin = deviation_place(of, angles[3]);
    const int64_t last = of->nodes - 1, row = 2 * of->owned;
    for (int side = 0; side < 2; side++) {
        const double ring = deviation_place(of, angles[0] - angles[1 + side]), own = side ? spin : spin + half;
        const double rate = per_angle * (speeds[0] - speeds[1 + side]), own_rate = per_angle * speeds[3];
        const int64_t own_cell = (int64_t)own;
        const double *before = of->own + row * (own_cell & last), *after = of->own + row * ((own_cell + 1) & last);
        for (int64_t j = 0; j < of->elements; j++) {
            const int64_t *tables = of->tables + 3 * j, of_ring = tables[side], of_own = 2 * tables[2];
            double *out = added + 2 * (2 * j + side);
            out[0] = of->sizes[j];
            out[1] = 0.0;
            if (of_ring >= 0) {
                const double place = ring + of->places[j], *table = of->table + 2 * of_ring * of->nodes;
                const int64_t cell = (int64_t)place;
                add_deviation(table + 2 * (cell & last), table + 2 * ((cell + 1) & last), place - (double)cell, rate, out);
            }
            if (of_own >= 0) add_deviation(before + of_own, after + of_own, own - (double)own_cell, own_rate, out);
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
