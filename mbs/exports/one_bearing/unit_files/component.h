/* ---------------------------------------------------------------------------------------------------------------------
 * A bearing of balls or tapered rollers as a component of a simulation, whatever the version of the interface: variables
 * by number, the force that follows from them, its directional derivatives. Films with memory go on by the steps of
 * co-simulation.
 * ------------------------------------------------------------------------------------------------------------------ */
#ifndef COMPONENT_H
#define COMPONENT_H

#include "bearing.h"
#include "identity.h"

#ifdef EHD_BALLS
typedef ehd_balls bodies;
#else
typedef ehd_rollers bodies;
#endif

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
#define OUTPUTS (VARIABLES - FIRST_OUTPUT)

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
#if EHD_MEMORY
    int begun;                   /* whether films have left the rest in which they begin */
    double former[INNER_SPEED];  /* poses, velocities and spins at the end of the last step */
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
    double play;
    ehd_bearing bearing;
    ehd_law law;
    bodies bodies; /* of the last call */
    ehd_bearing_force result;
} component;

/* A component with the values at its start; null without memory. */
component *component_make(void);

/* Go back to the start. */
void component_reset(component *of);

/* Go back, or on, to a state that was kept. */
void component_restore(component *of, const snapshot *kept);

/* The start is over: films with memory begin at rest in the inputs of now. */
int component_begin(component *of);

/* A step of co-simulation over a time [s]: the inputs of now are those of its end. Films with memory follow a ring that
 * moves there from the inputs of the last step; speeds are those of now all along. Returns the status; where it refuses,
 * nothing has changed. */
int component_step(component *of, double step);

/* Bring the outputs up to date. Returns the status; outputs are NaN where it refuses. */
int component_update(component *of);

/* Whether a value may be set, and is finite; sets it. */
int component_set(component *of, unsigned reference, double value);

/* Whether a value is there; gives it. Outputs want component_update first. */
int component_get(const component *of, unsigned reference, double *value);

/* Whether a variable has derivatives: outputs. */
int component_is_unknown(unsigned reference);

/* Derivative of an output by an input. By pose and velocity it is -K and -C, at speeds of the rings that are held; by
 * spins, speeds and play it is a quotient of differences. Films with memory are springs there, without time to give way. Returns a status; the derivative is NaN where
 * that refuses, and zero by variables that have no part in it. */
int component_derivative(component *of, unsigned unknown, unsigned known, double *derivative);

/* What to say of a status, with the values that led to it; into a text of so many characters. */
void component_message(const component *of, int status, char *text, size_t size);

#endif
