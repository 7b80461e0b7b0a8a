/* ---------------------------------------------------------------------------------------------------------------------
 * Deviations of a bearing from its form; see deviations.h
 * ------------------------------------------------------------------------------------------------------------------ */

#define DEVIATIONS_TURN 6.283185307179586476925

/* Place of an angle on a table, within 0 to nodes. */
static double deviation_place(const ehd_deviations *of, double angle) {
    const double turns = angle / DEVIATIONS_TURN;
    return (turns - floor(turns)) * (double)of->nodes;
}

/* Add the value of a table at a place, which may be up to two turns, and its change by a node times rate, to out (2,). */
EHD_INLINE void add_deviation(const ehd_deviations *of, int64_t table, double place, double rate, double *out) {
    const int64_t cell = (int64_t)place;
    const double *own = of->table + 2 * table * of->nodes, *left = own + 2 * (cell & (of->nodes - 1));
    const double *right = own + 2 * ((cell + 1) & (of->nodes - 1)), t = place - (double)cell;
    const double rise = right[0] - left[0], both = left[1] + right[1] - 2.0 * rise, bend = rise - left[1] - both;
    out[0] += left[0] + t * (left[1] + t * (bend + t * both));
    out[1] += rate * (left[1] + t * (2.0 * bend + 3.0 * t * both));
}

const double *ehd_deviations_at(const ehd_deviations *of, double angle, double speed) {
    if (!of || of->elements == 0) return NULL;
    if (of->moment[0] == angle && of->moment[1] == speed) return of->added;
    of->moment[0] = angle;
    of->moment[1] = speed;
    const double *turns = of->turns, per_angle = (double)of->nodes / DEVIATIONS_TURN;
    const double spin = deviation_place(of, turns[3] * angle), half = 0.5 * (double)of->nodes;
    for (int side = 0; side < 2; side++) {
        const double apart = turns[0] - turns[1 + side], rate = per_angle * apart * speed;
        const double ring = deviation_place(of, of->start + apart * angle), own = side ? spin : spin + half;
        for (int64_t j = 0; j < of->elements; j++) {
            const int64_t *tables = of->tables + 3 * j;
            double *out = of->added + 2 * (2 * j + side);
            out[0] = of->sizes[j];
            out[1] = 0.0;
            if (tables[side] >= 0) add_deviation(of, tables[side], ring + of->places[j], rate, out);
            if (tables[2] >= 0) add_deviation(of, tables[2], own, per_angle * turns[3] * speed, out);
        }
    }
    return of->added;
}

/* What deviations add to a bearing of several, or null where none has any. */
static const double *deviations_of(const ehd_deviations *all, int64_t b, const ehd_moment *at) {
    return all ? ehd_deviations_at(all + b, at->angle, at->speed) : NULL;
}

EHD_SIZE_OF(ehd_deviations)
