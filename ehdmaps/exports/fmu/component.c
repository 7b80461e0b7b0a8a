#include "component.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_STEP 5e-6 /* of films in co-simulation [s]: damping at 3 kHz is right within half a per cent */
#define MOST_FILM_STEPS 400

static const double START[VARIABLES] = FMU_START;

const int DIRECTION[OUTPUTS] = DIRECTIONS;

component *component_make(void) {
    component *of = calloc(1, sizeof *of);
    if (of) component_reset(of);
    return of;
}

void component_reset(component *of) {
    snapshot start;
    memset(&start, 0, sizeof start);
    memcpy(start.values, START, sizeof start.values);
    component_restore(of, &start);
}

void component_restore(component *of, const snapshot *kept) {
    of->now = *kept;
    of->stale = 1;
}

int component_told(component *of, int status) {
    of->status = status;
    for (int i = 0; i < OUTPUTS; i++)
        of->now.values[FIRST_OUTPUT + i] = EHD_REFUSES(status) ? NAN : of->result.force[DIRECTION[i]];
    of->stale = 0;
    return status;
}

int component_update(component *of) { return of->stale ? component_told(of, component_force(of)) : of->status; }

void component_follow(component *of) {
    of->now.begun = 1;
    memcpy(of->now.former, of->now.values, sizeof of->now.former);
}

void motion_of(const double *values, double pose[6], double velocity[6]) {
    memset(pose, 0, 6 * sizeof *pose);
    memset(velocity, 0, 6 * sizeof *velocity);
    for (int i = 0; i < OUTPUTS; i++) {
        pose[DIRECTION[i]] = values[FIRST_INPUT + i];
        velocity[DIRECTION[i]] = values[FIRST_VELOCITY + i];
    }
}

int film_steps(double step) {
    const double wanted = ceil(step / LONGEST_STEP * (1.0 - 1e-9));
    return wanted < MOST_FILM_STEPS ? (int)wanted : MOST_FILM_STEPS;
}

/* Place of the ring along a direction at a part of a step, from begin to end: cubic by the velocities at both, straight
 * where these are not the rates of this motion, or not given. Their mean differs from that of a motion at f by
 * (2 pi f step)^2/12. */
static double place_between(double begin, double end, double velocity, double velocity_at_end, double part, double step) {
    const double change = end - begin, first = step * velocity, last = step * velocity_at_end;
    const double largest = fmax(fabs(change), fmax(fabs(first), fabs(last)));
    const double bend = (1.0 - part) * (first - change) - part * (last - change);
    const int fits = fabs(0.5 * (first + last) - change) <= 0.5 * largest;
    return begin + part * (change + (fits ? (1.0 - part) * bend : 0.0));
}

void motion_between(const snapshot *now, double part, double step, double pose[6]) {
    const double *begin = now->former, *end = now->values;
    memset(pose, 0, 6 * sizeof *pose);
    for (int i = 0; i < OUTPUTS; i++)
        pose[DIRECTION[i]] = place_between(begin[FIRST_INPUT + i], end[FIRST_INPUT + i], begin[FIRST_VELOCITY + i],
                                           end[FIRST_VELOCITY + i], part, step);
}
