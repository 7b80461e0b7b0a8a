#include <math.h>
#include <stdlib.h>

#include "bearing_slot.h"
#include "ehd.h"
#include "film_history.h"

enum { FILMS = EHD_ROLLERS * EHD_SLICES };

/* A bearing; the law, or films and their history, come with the first call that needs them. */
typedef struct slot {
    int used, number;
    double clearance;
    ehd_bearing bearing;
    ehd_prepared *law;
    ehd_film *film;
    film_history history;
} slot;

static slot slots[SLOT_MOST];

static slot *find(int number);
static slot *slot_of(int number, double clearance, int *status);

/* Tilts of an axis, and the spin about it: a ring that is tilted by ty and tz has its axis along (1, tz, -ty), to the
 * second order of the tilt. */
static double spin_of(const double axis[3], const double turning[3], double across[2])
{
    double length;

    across[0] = axis[1] / axis[0];
    across[1] = axis[2] / axis[0];
    length = sqrt(1.0 + across[0] * across[0] + across[1] * across[1]);
    return (turning[0] + turning[1] * across[0] + turning[2] * across[1]) / length;
}

static void pose_of(const double place[3], const double across[2], double pose[6])
{
    int i;

    for (i = 0; i < 3; ++i)
        pose[i] = place[i];
    pose[3] = 0.0;
    pose[4] = -across[1];
    pose[5] = across[0];
}

int bearing_slot(int number, const double axis[3], const double place[3], const double speed[3],
                 const double turning[3], double cage_angle, double T, double clearance, double force[6])
{
    double across[2], pose[6], rate[6];
    const double spin = spin_of(axis, turning, across);
    ehd_bearing_force found;
    int i, status = 0;
    slot *own = slot_of(number, clearance, &status);

    for (i = 0; i < 6; ++i)
        force[i] = NAN;
    if (own == 0)
        return status;
    if (own->law == 0)
        own->law = calloc(1, sizeof *own->law);
    if (own->law == 0)
        return SLOT_FULL;
    /* The axis moves with turning x axis: of a ring that spins the tilt changes by more than the turning across. */
    pose_of(place, across, pose);
    for (i = 0; i < 3; ++i)
        rate[i] = speed[i];
    rate[3] = 0.0;
    rate[4] = turning[1] - turning[0] * across[0];
    rate[5] = turning[2] - turning[0] * across[1];
    status = ehd_bearing_call(&own->bearing, own->law, pose, rate, cage_angle, EHD_ENTRAINMENT * fabs(spin), T, 0.0,
                              &found);
    for (i = 0; i < 6; ++i)
        force[i] = found.force[i];
    return status;
}

/* Force of an instant with films that are there. */
static int force_at(const slot *own, const double pose[6], double cage_angle, const ehd_film_state films[],
                    ehd_bearing_force *found)
{
    static ehd_film_rates rates[FILMS];
    static double states[FILMS];
    int i;

    for (i = 0; i < FILMS; ++i)
        states[i] = films[i].approach;
    return ehd_bearing_rates(&own->bearing, own->film, pose, cage_angle, states, rates, found);
}

int bearing_slot_memory(int number, const double axis[3], const double place[3], const double turning[3],
                        double cage_angle, double T, double clearance, double time, double force[6])
{
    double across[2], pose[6], step, last_step;
    const double spin = spin_of(axis, turning, across);
    const ehd_film_state *before;
    ehd_film_state *after;
    ehd_bearing_force found;
    int i, kind, status = 0;
    slot *own = slot_of(number, clearance, &status);

    for (i = 0; i < 6; ++i)
        force[i] = NAN;
    if (own == 0)
        return status;
    if (own->film == 0) {
        own->film = calloc(1, sizeof *own->film);
        if (own->film == 0 || !film_history_make(&own->history, FILMS))
            return SLOT_FULL;
    }
    pose_of(place, across, pose);
    status = ehd_film_at(own->film, EHD_ENTRAINMENT * fabs(spin), T);
    if (EHD_REFUSES(status))
        return status;
    kind = film_history_call(&own->history, time, &before, &step, &last_step, &after);
    if (kind == FILMS_STEP)
        status |= ehd_bearing_advance(&own->bearing, own->film, step, last_step, pose, cage_angle, before, after,
                                      &found);
    else {
        if (kind == FILMS_SETTLE)
            status |= ehd_bearing_settled(&own->bearing, own->film, pose, cage_angle, after);
        if (!EHD_REFUSES(status))
            status |= force_at(own, pose, cage_angle, kind == FILMS_SETTLE ? after : before, &found);
    }
    if (EHD_REFUSES(status))
        return status;
    film_history_keep(&own->history, time, kind);
    for (i = 0; i < 6; ++i)
        force[i] = found.force[i];
    return status;
}

const char *bearing_slot_text(int status)
{
    return status == SLOT_FULL ? "more bearings than there are slots, or no room for one" : ehd_status_text(status);
}

/* The slot of an element, or the first free one; null where all are taken. */
static slot *find(int number)
{
    int i = 0;

    while (i < SLOT_MOST && slots[i].used && slots[i].number != number)
        ++i;
    return i < SLOT_MOST ? &slots[i] : 0;
}

static slot *slot_of(int number, double clearance, int *status)
{
    slot *own = find(number);

    if (own == 0) {
        *status = SLOT_FULL;
        return 0;
    }
    if (!own->used || own->clearance != clearance) {
        *status = ehd_bearing_make(&own->bearing, clearance, EHD_SLICES, 0);
        if (EHD_REFUSES(*status))
            return 0;
        own->used = 1;
        own->history.asked = own->history.gone = 0; /* films of another clearance */
        own->number = number;
        own->clearance = clearance;
    }
    return own;
}
