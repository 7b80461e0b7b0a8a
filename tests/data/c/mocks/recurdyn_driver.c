/* Plays RecurDyn: six parameters, penetration and velocity in, force out. */
#include <stdio.h>

void contact_force(double time, double upar[], int npar, double pen, double rvel[], int jflag, int iflag,
                   double *result);

int main(void)
{
    double given[10], result[6];
    int i;

    for (i = 0; i < 10; ++i)
        if (scanf("%lf", &given[i]) != 1)
            return 2;
    contact_force(0.0, given, 6, given[6], given + 7, 0, 0, result);
    for (i = 0; i < 6; ++i)
        printf("%.17g\n", result[i]);
    return 0;
}
