/* ---------------------------------------------------------------------------------------------------------------------
 * Statuses, laws of the contacts over speed, and the force of a bearing
 * ------------------------------------------------------------------------------------------------------------------ */

/* What a call found: a sum of these, 0 where all is well. */
enum {
    EHD_OK = 0,
    EHD_ABOVE_LOAD = 1,    /* more load than films were made for: they go on straight in the logarithms */
    EHD_OUTSIDE_SPEED = 2, /* slower or faster than films were made for: those at the end of the speeds are held */
    EHD_NOT_FINITE = 8,    /* an argument is NaN or infinite */
    EHD_TOO_FAR = 32,      /* a pose beyond reason, or an angular contact bearing beyond its middle: it has no raceway */
    EHD_BAD_ARGUMENT = 64, /* a null pointer, a clearance or play, or a speed beyond 20 000 rad/s */
    EHD_NO_BALANCE = 128   /* no balance of a ball or roller was found */
};

#define EHD_REFUSED (EHD_NOT_FINITE | EHD_TOO_FAR | EHD_BAD_ARGUMENT | EHD_NO_BALANCE)

/* Whether a status refuses: all results of such a call are NaN. The other ones tell. */
#define EHD_REFUSES(status) (((status) & EHD_REFUSED) != 0)

/* Law of a contact: F = coefficient g^(3/2), g the approach where it is dry, else from a table over
 * z = asinh((approach - centre)/scale): ln g and its slope by node, ln c and its slope. A dry contact with load has
 * c = damping + damping_time k. */
typedef struct ehd_contact {
    double coefficient, damping, damping_time, centre, scale, first, step;
    double table[EHD_ROWS + 1][4];
    double springs[EHD_MEMORY ? EHD_ROWS : 1][EHD_SPRINGS + 1]; /* of films with memory, by node; their longest time */
} ehd_contact;

/* The laws of both contacts at one entrainment speed; made by ehd_prepare. All zero before the first call. */
typedef struct ehd_law {
    int made, status;
    double u;       /* entrainment speed [m/s] */
    double highest; /* load up to which films were made [N] */
    ehd_contact inner, outer;
} ehd_law;

/* Force on the inner ring, and its derivatives at speeds of the rings that are held: stiffness = -dforce/dpose at rest,
 * damping = -dforce/dvelocity, by rows; and the speed of the cage [rad/s]. */
typedef struct ehd_bearing_force {
    double force[6], stiffness[6][6], damping[6][6];
    double cage_speed;
} ehd_bearing_force;

/* Laws at an entrainment speed [m/s], which is EHD_ENTRAINMENT |inner_speed - outer_speed|. Films are cubics of ln u
 * between the speeds of the table, and are held beyond. Does nothing where the speed is that of the last call. */
int ehd_prepare(ehd_law *law, double u);

/* Speed or angle of the cage in pure rolling at the nominal contact angle, by those of the rings. */
double ehd_cage(double inner, double outer);

/* Name of the gravest part of a status, for messages; never null. */
const char *ehd_status_text(int status);

size_t ehd_law_size(void);
