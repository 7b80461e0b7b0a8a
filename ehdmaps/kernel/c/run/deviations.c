/* ---------------------------------------------------------------------------------------------------------------------
 * Deviations of a bearing from its form; see deviations.h
 * ------------------------------------------------------------------------------------------------------------------ */

/* Add the value of a table at an angle, and its rate by that of the angle, to out (2,). */
static void add_deviation(const ehd_deviations *of, int64_t table, double angle, double rate, double *out) {
    const double per_turn = (double)of->nodes / 6.283185307179586476925;
    if (table < 0) return;
    const double turns = angle / 6.283185307179586476925, place = (turns - floor(turns)) * (double)of->nodes;
    const int64_t cell = place < (double)of->nodes ? (int64_t)place : of->nodes - 1;
    const double t = place - (double)cell, r = 1.0 - t;
    const double *low = of->table + 2 * (table * (of->nodes + 1) + cell), *high = low + 2;
    const double change = high[0] - low[0];
    out[0] += low[0] + t * t * (3.0 - 2.0 * t) * change + t * r * (low[1] * r - high[1] * t);
    out[1] += rate * per_turn * (6.0 * t * r * change + low[1] * r * (r - 2.0 * t) + high[1] * t * (t - 2.0 * r));
}

const double *ehd_deviations_at(const ehd_deviations *of, double angle, double speed) {
    if (!of || of->elements == 0) return NULL;
    if (of->moment[0] == angle && of->moment[1] == speed) return of->added;
    of->moment[0] = angle;
    of->moment[1] = speed;
    const double *turns = of->turns, spin = turns[3] * angle;
    for (int64_t j = 0; j < of->elements; j++) {
        const int64_t *tables = of->tables + 3 * j;
        const double place = of->start + of->places[j] + turns[0] * angle;
        for (int side = 0; side < 2; side++) {
            double *out = of->added + 2 * (2 * j + side);
            const double ring = turns[1 + side], half = side ? 0.0 : 3.14159265358979323846;
            out[0] = of->sizes[j];
            out[1] = 0.0;
            add_deviation(of, tables[side], place - ring * angle, (turns[0] - ring) * speed, out);
            add_deviation(of, tables[2], spin + half, turns[3] * speed, out);
        }
    }
    return of->added;
}

/* What deviations add to a bearing of several, or null where none has any. */
static const double *deviations_of(const ehd_deviations *all, int64_t b, const ehd_moment *at) {
    return all ? ehd_deviations_at(all + b, at->angle, at->speed) : NULL;
}

EHD_SIZE_OF(ehd_deviations)
