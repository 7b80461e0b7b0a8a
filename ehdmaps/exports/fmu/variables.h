/* Variables of a roller bearing, and what a component of one remembers. */
#ifndef VARIABLES_H
#define VARIABLES_H

#include "ehd.h"
#include "identity.h"

/* The variables, by their value references. */
enum {
    TIME = 0,
    POSE_Y, POSE_Z, POSE_THETA_Y, POSE_THETA_Z,                 /* of the inner ring [m], [rad] */
    VELOCITY_Y, VELOCITY_Z, VELOCITY_THETA_Y, VELOCITY_THETA_Z, /* their rates */
    INNER_ANGLE, OUTER_ANGLE,                                   /* spins of the rings [rad] */
    INNER_SPEED, OUTER_SPEED,                                   /* their rates [rad/s] */
    TEMPERATURE,                                                /* [K] */
    CLEARANCE,                                                  /* diametral [m]; a parameter */
    FORCE_Y, FORCE_Z, MOMENT_Y, MOMENT_Z,                       /* on the inner ring [N], [N m] */
    VARIABLES
};

#define FIRST_INPUT POSE_Y
#define FIRST_OUTPUT FORCE_Y
#define FIRST_VELOCITY VELOCITY_Y
#define OUTPUTS (VARIABLES - FIRST_OUTPUT)
#define DIRECTIONS {1, 2, 4, 5} /* place of each in poses and forces of six */

/* Films with memory have states xi [m], see ehd.h: after the variables above, one a slice, roller by roller; and then
 * their rates [m/s]. Without memory there are none. */
#define FILMS (FMU_MEMORY ? EHD_ROLLERS * EHD_SLICES : 0)
#define FIRST_STATE VARIABLES
#define FIRST_RATE (FIRST_STATE + FILMS)
#define REFERENCES (FIRST_RATE + FILMS)
#define IS_KNOWN(reference) ((reference) < FIRST_OUTPUT || ((reference) >= FIRST_STATE && (reference) < FIRST_RATE))
#define NOMINAL_STATE 1e-7 /* [m] */

/* All that a component has to remember. */
typedef struct snapshot {
    double values[VARIABLES];
    int begun;        /* whether films have left the equilibrium in which they begin */
    double last_step; /* of co-simulation [s] */
    double former[INNER_SPEED]; /* poses, velocities and spins at the end of the last step of co-simulation */
    ehd_film_state films[FILMS + 1];
} snapshot;

/* What a component remembers, and what it has found from it. */
typedef struct component {
    snapshot now;
    int stale;  /* whether outputs are older than inputs and states */
    int status; /* of the last call of the law, see ehd.h */
    ehd_bearing bearing;
    double added[4 * EHD_DEVIATES + 1]; /* by deviations from the form, for it */
    ehd_bearing_force result;
#if FMU_MEMORY
    ehd_film film;
    ehd_film_rates rates[FILMS];
    ehd_film_state stepped[FILMS];
#else
    ehd_prepared law;
#endif
    unsigned asked;                   /* the input by which quotients of differences are, 0 for none */
    double quotients[OUTPUTS + FILMS]; /* of outputs and of rates */
} component;

#endif
