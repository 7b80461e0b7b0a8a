/* ---------------------------------------------------------------------------------------------------------------------
 * The contact law at many places in one call, in blocks whose loops compilers put into vector instructions; and at one
 * place, for a caller to whom each argument is dear.
 *
 * Numbers of a place do not depend on its neighbours, nor on the processor. forces is (3, n): loads [N/m], stiffness
 * [N/m2], damping [N s/m2]. counts are counted up by cause: loads above the map, speeds above it, temperatures outside
 * it, places with numbers that are not finite, whose forces are NaN. Nothing is refused here.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Forces at approaches [m] and rates [m/s], at one speed, temperature and centrifugal load. */
void ehd_law_force_many(const ehd_law_point *point, int64_t n, const double *approach, const double *rate,
                        double *forces, int64_t *counts);

/* Forces at places that each have a speed [m/s], temperature [K] and centrifugal load [N/m] of their own; room as of
 * ehd_law_call. */
void ehd_law_call_many(const ehd_law_data *data, int64_t n, const double *approach, const double *rate, const double *u,
                       const double *T, const double *q, ehd_law_point *room, double *forces, int64_t *counts);

/* A call of ehd_law_call: answer and arguments are one row of numbers, which Python fills and reads at once. */
typedef struct ehd_law_errand {
    ehd_force force;
    double approach, rate, u, T, q;
    const ehd_law_data *data;
    ehd_law_point *room;
} ehd_law_errand;

/* ehd_law_call of what is asked there. */
int ehd_law_run(ehd_law_errand *errand);
