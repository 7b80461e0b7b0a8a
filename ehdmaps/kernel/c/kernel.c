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
#include "law/law.h"
#include "law/law_many.h"
#include "law/film_lines.h"
#include "law/rough.h"
#include "film/film.h"
#include "cylinder/cylinder_law.h"
#include "cylinder/cylinder.h"
#include "cylinder/cylinder_films.h"
#include "run/block.h"
#include "run/deviations.h"
#include "run/rings.h"
#include "cylinder/cylinder_block.h"

/* law */
#include "status.c"
#include "law/law.c"
#include "law/cells.c"
#include "law/law_block.c"
#include "law/law_many.c"
EHD_SIZE_OF(ehd_law_data)
EHD_SIZE_OF(ehd_law_errand)

size_t ehd_law_point_head_size(void);
size_t ehd_law_point_head_size(void) { return sizeof(ehd_law_point); }

/* films that tables of laws are made from */
#include "law/film_lines.c"
#include "law/rough.c"
EHD_SIZE_OF(ehd_rough_data)

/* films with memory */
#include "film/film.c"
#include "film/film_energy.c"
#include "film/film_fit.c"
#include "film/film_arrays.c"
#include "film/film_slices.c"
EHD_SIZE_OF(ehd_film_data)

/* pairs of rolling bodies */
#include "pair/pair_law.h"
#include "pair/pair_law.c"
#include "pair/pair_speeds.c"
#include "pair/pair_memory.c"

/* cylindrical rollers */
#include "cylinder/cylinder_law.c"
#include "cylinder/cylinder.c"
#include "cylinder/cylinder_films.c"
#include "cylinder/cylinder_coupled.c"
#include "cylinder/cylinder_call.c"

/* balls */
#include "ball/ball.h"
#include "ball/ball_balance.c"
#include "ball/ball_bearing.c"

/* tapered rollers */
#include "taper/taper.h"
#include "taper/taper_lines.c"
#include "taper/taper_balance.c"
#include "taper/taper_bearing.c"
#include "taper/taper_films.c"
EHD_SIZE_OF(ehd_taper_data)
EHD_SIZE_OF(ehd_taper_roller)
EHD_SIZE_OF(ehd_taper_answer)
EHD_SIZE_OF(ehd_pair_springs)

/* runs in time: elements, gears, matrices */
#include "run/deviations.c"
#include "run/rings.c"
#include "cylinder/cylinder_block.c"
#include "film/film_block.c"
#include "pair/pair_films.c"
#include "pair/pair_port.c"
#include "ball/ball_block.c"
#include "taper/taper_block.c"
#include "dense.c"
#include "run/gear.c"
#include "run/matrix.c"
#include "run/advance.c"

/* State of the C files that this library was made of, as `ehdmaps.kernel.building` looks for it in the file. */
const char *ehd_interface(void);
const char *ehd_interface(void) { return "ehdmaps kernel <" EHD_TEXT(EHD_NUMBER) ">"; }
