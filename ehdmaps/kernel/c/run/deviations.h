/* ---------------------------------------------------------------------------------------------------------------------
 * Deviations of a bearing from its form: waves of rings and rolling elements, spalls, elements of other sizes
 *
 * They bring the bodies of a contact closer, or further apart, and turn with their rings and elements. The approach that
 * they add to the contact of element j with the inner ring, side 0, or with the outer ring, side 1, is
 *
 *     e = size_j + r(p_j - q) + b_j(s + pi) of the inner ring,    e = size_j + r(p_j - q) + b_j(s) of the outer one,
 *
 * p_j the angle of the element, q that of the ring, s that of the element about its own axis in the cage. Each r and b is a
 * table over a turn, cubic between its nodes; those of elements, which are read at one s, stand node by node.
 * ------------------------------------------------------------------------------------------------------------------ */

#ifndef EHD_DEVIATIONS_H
#define EHD_DEVIATIONS_H

/* Deviations of a bearing. */
typedef struct ehd_deviations {
    int64_t elements, nodes;  /* rolling elements, none of a bearing without deviations; nodes of a turn, a power of 2 */
    int64_t rings, owned;     /* tables of rings and of elements */
    double start;             /* angle of the cage where that of the system is zero [rad] */
    double turns[4];          /* angles of cage, inner ring, outer ring, and of elements in the cage, by that of the system */
    const int64_t *tables;    /* (elements, 3): table of the inner ring, of the outer ring, of the element among own; < 0 none */
    const double *places;     /* (elements): angles in the cage, in nodes, from 0 to nodes */
    const double *sizes;      /* (elements): half of what the diameter is larger [m] */
    const double *table;      /* (rings, nodes, 2): value [m], and change by a node, of cubics between the nodes */
    const double *own;        /* (nodes, owned, 2): the same of elements */
    double *added;            /* (elements, 2, 2): approach [m] and its rate [m/s] of both contacts, written */
    double *moment;           /* (2): angle [rad] and speed [rad/s] of the system for which these are */
} ehd_deviations;

/* What deviations add to the contacts, (elements, 2, 2), by angles [rad] and speeds [rad/s] of cage, inner ring, outer ring,
 * and elements in the cage (4,). */
void ehd_deviations_by(const ehd_deviations *of, const double *angles, const double *speeds, double *added);

/* The same at an angle [rad] and speed [rad/s] of the system, (elements, 2, 2); null of a bearing
 * without any. */
const double *ehd_deviations_at(const ehd_deviations *of, double angle, double speed);

#endif
