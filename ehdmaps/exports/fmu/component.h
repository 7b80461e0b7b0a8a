/* ---------------------------------------------------------------------------------------------------------------------
 * A bearing as a component of a simulation, whatever the version of the interface: variables by number, the force that
 * follows from them, its directional derivatives.
 * ------------------------------------------------------------------------------------------------------------------ */
#ifndef COMPONENT_H
#define COMPONENT_H

#include "ehd.h"

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

#define FIRST_OUTPUT FORCE_Y

/* What a component is told and has found; `values` alone is its state. */
typedef struct component {
    double values[VARIABLES];
    int stale;  /* whether outputs are older than inputs */
    int status; /* of the last call of the law, see ehd.h */
    ehd_bearing bearing;
    ehd_prepared law;
    ehd_bearing_force result;
} component;

/* A component with the values at its start; null without memory. */
component *component_make(void);

/* Go back to the start. */
void component_reset(component *of);

/* Bring the outputs up to date. Returns the status of the law; outputs are NaN where it refuses. */
int component_update(component *of);

/* Whether a value may be set, and is finite; sets it. */
int component_set(component *of, unsigned reference, double value);

/* Whether a value is there; gives it. Outputs want component_update first. */
int component_get(const component *of, unsigned reference, double *value);

/* Derivative of an output by an input. By pose and velocity it is exact; by spins, speeds and temperature it is a
 * quotient of differences, taken to that side on which the map goes on. Returns a status; the derivative is NaN where
 * the law refuses, and zero by variables that have no part in it. */
int component_derivative(component *of, unsigned output, unsigned input, double *derivative);

/* What to say of a status, with the values that led to it; into a text of so many characters. */
void component_message(const component *of, int status, char *text, size_t size);

#endif
