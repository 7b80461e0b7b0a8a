/* ---------------------------------------------------------------------------------------------------------------------
 * What to call: the contact law, with the data of this file.
 *
 * Nothing here allocates, keeps a state of its own, reads or writes a file. All functions may be called from several
 * threads at once, each with structures of its own.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Whether a status refuses: all results of such a call are NaN. The other ones hold at the edge of the map. */
#define EHD_REFUSES(status) (((status) & EHD_REFUSED) != 0)

/* The law at one speed, temperature and centrifugal load; made by ehd_at, some 20 kB. Its fields are for the functions
 * here. */
typedef struct ehd_point {
    ehd_law_point law;
    double cell[(EHD_HAS_CENTRIFUGAL ? 3 : 1) * EHD_MOST_CELLS][2][4];
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

/* The law with memory at an entrainment speed [m/s], of either sign, and temperature [K]. Takes some 0.1 ms
 * where one of them is new; where neither is, the film is left as it is: set everything in it to zero before the first
 * call. What goes on from there are ehd_film_settled, ehd_film_advance and ehd_film_rate. */
int ehd_film_at(ehd_film *film, double u, double T);
