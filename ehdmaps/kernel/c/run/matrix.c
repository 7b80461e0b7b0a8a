/* ---------------------------------------------------------------------------------------------------------------------
 * Connections by matrices in runs: f = -K x - C dx/dt in six displacements, K and C linear between the speeds of a
 * table, and those at its ends beyond it, where the connection counts as outside.
 *
 * Dampings dissipate v^T C v; a stiffness that is not symmetric brings in -v^T (K - K^T)/2 x.
 * ------------------------------------------------------------------------------------------------------------------ */

/* First of what each connection feels, its place among all elements, the number of its speeds; speeds (count, longest)
 * [rad/s] and tables (count, longest, 2, 6, 6) of stiffness and damping. */
typedef struct ehd_matrix_block {
    int64_t count, longest;
    const int64_t *firsts, *places, *counts;
    const double *speeds, *tables;
} ehd_matrix_block;

EHD_SIZE_OF(ehd_matrix_block)

/* Stiffness and damping (2, 6, 6) of a connection at a speed, into out; whether that lies beyond its table. */
static int matrix_at(const ehd_matrix_block *block, int64_t e, double speed, double *out) {
    const int64_t count = block->counts[e];
    const double *speeds = block->speeds + e * block->longest;
    int64_t low = 0;
    while (low + 2 < count && speeds[low + 1] < speed) low++;
    const int64_t high = low + 1 < count ? low + 1 : count - 1;
    double part = 0.0;
    if (high > low) {
        part = (speed - speeds[low]) / (speeds[high] - speeds[low]);
        part = part > 0.0 ? (part < 1.0 ? part : 1.0) : 0.0;
    }
    const double *begin = block->tables + 72 * (e * block->longest + low);
    const double *end = block->tables + 72 * (e * block->longest + high);
    for (int i = 0; i < 72; i++) out[i] = begin[i] + part * (end[i] - begin[i]);
    return count > 1 && (speed < speeds[0] || speed > speeds[count - 1]);
}

int ehd_matrix_block_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    const ehd_matrix_block *block = data;
    const int64_t m = answers->m;
    for (int64_t e = 0; e < block->count; e++) {
        const int64_t first = block->firsts[e];
        double both[72];
        answers->outside[block->places[e]] += matrix_at(block, e, at->speed, both);
        for (int i = 0; i < 6; i++) {
            double total = 0.0;
            for (int j = 0; j < 6; j++) {
                const double k = both[6 * i + j], c = both[36 + 6 * i + j];
                total -= k * motion[first + j] + c * motion[m + first + j];
                answers->slopes[(first + i) * m + first + j] = at->by_q * k + at->by_v * c;
            }
            answers->force[first + i] = total;
        }
    }
    return EHD_FOUND;
}

void ehd_matrix_block_powers(void *data, const ehd_moment *at, const double *motion, const ehd_answers *answers,
                             double *out) {
    const ehd_matrix_block *block = data;
    for (int64_t e = 0; e < block->count; e++) {
        const double *x = motion + block->firsts[e], *rate = x + answers->m;
        double both[72], dissipated = 0.0, driven = 0.0;
        (void)matrix_at(block, e, at->speed, both);
        for (int i = 0; i < 6; i++) {
            for (int j = 0; j < 6; j++) {
                dissipated += rate[i] * both[36 + 6 * i + j] * rate[j];
                driven -= rate[i] * 0.5 * (both[6 * i + j] - both[6 * j + i]) * x[j];
            }
        }
        out[3 * block->places[e]] = dissipated;
        out[3 * block->places[e] + 1] = driven;
    }
}
