/* ---------------------------------------------------------------------------------------------------------------------
 * A bearing as a component of a simulation, whatever its kind and the version of the interface: variables by number, the
 * force that follows from them, its directional derivatives. A kind has its variables and what it remembers in
 * variables.h, and the functions of motion.c.
 * ------------------------------------------------------------------------------------------------------------------ */
#ifndef COMPONENT_H
#define COMPONENT_H

#include "variables.h"

/* Place of each output, and of each input of pose and velocity, in poses and forces of six. */
extern const int DIRECTION[OUTPUTS];

/* A component with the values at its start; null without memory. */
component *component_make(void);

/* Go back to the start. */
void component_reset(component *of);

/* Go back, or on, to a state that was kept. */
void component_restore(component *of, const snapshot *kept);

/* The start is over: films with memory begin at rest in the inputs of now. */
int component_begin(component *of);

/* A step of co-simulation over a time [s]: films with memory follow a ring that moves from the inputs of the last step (at
 * the first one, those of component_begin) to the inputs of now, which are those of the end. Speeds and temperature are
 * those of now all along. Returns a status; where it refuses, nothing has changed. */
int component_step(component *of, double step);

/* Bring the outputs up to date. Returns the status; outputs are NaN where it refuses. */
int component_update(component *of);

/* Whether a value may be set, and is finite; sets it. */
int component_set(component *of, unsigned reference, double value);

/* Whether a value is there; gives it. Outputs want component_update first. */
int component_get(const component *of, unsigned reference, double *value);

/* Whether a variable has derivatives: outputs and rates. */
int component_is_unknown(unsigned reference);

/* Derivative of an output or a rate by an input or a state, at the others as they are; what it is by which, see motion.c.
 * Returns a status; the derivative is NaN where that refuses, and zero by variables that have no part in it. */
int component_derivative(component *of, unsigned unknown, unsigned known, double *derivative);

/* What to say of a status, with the values that led to it; into a text of so many characters. */
void component_message(const component *of, int status, char *text, size_t size);

/* For motion.c: outputs by the result of a status that was found; the status. */
int component_told(component *of, int status);

/* For motion.c: from here on films have states of their own, and the inputs of now are those of the last step. */
void component_follow(component *of);

/* For motion.c: pose and velocity by some values. */
void motion_of(const double *values, double pose[6], double velocity[6]);

/* For motion.c: pose at a part of a step [s] from the inputs of the last one to those of now. */
void motion_between(const snapshot *now, double part, double step, double pose[6]);

/* For motion.c: steps of films in one of co-simulation [s]; rounding makes no further one. */
int film_steps(double step);

/* Of motion.c: the result of the values of now; the status. */
int component_force(component *of);

#endif
