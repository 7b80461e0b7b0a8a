/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings with cylindrical rollers in a run: what does not change of them, and the steps that are prepared
 *
 * A contact of a roller has one side, where both contacts in series stand for a massless roller, or two, the inner and the
 * outer one of a roller that is a body. All bearings of a block have as many. Rings that cannot tilt against each other
 * feel y and z alone, and slices of the same depth are looked at once, with a weight.
 *
 * With massless rollers a bearing feels y, z, theta_y, theta_z of the inner ring against the outer one; else y, z of the
 * inner ring, y, z of the outer one, theta_y, theta_z of the inner one against the outer one, and the radial place of each
 * roller.
 * ------------------------------------------------------------------------------------------------------------------ */
#ifndef EHD_RINGS_H
#define EHD_RINGS_H

#include "block.h"
#include "deviations.h"

/* Bearings, one row a bearing; rows of slices and rollers are as long as the longest. */
typedef struct ehd_rings {
    int64_t count, sides;
    int64_t most_rollers, most_slices; /* lengths of the rows */
    const int64_t *firsts, *places;    /* (count): first of what each feels; its place among all elements */
    const int64_t *films_of;           /* (count, sides): film of each contact */
    const int64_t *rollers, *slices;   /* (count) */
    const int64_t *felt, *alone;       /* (count): displacements of rings that each feels; place of its first roller */
    const double *start_angles, *cage_rates; /* (count): angle of the first roller [rad]; cage angle by the system's */
    const double *sizes;               /* (count, 6): half the clearance, length of a slice, most travel [m], most tilt [rad],
                                        * half the length of a roller, least profile [m] */
    const double *positions, *profiles, *weights; /* (count, most_slices): places [m]; profiles of both contacts [m]; how
                                        * many slices each stands for */
    const double *cosine, *sine;       /* (count, most_rollers): directions of the rollers in the cage */
    const double *row_places;          /* (count, most_rollers): place of the row of each roller along x [m] */
    const double *outward;             /* (count): centrifugal force of a roller that is a body by speed^2 [N s2/rad2] */
    const ehd_deviations *deviations;  /* (count): from its form; null where no bearing has any */
} ehd_rings;

/* Places of steps on tables of films over the speed: node and weight of the next one, whether speed or temperature lie
 * outside the map, and for how many steps what was read holds. */
typedef struct ehd_film_course {
    int64_t films;
    const int64_t *nodes, *outside; /* (steps, films) */
    const double *weights;          /* (steps, films) */
    const int64_t *kept;            /* (steps) */
} ehd_film_course;

#endif
