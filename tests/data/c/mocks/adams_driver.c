/* Plays Adams Solver: motion of the markers from a file of numbers, force or message out. */
#include <stdio.h>
#include <string.h>

#include "slv_c_utils.h"

adams_c_Gfosub Gfosub;

static double place[3], angles[3], speed[3], turning[3], cage;
static int stopped;

void c_sysary(const char *function, const int *ids, int count, double *values, int *states, int *failed)
{
    const double *from = !strcmp(function, "TDISP")   ? place
                         : !strcmp(function, "RDISP") ? angles
                         : !strcmp(function, "TVEL")  ? speed
                                                      : turning;
    const int wanted = from == place ? 3 : from == angles ? 2 : from == speed ? 4 : 3;

    *failed = count != wanted || ids[0] != 11 || ids[1] != 12;
    *states = 3;
    memcpy(values, from, 3 * sizeof(double));
}

void c_sysfnc(const char *function, const int *ids, int count, double *value, int *failed)
{
    *failed = strcmp(function, "VARVAL") || count != 1 || ids[0] != 7;
    *value = cage;
}

void c_errmes(int failed, const char *message, int id, const char *stop)
{
    if (failed && !strcmp(stop, "STOP")) {
        printf("stopped %d %s\n", id, message);
        stopped = 1;
    }
}

void c_usrmes(int wanted, const char *message, int id, const char *kind)
{
    if (wanted)
        fprintf(stderr, "%s %d %s\n", kind, id, message);
}

int main(void)
{
    double par[7] = {11.0, 12.0, 0.0, 0.0, 1e-3, 7.0, 0.0}, result[6], kick, step;
    struct sAdamsGforce gforce = {3, 6, 0, 11, 12, 13};
    double *all[4] = {place, angles, speed, turning};
    int i, k;

    gforce.PAR = par;
    for (k = 0; k < 4; ++k)
        for (i = 0; i < 3; ++i)
            if (scanf("%lf", &all[k][i]) != 1)
                return 2;
    if (scanf("%lf %lf %lf", &cage, &par[2], &par[3]) != 3)
        return 2;
    if (scanf("%lf %lf %lf", &par[6], &kick, &step) == 3) { /* with memory: a rest, and two steps after a kick along x */
        gforce.NPAR = 7;
        Gfosub(&gforce, 0.0, 0, 0, result);
        place[0] += kick;
        Gfosub(&gforce, 3.0 * step, 0, 0, result); /* a step that the solver gives up */
        Gfosub(&gforce, step, 0, 0, result);
        place[0] += kick;
        Gfosub(&gforce, step, 1, 0, result); /* for a partial derivative */
        place[0] -= kick;
        Gfosub(&gforce, 2.0 * step, 0, 0, result);
        for (i = 0; i < 6; ++i)
            printf("%.17g\n", result[i]);
        return 0;
    }
    Gfosub(&gforce, 0.0, 0, 1, result);
    Gfosub(&gforce, 0.0, 0, 0, result);
    if (!stopped)
        Gfosub(&gforce, 0.0, 0, 0, result); /* again, as solvers do */
    if (!stopped)
        for (i = 0; i < 6; ++i)
            printf("%.17g\n", result[i]);
    return 0;
}
