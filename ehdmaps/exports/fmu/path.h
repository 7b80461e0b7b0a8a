/* Path of a ring over a step of co-simulation, for films with memory, and the steps that the unit takes on it. */
#ifndef PATH_H
#define PATH_H

#include <math.h>

#define LONGEST_STEP 5e-6 /* of films in co-simulation [s]: damping at 3 kHz is right within half a per cent */
#define MOST_FILM_STEPS 400

/* Steps of a unit in one of co-simulation [s]; rounding makes no further one. */
static int film_steps(double step) {
    const double wanted = ceil(step / LONGEST_STEP * (1.0 - 1e-9));
    return wanted < MOST_FILM_STEPS ? (int)wanted : MOST_FILM_STEPS;
}

/* Place of the ring along a direction at a part of a step, from begin to end: cubic by the velocities at both, straight
 * where these are not the rates of this motion, or not given. Their mean differs from that of a motion at f by
 * (2 pi f step)^2/12. */
static double place_between(double begin, double end, double velocity, double velocity_at_end, double part, double step) {
    const double change = end - begin, first = step * velocity, last = step * velocity_at_end;
    const double largest = fmax(fabs(change), fmax(fabs(first), fabs(last)));
    const double bend = (1.0 - part) * (first - change) - part * (last - change);
    const int fits = fabs(0.5 * (first + last) - change) <= 0.5 * largest;
    return begin + part * (change + (fits ? (1.0 - part) * bend : 0.0));
}

#endif
