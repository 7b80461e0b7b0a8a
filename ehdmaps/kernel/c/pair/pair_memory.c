/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory of contacts: springs in series with dampers beside the law of rest
 *
 * Beside the load p(approach) at rest act springs K_r in series with dampers, whose forces f_r are the states:
 *
 *     f_r' = K_r approach' - f_r/theta_r,    load = p + f where f = sum f_r >= 0, else f + sqrt(f^2 + p^2).
 *
 * The sum of the K_r theta_r is the damping of slow motion. Over a step of h in which the approach goes evenly each force
 * is exact,
 *
 *     f <- exp(-a) f + K phi (approach - approach before),        a = h/theta, phi = (1 - exp(-a))/a,
 *
 * with K and theta of the beginning of the step, so that p gets a constant force and a spring, see pair_law.c, and a
 * balance stays that of a convex potential. Between two steps K follows the load: where it falls f falls in proportion,
 * where it rises f stays. Both take energy away.
 *
 * K and theta are read from tables over the approach with the rows of the laws, straight between them; beyond the ends
 * K stays, and theta follows the damping.
 * ------------------------------------------------------------------------------------------------------------------ */

#define PAIR_SHORTEST 1e-30 /* shortest theta [s]: below any step */
#define PAIR_MOST_SPRINGS 3

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

/* What a line of n contacts holds over a step; as below, with a number of springs that compilers know. */
EHD_INLINE void pair_hold_line(int64_t n, int64_t springs, const double *shorter, double step, double *memory) {
    double *pull = memory + EHD_PAIR_PULL * n, *spring = memory + EHD_PAIR_SPRING * n;
    const double *time = memory + EHD_PAIR_TIME * n;
    for (int64_t r = 0; r < springs; r++) {
        double *own = memory + (EHD_PAIR_HEAD + EHD_PAIR_EACH * r) * n;
        for (int64_t i = 0; i < n; i++) {
            double found[2];
            pair_over_step(step, own[EHD_PAIR_STIFFNESS * n + i], time[i] * shorter[r], found);
            own[EHD_PAIR_LEFT * n + i] = found[0];
            own[EHD_PAIR_OVER * n + i] = found[1];
            const double pulled = found[0] * own[EHD_PAIR_FORCE * n + i];
            pull[i] = r > 0 ? pull[i] + pulled : pulled;
            spring[i] = r > 0 ? spring[i] + found[1] : found[1];
        }
    }
}

/* Write what contacts hold over a step [s], >= 0: memory (lines, EHD_PAIR_MEMORY(springs), n). */
void ehd_pair_hold(int64_t lines, int64_t n, int64_t springs, const double *shorter, double step, double *memory) {
    for (int64_t line = 0; line < lines; line++, memory += EHD_PAIR_MEMORY(springs) * n) {
        if (springs == 1)
            pair_hold_line(n, 1, shorter, step, memory);
        else if (n == 1)
            pair_hold_line(1, springs, shorter, step, memory);
        else
            pair_hold_line(n, springs, shorter, step, memory);
    }
}

/* K_r and the longest theta of a contact at an approach; out (count + 1,). */
EHD_INLINE void pair_springs_at(const ehd_pair_law *law, const ehd_pair_springs *of, int64_t count, int side,
                                double approach, double *out) {
    const int64_t columns = count + 1;
    const double last = (double)law->rows - 1.0, place = pair_place(law, approach);
    const double held = least(most(place, 0.0), last);
    const int64_t cell = pair_cell(law, held);
    const double t = held - (double)cell, weight = of->weight;
    const double *low = of->springs[side] + columns * cell, *other = of->others[side] + columns * cell;
    for (int64_t i = 0; i < columns; i++) {
        out[i] = low[i] + t * (low[columns + i] - low[i]);
        if (weight > 0.0) out[i] += weight * (other[i] + t * (other[columns + i] - other[i]) - out[i]);
    }
    if (place != held) out[count] *= exp(law->table[4 * (place < 0.0 ? 0 : law->rows - 1) + 3] * (place - held));
    out[count] = most(out[count], PAIR_SHORTEST);
}

/* Energy of a spring by its force [J]. */
EHD_INLINE double pair_spring_energy(double force, double stiffness) {
    return stiffness > 0.0 ? 0.5 * force * force / stiffness : 0.0;
}

/* Bring the memory of n contacts of a side, of as many springs as compilers know, to the end of the step over which they
 * held, and to K and theta at their approaches there; by how much the energy of their springs rises [J]. A dry contact keeps
 * no force. */
EHD_INLINE double pair_go_on(const ehd_pair_law *law, const ehd_pair_springs *of, int64_t count, int side, int64_t n,
                           const double *approach, double *memory) {
    const int has_film = law->rows > 1;
    double rise = 0.0;
    for (int64_t i = 0; i < n; i++) {
        double after[PAIR_MOST_SPRINGS + 1] = {0.0}, *at = memory + EHD_PAIR_AT * n + i;
        const double moved = approach[i] - *at;
        after[count] = 1.0;
        if (has_film) pair_springs_at(law, of, count, side, approach[i], after);
        for (int64_t r = 0; r < count; r++) {
            double *own = memory + (EHD_PAIR_HEAD + EHD_PAIR_EACH * r) * n + i;
            double *force = own + EHD_PAIR_FORCE * n, *stiffness = own + EHD_PAIR_STIFFNESS * n;
            rise -= pair_spring_energy(*force, *stiffness);
            *force = has_film ? pair_gone_on(*force, own[EHD_PAIR_LEFT * n], own[EHD_PAIR_OVER * n] * moved, *stiffness,
                                             after[r])
                              : 0.0;
            *stiffness = after[r];
            rise += pair_spring_energy(*force, *stiffness);
        }
        *at = approach[i];
        memory[EHD_PAIR_TIME * n + i] = after[count];
    }
    return rise;
}
