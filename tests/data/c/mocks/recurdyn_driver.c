/* Plays RecurDyn: six parameters, penetration and velocity in, force out. */
#include <stdio.h>

void contact_force(double time, double upar[], int npar, double pen, double rvel[], int jflag, int iflag,
                   double *result);

int main(void)
{
    double given[10], result[6], more[3]; /* number, kick, step */
    int i;

    for (i = 0; i < 10; ++i)
        if (scanf("%lf", &given[i]) != 1)
            return 2;
    if (scanf("%lf %lf %lf", &more[0], &more[1], &more[2]) == 3) { /* with memory: a rest, two steps after a kick */
        const double rest = given[6];

        given[6] = more[0];
        contact_force(0.0, given, 7, rest, given + 7, 0, 0, result);
        contact_force(more[2], given, 7, rest + more[1], given + 7, 0, 0, result);
        contact_force(more[2], given, 7, rest + 2.0 * more[1], given + 7, 1, 0, result); /* for the Jacobian */
        contact_force(2.0 * more[2], given, 7, rest + more[1], given + 7, 0, 0, result);
    } else
        contact_force(0.0, given, 6, given[6], given + 7, 0, 0, result);
    for (i = 0; i < 6; ++i)
        printf("%.17g\n", result[i]);
    return 0;
}
