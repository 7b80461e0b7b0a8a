/* ---------------------------------------------------------------------------------------------------------------------
 * Load sharing of film and asperities in a contact of rough surfaces; see `ehdmaps.maps.rough_layer`.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Asperities of a surface over ln of the pressure that they carry [ln Pa], at even steps; cubics, straight beyond. */
typedef struct ehd_rough_data {
    int64_t nodes;
    double start, step;                        /* of ln p */
    const double *distance, *distance_slope;   /* of the mean planes in sigma, and its slope by ln p */
    const double *log_gap, *log_gap_slope;     /* ln of the mean gap in sigma, and its slope by ln p */
    double sigma;                              /* roughness [m] */
    double thick;                              /* film over sigma above which nothing is shared */
    double oil_exponent, full_from;            /* of the scaled film */
} ehd_rough_data;

/* Rough offset [m], its slope and the share of the film of all samples, into out (3, n, lines).
 *
 * roots, log_pressures (ln of (pi/4) p_H), their slopes by the root, films [m] and their slopes are (n, lines); log_loads
 * (ln of Moes' M less 2 ln of the pressure) and log_oils (ln L) are (lines). room is for 2 lines numbers. */
void ehd_rough_share(const ehd_rough_data *data, int64_t n, int64_t lines, const double *roots,
                     const double *log_pressures, const double *pressure_slopes, const double *log_loads,
                     const double *log_oils, const double *films, const double *slopes, double *room, double *out);

/* ln H of Moes' film formula at ln M and ln L, and its derivatives by these: found[0..2]. */
void ehd_rough_moes(double log_load, double log_oil, double found[3]);

/* ln of h_f(g)/h_f(1), and its derivatives by ln g and by ln M, from ln H of the whole load and its slope: found[0..2].
 * log_load and log_oil are ln M and ln L of the whole load, log_share is ln g <= 0. */
void ehd_rough_scaled(const ehd_rough_data *data, double log_load, double log_oil, double whole, double whole_slope,
                      double log_share, double found[3]);
