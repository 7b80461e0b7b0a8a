/* ---------------------------------------------------------------------------------------------------------------------
 * Energy of films with memory
 *
 * The work on a contact is w da + p dy + (w - p) dy. The first two terms are stored: they depend on the load w and the
 * state xi alone. The last one is taken up for good. This holds at one speed and temperature; all is per unit length of
 * contact [J/m].
 * ------------------------------------------------------------------------------------------------------------------ */

/* Gauss' three points over 0 to 1, exact for the product of two cubics' values and slopes. */
static const double GAUSS_PLACE[3] = {0.11270166537925831, 0.5, 0.8872983346207417};
static const double GAUSS_WEIGHT[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

/* What a film takes up from one state and load to others, (w - p) dy by the trapezoidal rule. */
static double spent_by_film(const ehd_film_table *film, double before, double load_before, double state, double load) {
    reading begin[3], end[3];
    if (before == state) return 0.0;
    equilibrium(film, before, begin);
    equilibrium(film, state, end);
    return 0.5 * (load_before - begin[P_OF].value + load - end[P_OF].value) * (end[Y_OF].value - begin[Y_OF].value);
}

/* Integral of p dy over a part of a cell. */
static double over_cell(const double cell[3][4], double begin, double end) {
    double total = 0.0;
    for (int i = 0; i < 3; i++) {
        const double t = begin + GAUSS_PLACE[i] * (end - begin);
        total += GAUSS_WEIGHT[i] * read_cubic(cell[P_OF], t).value * read_cubic(cell[Y_OF], t).slope;
    }
    return total * (end - begin);
}

/* Integral of p dy up to a state, cell by cell: those below the centre, which are counted from it down, then those above
 * it. */
static double film_energy(const ehd_film_table *film, double state) {
    const double z = (state - film->centre) * film->inverse_scale;
    double total = 0.0;
    for (int row = 0; row < EHD_ROWS; row++) {
        const double near = cell_end(row) - 1.0, far = cell_end(row + 1) - 1.0, upper = least(-near, z);
        if (upper > -far) total += over_cell(film->cell[EHD_ROWS + row], near - far, upper + near);
    }
    for (int row = 0; row < EHD_ROWS && z > cell_end(row) - 1.0; row++) {
        const double near = cell_end(row) - 1.0, far = cell_end(row + 1) - 1.0;
        total += over_cell(film->cell[row], 0.0, row == EHD_ROWS - 1 ? z - near : least(z, far) - near);
    }
    return total;
}

/* Integral of w da up to a load. */
static double load_energy(const ehd_film_table *film, double load) {
    double total = 0.0;
    for (int row = 0; row < EHD_LOAD_ROWS; row++) {
        const double begin = cell_end(row) - 1.0, far = cell_end(row + 1) - 1.0;
        const double end = row == EHD_LOAD_ROWS - 1 ? load : least(load, far);
        if (load <= begin) break;
        for (int i = 0; i < 3; i++) {
            const double t = GAUSS_PLACE[i] * (end - begin);
            total += GAUSS_WEIGHT[i] * (end - begin) * (begin + t) * read_cubic(film->load_cell[row], t).slope;
        }
    }
    return total;
}
