/* ---------------------------------------------------------------------------------------------------------------------
 * Law of a contact of a bearing over its approach, of balls and of lines that follow tables of their own: structures
 *
 *     F = C g^(3/2),    g = approach where it is dry, else g(approach) of a table,
 *     c = damping + damping_time k of a dry contact with load, else c(approach) of the table.
 *
 * A table has rows at even places of z = asinh((approach - centre)/scale); beyond its ends it goes on straight in the
 * logarithms. All in SI units: approach [m], load [N], stiffness [N/m], damping [N s/m].
 * ------------------------------------------------------------------------------------------------------------------ */

/* What a call found; as statuses of bearings that are exported. */
enum {
    EHD_PAIR_OUTSIDE_SPEED = 2 /* slower or faster than films were made for: those at the end of the speeds are held */
};

/* What rates of deviations from the form do to a bearing, numbers of it: their force on the inner ring by the dampers [N],
 * [N m]; what dampers dissipate by them alone, and the power of the loads at rest [W]. With s the power that the force takes
 * from the ring, dampers dissipate 2 s and this beside what the motion of the ring alone does. */
enum { EHD_PAIR_OWN = 6, EHD_PAIR_AT_REST, EHD_PAIR_BY_RATES };

/* Law of a contact at one speed. */
typedef struct ehd_pair_law {
    double coefficient;                /* C [N/m^1.5] */
    double damping, damping_time;      /* constant part of c [N s/m], and part in proportion to the stiffness [s] */
    double centre, scale, first, step; /* grid of the table: z of the first row, distance of the rows */
    int64_t rows;                      /* 0 for a dry contact */
    const double *table;               /* (rows, 4): ln g and its slope by row, ln c and its slope */
} ehd_pair_law;

/* Load, stiffness and damping of a contact. */
typedef struct ehd_pair_state {
    double load, stiffness, damping;
} ehd_pair_state;

/* Load and stiffness of a contact, and its place on the table; what its memory adds to the load at rest. */
typedef struct ehd_pair_load {
    double load, stiffness, place, held;
} ehd_pair_load;

/* Laws of both contacts of a bearing over the entrainment speed, at speeds that are even in its logarithm. Index 0 is the
 * inner contact, 1 the outer one. */
typedef struct ehd_pair_speeds {
    int64_t speeds, rows, springs; /* springs: of a contact whose film has a memory, else 0 */
    double lowest, highest;        /* first and last speed [m/s] */
    double first_log, per_log;     /* ln of the first speed; speeds in a unit of the logarithm */
    double most_load;              /* load up to which films were made [N] */
    const double *times;           /* (springs,): times of the springs over the longest one */
    const double *places[2];       /* (speeds, 2): centre and scale [m] */
    const double *tables[2];       /* (speeds, rows, 4) */
    const double *shares[2];       /* (speeds, rows, springs + 1): parts of the damping, and ln of the longest time */
} ehd_pair_speeds;

/* Springs in series with dampers of films with memory, at the rows of the tables of the inner and the outer contact,
 * (rows, count + 1): stiffness [N/m], and the longest of their times [s]; those of another speed, and the part of the way
 * to them; times over the longest one (count,). */
typedef struct ehd_pair_springs {
    int64_t count;
    const double *shorter, *springs[2], *others[2];
    double weight;
} ehd_pair_springs;

/* Rows of the memory of contacts that stand side by side, each n numbers: points, n = 1, or the slices of a line. Over a
 * step they hold a force [N] and a spring [N/m] at an approach [m]. Behind the longest time [s] four rows follow for each
 * spring: the part of its force that is left at the end of the step and its spring of the end, and force and stiffness of
 * its beginning. */
enum { EHD_PAIR_PULL, EHD_PAIR_SPRING, EHD_PAIR_AT, EHD_PAIR_TIME, EHD_PAIR_HEAD };
enum { EHD_PAIR_LEFT, EHD_PAIR_OVER, EHD_PAIR_FORCE, EHD_PAIR_STIFFNESS, EHD_PAIR_EACH };
#define EHD_PAIR_MEMORY(springs) (EHD_PAIR_HEAD + EHD_PAIR_EACH * (springs))
