/* ---------------------------------------------------------------------------------------------------------------------
 * Films of a table, read at many points: what the tables of a law are made from.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Weighted sums of the coefficients around each of n points. first is (n, 2), by_zeta and by_size (n, 4), by_oil
 * (n, oils); coefficients are (., sizes, oils, fields); sums, (n, fields), are filled. room is for oils * fields
 * numbers. */
void ehd_table_sums(const double *coefficients, int64_t sizes, int64_t oils, int64_t fields, int64_t n,
                    const int64_t *first, const double *by_zeta, const double *by_size, const double *by_oil,
                    double *room, double *sums);

/* Weighted sum of some lines at each of n places zeta, by cubic Hermite on their common lattice, straight beyond its
 * ends. lattice is (., nodes, 5): ln(film number), its slope, the slope of that, scaled loss, its slope, over zeta. out,
 * (3, n), is filled with ln(film number), its slope, scaled loss. */
void ehd_table_lines(const double *lattice, int64_t nodes, double first, double spacing, int64_t count,
                     const int64_t *lines, const double *weights, int64_t n, const double *zeta, double *out);
