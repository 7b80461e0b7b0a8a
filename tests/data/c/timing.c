/* Times calls of a bearing of 41 slices, and prints forces with all digits. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "ehd.h"

#define CALLS 20000

static double seconds(void) { return (double)clock() / CLOCKS_PER_SEC; }

static ehd_prepared law;
static ehd_bearing bearing;
static ehd_bearing_force result;

/* Microseconds of a call: the best of many rounds. */
static double time_of(double tilt) {
    double pose[6] = {0.0, 3e-6, 1e-6, 0.0, tilt, 2.0 * tilt}, velocity[6] = {0.0, 1e-4, 0.0, 0.0, 10.0 * tilt, 0.0};
    double best = 1e9;
    for (int n = 0; n < 15; n++) {
        const double begin = seconds();
        for (int i = 0; i < CALLS; i++) {
            pose[2] = 1e-6 + 1e-12 * i;
            ehd_bearing_at(&bearing, &law, pose, velocity, 0.1, &result);
        }
        const double took = (seconds() - begin) / CALLS;
        best = took < best ? took : best;
    }
    printf("%a %a %a\n", result.force[1], result.stiffness[1][1], result.damping[2][2]);
    return 1e6 * best;
}

int main(int count, char **arguments) {
    const double u = count > 1 ? atof(arguments[1]) : 1.0, T = count > 2 ? atof(arguments[2]) : 313.15;
    double took[4], best = 1e9;
    ehd_force force;
    ehd_bearing_make(&bearing, 0.0, 41, NULL);
    if (EHD_REFUSES(ehd_prepare(&law, u, T, 0.0))) return 1;
    took[0] = time_of(0.0);
    took[1] = time_of(1e-5);
    for (int n = 0; n < 10; n++) {
        const double begin = seconds();
        for (int i = 0; i < 2000; i++) ehd_prepare(&law, u * (1.0 + 1e-6 * i), T, 0.0);
        const double each = (seconds() - begin) / 2000;
        best = each < best ? each : best;
    }
    took[2] = 1e6 * best;
    best = 1e9;
    for (int n = 0; n < 10; n++) {
        const double begin = seconds();
        for (int i = 0; i < CALLS; i++) ehd_law(5e-6 + 1e-11 * i, 1e-4, u, T, 0.0, &force);
        const double each = (seconds() - begin) / CALLS;
        best = each < best ? each : best;
    }
    took[3] = 1e6 * best;
    printf("%.3f %.3f %.2f %.4f\n", took[0], took[1], took[2], took[3]);
    return 0;
}
