/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory of the slices of rollers, see pair_memory.c
 * ------------------------------------------------------------------------------------------------------------------ */

/* Bring the memory (rollers, 2, EHD_TAPER_MEMORY, slices) of cone and cup to the end of the step over which they held.
 * rollers: in balance at that end; approaches (slices,): work space. */
void ehd_taper_go_on(const ehd_taper_data *data, const ehd_pair_law law[2], const ehd_pair_springs *springs,
                     const ehd_taper_roller *rollers, double *approaches, double *memory) {
    const int64_t n = data->slices;
    for (int64_t j = 0; j < data->rollers; j++)
        for (int side = 0; side < 2; side++, memory += EHD_TAPER_MEMORY * n) {
            const double *normal = side ? data->cup : data->cone;
            double moved[3];
            for (int k = 0; k < 3; k++)
                moved[k] = side ? rollers[j].place[k] : rollers[j].ring[k] - rollers[j].place[k];
            const double approach = normal[0] * moved[0] + normal[1] * moved[1] - rollers[j].play + rollers[j].added[side];
            for (int64_t i = 0; i < n; i++) approaches[i] = approach + moved[2] * data->lever[i] - data->profile[i];
            pair_go_on(law + side, springs, EHD_TAPER_SPRINGS, side, n, approaches, memory);
        }
}
