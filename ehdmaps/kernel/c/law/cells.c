/* ---------------------------------------------------------------------------------------------------------------------
 * Cells of tables that are the binary digits of a number a >= 1: 2^CELL_BITS to each doubling, found without a logarithm
 * ------------------------------------------------------------------------------------------------------------------ */

#define CELL_BITS 5

/* Where cell k begins, as a value of a >= 1. */
static double cell_end(int k) {
    return number_of_bits(((UINT64_C(1023) << CELL_BITS) + (uint64_t)k) << (52 - CELL_BITS));
}

/* Cell of a number a >= 1 among so many, and what a is above its lower end; held in the last one. */
static int cell_from(double a, int rows, double *above) {
    const double last = number_of_bits(bits_of(cell_end(rows)) - 1), held = a < last ? a : last;
    const uint64_t cell = bits_of(held) >> (52 - CELL_BITS);
    *above = held - number_of_bits(cell << (52 - CELL_BITS));
    return (int)(cell - (UINT64_C(1023) << CELL_BITS));
}

/* Row of the cells on both sides of a centre at a place z from it, and the part of the cell from the end that is nearer
 * to the centre. Rows below the centre follow those above it. */
static int row_of(double z, double *t) {
    double above;
    const int row = cell_from(1.0 + fabs(z), EHD_ROWS, &above);
    *t = z >= 0.0 ? above : -above;
    return z >= 0.0 ? row : row + EHD_ROWS;
}

/* Node number i of the cells on both sides of a centre, as a place from it. */
static double node_place(int i) { return i >= EHD_ROWS ? cell_end(i - EHD_ROWS) - 1.0 : 1.0 - cell_end(EHD_ROWS - i); }
