/* Variables of a bearing of balls or tapered rollers, and what a component of one remembers. */
#ifndef VARIABLES_H
#define VARIABLES_H

#include "bearing.h"
#ifdef EHD_BALLS
typedef ehd_balls bodies;
#else
typedef ehd_rollers bodies;
#endif
#include "identity.h"

/* The variables, by their value references. */
enum {
    TIME = 0,
    POSE_X, POSE_Y, POSE_Z, POSE_THETA_Y, POSE_THETA_Z,                     /* of the inner ring [m], [rad] */
    VELOCITY_X, VELOCITY_Y, VELOCITY_Z, VELOCITY_THETA_Y, VELOCITY_THETA_Z, /* their rates */
    INNER_ANGLE, OUTER_ANGLE,                                               /* spins of the rings [rad] */
    INNER_SPEED, OUTER_SPEED,                                               /* their rates [rad/s] */
    PLAY,                                                                   /* as ehd_bearing_make has it [m] */
    MIRRORED,                                                               /* 0 or 1; a parameter */
    FORCE_X, FORCE_Y, FORCE_Z, MOMENT_Y, MOMENT_Z,                          /* on the inner ring [N], [N m] */
    VARIABLES
};

#define FIRST_INPUT POSE_X
#define FIRST_OUTPUT FORCE_X
#define FIRST_VELOCITY VELOCITY_X
#define OUTPUTS (VARIABLES - FIRST_OUTPUT)
#define DIRECTIONS {0, 1, 2, 4, 5} /* place of each in poses and forces of six */

/* No states of the interface. */
#define FILMS 0
#define FIRST_STATE VARIABLES
#define FIRST_RATE VARIABLES
#define REFERENCES VARIABLES
#define IS_KNOWN(reference) ((reference) < FIRST_OUTPUT || ((reference) >= FIRST_STATE && (reference) < FIRST_RATE))
#define NOMINAL_STATE 1.0

/* All that a component has to remember. */
typedef struct snapshot {
    double values[VARIABLES];
    int begun;                  /* whether films have left the rest in which they begin */
    double former[INNER_SPEED]; /* poses, velocities and spins at the end of the last step */
#if EHD_MEMORY
    ehd_films films;
    bodies bodies;
#endif
} snapshot;

/* What a component remembers, and what it has found from it. */
typedef struct component {
    snapshot now;
    int stale;  /* whether outputs are older than inputs */
    int status; /* of the last call, see bearing.h */
    int made;   /* whether the bearing is that of the parameters */
    double play, mirrored;
    ehd_bearing bearing;
    double added[4 * EHD_DEVIATES + 1]; /* by deviations from the form, for it */
    ehd_law law;
    bodies bodies; /* of the last call */
    ehd_bearing_force result;
} component;

#endif
