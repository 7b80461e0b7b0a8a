/* ---------------------------------------------------------------------------------------------------------------------
 * Films of rollers with memory
 *
 * A slice at rest has the load p(approach). Beside it acts a spring K = c/theta in series with a damper, whose force f
 * is its state: the load is p + f, and where f pulls it is f + sqrt(f^2 + p^2), never a tension. c is the damping of
 * slow motion and theta the relaxation time. Over a step f is exact, see pair_memory.c, so that the balance of a roller
 * stays that of a convex potential.
 *
 * K and theta are read from tables over the approach with the rows of the laws, straight between them; beyond the ends
 * K stays, and theta follows c.
 * ------------------------------------------------------------------------------------------------------------------ */

#define TAPER_SHORTEST 1e-30 /* shortest theta [s]: below any step */

/* Write what all slices hold over a step [s], >= 0: memory (rollers, 2, EHD_TAPER_MEMORY, slices) of cone and cup. */
void ehd_taper_hold(int64_t rollers, int64_t slices, double step, double *memory) {
    for (int64_t line = 0; line < 2 * rollers; line++) {
        double *row = memory + line * EHD_TAPER_MEMORY * slices;
        for (int64_t i = 0; i < slices; i++) {
            double found[2];
            pair_over_step(step, row[EHD_TAPER_STIFFNESS * slices + i], row[EHD_TAPER_TIME * slices + i], found);
            row[EHD_TAPER_LEFT * slices + i] = found[0];
            row[EHD_TAPER_SPRING * slices + i] = found[1];
            row[EHD_TAPER_PULL * slices + i] = found[0] * row[EHD_TAPER_FORCE * slices + i];
        }
    }
}

/* K and theta at an approach; (2,). */
static void taper_springs_at(const ehd_pair_law *law, const ehd_taper_springs *springs, int side, double approach,
                             double *out) {
    const double last = (double)law->rows - 1.0, place = pair_place(law, approach);
    const double held = least(most(place, 0.0), last);
    const int64_t cell = pair_cell(law, held);
    const double t = held - (double)cell, weight = springs->weight;
    const double *low = springs->springs[side] + 2 * cell, *other = springs->others[side] + 2 * cell;
    for (int i = 0; i < 2; i++) {
        out[i] = low[i] + t * (low[2 + i] - low[i]);
        if (weight > 0.0) out[i] += weight * (other[i] + t * (other[2 + i] - other[i]) - out[i]);
    }
    if (place != held) out[1] *= exp(law->table[4 * (place < 0.0 ? 0 : law->rows - 1) + 3] * (place - held));
    out[1] = most(out[1], TAPER_SHORTEST);
}

/* Bring the memory of all slices to the end of the step over which they held, and to K and theta there. rollers: in
 * balance at that end. A dry line keeps no force. */
void ehd_taper_go_on(const ehd_taper_data *data, const ehd_pair_law law[2], const ehd_taper_springs *springs,
                     const ehd_taper_roller *rollers, double *memory) {
    const int64_t n = data->slices;
    for (int64_t j = 0; j < data->rollers; j++)
        for (int side = 0; side < 2; side++) {
            const double *normal = side ? data->cup : data->cone;
            double *row = memory + (2 * j + side) * EHD_TAPER_MEMORY * n, moved[3];
            for (int k = 0; k < 3; k++)
                moved[k] = side ? rollers[j].place[k] : rollers[j].ring[k] - rollers[j].place[k];
            const double approach = normal[0] * moved[0] + normal[1] * moved[1] - rollers[j].play;
            for (int64_t i = 0; i < n; i++) {
                double *force = row + EHD_TAPER_FORCE * n + i, *stiffness = row + EHD_TAPER_STIFFNESS * n + i;
                double *at = row + EHD_TAPER_AT * n + i, *time = row + EHD_TAPER_TIME * n + i;
                const double g = approach + moved[2] * data->lever[i] - data->profile[i];
                const double pushed = row[EHD_TAPER_SPRING * n + i] * (g - *at);
                double after[2] = {0.0, 1.0};
                *at = g;
                if (law[side].rows > 1) {
                    taper_springs_at(law + side, springs, side, g, after);
                    *force = pair_gone_on(*force, row[EHD_TAPER_LEFT * n + i], pushed, *stiffness, after[0]);
                } else
                    *force = 0.0;
                *stiffness = after[0];
                *time = after[1];
            }
        }
}
