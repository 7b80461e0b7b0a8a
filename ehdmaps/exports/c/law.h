/* ---------------------------------------------------------------------------------------------------------------------
 * The contact law: load, stiffness and damping of a contact over approach, rate, entrainment speed and temperature.
 *
 * All is per unit length of contact, in SI units: approach [m], rate [m/s], u [m/s], T [K], load [N/m], stiffness
 * [N/m2], damping [N s/m2]. The approach is positive where the bodies come together. The law is never a tension, rises
 * with the approach, takes up power at any rate, and its derivatives are exact.
 *
 * Nothing here allocates, keeps a state of its own, reads or writes a file. All functions may be called from several
 * threads at once, each with structures of its own.
 * ------------------------------------------------------------------------------------------------------------------ */

/* What a call found: a sum of these, 0 where all is well. */
enum {
    EHD_OK = 0,
    EHD_ABOVE_LOAD = 1,          /* more load than is mapped */
    EHD_ABOVE_SPEED = 2,         /* faster than is mapped */
    EHD_OUTSIDE_TEMPERATURE = 4, /* colder or hotter than is mapped */
    EHD_NOT_FINITE = 8,          /* an argument, or what follows from it, is NaN or infinite */
    EHD_BAD_CENTRIFUGAL = 16,    /* a centrifugal load that is negative, too high, or not in this file */
    EHD_TOO_FAR = 32,            /* a pose beyond reason */
    EHD_BAD_ARGUMENT = 64        /* a null pointer, a number of slices or a step that is not allowed */
};

/* Whether a status refuses: all results of such a call are NaN. The other ones hold at the edge of the map. */
#define EHD_REFUSES(status) (((status) & EHD_REFUSED) != 0)

/* Load of a contact and its derivatives by approach and rate: w [N/m], k [N/m2], c [N s/m2]. */
typedef struct ehd_force {
    double load, stiffness, damping;
} ehd_force;

/* A table at one speed and temperature: cubics over cells of the stretched approach
 * s = asinh((approach - offset) inverse_scale). In a cell, by the part t of it from 0 to 1, are the coefficients of
 * t^0 to t^3, first of g = w^(1/3) [(N/m)^(1/3)], then of ln(c/w) [c/w in s/m]. */
typedef struct ehd_line {
    double offset, inverse_scale, start, step;
    int cells;
    double cell[EHD_MOST_CELLS][2][4];
} ehd_line;

/* The law at one speed, temperature and centrifugal load; made by ehd_at, some 20 kB. Its fields are for the functions
 * here. */
typedef struct ehd_point {
    double entrainment_speed, temperature, centrifugal_load; /* what was asked for, u >= 0 */
    double film;                                             /* part of the film that is there, 0 to 1 */
    double inner_lift_off, outer_start;                      /* approach of each contact at lift-off [m] */
    double lift_off;                                         /* approach up to which there is no load [m] */
    double highest_load;                                     /* load above which a call is outside [N/m] */
    double held_load, held_approach;                         /* above these the law is its tangent */
    double held_stiffness, held_damping;                     /* of the tangent */
    int status;
    ehd_line own;
#if EHD_HAS_CENTRIFUGAL
    ehd_line inner, outer;
#endif
} ehd_point;

/* The law at one speed and temperature.
 *
 * u is of either sign, T in K. q >= 0 is the centrifugal load of a roller [N/m], which only the outer contact carries;
 * 0 where EHD_HAS_CENTRIFUGAL is. Takes some microseconds. Returns a status, which all calls with the point give again;
 * a point that is refused gives NaN. */
int ehd_at(ehd_point *point, double u, double T, double q);

/* Load, stiffness and damping at an approach and a rate, at the speed and temperature of a point. */
int ehd_law_at(const ehd_point *point, double approach, double rate, ehd_force *force);

/* The same in one call, with any speed and temperature. Within the map it reads the table at one place; below the
 * lowest mapped speed, outside the map and with a centrifugal load it makes a point on the stack first. */
int ehd_law(double approach, double rate, double u, double T, double q, ehd_force *force);

/* Size of a point in bytes, for callers in other languages. */
size_t ehd_point_size(void);

/* Name of the gravest part of a status, for messages; never null. */
const char *ehd_status_text(int status);
