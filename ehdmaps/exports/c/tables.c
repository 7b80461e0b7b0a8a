/* ---------------------------------------------------------------------------------------------------------------------
 * The tables of the law
 * ------------------------------------------------------------------------------------------------------------------ */

/* A table of coefficients of B-splines over speed, temperature and approach, all axes evenly spaced: in ln u, in
 * 1/(T - coldest) and in s = asinh((approach - offset) inverse_scale). A step is the inverse distance of two nodes. */
typedef struct axes {
    int speeds, temperatures, places;                 /* numbers of coefficients along each axis */
    double log_speed_start, log_speed_step;           /* u in m/s */
    double temperature_start, temperature_step;       /* [1/K], [K] */
    double start, step;                               /* of s */
    const double *coefficients;                       /* of g = w^(1/3) and ln(c/w), in turns, over s */
    const double *place;                              /* of offset [m] and inverse_scale [1/m] */
} axes;

/* Structural law of a contact: a w (b - ln(w)/2) of a half-space, else a w^b [m], w in N/m. */
typedef struct structure {
    int half_space;
    double a, b;
} structure;
