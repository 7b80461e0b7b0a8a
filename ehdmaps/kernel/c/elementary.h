/* ---------------------------------------------------------------------------------------------------------------------
 * Logarithm and exponential without a branch or a call, for loops that compilers put into vector instructions
 *
 * The textbook reductions with Taylor series long enough for double precision. Nothing is contracted to fused operations:
 * all processors give the same numbers.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Versions of a function for several processors, of which the fastest is taken when the program is loaded: in the
 * library, not in what exports write. */
#if defined(EHD_NUMBER) && defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) &&    \
    !defined(__SANITIZE_ADDRESS__) && defined(__OPTIMIZE__)
#define EHD_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define EHD_CLONES
#endif

#define LN2 6.93147180369123816490e-01      /* with the last digits zero, */
#define LN2_REST 1.90821492927058770002e-10 /* and what that leaves */

EHD_INLINE double number_of_bits(uint64_t bits) {
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

EHD_INLINE uint64_t bits_of(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Natural logarithm of a positive normal number, to 3e-16 absolute or relative: that of a mantissa m between the roots of
 * 1/2 and 2 by the one of (1 + f)/(1 - f). */
EHD_INLINE double plain_log(double x) {
    const uint64_t one = UINT64_C(0x3FF0000000000000), root_half = UINT64_C(0x3FE6A09E667F3BCD), bits = bits_of(x);
    const uint64_t exponent = (bits + (one - root_half)) >> 52;
    const double e = number_of_bits(exponent | UINT64_C(0x4330000000000000)) - (4503599627370496.0 + 1023.0);
    const double m = number_of_bits(bits + one - (exponent << 52)), f = (m - 1.0) / (m + 1.0);
    const double z = f * f, z2 = z * z, z4 = z2 * z2;
    const double low = (2.0 / 3.0 + z * (2.0 / 5.0)) + z2 * (2.0 / 7.0 + z * (2.0 / 9.0));
    const double high = (2.0 / 11.0 + z * (2.0 / 13.0)) + z2 * (2.0 / 15.0 + z * (2.0 / 17.0));
    const double series = low + z4 * (high + z4 * (2.0 / 19.0 + z * (2.0 / 21.0)));
    return e * LN2 + (e * LN2_REST + f * (2.0 + z * series));
}

/* e^x for |x| <= 700, to 4e-16 relative. */
EHD_INLINE double plain_exp(double x) {
    const double rounding = 6755399441055744.0; /* 3 2^51: adding it leaves the nearest whole number in the last bits */
    const double shifted = x * 1.4426950408889634 + rounding, n = shifted - rounding;
    const double r = (x - n * LN2) - n * LN2_REST, r2 = r * r, r4 = r2 * r2;
    const double low = (1.0 + r) + r2 * (0.5 + r * (1.0 / 6.0));
    const double middle = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0));
    const double high = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + r2 * (1.0 / 3628800.0 + r * (1.0 / 39916800.0));
    const double last = 1.0 / 479001600.0 + r * (1.0 / 6227020800.0);
    return (low + r4 * (middle + r4 * (high + r4 * last))) * number_of_bits((bits_of(shifted) + 1023) << 52);
}
