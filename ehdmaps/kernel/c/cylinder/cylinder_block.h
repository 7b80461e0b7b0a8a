/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings with cylindrical rollers in runs, whose films follow at once, or which are dry: they read tables of their law
 * over the speed
 *
 * Between two nodes the table in use is the straight blend of both, in ln of the speed, cell by cell. Tables have the same
 * cells in z = (approach - centre)/scale, so that the blend of laws that rise with the approach rises too, and is C1. A
 * faded film has one table, and its weight is the part of the film that is there.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Tables of a law at nodes over the speed, and the table in use. */
typedef struct ehd_course_law {
    ehd_cylinder_law law;           /* the one in use */
    int64_t slots, rows;            /* nodes that are held in turns; rows of a table, 0 where there are none */
    const double *numbers, *tables; /* (slots + 1, 15), (slots + 1, rows, 8): the last one is of a faded film */
    double *in_use;                 /* (2): node and weight */
} ehd_course_law;

/* The bearings of a block. */
typedef struct ehd_cylinder_block {
    ehd_rings rings;
    ehd_film_course course;
    ehd_course_law *laws;           /* one for each film */
    const double *profiles;         /* (count, most_slices): profiles of one contact, or of both in series [m] */
    const int64_t *strict;          /* (count): whether a law refuses loads above its map */
    double *states;                 /* (count, sides, room): slices of each bearing at the last answer, see ehd_cylinder_work;
                                     * of rollers that are bodies those of one contact after the other */
    int64_t room;                   /* numbers of one side */
    double *place;                  /* work space of the slices of a roller, and one more */
    uint64_t *row;
} ehd_cylinder_block;

/* Bring the table in use to a place between two nodes. */
void ehd_course_law_blend(ehd_course_law *law, int64_t node, double weight);
