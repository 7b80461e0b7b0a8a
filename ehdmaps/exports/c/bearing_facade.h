/* ---------------------------------------------------------------------------------------------------------------------
 * What to call: the bearing, with the data of this file.
 *
 * Without slip the cage turns with cage_angle = spin_inner EHD_CAGE_INNER + spin_outer EHD_CAGE_OUTER, and the
 * entrainment speed is EHD_ENTRAINMENT |speed_inner - speed_outer| [m/s], of the speeds of the rings in rad/s. There are
 * EHD_ROLLERS rollers.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Room for slices of a roller. */
#define EHD_MOST_SLICES 201

/* What does not change of a bearing; made by ehd_bearing_make. */
typedef struct ehd_bearing {
    int slices;
    int symmetric;                                               /* whether the profile is */
    double clearance, slice_length, least_profile, most_profile; /* [m] */
    double position[EHD_MOST_SLICES + 1];                        /* middles of the slices along the roller [m] */
    double profile[EHD_MOST_SLICES + 1];                         /* twice the depth of the roller's profile there [m] */
    const double *added; /* (EHD_ROLLERS, 2, 2), of the caller, or null: approach [m] and its rate [m/s] that deviations from
                          * the form add to each roller at the inner and the outer ring */
} ehd_bearing;

/* The law at one speed, temperature and centrifugal load, as a table that a bearing reads in nanoseconds; made by
 * ehd_prepare. Some 150 kB: make it static, or on the heap, and one for each thread. */
typedef struct ehd_prepared {
    int64_t prepared;                /* whether it is */
    ehd_cylinder_numbers numbers;
    double cell[2 * EHD_ROWS][4][2]; /* cubics of load and damping, in turns */
    double knot[2 * EHD_ROWS];       /* where cells begin [m], below the lowest mapped speed */
    double node[2 * EHD_ROWS][8];    /* work space */
    int64_t mark[EHD_NODES / 4 + 1]; /* the same */
    ehd_point point;
} ehd_prepared;

/* Cut a bearing into slices.
 *
 * clearance: diametral clearance in force [m], < 0 for a preloaded bearing. slices: 1 to EHD_MOST_SLICES; statics want
 * 30 or more. profile: depth of the roller's profile at the middles of the slices, on one side [m]; a null pointer takes
 * the one of the export (EHD_ISO_PROFILE). */
int ehd_bearing_make(ehd_bearing *bearing, double clearance, int slices, const double *profile);

/* Make a law ready for a bearing, at an entrainment speed [m/s], temperature [K] and centrifugal load [N/m], see
 * ehd_at. Takes some tens of microseconds. */
int ehd_prepare(ehd_prepared *law, double u, double T, double q);

/* Force, stiffness and damping of a bearing at the speed and temperature of a prepared law, which are held fixed in the
 * derivatives. velocity may be a null pointer: at rest. */
int ehd_bearing_at(const ehd_bearing *bearing, const ehd_prepared *law, const double pose[6], const double velocity[6],
                   double cage_angle, ehd_bearing_force *result);

/* The same at any speed and temperature: prepares the law again where these are not those of the last call. Set
 * everything in `law` to zero before the first one. */
int ehd_bearing_call(const ehd_bearing *bearing, ehd_prepared *law, const double pose[6], const double velocity[6],
                     double cage_angle, double u, double T, double q, ehd_bearing_force *result);

/* Films with memory in equilibrium at a pose. states: EHD_ROLLERS * slices. */
int ehd_bearing_settled(const ehd_bearing *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                        ehd_film_state states[]);

/* A discrete step of all films, see ehd_film_advance; pose, cage angle and film are those of its end. */
int ehd_bearing_advance(const ehd_bearing *bearing, const ehd_film *film, double step, double last_step,
                        const double pose[6], double cage_angle, const ehd_film_state before[], ehd_film_state after[],
                        ehd_bearing_force *result);

/* Force of an instant and all that ehd_film_rate gives, for states xi; rates: EHD_ROLLERS * slices. */
int ehd_bearing_rates(const ehd_bearing *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                      const double states[], ehd_film_rates rates[], ehd_bearing_force *result);

/* Direction of the force of a slice: column[0..3] are its shares in y, z, theta_y and theta_z of the approach of slice i
 * of roller j by the pose; the force on the ring has those of the load times EHD_ROLLER_LENGTH/slices, negative. */
void ehd_bearing_direction(const ehd_bearing *bearing, double cage_angle, int j, int i, double column[4]);

/* Sizes in bytes, for callers in other languages. */
size_t ehd_bearing_size(void);
size_t ehd_prepared_size(void);
