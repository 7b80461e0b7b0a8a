/* ---------------------------------------------------------------------------------------------------------------------
 * A bearing as a component of a simulation, whatever the version of the interface: variables by number, the force that
 * follows from them, its directional derivatives.
 * ------------------------------------------------------------------------------------------------------------------ */
#ifndef COMPONENT_H
#define COMPONENT_H

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
#define OUTPUTS (VARIABLES - FIRST_OUTPUT)

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

/* A component with the values at its start; null without memory. */
component *component_make(void);

/* Go back to the start. */
void component_reset(component *of);

/* Go back, or on, to a state that was kept. */
void component_restore(component *of, const snapshot *kept);

/* The start is over: films begin in the equilibrium of the inputs of now, and have states of their own from here on. */
int component_begin(component *of);

/* A step of co-simulation over a time [s]: films follow a ring that moves from the inputs of the last step (at the first
 * one, those of component_begin) to the inputs of now, which are those of the end. Speeds and temperature are those of now
 * all along. Returns the status of the law; where it refuses, nothing has changed. */
int component_step(component *of, double step);

/* Bring the outputs up to date. Returns the status of the law; outputs are NaN where it refuses. */
int component_update(component *of);

/* Whether a value may be set, and is finite; sets it. */
int component_set(component *of, unsigned reference, double value);

/* Whether a value is there; gives it. Outputs want component_update first. */
int component_get(const component *of, unsigned reference, double *value);

/* Whether a variable has derivatives: outputs and rates. */
int component_is_unknown(unsigned reference);

/* Derivative of an output or a rate by an input or a state. By pose, velocity and states it is exact; by spins, speeds
 * and temperature it is a quotient of differences, taken to that side on which the map goes on. Returns a status; the
 * derivative is NaN where the law refuses, and zero by variables that have no part in it. */
int component_derivative(component *of, unsigned unknown, unsigned known, double *derivative);

/* What to say of a status, with the values that led to it; into a text of so many characters. */
void component_message(const component *of, int status, char *text, size_t size);

#endif
