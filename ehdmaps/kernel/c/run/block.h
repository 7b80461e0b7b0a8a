/* ---------------------------------------------------------------------------------------------------------------------
 * Blocks: what a kind of elements brings to a run in time
 *
 * A run (advance.c) puts all elements of a kind into one block: a row of function pointers and the data that they take.
 * Nothing else is known of elements there, so that any function of these types is one: of a kind in this library, or of
 * anyone's own, from C or from elsewhere.
 *
 * Elements feel m displacements; motion (2, m) has them, and their rates. Elements with many coordinates of their own
 * that nothing else touches have those first.
 *
 * answer   writes the forces of all elements of the block, and slopes = by_q K + by_v C, K = -d force/d motion,
 *          C = -d force/d rate; slopes only between what one element feels: all else of it stays zero. It may count an
 *          element that is outside its map. It may be asked many times for one step.
 * accept   tells elements with states of their own that the step of the last answer is made; NULL: no element has any.
 * powers   writes the numbers of mbs.model.elements.Powers of each element [W, W, J], for the last answer, when a step
 *          is made, after accept: a row of out (elements, 3) that is its place; NULL: elements do not say.
 * data     first argument of all three.
 *
 * Nothing of a run allocates. Several runs may be made at once by several threads, each with data of its own.
 * ------------------------------------------------------------------------------------------------------------------ */

#ifndef EHD_BLOCK_H
#define EHD_BLOCK_H

#include "../numbers.h"

/* How an answer, and a run, ended. */
enum {
    EHD_FOUND = 0,       /* all is written; all steps are made */
    EHD_NO_SOLUTION = 1, /* there is no answer to such a motion, so that the step is halved */
    EHD_IN_PYTHON = 2,   /* compiled code has no answer: the step is made in Python */
    EHD_TOO_LARGE = 3,   /* of runs: the error of the step is above the tolerance */
    EHD_STOPPED = 4      /* a Python function raised */
};

/* When elements are asked: index among the steps that were prepared; time [s], speed [rad/s] and angle [rad] at the end
 * of the step; weights of the slopes [s2], [s]. */
typedef struct ehd_moment {
    int64_t step;
    double time, speed, angle, by_q, by_v;
} ehd_moment;

/* Answers of all elements, each in its own places: force (m,) [N or N m], slopes (m, m), and outside (elements,), which
 * is counted up for an element outside its map. */
typedef struct ehd_answers {
    double *force, *slopes;
    int64_t *outside;
    int64_t m;
} ehd_answers;

typedef int ehd_answer_function(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers);
typedef void ehd_accept_function(void *data, const ehd_moment *at);
typedef void ehd_powers_function(void *data, const ehd_moment *at, const double *motion, const ehd_answers *answers,
                                 double *out);

typedef struct ehd_block {
    ehd_answer_function *answer;
    ehd_accept_function *accept;
    ehd_powers_function *powers;
    void *data;
} ehd_block;

#endif
