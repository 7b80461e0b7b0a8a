/* ---------------------------------------------------------------------------------------------------------------------
 * The contact law: load, stiffness and damping of a contact over approach, rate, entrainment speed and temperature.
 *
 * All is per unit length of contact, in SI units: approach [m], rate [m/s], u [m/s], T [K], load [N/m], stiffness
 * [N/m2], damping [N s/m2]. The approach is positive where the bodies come together. The law is never a tension, rises
 * with the approach, takes up power at any rate, and its derivatives are exact.
 *
 * Nothing here allocates, keeps a state of its own, reads or writes a file. All functions may be called from several
 * threads at once, each with memory of its own.
 * ------------------------------------------------------------------------------------------------------------------ */

/* A table of coefficients of B-splines over speed, temperature and approach, all axes evenly spaced: in ln u, in
 * 1/(T - coldest) and in s = asinh((approach - offset) inverse_scale). A step is the inverse distance of two nodes. */
typedef struct ehd_law_table {
    int64_t speeds, temperatures, places;             /* numbers of coefficients along each axis */
    double log_speed_start, log_speed_step;           /* u in m/s */
    double temperature_start, temperature_step;       /* [1/K], [K] */
    double start, step;                               /* of s */
    const double *coefficients;                       /* of g = w^(1/3) and ln(c/w), in turns, over s */
    const double *place;                              /* of offset [m] and inverse_scale [1/m] */
} ehd_law_table;

/* The numbers of a law. */
typedef struct ehd_law_data {
    int64_t refused;                                /* parts of a status that refuse */
    int64_t contacts;                               /* in series */
    int64_t centrifugal;                            /* whether tables of both contacts are there, for centrifugal loads */
    double film_speed;                              /* speed below which films fade [m/s] */
    double lowest_speed, highest_speed;             /* of the tables: held beyond [m/s] */
    double lowest_temperature, highest_temperature; /* of the tables: held beyond [K] */
    double highest_load, known_load;                /* mapped somewhere; mapped everywhere [N/m] */
    double held_load;                               /* above it the law is straight [N/m] */
    double counted_speed;                           /* the highest mapped one [m/s] */
    double counted_cold, counted_hot;               /* mapped temperatures [K] */
    const double *structure;                        /* (contacts, 3): law of a contact without a film, see law.c */
    int64_t end_rows, end_columns;                  /* of the highest mapped loads */
    const double *ends;                             /* below a row of [., T ...]: rows of [ln u, loads ...] */
    ehd_law_table own, inner, outer;
} ehd_law_data;

/* A table at one speed and temperature: cubics over cells of the stretched approach
 * s = asinh((approach - offset) inverse_scale). In a cell, by the part t of it from 0 to 1, are the coefficients of
 * t^0 to t^3, first of g = w^(1/3) [(N/m)^(1/3)], then of ln(c/w) [c/w in s/m]: double [cells][2][4]. */
typedef struct ehd_line {
    double offset, inverse_scale, start, step;
    int64_t cells;
    int64_t to_cells; /* bytes from here to them: so what is copied whole stays whole */
} ehd_line;

/* The law at one speed, temperature and centrifugal load; made by ehd_law_make. The cells of its lines follow it in
 * memory: it takes ehd_law_point_size bytes, some 30 kB. Its fields are for the functions here. */
typedef struct ehd_law_point {
    const ehd_law_data *data;
    double entrainment_speed, temperature, centrifugal_load; /* what was asked for, u >= 0 */
    double film;                                             /* part of the film that is there, 0 to 1 */
    double inner_lift_off, outer_start;                      /* approach of each contact at lift-off [m] */
    double lift_off;                                         /* approach up to which there is no load [m] */
    double highest_load;                                     /* load above which a call is outside [N/m] */
    double held_load, held_approach;                         /* above these the law is its tangent */
    double held_stiffness, held_damping;                     /* of the tangent */
    int64_t status;
    ehd_line own, inner, outer;
} ehd_law_point;

/* Size of a point of a law with all that follows it, in bytes. */
size_t ehd_law_point_size(const ehd_law_data *data);

/* The law at one speed and temperature.
 *
 * u is of either sign, T in K. q >= 0 is the centrifugal load of a roller [N/m], which only the outer contact carries;
 * 0 where the data have none. Takes some microseconds. Returns a status, which all calls with the point give again;
 * a point that is refused gives NaN. */
int ehd_law_make(const ehd_law_data *data, double u, double T, double q, ehd_law_point *point);

/* Load, stiffness and damping at an approach and a rate, at the speed and temperature of a point. */
int ehd_law_force(const ehd_law_point *point, double approach, double rate, ehd_force *force);

/* The same in one call, with any speed and temperature. Within the map it reads the table at one place; below the
 * lowest mapped speed, outside the map and with a centrifugal load it makes a point first, in `room` of
 * ehd_law_point_size bytes. */
int ehd_law_call(const ehd_law_data *data, double approach, double rate, double u, double T, double q,
                 ehd_law_point *room, ehd_force *force);

/* Approach [m] at which the contacts of a point carry a load [N/m] at rest, with the whole film; for zero the highest
 * one without. */
double ehd_law_approach(const ehd_law_point *point, double load);
