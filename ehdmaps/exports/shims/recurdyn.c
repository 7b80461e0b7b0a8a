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
 *   upar[6]   number of this contact among those whose films have a memory, from 1 to 256, another one for each; 0 or left
 *             out: films follow at once. They go on with the steps of RecurDyn (film_history.h); calls with jflag are for
 *             its Jacobian, and leave no trace.
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
#include "film_history.h"

#ifdef _WIN32
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED
#endif

enum { LEAST = 6, MOST = 7, CONTACTS = 256 };

/* A contact whose film has a memory. */
typedef struct contact {
    ehd_film film;
    film_history history;
} contact;

static contact *contacts[CONTACTS];

EXPORTED void contact_force(double time, double upar[], int npar, double pen, double rvel[], int jflag, int iflag,
                            double *result);

/* Load of a contact whose film has a memory; NaN where the law refuses. */
static double load_of(int number, double time, int trial, double approach, double u, double T)
{
    contact *own = 0;
    const ehd_film_state *before;
    ehd_film_state *after;
    ehd_film_rates rates = {0};
    ehd_force force = {0.0, 0.0, 0.0};
    double step, last_step;
    int kind, status;

    if (number < 1 || number > CONTACTS)
        return NAN;
    own = contacts[number - 1];
    if (own == 0) {
        own = calloc(1, sizeof *own);
        if (own == 0 || !film_history_make(&own->history, 1)) {
            free(own);
            return NAN;
        }
        contacts[number - 1] = own;
    }
    status = ehd_film_at(&own->film, u, T);
    kind = film_history_call(&own->history, time, trial, &before, &step, &last_step, &after);
    if (kind == FILMS_STEP)
        status |= ehd_film_advance(&own->film, step, last_step, approach, before, after, &force);
    else {
        if (kind == FILMS_SETTLE)
            status |= ehd_film_settled(&own->film, approach, after);
        status |= ehd_film_rate(&own->film, approach, (kind == FILMS_SETTLE ? after : before)->approach, &rates);
        force.load = rates.load;
    }
    if (EHD_REFUSES(status))
        return NAN;
    if (!trial)
        film_history_keep(&own->history, time, kind);
    return force.load;
}

EXPORTED void contact_force(double time, double upar[], int npar, double pen, double rvel[], int jflag, int iflag,
                            double *result)
{
    ehd_force force = {0.0, 0.0, 0.0};
    double sign, approach;
    int i, axis;

    (void)iflag;
    for (i = 0; i < 6; ++i)
        result[i] = 0.0;
    axis = npar == LEAST || npar == MOST ? (int)upar[4] : 0;
    if (abs(axis) < 1 || abs(axis) > 3) {
        result[0] = NAN; /* another number of parameters, or no axis */
        return;
    }
    sign = axis > 0 ? 1.0 : -1.0;
    axis = abs(axis) - 1;
    approach = upar[3] * (fabs(pen) - upar[5]);
    if (npar == MOST && upar[6] != 0.0)
        force.load = load_of((int)upar[6], time, jflag, approach, upar[0], upar[1]);
    else
        ehd_law(approach, -upar[3] * sign * rvel[axis], upar[0], upar[1], 0.0, &force);
    result[axis] = sign * upar[2] * force.load;
}
