/* ---------------------------------------------------------------------------------------------------------------------
 * What every part needs: headers of the standard library, what a call answers, and small functions of numbers.
 *
 * All quantities are in SI units. Python fills structs and arrays with `double` and `int64_t` alone. Nothing here
 * allocates, keeps a state of its own, reads or writes a file: all functions may be called from several threads at once,
 * each with data of its own.
 * ------------------------------------------------------------------------------------------------------------------ */
#ifndef EHD_NUMBERS_H
#define EHD_NUMBERS_H

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Functions that are part of the loops that call them. */
#if defined(__GNUC__)
#define EHD_INLINE static inline __attribute__((always_inline))
#else
#define EHD_INLINE static inline
#endif

/* The public function NAME_size, by which Python compares its struct with this one. */
#define EHD_SIZE_OF(NAME)                                                                                              \
    size_t NAME##_size(void);                                                                                          \
    size_t NAME##_size(void) { return sizeof(NAME); }

static inline double least(double a, double b) { return a < b ? a : b; }

static inline double most(double a, double b) { return a > b ? a : b; }

static inline int is_finite(double x) { return fabs(x) <= DBL_MAX; }

#endif
