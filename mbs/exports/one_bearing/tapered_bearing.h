/* ---------------------------------------------------------------------------------------------------------------------
 * A bearing of tapered rollers, or of cylindrical ones between ribs: from the pose and velocity of its inner ring to
 * force, stiffness and damping, all in SI units.
 *
 * Frame O is the one of the outer ring, in the plane of the middles of the rollers; x is the axis of the bearing; it does
 * not spin. A pose is x y z theta_x theta_y theta_z of the inner ring in O [m], [rad]; a velocity is its rate; a force is
 * what acts on the inner ring [N], [N m], about its centre. theta_x has no force. The outer ring gets the opposite. In
 * the pose zero tapered rollers just touch; cylindrical ones are in the middle of their play.
 *
 * Roller j stands at cage_angle + 2 pi j/EHD_ROW_ROLLERS, from y towards z; of two rows the one with ribs is first, and
 * x is counted from the middle between both. Each roller is in balance with both raceways in slices, the ribs, its centrifugal load and its gyroscopic moment. Rollers have no inertia beside that.
 *
 *     static ehd_law law;         // all zero before the first call
 *     static ehd_rollers rollers; // the same
 *     ehd_bearing bearing;
 *     ehd_bearing_force result;
 *     ehd_bearing_make(&bearing, EHD_PLAY, 0);
 *     int status = ehd_bearing_call(&bearing, &law, &rollers, pose, velocity, cage_angle, inner_speed, outer_speed,
 *                                   &result);
 *     if (EHD_REFUSES(status)) puts(ehd_status_text(status)); // result is NaN
 *
 * Nothing here allocates, keeps a state of its own, reads or writes a file. All functions may be called from several
 * threads at once, each with structures of its own.
 * ------------------------------------------------------------------------------------------------------------------ */

/* What does not change of a bearing; made by ehd_bearing_make. */
typedef struct ehd_bearing {
    double play, offset; /* of each raceway, and along x [m] */
    int mirrored;
    double cosine[EHD_ROLLERS], sine[EHD_ROLLERS]; /* directions of the rollers in the cage */
    const double *added; /* (EHD_ROLLERS, 2, 2), of the caller, or null: approach [m] and its rate [m/s] that deviations from
                          * the form add to the lines of each roller with cone and cup */
} ehd_bearing;

/* A roller in balance, to be read. Of a mirrored bearing all is that of the bearing in its mirror, x and turns the other way. */
typedef struct ehd_roller {
    int made;                              /* whether it was found */
    double play;                           /* of each raceway, of the bearing [m] */
    double place[3], ring[3];              /* of roller and ring in its plane: axial, radial [m], turn [rad] */
    double share[3][3];                    /* derivative of the one by the other */
    double force[3];                       /* on the roller, of the inner ring: axial, radial [N], moment [N m] */
    double stiffness[3][3], damping[3][3]; /* by the motion of the ring there */
    double inner_load, outer_load, carried; /* of cone and cup; of the inner ring with its ribs [N] */
    double rib_load[EHD_RIBS + 1];         /* [N] */
} ehd_roller;

/* The rollers of a bearing. All zero before the first call: they start from nothing. Answers hang on where they started
 * by what Newton's method leaves, 1e-13 of the load, 1e-11 of stiffness and damping. */
typedef struct ehd_rollers {
    ehd_roller roller[EHD_ROLLERS];
    double own[EHD_ROLLERS][55]; /* what the next call starts from */
#if EHD_MEMORY
    double held[EHD_ROLLERS][2][8][EHD_SLICES]; /* what the films of the slices of cone and cup hold over a step */
#endif
} ehd_rollers;

/* Make a bearing.
 *
 * play: of cylindrical rollers the diametral clearance [m], EHD_PLAY is the one of the export; of tapered ones the way of
 * the inner ring along x against the outer one in the pose zero [m], which preloads. mirrored: 0, or 1 for a bearing that
 * stands the other way round. */
int ehd_bearing_make(ehd_bearing *bearing, double play, int mirrored);

/* Force, stiffness and damping at speeds of the rings [rad/s], which prepare the law; the cage rolls. velocity may be a
 * null pointer: at rest. The force is linear in it. */
int ehd_bearing_call(const ehd_bearing *bearing, ehd_law *law, ehd_rollers *rollers, const double pose[6],
                     const double velocity[6], double cage_angle, double inner_speed, double outer_speed,
                     ehd_bearing_force *result);

/* Sizes in bytes, for callers in other languages. */
size_t ehd_bearing_size(void);
size_t ehd_rollers_size(void);
