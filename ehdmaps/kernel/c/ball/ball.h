/* ---------------------------------------------------------------------------------------------------------------------
 * A ball bearing: structures
 *
 * All of a ball happens in the plane of the axis and the ball. There the centre of the outer groove is the origin, d the
 * centre of the inner groove, v that of the ball, each (axial, radial) [m].
 * ------------------------------------------------------------------------------------------------------------------ */

#define EHD_BALL_SPRINGS 3 /* of a contact with memory */
#define EHD_BALL_MEMORY EHD_PAIR_MEMORY(EHD_BALL_SPRINGS)

/* What ehd_ball_force found instead of an answer. */
enum { EHD_BALL_NOT_FINITE = -1, EHD_BALL_TOO_FAR = -2, EHD_BALL_NO_BALANCE = -3 };

/* Axis of a ball: without drilling at the outer or at the inner raceway, half way between the contacts, or that without
 * a gyroscopic moment. */
enum { EHD_AXIS_OUTER, EHD_AXIS_INNER, EHD_AXIS_BISECTOR, EHD_AXIS_NO_MOMENT };

/* Lengths of a bearing. */
typedef struct ehd_ball_shape {
    double axial, radial;          /* inner groove's centre against the outer one, rings in the middle [m] */
    double arm;                    /* distance of the inner groove's centre from the axis [m] */
    double inner_arm, outer_arm;   /* of a groove's centre and that of a ball that touches it [m] */
    double most_travel, most_tilt; /* largest accepted displacement [m] and tilt [rad] */
} ehd_ball_shape;

/* Speeds that turn the balls, and what they weigh. */
typedef struct ehd_ball_drive {
    double inner, outer;            /* speeds of the rings [rad/s] */
    double cage;                    /* at which a cage holds the balls [rad/s]; NaN for balls that roll */
    double ratio;                   /* diameter of a ball over the pitch diameter */
    double centrifugal, gyroscopic; /* centrifugal load over the square of the speed, and 2 J d_m/Dw^2 [kg m] */
    double axis;                    /* about which a ball turns, EHD_AXIS_... */
} ehd_ball_drive;

/* Where a ball begins: its centre at the last call, d there [m], S = dv/dd, and what deviations added to both contacts [m];
 * all zero or NaN from nothing. */
typedef struct ehd_ball_start {
    double centre[2], groove[2], share[4], added[2];
} ehd_ball_start;

/* A ball in balance. */
typedef struct ehd_ball_found {
    double force[2];                /* of the inner ring on the ball: axial, radial [N] */
    double stiffness[4];            /* of the inner groove's centre, by rows [N/m] */
    double damping[4];              /* the same [N s/m] */
    double load[2];                 /* of the inner contact and the outer one [N] */
    double angle[2];                /* their contact angles, written by ehd_ball_angles alone [rad] */
    double approach[2];             /* below zero a gap, or a film [m] */
    double inner[2], outer[2];      /* directions e_i and e_o of the contacts: axial, radial */
    double place[2];                /* of the contacts on their tables */
    double speed;                   /* around the axis [rad/s] */
    double centrifugal, traction;   /* F_c, and the traction at the outer raceway [N] */
    double inner_traction;          /* that at the inner one [N] */
    double held[2];                 /* what the memory of films adds to the loads at rest [N] */
} ehd_ball_found;

/* A bearing at a time. */
typedef struct ehd_ball_data {
    ehd_ball_shape shape;
    ehd_ball_drive drive;
    double cage_angle; /* of the first ball, from y towards z [rad] */
    double rest;       /* approach at the outer raceway under the centrifugal load alone [m] */
    int64_t balls;
    const double *cosine, *sine; /* (balls,): directions of the balls in the cage, y and z */
    const double *rows; /* (balls, 4): of its row: way, place, shift, other, see ball_bearing.c; null: one row */
    const double *held; /* (balls, 2, EHD_BALL_MEMORY): memory of contacts over a step, or null, see pair_law.h */
    ehd_pair_law inner, outer;
    const double *added; /* (balls, 2, 2): what deviations add to both contacts, see ../run/deviations.h; null: none */
    double *by_rates;    /* (8,): what the rates of that do, see EHD_PAIR_BY_RATES; of no use where nothing is added */
} ehd_ball_data;
