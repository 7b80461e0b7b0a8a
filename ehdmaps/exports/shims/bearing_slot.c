#include <math.h>

#include "bearing_slot.h"
#include "ehd.h"

typedef struct slot {
    int used, number, told;
    double clearance;
    ehd_bearing bearing;
    ehd_prepared law;
} slot;

static slot slots[SLOT_MOST];

static slot *find(int number);
static slot *slot_of(int number, double clearance, int *status);

int bearing_slot(int number, const double axis[3], const double place[3], const double speed[3],
                 const double turning[3], double cage_angle, double T, double clearance, double force[6])
{
    const double across[2] = {axis[1] / axis[0], axis[2] / axis[0]};
    const double length = sqrt(1.0 + across[0] * across[0] + across[1] * across[1]);
    const double spin = (turning[0] + turning[1] * across[0] + turning[2] * across[1]) / length;
    double pose[6], rate[6];
    ehd_bearing_force found;
    int i, status = 0;
    slot *own = slot_of(number, clearance, &status);

    for (i = 0; i < 6; ++i)
        force[i] = NAN;
    if (own == 0)
        return status;
    /* A ring that is tilted by ty and tz has its axis along (1, tz, -ty), to the second order of the tilt. The axis
     * moves with turning x axis: of a ring that spins the tilt changes by more than the turning across. */
    for (i = 0; i < 3; ++i) {
        pose[i] = place[i];
        rate[i] = speed[i];
    }
    pose[3] = rate[3] = 0.0;
    pose[4] = -across[1];
    pose[5] = across[0];
    rate[4] = turning[1] - turning[0] * across[0];
    rate[5] = turning[2] - turning[0] * across[1];
    status = ehd_bearing_call(&own->bearing, &own->law, pose, rate, cage_angle, EHD_ENTRAINMENT * fabs(spin), T, 0.0,
                              &found);
    for (i = 0; i < 6; ++i)
        force[i] = found.force[i];
    return status;
}

int bearing_slot_news(int number, int status)
{
    slot *own = find(number);
    const int news = own ? status & ~own->told : status;

    if (own)
        own->told |= status;
    return news;
}

const char *bearing_slot_text(int status)
{
    return status == SLOT_FULL ? "more bearings than there are slots" : ehd_status_text(status);
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
        own->number = number;
        own->clearance = clearance;
    }
    return own;
}
