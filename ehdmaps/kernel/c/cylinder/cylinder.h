/* ---------------------------------------------------------------------------------------------------------------------
 * A cylindrical roller bearing: from the pose and velocity of the inner ring to force, stiffness and damping.
 *
 * Frame O is the one of the outer ring, x is the axis of the bearing; it does not spin. A pose is x y z theta_x theta_y
 * theta_z of the inner ring in O [m], [rad]; a velocity is its rate; a force is what acts on the inner ring [N], [N m],
 * about its centre. Neither x nor theta_x has a stiffness.
 *
 * Each slice of each roller carries the load of the law, of a roller between both raceways, times its length:
 *
 *     approach = y cos + z sin - clearance/2 + (p + x) (theta_z cos - theta_y sin) - profile(x),    p the place of its row
 *
 * Between rings that do not tilt against each other slices of the same depth carry the same. So of a symmetric bearing
 * only one half is computed there, and of one whose slices have weights one of each depth, without moments.
 * ------------------------------------------------------------------------------------------------------------------ */

/* What does not change of a bearing. Arrays of slices have a last number more, which is read and has no effect. */
typedef struct ehd_cylinder {
    int64_t rollers, slices;
    int64_t symmetric;                          /* whether slices left and right of the middle are alike */
    double half_clearance, slice_length;        /* [m] */
    double most_travel, most_tilt;              /* largest accepted displacement [m] and tilt [rad] */
    double half_length;                         /* half the length of a roller [m] */
    double least_profile, most_profile;         /* [m] */
    const double *position, *profile;           /* (slices + 1): places along the roller; twice the profile there [m] */
    const double *cosine, *sine;                /* (rollers): directions of the rollers in the cage */
    const double *weight;                       /* (slices): how many each stands for; null where rings tilt */
    const double *added;                        /* (rollers, 2, 2): approach and rate that deviations from its form add to
                                                 * both contacts, see ../run/deviations.h; null without any */
    const double *row;                          /* (rollers): place of the row of each along x [m]; null: one row */
} ehd_cylinder;

/* Motion of the inner ring against the outer one, as far as rollers feel it, and where the cage stands. */
typedef struct ehd_ring_motion {
    double y, z, theta_y, theta_z;                         /* [m], [rad] */
    double y_rate, z_rate, theta_y_rate, theta_z_rate;
    double cage_cosine, cage_sine;                         /* direction of the first roller */
} ehd_ring_motion;

/* Work space. States of the slices of a roller at rest: first load [N/m] and damping [N s/m2] of each, in turns, then
 * the slopes of both, to be multiplied by that of the law; from roller to roller so many numbers on, or 0 where they are
 * of no use after a call. Rollers without load, and the second half of those that are symmetric and level, are written
 * only where all is wanted. */
typedef struct ehd_cylinder_work {
    double *states;    /* (rollers or 1, 2, slices, 2) */
    double *place;     /* (slices + 1) */
    uint64_t *row;     /* (slices + 1) */
    int64_t stride, whole;
} ehd_cylinder_work;

/* Force on the inner ring, and its derivatives: stiffness = -dforce/dpose, damping = -dforce/dvelocity, by rows. */
typedef struct ehd_bearing_force {
    double force[6], stiffness[6][6], damping[6][6];
} ehd_bearing_force;

/* A bearing at one speed, temperature and centrifugal load, as Python calls it. */
typedef struct ehd_cylinder_call {
    const ehd_cylinder *bearing;
    ehd_cylinder_law *law;
    ehd_cylinder_work *work;
    double *state;     /* (13): pose, velocity, angle of the cage [rad] */
    double *answer;    /* (13, 6): an ehd_bearing_force */
    /* of slices that are coupled, else null: */
    const double *coupling; /* (slices, slices): compliances between slices [m2/N] */
    double *own;       /* (rollers, slices): approaches that the law takes, written [m] */
    double *scratch;   /* (slices, slices + 9) */
} ehd_cylinder_call;

/* Force, stiffness and damping, into `answer`, which is left alone where the motion is wrong. Returns a status: EHD_OK,
 * EHD_ABOVE_LOAD, EHD_NOT_FINITE, EHD_TOO_FAR, EHD_NO_LOADS. */
int ehd_cylinder_force(const ehd_cylinder_call *call);

/* Approaches of all slices (rollers, slices) [m], of a row of 13 numbers as of ehd_cylinder_call. */
int ehd_cylinder_approaches(const ehd_cylinder *bearing, const double *state, double *approaches);

/* Gap and tilt of all rollers, and their rates, (4, rollers). */
int ehd_cylinder_rollers(const ehd_cylinder *bearing, const double *state, double *out);

/* Force and stiffness of slices whose loads, and their slopes by the approach, are there, each (rollers, slices). */
int ehd_cylinder_of_loads(const ehd_cylinder *bearing, const double *state, const double *loads, const double *slopes,
                          double *answer);
