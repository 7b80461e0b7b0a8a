/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory of the slices of rollers, see pair_memory.c
 * ------------------------------------------------------------------------------------------------------------------ */

/* Approach of the line of the cone, 0, or the cup, 1, of a roller [m]; how it grows along the roller into turn. */
static double taper_approach(const ehd_taper_data *data, const ehd_taper_roller *of, int side, double *turn) {
    const double *normal = side ? data->cup : data->cone;
    double moved[3];
    for (int k = 0; k < 3; k++) moved[k] = side ? of->place[k] : of->ring[k] - of->place[k];
    *turn = moved[2];
    return normal[0] * moved[0] + normal[1] * moved[1] - of->play + of->added[side];
}

/* Bring the memory (rollers, 2, EHD_TAPER_MEMORY, slices) of cone and cup to the end of the step over which they held; by how
 * much the energy of their springs rises [J]. rollers: in balance at that end; approaches (slices,): work space. */
double ehd_taper_go_on(const ehd_taper_data *data, const ehd_pair_law law[2], const ehd_pair_springs *springs,
                       const ehd_taper_roller *rollers, double *approaches, double *memory) {
    const int64_t n = data->slices;
    double rise = 0.0, turn;
    for (int64_t j = 0; j < data->rollers; j++)
        for (int side = 0; side < 2; side++, memory += EHD_TAPER_MEMORY * n) {
            const double approach = taper_approach(data, rollers + j, side, &turn);
            for (int64_t i = 0; i < n; i++) approaches[i] = approach + turn * data->lever[i] - data->profile[i];
            rise += pair_go_on(law + side, springs, EHD_TAPER_SPRINGS, side, n, approaches, memory);
        }
    return rise;
}
