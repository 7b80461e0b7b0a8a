/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings with cylindrical rollers: from the pose and velocity of the inner ring to force, stiffness and damping.
 *
 * Frame O is the one of the outer ring, x is the axis of the bearing; it does not spin. A pose is x y z theta_x theta_y
 * theta_z of the inner ring in O [m], [rad]; a velocity is its rate; a force is what acts on the inner ring [N], [N m],
 * about its centre. Neither x nor theta_x has a stiffness: what holds a ring axially is another element. The outer
 * ring gets the opposite.
 *
 * Roller j stands at cage_angle + 2 pi j/rollers, from y towards z.
 *
 * Each slice of each roller carries the load of the law times its length; no slice knows of its neighbours. Slip,
 * traction, ribs and contacts with the cage are left out.
 * ------------------------------------------------------------------------------------------------------------------ */

/* The numbers of a bearing. */
typedef struct ehd_cylinder_data {
    const ehd_law_data *law;
    int64_t rollers;
    double roller_length, roller_diameter; /* [m] */
    int64_t iso_profile;                   /* 1: profile of ISO/TS 16281, 0: straight */
    const double *cosine, *sine;           /* (rollers): directions 2 pi j/rollers of the rollers in the cage */
} ehd_cylinder_data;

/* Room for slices of a roller. */
#define EHD_MOST_SLICES 201

/* What does not change of a bearing; made by ehd_cylinder_make. */
typedef struct ehd_cylinder {
    const ehd_cylinder_data *data;
    int slices;
    int symmetric;                                               /* whether the profile is */
    double clearance, slice_length, least_profile, most_profile; /* [m] */
    double position[EHD_MOST_SLICES + 1];                        /* middles of the slices along the roller [m] */
    double profile[EHD_MOST_SLICES + 1];                         /* twice the depth of the roller's profile there [m] */
} ehd_cylinder;

/* The law at one speed, temperature and centrifugal load, as a table that a bearing reads in nanoseconds; made by
 * ehd_cylinder_prepare. The cells of its point follow it in memory: it takes ehd_cylinder_law_size bytes, some 150 kB.
 * Its own cells are the binary digits of 1 + |z|, z = (approach - centre) inverse_scale: no logarithm is needed to find
 * one. */
typedef struct ehd_cylinder_law {
    double cell[2 * EHD_ROWS][4][2];    /* cubics of load and damping, in turns */
    int64_t kind;
    double centre, inverse_scale;       /* of the cells [m], [1/m] */
    double coefficient, exponent;       /* of dry contacts, w = coefficient approach^exponent */
    double highest;                     /* load above which slices are outside the map [N/m] */
    double safe_approach;               /* up to it no slice is, nor above the held load [m] */
    double lift_off;                    /* up to it there is no load [m] */
    double slope;                       /* what slopes are multiplied by */
    double held_approach, held_damping; /* of the tangent above the held load */
    double knot[2 * EHD_ROWS];          /* where cells begin [m], below the lowest mapped speed */
    double node[6][EHD_NODES];          /* work space */
    ehd_law_point point;
} ehd_cylinder_law;

/* Force on the inner ring, and its derivatives: stiffness = -dforce/dpose, damping = -dforce/dvelocity, by rows. */
typedef struct ehd_bearing_force {
    double force[6], stiffness[6][6], damping[6][6];
} ehd_bearing_force;

/* Cut a bearing into slices.
 *
 * clearance: diametral clearance in force [m], < 0 for a preloaded bearing. slices: 1 to EHD_MOST_SLICES; statics want
 * 30 or more. profile: depth of the roller's profile at the middles of the slices, on one side [m]; a null pointer takes
 * the one of the data. */
int ehd_cylinder_make(const ehd_cylinder_data *data, double clearance, int slices, const double *profile,
                      ehd_cylinder *bearing);

/* Make a law ready for a bearing, at an entrainment speed [m/s], temperature [K] and centrifugal load [N/m], see
 * ehd_law_make. Takes some tens of microseconds. */
int ehd_cylinder_prepare(const ehd_law_data *data, double u, double T, double q, ehd_cylinder_law *law);

/* Force, stiffness and damping of a bearing at the speed and temperature of a prepared law, which are held fixed in the
 * derivatives. velocity may be a null pointer: at rest. */
int ehd_cylinder_at(const ehd_cylinder *bearing, const ehd_cylinder_law *law, const double pose[6],
                    const double velocity[6], double cage_angle, ehd_bearing_force *result);

/* The same at any speed and temperature: prepares the law again where these are not those of the last call. Set
 * everything in `law` to zero before the first one. */
int ehd_cylinder_call(const ehd_cylinder *bearing, ehd_cylinder_law *law, const double pose[6], const double velocity[6],
                      double cage_angle, double u, double T, double q, ehd_bearing_force *result);

/* Size of a bearing, and of a prepared law with all that follows it, in bytes. */
size_t ehd_cylinder_size(void);
size_t ehd_cylinder_law_size(const ehd_law_data *data);
