/* ---------------------------------------------------------------------------------------------------------------------
 * The unit that is compiled: all parts in their order, so that one may be inlined in another.
 *
 * EHD_NUMBER is the hash of the C files, given by the compiler's command line (`ehdmaps.kernel.building`).
 * ------------------------------------------------------------------------------------------------------------------ */
#ifndef EHD_NUMBER
#define EHD_NUMBER none
#endif
#define EHD_TEXT_OF(NAME) #NAME
#define EHD_TEXT(NAME) EHD_TEXT_OF(NAME)

#include "numbers.h"
#include "elementary.h"
#include "status.h"
#include "law.h"
#include "law_many.h"
#include "film_lines.h"
#include "rough.h"
#include "film.h"
#include "cylinder_law.h"
#include "cylinder.h"
#include "cylinder_films.h"
#include "block.h"
#include "rings.h"
#include "cylinder_block.h"

/* law */
#include "status.c"
#include "law.c"
#include "cells.c"
#include "law_many.c"
EHD_SIZE_OF(ehd_law_data)

size_t ehd_law_point_head_size(void);
size_t ehd_law_point_head_size(void) { return sizeof(ehd_law_point); }

/* films that tables of laws are made from */
#include "film_lines.c"
#include "rough.c"
EHD_SIZE_OF(ehd_rough_data)

/* films with memory */
#include "film.c"
#include "film_energy.c"
#include "film_fit.c"
#include "film_arrays.c"
#include "film_slices.c"
EHD_SIZE_OF(ehd_film_data)

/* pairs of rolling bodies */
#include "pair_law.h"
#include "pair_law.c"
#include "pair_speeds.c"
#include "pair_memory.c"

/* cylindrical rollers */
#include "cylinder_law.c"
#include "cylinder.c"
#include "cylinder_films.c"
#include "cylinder_coupled.c"
#include "cylinder_call.c"

/* balls */
#include "ball.h"
#include "ball_balance.c"
#include "ball_bearing.c"
#include "ball_films.c"

/* tapered rollers */
#include "taper.h"
#include "taper_lines.c"
#include "taper_balance.c"
#include "taper_bearing.c"
#include "taper_films.c"
EHD_SIZE_OF(ehd_taper_data)
EHD_SIZE_OF(ehd_taper_roller)
EHD_SIZE_OF(ehd_taper_answer)
EHD_SIZE_OF(ehd_taper_springs)

/* runs in time: elements, gears, matrices */
#include "rings.c"
#include "cylinder_block.c"
#include "film_block.c"
#include "pair_films.c"
#include "pair_port.c"
#include "ball_block.c"
#include "taper_block.c"
#include "dense.c"
#include "gear.c"
#include "matrix.c"
#include "advance.c"

/* State of the C files that this library was made of, as `ehdmaps.kernel.building` looks for it in the file. */
const char *ehd_interface(void);
const char *ehd_interface(void) { return "ehdmaps kernel <" EHD_TEXT(EHD_NUMBER) ">"; }
