#include "component.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static double cage_angle_of(const double *values) {
    return EHD_CAGE_INNER * values[INNER_ANGLE] + EHD_CAGE_OUTER * values[OUTER_ANGLE];
}

static double entrainment_of(const double *values) {
    return EHD_ENTRAINMENT * (values[INNER_SPEED] - values[OUTER_SPEED]);
}

/* Deviations from the form at a part of the way from some values to others. */
static void deviate(component *of, const double *from, const double *to, double part) {
#if EHD_DEVIATES
    const double inner = from[INNER_ANGLE] + part * (to[INNER_ANGLE] - from[INNER_ANGLE]);
    const double outer = from[OUTER_ANGLE] + part * (to[OUTER_ANGLE] - from[OUTER_ANGLE]);
    const double cage = EHD_CAGE_INNER * inner + EHD_CAGE_OUTER * outer;
    ehd_bearing_deviations(cage, inner, outer, to[INNER_SPEED], to[OUTER_SPEED], of->added);
    of->bearing.added = of->added;
#else
    (void)of, (void)from, (void)to, (void)part;
#endif
}

/* Make the bearing and the law that some values ask for; films that have not begun settle there. */
static int law_for(component *of, const double *values) {
    if (of->bearing.slices == 0 || of->bearing.clearance != values[CLEARANCE])
        if (ehd_bearing_make(&of->bearing, values[CLEARANCE], EHD_SLICES, NULL)) return EHD_BAD_ARGUMENT;
    deviate(of, values, values, 1.0);
#if FMU_MEMORY
    double pose[6], velocity[6];
    motion_of(values, pose, velocity);
    const int status = ehd_film_at(&of->film, entrainment_of(values), values[TEMPERATURE]);
    if (!of->now.begun)
        ehd_bearing_settled(&of->bearing, &of->film, pose, cage_angle_of(values), of->now.films);
    return status;
#else
    return EHD_OK;
#endif
}

/* Force of some values, and what follows for the films. */
static int force_of(component *of, const double *values, ehd_bearing_force *result, ehd_film_rates *rates) {
    double pose[6], velocity[6];
    const double cage = cage_angle_of(values);
    motion_of(values, pose, velocity);
    if (law_for(of, values) & EHD_BAD_ARGUMENT) return EHD_BAD_ARGUMENT;
#if FMU_MEMORY
    double states[FILMS];
    for (int n = 0; n < FILMS; n++) states[n] = of->now.films[n].approach;
    return ehd_bearing_rates(&of->bearing, &of->film, pose, cage, states, rates, result);
#else
    (void)rates;
    return ehd_bearing_call(&of->bearing, &of->law, pose, velocity, cage, entrainment_of(values), values[TEMPERATURE],
                            0.0, result);
#endif
}

static ehd_film_rates *rates_of(component *of) {
#if FMU_MEMORY
    return of->rates;
#else
    return (void)of, NULL;
#endif
}

int component_force(component *of) {
    of->asked = 0;
    return force_of(of, of->now.values, &of->result, rates_of(of));
}

int component_begin(component *of) {
    const int status = FILMS ? component_update(of) : EHD_OK;
    if (!EHD_REFUSES(status)) component_follow(of);
    return status;
}

#if FMU_MEMORY
int component_step(component *of, double step) {
    double pose[6];
    const snapshot before = of->now;
    const int count = film_steps(step);
    if (!(step > 0.0)) return component_update(of);
    int status = law_for(of, of->now.values);
    if (!of->now.begun) component_follow(of);
    const double begin = cage_angle_of(of->now.former), turn = cage_angle_of(of->now.values) - begin;
    for (int n = 1; n <= count && !EHD_REFUSES(status); n++) {
        const double part = (double)n / count;
        motion_between(&of->now, part, step, pose);
        deviate(of, of->now.former, of->now.values, part);
        status |= ehd_bearing_advance(&of->bearing, &of->film, step / count, of->now.last_step, pose,
                                      begin + part * turn, of->now.films, of->stepped, &of->result);
        memcpy(of->now.films, of->stepped, sizeof of->stepped);
        of->now.last_step = step / count;
    }
    of->stale = 1;
    component_follow(of);
    if (!EHD_REFUSES(status)) status |= component_update(of);
    if (EHD_REFUSES(status)) component_restore(of, &before);
    return status;
}
#else
int component_step(component *of, double step) { return (void)step, component_update(of); }
#endif

int component_set(component *of, unsigned reference, double value) {
    double *place = reference < FIRST_OUTPUT ? &of->now.values[reference] : NULL;
    if (reference >= FIRST_STATE && reference < FIRST_RATE) {
        place = &of->now.films[reference - FIRST_STATE].approach;
        if (!of->now.begun) component_follow(of);
    }
    if (reference == TIME || !place || !(fabs(value) <= DBL_MAX)) return 0;
    if (*place != value) of->stale = 1;
    *place = value;
    return 1;
}

int component_get(const component *of, unsigned reference, double *value) {
    if (reference >= REFERENCES) return 0;
#if FMU_MEMORY
    if (reference >= FIRST_RATE)
        *value = of->rates[reference - FIRST_RATE].rate;
    else if (reference >= FIRST_STATE)
        *value = of->now.films[reference - FIRST_STATE].approach;
    else
#endif
        *value = of->now.values[reference];
    return 1;
}

/* Step of a quotient of differences. */
static double step_of(unsigned input, double value) {
    if (input == TEMPERATURE) return 1e-3;
    if (input == CLEARANCE) return 1e-10;
    return input < INNER_SPEED ? 1e-6 : 1e-5 * (1.0 + fabs(value));
}

/* Quotients of differences of all outputs and rates by an input. */
static void quotients_by(component *of, unsigned known) {
    double values[VARIABLES], found[2][OUTPUTS + FILMS], place[2];
    ehd_bearing_force result;
    ehd_film_rates rates[FILMS + 1];
    const double step = step_of(known, of->now.values[known]);
    if (of->asked == known) return;
    const snapshot now = of->now; /* films that have not begun settle at the inputs of each call */
    for (int side = 0; side < 2; side++) {
        memcpy(values, of->now.values, sizeof values);
        values[known] += side ? step : -step;
        place[side] = values[known];
        if (EHD_REFUSES(force_of(of, values, &result, rates))) { /* the edge of the map: take the other side alone */
            result = of->result;
            if (FILMS) memcpy(rates, rates_of(of), FILMS * sizeof *rates);
            place[side] = of->now.values[known];
        }
        for (int i = 0; i < OUTPUTS; i++) found[side][i] = result.force[DIRECTION[i]];
        for (int n = 0; n < FILMS; n++) found[side][OUTPUTS + n] = rates[n].rate;
    }
    of->now = now;
    for (int i = 0; i < OUTPUTS + FILMS; i++) of->quotients[i] = (found[1][i] - found[0][i]) / (place[1] - place[0]);
    of->asked = known;
}

int component_is_unknown(unsigned reference) {
    return (reference >= FIRST_OUTPUT && reference < VARIABLES) || (reference >= FIRST_RATE && reference < REFERENCES);
}

#if FMU_MEMORY
/* Derivative of an output or a rate by pose or state of a film. */
static double film_derivative(const component *of, unsigned unknown, unsigned known) {
    const int n = (int)(unknown >= FIRST_RATE ? unknown - FIRST_RATE : known - FIRST_STATE);
    const ehd_film_rates *rates = &of->rates[n];
    double column[4];
    ehd_bearing_direction(&of->bearing, cage_angle_of(of->now.values), n / EHD_SLICES, n % EHD_SLICES, column);
    if (unknown < FIRST_RATE) return -column[unknown - FIRST_OUTPUT] * rates->by_state * of->bearing.slice_length;
    if (known < FIRST_STATE) return column[known - POSE_Y] * rates->rate_by_approach;
    return known - FIRST_STATE == unknown - FIRST_RATE ? rates->rate_by_state : 0.0;
}
#endif

/* By pose, velocity and states it is exact; by spins, speeds
 * and temperature it is a quotient of differences, taken to that side on which the map goes on. */
int component_derivative(component *of, unsigned unknown, unsigned known, double *derivative) {
    *derivative = NAN;
    const int status = component_update(of);
    if (EHD_REFUSES(status)) return status;
    *derivative = 0.0;
    if (known >= INNER_ANGLE && known <= CLEARANCE) {
        quotients_by(of, known);
        *derivative = of->quotients[unknown < VARIABLES ? unknown - FIRST_OUTPUT : OUTPUTS + unknown - FIRST_RATE];
        return status;
    }
#if FMU_MEMORY
    if ((known >= FIRST_STATE && known < FIRST_RATE) ||
        (unknown >= FIRST_RATE && known >= POSE_Y && known <= POSE_THETA_Z)) {
        *derivative = film_derivative(of, unknown, known);
        return status;
    }
#endif
    if (unknown >= VARIABLES) return status;
    const int row = DIRECTION[unknown - FIRST_OUTPUT];
    if (known >= POSE_Y && known <= POSE_THETA_Z)
        *derivative = -of->result.stiffness[row][DIRECTION[known - POSE_Y]];
    else if (known >= VELOCITY_Y && known <= VELOCITY_THETA_Z)
        *derivative = -of->result.damping[row][DIRECTION[known - VELOCITY_Y]];
    return status;
}

void component_message(const component *of, int status, char *text, size_t size) {
    const double *v = of->now.values;
    snprintf(text, size,
             "%s: y = %.6g m, z = %.6g m, theta_y = %.6g rad, theta_z = %.6g rad, entrainment speed %.6g m/s, "
             "temperature %.6g K; mapped: up to %.6g N/m, %.6g m/s, %.6g K to %.6g K%s",
             ehd_status_text(status), v[POSE_Y], v[POSE_Z], v[POSE_THETA_Y], v[POSE_THETA_Z],
             EHD_ENTRAINMENT * fabs(v[INNER_SPEED] - v[OUTER_SPEED]), v[TEMPERATURE], EHD_HIGHEST_LOAD,
             EHD_HIGHEST_SPEED, EHD_LOWEST_TEMPERATURE, EHD_HIGHEST_TEMPERATURE,
             EHD_REFUSES(status) ? "" : "; held at the edge of the map");
}
