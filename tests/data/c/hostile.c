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

int main(int count, char **arguments) {
    static ehd_prepared law;
    static ehd_point point;
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
        }
        int status = ehd_law(number(1e-4), number(1e-2), u, T, q, &force);
        if (!sound(status, &force.load, 1) || !sound(status, &force.stiffness, 1) || force.load < 0.0) return 1;
        status = ehd_law_at(&point, number(1e-4), number(1e-2), &force);
        if (!sound(status, &force.load, 1) || !sound(status, &force.damping, 1) || force.load < 0.0) return 1;
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
    }
    printf("%ld calls, %ld of bearings refused\n", calls, refused);
    return ehd_law(0.0, 0.0, 1.0, 300.0, 0.0, NULL) != EHD_BAD_ARGUMENT;
}
