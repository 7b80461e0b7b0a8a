/* Calls an export with numbers of any kind, as many times as the first argument says: whatever is refused must be NaN,
 * whatever is not must be finite, and no load may be negative. Returns 1 where it is not so. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "ehd.h"

static uint64_t seed = 88172645463325252u;

static uint64_t any(void) {
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return seed;
}

/* NaN, infinities, zeros, denormals, huge and tiny numbers, and numbers around a size. */
static double number(double size) {
    static const double odd[] = {0.0, -0.0, 1e-310, -4.9e-324, 1e-30, 1e30, -1e300, 1.7e308};
    const double part = (double)(any() >> 11) / 9007199254740992.0;
    const unsigned kind = (unsigned)(any() % 64);
    if (kind == 0) return NAN;
    if (kind == 1) return INFINITY;
    if (kind == 2) return -INFINITY;
    if (kind < 8) return odd[any() % 8];
    if (kind < 16) return (part - 0.5) * size * pow(10.0, (double)(any() % 13) - 4.0);
    return (part - 0.5) * 2.0 * size;
}

static int sound(int status, const double *values, int count) {
    for (int i = 0; i < count; i++)
        if (EHD_REFUSES(status) ? !isnan(values[i]) : !isfinite(values[i])) return 0;
    return 1;
}

/* A film through a step and at an instant: what is not refused is finite, and no load is negative. */
static int film_sound(const ehd_film *film) {
    const double approach = number(1e-4);
    ehd_film_state state = {number(1e-4), number(1.0), number(1e5)};
    ehd_film_rates rates;
    ehd_force force;
    if (any() % 2) {
        const int status = ehd_film_settled(film, number(1e-4), &state);
        if (!sound(status, &state.approach, 1) || !sound(status, &state.load, 1) || state.load < 0.0) return 0;
    }
    int status = ehd_film_advance(film, number(1e-4), number(1e-4), approach, &state, &state, &force);
    if (!sound(status, &force.load, 1) || !sound(status, &force.stiffness, 1) || force.load < 0.0) return 0;
    if (!sound(status, &state.approach, 1) || force.stiffness < 0.0) return 0;
    status = ehd_film_rate(film, approach, number(1e-4), &rates);
    if (!sound(status & ~EHD_ABOVE_LOAD, &rates.rate, 3)) return 0;
    return sound(status, &rates.load, 3) && !(rates.load < 0.0) && !(rates.stiffness < 0.0);
}

int main(int count, char **arguments) {
    static ehd_prepared law;
    static ehd_point point;
    static ehd_film film;
    static ehd_film_state begun[EHD_ROLLERS * EHD_MOST_SLICES], ended[EHD_ROLLERS * EHD_MOST_SLICES];
    static ehd_film_rates rates[EHD_ROLLERS * EHD_MOST_SLICES];
    static double states[EHD_ROLLERS * EHD_MOST_SLICES];
    ehd_bearing bearing;
    long refused = 0, calls = count > 1 ? atol(arguments[1]) : 1000;
    for (long n = 0; n < calls; n++) {
        ehd_force force;
        ehd_bearing_force result;
        double pose[6], velocity[6];
        const double u = number(5.0), T = 330.0 + number(60.0), q = any() % 4 ? 0.0 : number(1e3);
        if (n % 64 == 0) {
            while (ehd_bearing_make(&bearing, number(1e-4), (int)(any() % (EHD_MOST_SLICES + 2)) - 1, NULL)) {}
            ehd_prepare(&law, u, T, q);
            ehd_at(&point, u, T, q);
            ehd_film_at(&film, u, T);
        }
        int status = ehd_law(number(1e-4), number(1e-2), u, T, q, &force);
        if (!sound(status, &force.load, 1) || !sound(status, &force.stiffness, 1) || force.load < 0.0) return 1;
        status = ehd_law_at(&point, number(1e-4), number(1e-2), &force);
        if (!sound(status, &force.load, 1) || !sound(status, &force.damping, 1) || force.load < 0.0) return 1;
        if (!film_sound(&film)) return 1;
        if (n % 16) continue;
        for (int i = 0; i < 6; i++) {
            pose[i] = any() % 8 ? 1e-4 * ((double)(any() % 1001) / 500.0 - 1.0) : number(1e-4);
            velocity[i] = any() % 8 ? 0.0 : number(1e-2);
        }
        status = ehd_bearing_at(&bearing, &law, pose, velocity, any() % 4 ? 0.0 : number(10.0), &result);
        if (!sound(status, result.force, 6) || !sound(status, result.stiffness[0], 36) ||
            !sound(status, result.damping[0], 36))
            return 1;
        refused += EHD_REFUSES(status);
        const double cage_angle = any() % 4 ? 0.0 : number(10.0);
        const int count_of = EHD_ROLLERS * bearing.slices;
        status = ehd_bearing_settled(&bearing, &film, pose, cage_angle, begun);
        for (int i = 0; i < count_of; i++) {
            if (EHD_REFUSES(status)) begun[i].approach = begun[i].change = begun[i].load = 0.0;
            states[i] = begun[i].approach + number(1e-6);
        }
        status = ehd_bearing_advance(&bearing, &film, number(1e-4), number(1e-4), pose, cage_angle, begun, ended, &result);
        if (!sound(status, result.force, 6) || !sound(status, result.stiffness[0], 36)) return 1;
        status = ehd_bearing_rates(&bearing, &film, pose, cage_angle, states, rates, &result);
        if (!sound(status, result.force, 6) || !sound(status, result.stiffness[0], 36)) return 1;
    }
    printf("%ld calls, %ld of bearings refused\n", calls, refused);
    return ehd_law(0.0, 0.0, 1.0, 300.0, 0.0, NULL) != EHD_BAD_ARGUMENT;
}
