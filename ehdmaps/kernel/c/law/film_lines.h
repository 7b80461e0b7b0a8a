/* ---------------------------------------------------------------------------------------------------------------------
 * Films of a table, read at many points: what the tables of a law are made from; and the nodes of such a table.
 * ------------------------------------------------------------------------------------------------------------------ */

/* For n places, the first coefficient of the cubic spline over so many knots that counts, weights of four from it, and
 * the derivatives of these: first (n,), weights and slopes (n, 4). */
void ehd_spline_weights(const double *knots, int64_t count, int64_t n, const double *x, int64_t *first, double *weights,
                        double *slopes);

/* Weights, (n, count), of the polynomial through so many nodes at n places. */
void ehd_lagrange_weights(const double *nodes, int64_t count, int64_t n, const double *x, double *weights);

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

/* Lines, each at places of its own, straight beyond the breaks of all: polynomials of degree 4 with a bend outside a
 * valley, and cubics. breaks is (cells + 1,); quartic (5, cells, lines) and cubic (4, cells, lines), the highest power
 * first; bend (5, lines) a constant, and a square and a cube below valley[0] and above valley[1]; places (n, lines).
 * values, slopes of the bent quartics and values of the cubics, (n, lines), are filled. room is for so many lines. */
void ehd_film_columns(int64_t lines, int64_t cells, const double *breaks, const double *quartic, const double *bend,
                      const double *valley, const double *cubic, int64_t n, const double *places, int64_t *room,
                      double *values, double *slopes, double *cubics);

/* g and ln(c/w) at the nodes of a table, from samples along each line. s, which rises, root, its slope by s, and logs
 * are (samples, lines); values, (lines, nodes, 2), are filled. g goes on along its tangent below the samples and as an
 * exponential above them; ln(c/w) along its tangents, or, below the sample number `held` >= 0, as it is there. room is for
 * 34 numbers a sample. */
void ehd_law_nodes(int64_t samples, int64_t lines, const double *s, const double *root, const double *slope,
                   const double *logs, int64_t held, int64_t nodes, const double *node, double *room, double *values);
