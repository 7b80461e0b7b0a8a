/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory: a film answers a change of load with a delay.
 *
 * The state of a film is xi, the approach at which it would be in equilibrium [m]; the load of that equilibrium is
 * p(xi), that of the law at rest. With the load w of the contact
 *
 *     approach = a(w) + y(xi),    xi' = (w^2 - p^2)/(2 w) / (dG/dxi).
 *
 * a is what answers at once, the structure and oil that cannot leave the inlet; y is what follows. A slow oscillation
 * sees stiffness and damping of ehd_law, a fast one that of a(w) alone. Films with memory take no centrifugal load, and
 * the rate of the approach has no part in their load: it is in the states.
 *
 * There are two ways to go on in time. Discrete: ehd_film_advance takes one step, of second order, stable and passive
 * for steps of any length. Continuous, for programs with solvers of differential equations: ehd_film_rate gives xi'.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Cells of a prepared law on each side of its centre, and of a. They are the binary digits of 1 + |z|,
 * z = (approach - centre) inverse_scale, and of 1 + w/(1 N/m): no logarithm is needed to find one. */
#define EHD_ROWS 448
#define EHD_NODES (2 * EHD_ROWS + 1)
#define EHD_LOAD_ROWS 768

/* Contacts in series, as the closed formula of the locked film sees them. */
typedef struct ehd_film_contacts {
    double count, radius, modulus; /* how many; mean reduced radius [m], E' [Pa] */
} ehd_film_contacts;

/* The numbers of films with memory, beside their law. */
typedef struct ehd_film_data {
    const ehd_law_data *law;
    ehd_film_contacts contacts;
    double lowest_speed;                  /* the lowest mapped one [m/s] */
    int64_t speeds, temperatures, loads;  /* places of the factors of that formula, over ln u, 1/(T - coldest), ln w */
    double log_speed_start, log_speed_step, temperature_start, temperature_step, log_load_start, log_load_step;
    const double *factors;                /* (speeds, temperatures, loads) */
} ehd_film_data;

/* A contact whose film has a memory, at one speed and temperature: numbers alone, so that two may be blended number by
 * number. Cells are cubics over the distance from the end that is nearer to the centre, in 1/inverse_scale, or from the
 * lower end, in N/m. */
typedef struct ehd_film_table {
    double centre, inverse_scale;       /* of the cells [m], [1/m] */
    double lift_off;                    /* approach up to which nothing is carried [m] */
    double highest;                     /* load above which slices are outside the map [N/m] */
    double least_damping;               /* what is added to dG/dxi for rates [N s/m2] */
    double cell[2 * EHD_ROWS][3][4];    /* cubics of p [N/m], y [m] and G [N s/m2] */
    double load_cell[EHD_LOAD_ROWS][4]; /* cubics of a [m] */
} ehd_film_table;

/* Values at the nodes of a table while it is made. */
typedef double ehd_film_nodes[9][EHD_NODES];

/* The law with memory at one speed and temperature; made by ehd_film_make. Some 190 kB: make it static, or on the heap,
 * and one for each thread. Its fields are for the functions here. */
typedef struct ehd_film {
    const ehd_law_data *law;
    double entrainment_speed, temperature; /* what was asked for, u >= 0 */
    int64_t status;
    ehd_film_table table;
    ehd_film_nodes node; /* work space */
} ehd_film;

/* A film between two discrete steps: the approach at which it would be in equilibrium [m], what the last step changed
 * in its G [N s/m2], and the load after it [N/m]. */
typedef struct ehd_film_state {
    double approach, change, load;
} ehd_film_state;

/* A film at an instant: load of the contact, and its derivatives by approach and by state [N/m2]; the rate of the state
 * [m/s], and its derivatives by approach and by state [1/s]. */
typedef struct ehd_film_rates {
    double load, stiffness, by_state;
    double rate, rate_by_approach, rate_by_state;
} ehd_film_rates;

/* The law with memory at an entrainment speed [m/s], of either sign, and temperature [K]. Takes some 0.1 ms
 * where one of them is new; where neither is, the film is left as it is: set everything in it to zero before the first
 * call. `room` of ehd_law_point_size bytes is for the time of the call. */
int ehd_film_make(const ehd_film_data *data, double u, double T, ehd_law_point *room, ehd_film *film);

/* A film in equilibrium at an approach [m]. */
int ehd_film_settled(const ehd_film *film, double approach, ehd_film_state *state);

/* A discrete step in time.
 *
 * step > 0 is its length [s], last_step that of the step before, 0 after a rest: the method is of second order while
 * steps grow by no more than a fifth. approach [m] is that at the end of the step. before is left as it is, so that a
 * step may be tried again; after may be the same place. force->stiffness is the exact derivative of the load at the end
 * of the step by the approach there; force->damping is zero. */
int ehd_film_advance(const ehd_film *film, double step, double last_step, double approach, const ehd_film_state *before,
                     ehd_film_state *after, ehd_force *force);

/* What keeps rates finite where there is hardly a load. dG/dxi is raised by what makes the shortest relaxation time this
 * [s], and where a contact opens so fast that w falls below 2 EHD_OPENING p, the film follows more slowly. Without that
 * its rate goes to minus infinity as w goes to zero, which no corrector follows. */
#define EHD_SHORTEST_MEMORY 1e-12
#define EHD_OPENING 0.003

/* Load and rate at an approach [m] and a state xi [m]: a differential equation, stiff where contacts carry little. The
 * rate and its derivatives are numbers above the highest mapped load too: solvers try states far from where they end. */
int ehd_film_rate(const ehd_film *film, double approach, double state, ehd_film_rates *rates);

/* Size of a film in bytes, for callers in other languages. */
size_t ehd_film_size(void);
