/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory in a program that asks for forces only: which of its calls are steps in time.
 *
 * A solver asks several times at one time, tries a step and takes it back, and asks with poses that it has changed a
 * little. Kept are the films at the begin of a step and those of the last call. A call at a later time than the last one
 * begins a new step there; a call at the same time, or at an earlier one within the step, repeats the step. Calls before
 * that, and all calls before time goes on for the first time, find films in equilibrium.
 *
 * The last call at a time counts: it should be within the tolerance of the solver of what it accepts.
 *
 * A step is one of ehd_film_advance, so that the solver's step decides: damping at the frequency f is wrong by some
 * (2 pi f step)^2/3.
 * ------------------------------------------------------------------------------------------------------------------ */
#ifndef FILM_HISTORY_H
#define FILM_HISTORY_H

#include "ehd.h"

typedef struct film_history {
    int count;                                 /* of films */
    int asked, gone;                           /* whether there was a call, and whether time has gone on since */
    double begin, last;                        /* times of the kept films [s] */
    double step_before, last_step;             /* lengths of the steps that led there, 0 after a rest [s] */
    ehd_film_state *at_begin, *at_last, *work; /* films */
} film_history;

/* What a call is: from films in equilibrium, from films that are there, or a step. */
enum { FILMS_SETTLE, FILMS_STAY, FILMS_STEP };

/* Room for some films; 0 where there is none. */
int film_history_make(film_history *of, int count);

/* What a call at a time [s] is. `before` are the films at its begin, `step` and `last_step` [s] are for
 * ehd_film_advance; `after` is where the caller puts the films that it finds. */
int film_history_call(film_history *of, double time, const ehd_film_state **before, double *step,
                      double *last_step, ehd_film_state **after);

/* Keep what was put there. */
void film_history_keep(film_history *of, double time, int kind);

#endif /* FILM_HISTORY_H */
