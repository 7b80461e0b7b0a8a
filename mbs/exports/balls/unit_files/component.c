#include "component.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double START[VARIABLES] = FMU_START;

/* Place of each of the five directions in the poses and forces of ball_bearing.h. */
static const int DIRECTION[5] = {0, 1, 2, 4, 5};

component *component_make(void) {
    component *of = calloc(1, sizeof *of);
    if (of) component_reset(of);
    return of;
}

void component_reset(component *of) {
    snapshot start;
    memcpy(start.values, START, sizeof start.values);
    component_restore(of, &start);
}

void component_restore(component *of, const snapshot *kept) {
    of->now = *kept;
    of->stale = 1;
    of->made = 0;
}

/* Force of some values. Balls start from nothing, so that it hangs on these values alone. */
static int force_of(component *of, const double *values, ehd_bearing_force *result) {
    double pose[6] = {0.0}, velocity[6] = {0.0};
    const double cage_angle = ehd_cage(values[INNER_ANGLE], values[OUTER_ANGLE]);
    if (!of->made || of->bearing.clearance != values[CLEARANCE]) {
        of->made = 0;
        if (ehd_bearing_make(&of->bearing, values[CLEARANCE], values[MIRRORED] != 0.0)) return EHD_BAD_ARGUMENT;
        of->made = 1;
    }
    for (int i = 0; i < 5; i++) {
        pose[DIRECTION[i]] = values[POSE_X + i];
        velocity[DIRECTION[i]] = values[VELOCITY_X + i];
    }
    memset(&of->balls, 0, sizeof of->balls);
    return ehd_bearing_call(&of->bearing, &of->law, &of->balls, pose, velocity, cage_angle, values[INNER_SPEED],
                            values[OUTER_SPEED], result);
}

int component_update(component *of) {
    if (!of->stale) return of->status;
    of->status = force_of(of, of->now.values, &of->result);
    for (int i = 0; i < OUTPUTS; i++)
        of->now.values[FIRST_OUTPUT + i] = EHD_REFUSES(of->status) ? NAN : of->result.force[DIRECTION[i]];
    of->stale = 0;
    return of->status;
}

int component_begin(component *of) { return (void)of, EHD_OK; }

int component_step(component *of, double step) { return (void)step, component_update(of); }

int component_set(component *of, unsigned reference, double value) {
    if (reference == TIME || reference >= FIRST_OUTPUT || !(fabs(value) <= DBL_MAX)) return 0;
    if (reference == MIRRORED && value != 0.0 && value != 1.0) return 0;
    if (of->now.values[reference] != value) {
        of->stale = 1;
        if (reference == MIRRORED) of->made = 0;
    }
    of->now.values[reference] = value;
    return 1;
}

int component_get(const component *of, unsigned reference, double *value) {
    if (reference >= REFERENCES) return 0;
    *value = of->now.values[reference];
    return 1;
}

int component_is_unknown(unsigned reference) { return reference >= FIRST_OUTPUT && reference < VARIABLES; }

/* Step of a quotient of differences. */
static double step_of(unsigned input, double value) {
    if (input == CLEARANCE) return 1e-9;
    return input < INNER_SPEED ? 1e-5 : 1e-4 * (1.0 + fabs(value));
}

/* Quotient of differences of an output; to one side where the other one is refused. */
static double quotient_of(component *of, unsigned unknown, unsigned known) {
    double found[2], place[2];
    const double step = step_of(known, of->now.values[known]);
    for (int side = 0; side < 2; side++) {
        double values[VARIABLES];
        ehd_bearing_force result;
        memcpy(values, of->now.values, sizeof values);
        values[known] += side ? step : -step;
        place[side] = values[known];
        if (EHD_REFUSES(force_of(of, values, &result))) {
            result = of->result;
            place[side] = of->now.values[known];
        }
        found[side] = result.force[DIRECTION[unknown - FIRST_OUTPUT]];
    }
    return place[1] > place[0] ? (found[1] - found[0]) / (place[1] - place[0]) : NAN;
}

int component_derivative(component *of, unsigned unknown, unsigned known, double *derivative) {
    *derivative = NAN;
    const int status = component_update(of), row = DIRECTION[unknown - FIRST_OUTPUT];
    if (EHD_REFUSES(status)) return status;
    *derivative = 0.0;
    if (known >= INNER_ANGLE && known <= CLEARANCE)
        *derivative = quotient_of(of, unknown, known);
    else if (known >= POSE_X && known <= POSE_THETA_Z)
        *derivative = -of->result.stiffness[row][DIRECTION[known - POSE_X]];
    else if (known >= VELOCITY_X && known <= VELOCITY_THETA_Z)
        *derivative = -of->result.damping[row][DIRECTION[known - VELOCITY_X]];
    return status;
}

void component_message(const component *of, int status, char *text, size_t size) {
    const double *v = of->now.values;
    snprintf(text, size,
             "%s: x = %.6g m, y = %.6g m, z = %.6g m, theta_y = %.6g rad, theta_z = %.6g rad, speeds of inner and outer "
             "ring %.6g and %.6g rad/s, entrainment speed %.6g m/s; films: %.6g to %.6g m/s, up to %.6g N",
             ehd_status_text(status), v[POSE_X], v[POSE_Y], v[POSE_Z], v[POSE_THETA_Y], v[POSE_THETA_Z],
             v[INNER_SPEED], v[OUTER_SPEED], EHD_ENTRAINMENT * fabs(v[INNER_SPEED] - v[OUTER_SPEED]),
             EHD_LOWEST_SPEED, EHD_HIGHEST_SPEED, of->law.highest);
}
