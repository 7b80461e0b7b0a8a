/* ---------------------------------------------------------------------------------------------------------------------
 * GFORCE of Adams Solver: force and moment of a cylindrical roller bearing with films.
 *
 *   GFORCE/id, I = inner marker, JFLOAT = floating marker, RM = outer marker,
 *   , FUNCTION = USER(inner, outer, temperature, clearance, metres, cage, memory)\, ROUTINE = bearing:Gfosub
 *
 *   inner, outer   numbers of the markers at the centres of both rings; the z axis of both is the axis of the bearing
 *                  (Adams turns joints about z). The outer marker stands or moves with the housing; it does not spin.
 *                  The bearing's y is x of the outer marker, its z is y of the outer marker: there rollers are counted.
 *   temperature    of the raceways [K]
 *   clearance      diametral [length of the model]
 *   metres         of one length of the model, such as 0.001 for millimetres; forces are in newtons, time in seconds
 *   cage           number of a VARIABLE that holds the angle of the first roller [rad]: turns of the inner ring times
 *                  EHD_CAGE_INNER of ehd.h, plus turns of the outer one times EHD_CAGE_OUTER; 0: the cage stands
 *   memory         1: films have a memory, and go on with the steps of Adams (film_history.h); 0 or left out: they follow
 *                  at once, with stiffness and damping of slow motion
 *
 * The film takes the speed of the inner marker against the outer one about z. Beyond the range of the map the run is
 * stopped with a message, also where only a trial of the solver is there. Exported with --outside clamp or asymptote the
 * law goes on, and the first time that an element leaves the map in a way is told as a warning. Partial derivatives are
 * left to Adams. Adams calls this from one thread, since it does not declare itself safe for several.
 *
 * Signatures after the documentation of Adams Solver (GFOSUB, SYSARY, SYSFNC, ERRMES, USRMES); no Adams has run this.
 * ------------------------------------------------------------------------------------------------------------------ */
#include <math.h>

#include "bearing_slot.h"
#include "ehd.h"
#include "slv_c_utils.h"

enum { LEAST = 6, MOST = 7 };

adams_c_Gfosub Gfosub;

static void ask(const char *what, int *ids, int count, double *values, int id);

void Gfosub(const struct sAdamsGforce *gforce, double time, int dflag, int iflag, double *result)
{
    static const char STOP[] = "STOP";
    double place[3], angles[3], speed[3], turning[3];
    double axis[3], centre[3], velocity[3], omega[3], force[6], cage = 0.0, metres;
    int ids[4], i, status, failed = 0;

    for (i = 0; i < 6; ++i)
        result[i] = 0.0;
    if (gforce->NPAR < LEAST || gforce->NPAR > MOST) {
        c_errmes(1, "bearing: USER() takes inner, outer, temperature, clearance, metres, cage, memory", gforce->ID, STOP);
        return;
    }
    metres = gforce->PAR[4];
    ids[0] = (int)gforce->PAR[0];
    ids[1] = ids[2] = ids[3] = (int)gforce->PAR[1];
    ask("TDISP", ids, 3, place, gforce->ID);
    ask("RDISP", ids, 2, angles, gforce->ID);
    ask("TVEL", ids, 4, speed, gforce->ID);
    ask("RVEL", ids, 3, turning, gforce->ID);
    if ((int)gforce->PAR[5] > 0) {
        ids[0] = (int)gforce->PAR[5];
        c_sysfnc("VARVAL", ids, 1, &cage, &failed);
        c_errmes(failed, "bearing: the angle of the cage cannot be read", gforce->ID, STOP);
    }
    if (iflag)
        return; /* Adams notes what the force depends on */
    /* Angles are those of turns about z, x and z again; the axis is z. Bearing x, y, z are z, x, y of the markers. */
    axis[0] = cos(angles[1]);
    axis[1] = sin(angles[0]) * sin(angles[1]);
    axis[2] = -cos(angles[0]) * sin(angles[1]);
    for (i = 0; i < 3; ++i) {
        centre[i] = metres * place[(i + 2) % 3];
        velocity[i] = metres * speed[(i + 2) % 3];
        omega[i] = turning[(i + 2) % 3];
    }
    if (gforce->NPAR == MOST && gforce->PAR[6] != 0.0) /* dflag: Adams changes a pose for a partial derivative */
        status = bearing_slot_memory(gforce->ID, axis, centre, omega, cage, gforce->PAR[2], metres * gforce->PAR[3],
                                     time, dflag, force);
    else
        status = bearing_slot(gforce->ID, axis, centre, velocity, omega, cage, gforce->PAR[2],
                              metres * gforce->PAR[3], force);
    if (status == SLOT_FULL || EHD_REFUSES(status)) {
        c_errmes(1, bearing_slot_text(status), gforce->ID, STOP);
        return;
    }
    status = bearing_slot_news(gforce->ID, status);
    if (status)
        c_usrmes(1, bearing_slot_text(status), gforce->ID, "WARN");
    for (i = 0; i < 3; ++i) {
        result[i] = force[(i + 1) % 3];
        result[3 + i] = force[3 + (i + 1) % 3] / metres;
    }
}

static void ask(const char *what, int *ids, int count, double *values, int id)
{
    int states, failed;

    c_sysary(what, ids, count, values, &states, &failed);
    c_errmes(failed, "bearing: the motion of a marker cannot be read", id, "STOP");
}
