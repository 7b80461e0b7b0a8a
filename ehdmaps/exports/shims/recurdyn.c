/* ---------------------------------------------------------------------------------------------------------------------
 * Contact force of RecurDyn: one contact line with its film, the law alone.
 *
 *   upar[0]   entrainment speed [m/s]
 *   upar[1]   temperature of the surfaces [K]
 *   upar[2]   length of the contact [m]
 *   upar[3]   metres of one length of the model, such as 0.001; forces are in newtons, time in seconds
 *   upar[4]   axis of the contact frame along which the force pushes the bodies apart: 1, 2 or 3, negative against it.
 *             A public sample of this routine has 3: there a positive result[2] pushes apart, and a positive rvel[2]
 *             parts the bodies. The documentation says no more than "contact reference frame": look at a contact at rest
 *             first.
 *   upar[5]   penetration at which the dry bodies would just touch [length of the model]. A film carries before, so that
 *             the geometries have to be larger by the film, and this is by how much.
 *
 * The penetration is taken without its sign, as the sample does: its sign is not documented. That RecurDyn calls only
 * where the geometries overlap is what this needs, and is not documented either.
 *
 * Beyond the range of the map, where the law refuses, the force is NaN: no call that stops RecurDyn with a message is
 * documented here. Exported with --outside clamp or asymptote the law goes on there, and RecurDyn is told nothing.
 * Signature after the documentation of RecurDyn (CONTACT_FORCE); no RecurDyn has run this.
 * ------------------------------------------------------------------------------------------------------------------ */
#include <math.h>
#include <stdlib.h>

#include "ehd.h"

#ifdef _WIN32
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED
#endif

enum { PARAMETERS = 6 };

EXPORTED void contact_force(double time, double upar[], int npar, double pen, double rvel[], int jflag, int iflag,
                            double *result);

EXPORTED void contact_force(double time, double upar[], int npar, double pen, double rvel[], int jflag, int iflag,
                            double *result)
{
    ehd_force force = {0.0, 0.0, 0.0};
    double sign;
    int i, axis;

    (void)time;
    (void)jflag;
    (void)iflag;
    for (i = 0; i < 6; ++i)
        result[i] = 0.0;
    axis = npar == PARAMETERS ? (int)upar[4] : 0;
    if (abs(axis) < 1 || abs(axis) > 3) {
        result[0] = NAN; /* another number of parameters, or no axis */
        return;
    }
    sign = axis > 0 ? 1.0 : -1.0;
    axis = abs(axis) - 1;
    ehd_law(upar[3] * (fabs(pen) - upar[5]), -upar[3] * sign * rvel[axis], upar[0], upar[1], 0.0, &force);
    result[axis] = sign * upar[2] * force.load;
}
