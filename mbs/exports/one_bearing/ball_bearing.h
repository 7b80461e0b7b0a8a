/* ---------------------------------------------------------------------------------------------------------------------
 * A ball bearing: from the pose and velocity of its inner ring to force, stiffness and damping, all in SI units.
 *
 * Frame O is the one of the outer ring, in the middle of its groove; x is the axis of the bearing; it does not spin. A
 * pose is x y z theta_x theta_y theta_z of the inner ring in O [m], [rad]; a velocity is its rate; a force is what acts
 * on the inner ring [N], [N m], about its centre. theta_x has no force. The outer ring gets the opposite. In the pose
 * zero angular contact bearings without clearance just touch.
 *
 * Ball j stands at cage_angle + 2 pi j/EHD_ROW_BALLS, from y towards z. Each ball is in balance with both raceways, its
 * centrifugal load and its gyroscopic moment, which traction at the outer raceway holds. It goes around at the speed of its
 * own contact angles, by which it rolls at both raceways and does not drill at the outer one. Balls have no inertia beside
 * that.
 *
 *     static ehd_law law;     // all zero before the first call
 *     static ehd_balls balls; // the same
 *     ehd_bearing bearing;
 *     ehd_bearing_force result;
 *     ehd_bearing_make(&bearing, EHD_CLEARANCE, 0);
 *     int status = ehd_bearing_call(&bearing, &law, &balls, pose, velocity, cage_angle, inner_speed, outer_speed, &result);
 *     if (EHD_REFUSES(status)) puts(ehd_status_text(status)); // result is NaN
 *
 * Nothing here allocates, keeps a state of its own, reads or writes a file. All functions may be called from several
 * threads at once, each with structures of its own.
 * ------------------------------------------------------------------------------------------------------------------ */

/* What does not change of a bearing; made by ehd_bearing_make. */
typedef struct ehd_bearing {
    double clearance;
    int mirrored;
    double axial, radial;                    /* inner groove's centre against the outer one, rings in the middle [m] */
    double arm;                              /* distance of the inner groove's centre from the axis [m] */
    double most_travel, most_tilt;           /* largest accepted displacement [m] and tilt [rad] */
    double cosine[EHD_BALLS], sine[EHD_BALLS]; /* directions of the balls in the cage */
    double row[EHD_BALLS][4]; /* way, place [m] and shift [m] of their rows; balls to their other contacts */
    const double *added; /* (EHD_BALLS, 2, 2), of the caller, or null: approach [m] and its rate [m/s] that deviations from
                          * the form add to the inner and the outer contact of each ball */
} ehd_bearing;

/* A ball in balance. */
typedef struct ehd_ball {
    double centre[2];                      /* from the outer groove's centre: axial, radial [m] */
    double force[2];                       /* on the ball, of the inner ring: axial, radial [N] */
    double stiffness[4], damping[4];       /* of the inner groove's centre, by rows [N/m], [N s/m] */
    double inner_load, outer_load;         /* [N] */
    double inner_angle, outer_angle;       /* contact angles [rad] */
    double inner_approach, outer_approach; /* below zero a gap, or a film [m] */
    double speed;                          /* around the axis [rad/s] */
} ehd_ball;

/* The balls of a bearing. All zero before the first call: they start from nothing. Answers hang on where they started
 * by what Newton's method leaves: 1e-13 of the load, 1e-11 of stiffness and damping. */
typedef struct ehd_balls {
    double rest; /* approach at the outer raceway under the centrifugal load alone [m] */
    ehd_ball ball[EHD_BALLS];
    double start[EHD_BALLS][10]; /* where they start at the next call */
} ehd_balls;

/* Make a bearing.
 *
 * clearance: diametral clearance in force, axial of rows that carry either way [m], < 0 for preload; EHD_CLEARANCE is the one of the export. mirrored: 0, or
 * 1 for an angular contact bearing that stands the other way round, and carries an axial force on the inner ring in -x. */
int ehd_bearing_make(ehd_bearing *bearing, double clearance, int mirrored);

/* Force, stiffness and damping at speeds of the outer ring and of a cage that holds all balls [rad/s], and a prepared law:
 * of motion that is too fast for balls to change their speed. velocity may be a null pointer: at rest. The force is linear
 * in it. */
int ehd_bearing_at(const ehd_bearing *bearing, const ehd_law *law, ehd_balls *balls, const double pose[6],
                   const double velocity[6], double cage_angle, double cage_speed, double outer_speed,
                   ehd_bearing_force *result);

/* The same with the law of the speeds of the rings, and with balls that go around at speeds of their own, which follow the
 * pose: slow motion. cage_speed of the result is their mean by their loads. */
int ehd_bearing_call(const ehd_bearing *bearing, ehd_law *law, ehd_balls *balls, const double pose[6],
                     const double velocity[6], double cage_angle, double inner_speed, double outer_speed,
                     ehd_bearing_force *result);

/* Sizes in bytes, for callers in other languages. */
size_t ehd_bearing_size(void);
size_t ehd_balls_size(void);
