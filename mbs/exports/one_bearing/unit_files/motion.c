#include "component.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Make the bearing that some values ask for. */
static int bearing_for(component *of, const double *values) {
    if (!of->made || of->play != values[PLAY] || of->mirrored != values[MIRRORED]) {
        of->made = 0;
        if (ehd_bearing_make(&of->bearing, values[PLAY], values[MIRRORED] != 0.0)) return EHD_BAD_ARGUMENT;
        of->made = 1;
        of->play = values[PLAY];
        of->mirrored = values[MIRRORED];
    }
    return EHD_OK;
}

/* Deviations from the form at a part of the way from some values to others. */
static void deviate(component *of, const double *from, const double *to, double part) {
#if EHD_DEVIATES
    const double inner = from[INNER_ANGLE] + part * (to[INNER_ANGLE] - from[INNER_ANGLE]);
    const double outer = from[OUTER_ANGLE] + part * (to[OUTER_ANGLE] - from[OUTER_ANGLE]);
    ehd_bearing_deviations(ehd_cage(inner, outer), inner, outer, to[INNER_SPEED], to[OUTER_SPEED], of->added);
    of->bearing.added = of->added;
#else
    (void)of, (void)from, (void)to, (void)part;
#endif
}

/* Force of some values. Bodies start from nothing, so that it hangs on these values alone; or on films that have begun,
 * which are springs after no time. */
static int force_of(component *of, const double *values, ehd_bearing_force *result) {
    double pose[6], velocity[6];
    const double cage_angle = ehd_cage(values[INNER_ANGLE], values[OUTER_ANGLE]);
    motion_of(values, pose, velocity);
    if (bearing_for(of, values)) return EHD_BAD_ARGUMENT;
    deviate(of, values, values, 1.0);
#if EHD_MEMORY
    if (of->now.begun) {
        of->bodies = of->now.bodies;
        ehd_prepare(&of->law, EHD_ENTRAINMENT * (values[INNER_SPEED] - values[OUTER_SPEED]));
        return ehd_films_look(&of->bearing, &of->law, &of->bodies, &of->now.films, 0.0, pose, cage_angle,
                              values[INNER_SPEED], values[OUTER_SPEED], result);
    }
#endif
    memset(&of->bodies, 0, sizeof of->bodies);
    return ehd_bearing_call(&of->bearing, &of->law, &of->bodies, pose, velocity, cage_angle, values[INNER_SPEED],
                            values[OUTER_SPEED], result);
}

int component_force(component *of) { return force_of(of, of->now.values, &of->result); }

#if EHD_MEMORY
int component_begin(component *of) {
    of->now.begun = 0;
    of->stale = 1;
    const int status = component_update(of);
    if (EHD_REFUSES(status)) return status;
    ehd_films_begin(&of->law, &of->bodies, &of->now.films);
    of->now.bodies = of->bodies;
    component_follow(of);
    return status;
}

int component_step(component *of, double step) {
    const snapshot before = of->now;
    snapshot *now = &of->now;
    const int count = film_steps(step);
    int status = EHD_OK;
    if (!(step > 0.0)) return component_update(of);
    if (!now->begun) status = component_begin(of);
    if (!EHD_REFUSES(status)) status |= bearing_for(of, now->values);
    if (!EHD_REFUSES(status))
        status |= ehd_prepare(&of->law, EHD_ENTRAINMENT * (now->values[INNER_SPEED] - now->values[OUTER_SPEED]));
    const double begin = ehd_cage(now->former[INNER_ANGLE], now->former[OUTER_ANGLE]);
    const double turn = ehd_cage(now->values[INNER_ANGLE], now->values[OUTER_ANGLE]) - begin;
    for (int n = 1; n <= count && !EHD_REFUSES(status); n++) {
        const double part = (double)n / count;
        double pose[6];
        motion_between(now, part, step, pose);
        deviate(of, now->former, now->values, part);
        status |= ehd_films_step(&of->bearing, &of->law, &now->bodies, &now->films, step / count, pose,
                                 begin + part * turn, now->values[INNER_SPEED], now->values[OUTER_SPEED], &of->result);
    }
    if (EHD_REFUSES(status)) {
        component_restore(of, &before);
        return status;
    }
    component_follow(of);
    return component_told(of, status);
}
#else
int component_begin(component *of) { return (void)of, EHD_OK; }

int component_step(component *of, double step) { return (void)step, component_update(of); }
#endif

int component_set(component *of, unsigned reference, double value) {
    if (reference == TIME || reference >= FIRST_OUTPUT || !(fabs(value) <= DBL_MAX)) return 0;
    if (reference == MIRRORED && value != 0.0 && value != 1.0) return 0;
    if (of->now.values[reference] != value) of->stale = 1;
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
    if (input == PLAY) return 1e-9;
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

/* By pose and velocity it is -K and -C, at speeds of the rings that are held; by spins, speeds and play it is a quotient of
 * differences. Films with memory are springs there, without time to give way. */
int component_derivative(component *of, unsigned unknown, unsigned known, double *derivative) {
    *derivative = NAN;
    const int row = DIRECTION[unknown - FIRST_OUTPUT];
    int status = component_update(of);
    if (EHD_REFUSES(status)) return status;
#if EHD_MEMORY /* of a step there is another stiffness */
    if (of->now.begun && EHD_REFUSES(status = force_of(of, of->now.values, &of->result))) return status;
#endif
    *derivative = 0.0;
    if (known >= INNER_ANGLE && known <= PLAY)
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
