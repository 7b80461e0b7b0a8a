#include <stdlib.h>

#include "film_history.h"

int film_history_make(film_history *of, int count)
{
    free(of->at_begin);
    of->asked = of->gone = 0;
    of->step_before = of->last_step = 0.0;
    of->count = count;
    of->at_begin = calloc(3 * (size_t)count, sizeof *of->at_begin);
    of->at_last = of->at_begin ? of->at_begin + count : 0;
    of->work = of->at_begin ? of->at_last + count : 0;
    return of->at_begin != 0;
}

int film_history_call(film_history *of, double time, const ehd_film_state **before, double *step,
                      double *last_step, ehd_film_state **after)
{
    const int onward = of->asked && time > of->last;
    int i;

    *step = *last_step = 0.0;
    *before = 0;
    *after = of->work;
    if (!of->asked || (!of->gone && !onward) || (of->gone && time < of->begin))
        return FILMS_SETTLE;
    *step = time - (onward ? of->last : of->begin);
    *last_step = onward ? of->last_step : of->step_before;
    *before = of->at_begin;
    if (onward) { /* what was found last is what the solver has accepted */
        for (i = 0; i < of->count; ++i)
            of->at_begin[i] = of->at_last[i];
        of->begin = of->last;
        of->step_before = of->last_step;
        of->gone = 1;
    }
    return *step > 0.0 ? FILMS_STEP : FILMS_STAY;
}

void film_history_keep(film_history *of, double time, int kind)
{
    int i;

    if (kind == FILMS_SETTLE)
        of->gone = 0;
    for (i = 0; i < of->count; ++i)
        of->at_last[i] = kind == FILMS_STAY ? of->at_begin[i] : of->work[i];
    of->last_step = kind == FILMS_STEP ? time - of->begin : kind == FILMS_STAY ? of->step_before : 0.0;
    of->last = time;
    of->asked = 1;
}
