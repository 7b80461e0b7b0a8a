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

/* law */

/* films with memory */

/* pairs of rolling bodies */

/* cylindrical rollers */

/* balls */

/* tapered rollers */

/* runs in time: elements, gears, matrices */

/* State of the C files that this library was made of, as `ehdmaps.kernel.building` looks for it in the file. */
const char *ehd_interface(void);
const char *ehd_interface(void) { return "ehdmaps kernel <" EHD_TEXT(EHD_NUMBER) ">"; }
