#include "component.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "identity.h"

static const double START[VARIABLES] = {[TEMPERATURE] = EHD_START_TEMPERATURE, [CLEARANCE] = EHD_CLEARANCE};

/* Place of each of the four directions in the poses and forces of ehd.h. */
static const int DIRECTION[4] = {1, 2, 4, 5};

component *component_make(void) {
    component *of = calloc(1, sizeof *of);
    if (of) component_reset(of);
    return of;
}

void component_reset(component *of) {
    memcpy(of->values, START, sizeof of->values);
    of->stale = 1;
}

static void motion_of(const double *values, double pose[6], double velocity[6]) {
    memset(pose, 0, 6 * sizeof *pose);
    memset(velocity, 0, 6 * sizeof *velocity);
    for (int i = 0; i < 4; i++) {
        pose[DIRECTION[i]] = values[POSE_Y + i];
        velocity[DIRECTION[i]] = values[VELOCITY_Y + i];
    }
}

/* Force of some values. */
static int force_of(component *of, const double *values, ehd_bearing_force *result) {
    double pose[6], velocity[6];
    const double cage = EHD_CAGE_INNER * values[INNER_ANGLE] + EHD_CAGE_OUTER * values[OUTER_ANGLE];
    const double u = EHD_ENTRAINMENT * (values[INNER_SPEED] - values[OUTER_SPEED]);
    motion_of(values, pose, velocity);
    if (of->bearing.slices == 0 || of->bearing.clearance != values[CLEARANCE])
        if (ehd_bearing_make(&of->bearing, values[CLEARANCE], EHD_SLICES, NULL)) return EHD_BAD_ARGUMENT;
    return ehd_bearing_call(&of->bearing, &of->law, pose, velocity, cage, u, values[TEMPERATURE], 0.0, result);
}

int component_update(component *of) {
    if (!of->stale) return of->status;
    of->status = force_of(of, of->values, &of->result);
    for (int i = 0; i < 4; i++)
        of->values[FIRST_OUTPUT + i] = EHD_REFUSES(of->status) ? NAN : of->result.force[DIRECTION[i]];
    of->stale = 0;
    return of->status;
}

int component_set(component *of, unsigned reference, double value) {
    if (reference == TIME || reference >= FIRST_OUTPUT || !(fabs(value) <= DBL_MAX)) return 0;
    if (of->values[reference] != value) of->stale = 1;
    of->values[reference] = value;
    return 1;
}

int component_get(const component *of, unsigned reference, double *value) {
    if (reference >= VARIABLES) return 0;
    *value = of->values[reference];
    return 1;
}

/* Step of a quotient of differences. */
static double step_of(unsigned input, double value) {
    if (input == TEMPERATURE) return 1e-3;
    if (input == CLEARANCE) return 1e-10;
    return input < INNER_SPEED ? 1e-6 : 1e-5 * (1.0 + fabs(value));
}

int component_derivative(component *of, unsigned output, unsigned input, double *derivative) {
    const int row = DIRECTION[output - FIRST_OUTPUT];
    *derivative = NAN;
    const int status = component_update(of);
    if (EHD_REFUSES(status)) return status;
    if (input >= POSE_Y && input <= POSE_THETA_Z) {
        *derivative = -of->result.stiffness[row][DIRECTION[input - POSE_Y]];
    } else if (input >= VELOCITY_Y && input <= VELOCITY_THETA_Z) {
        *derivative = -of->result.damping[row][DIRECTION[input - VELOCITY_Y]];
    } else if (input >= INNER_ANGLE && input <= CLEARANCE) {
        double values[VARIABLES], force[2], place[2];
        ehd_bearing_force result;
        const double step = step_of(input, of->values[input]);
        for (int side = 0; side < 2; side++) {
            memcpy(values, of->values, sizeof values);
            values[input] += side ? step : -step;
            place[side] = values[input];
            if (EHD_REFUSES(force_of(of, values, &result))) { /* the edge of the map: take the other side alone */
                result = of->result;
                place[side] = of->values[input];
            }
            force[side] = result.force[row];
        }
        *derivative = (force[1] - force[0]) / (place[1] - place[0]);
    } else {
        *derivative = 0.0;
    }
    return status;
}

void component_message(const component *of, int status, char *text, size_t size) {
    const double *v = of->values;
    snprintf(text, size,
             "%s: y = %.6g m, z = %.6g m, theta_y = %.6g rad, theta_z = %.6g rad, entrainment speed %.6g m/s, "
             "temperature %.6g K; mapped: up to %.6g N/m, %.6g m/s, %.6g K to %.6g K%s",
             ehd_status_text(status), v[POSE_Y], v[POSE_Z], v[POSE_THETA_Y], v[POSE_THETA_Z],
             EHD_ENTRAINMENT * fabs(v[INNER_SPEED] - v[OUTER_SPEED]), v[TEMPERATURE], EHD_HIGHEST_LOAD,
             EHD_HIGHEST_SPEED, EHD_LOWEST_TEMPERATURE, EHD_HIGHEST_TEMPERATURE,
             EHD_REFUSES(status) ? "" : "; held at the edge of the map");
}
