/* ---------------------------------------------------------------------------------------------------------------------
 * A spring in series with a damper over a step, exact where its end moves evenly
 *
 * Its force f follows the approach of its end, f' = K approach' - f/theta, so that over a step of h
 *
 *     f <- exp(-a) f + K phi (approach - approach before),        a = h/theta, phi = (1 - exp(-a))/a,
 *
 * with K and theta of the beginning of the step. Between two steps K follows the load: where it falls f falls in
 * proportion, where it rises f stays. Both take energy away.
 * ------------------------------------------------------------------------------------------------------------------ */

#define PAIR_SHORT 0.25 /* h/theta below which 1 - exp(-a) is its series, right to 1e-15 */

/* Part of the force that is left at the end of a step, and the spring of the end [N/m]; out (2,). */
EHD_INLINE void pair_over_step(double step, double spring, double time, double *out) {
    const double a = step / time, x = a < PAIR_SHORT ? a : PAIR_SHORT;
    double series = 1.0 - x / 8.0 * (1.0 - x / 9.0 * (1.0 - x / 10.0 * (1.0 - x / 11.0 * (1.0 - x / 12.0))));
    series = 1.0 - x / 4.0 * (1.0 - x / 5.0 * (1.0 - x / 6.0 * (1.0 - x / 7.0 * series)));
    series = 1.0 - x / 2.0 * (1.0 - x / 3.0 * series);
    const double gone = exp(-a);
    const int is_long = a >= PAIR_SHORT;
    const double left = is_long ? gone : 1.0 - a * series, mean = is_long ? (1.0 - gone) / a : series;
    out[0] = spring > 0.0 ? left : 0.0;
    out[1] = spring * mean;
}

/* Force at the end of a step beside the spring there [N]: by the force at its beginning, the part of it that is left, the
 * spring of the step times the way of the approach [N], and the springs before and after [N/m]. */
EHD_INLINE double pair_gone_on(double force, double left, double pushed, double spring, double after) {
    const double found = left * force + pushed;
    return after < spring ? found * after / spring : found;
}

void ehd_pair_over_step(double step, double spring, double time, double *out) { pair_over_step(step, spring, time, out); }

double ehd_pair_gone_on(double force, double left, double pushed, double spring, double after) {
    return pair_gone_on(force, left, pushed, spring, after);
}
