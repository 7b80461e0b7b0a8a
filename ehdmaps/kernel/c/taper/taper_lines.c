/* ---------------------------------------------------------------------------------------------------------------------
 * Sums over the slices of a line of a roller: load, stiffness, damping; dry, with a film, or with its memory
 *
 * A slice of a dry line has q = C g^(10/9)/n, one with a film the part 1/n of the law of a whole roller, pair_law.h.
 * Slices stand side by side in loops without branches or calls, which compilers put into vector instructions: with a
 * root of their own, and logarithm and exponential of elementary.h.
 * ------------------------------------------------------------------------------------------------------------------ */

#define TAPER_CHUNK 32 /* slices at once */
#define TAPER_LANES 4  /* slices that are added up side by side */

/* Sums of a contact: load, load b; stiffness k, k b, k b b; the same of damping; what memory adds to load and load b.
 * b is the lever of a slice. */
typedef struct taper_sums {
    double q, qb, k[3], c[3], held[2];
} taper_sums;

/* What of a line is asked: its law; levers and depths of the slices; approach and rotation of the line; the memory of
 * the slices, or null. */
typedef struct taper_line {
    const ehd_pair_law *law;
    const double *lever, *profile, *memory;
    int64_t slices;
    double approach, turn;
} taper_line;

/* x or 0, whichever is larger. */
EHD_INLINE double taper_positive(double x) { return 0.5 * (x + fabs(x)); }

/* x within -700 to 700, where plain_exp has a result. */
EHD_INLINE double taper_held(double x) { return x - taper_positive(x - 700.0) + taper_positive(-700.0 - x); }

/* x^(1/9) of a positive normal number, to 5e-16. The start divides the bits of x as a whole number by 9, which is right
 * to 3.4 %; each step of Halley's method leaves 20/3 of the cube of an error. */
EHD_INLINE double taper_ninth_root(double x) {
    const double whole = 4503599627370496.0; /* 2^52, whose last bits are whole numbers */
    const double place = number_of_bits(bits_of(x) >> 12 | UINT64_C(0x4330000000000000)) - whole;
    double y = number_of_bits(bits_of(place * (1.0 / 9.0) + (whole + 909.2935333333 * 1099511627776.0)) << 12);
    for (int i = 0; i < 3; i++) {
        const double y2 = y * y, y4 = y2 * y2, y9 = y4 * y4 * y;
        y *= (4.0 * y9 + 5.0 * x) / (5.0 * y9 + 4.0 * x);
    }
    return y;
}

/* Load and stiffness of slices of a dry line, times n. */
EHD_INLINE void taper_dry(const ehd_pair_law *law, int count, const double *g, double *load, double *stiffness) {
    for (int i = 0; i < count; i++) {
        const double pressed = taper_positive(g[i]), root = law->coefficient * taper_ninth_root(pressed + 1e-290);
        load[i] = root * pressed;
        stiffness[i] = 10.0 / 9.0 * root;
    }
}

/* Where approaches lie on the table of a film: the row before each, how far behind it, within 0 to 1 and as it is; and
 * one over the slope of asinh. */
typedef struct taper_places {
    int row[TAPER_CHUNK];
    double within[TAPER_CHUNK], beyond[TAPER_CHUNK], root[TAPER_CHUNK];
} taper_places;

EHD_INLINE void taper_places_of(const ehd_pair_law *law, int count, const double *g, taper_places *of) {
    const double per_scale = 1.0 / law->scale, per_step = 1.0 / law->step, last = (double)law->rows - 2.0;
    double place[TAPER_CHUNK];
    for (int i = 0; i < count; i++) {
        const double x = (g[i] - law->centre) * per_scale, root = sqrt(1.0 + x * x);
        of->root[i] = root;
        place[i] = (copysign(plain_log(fabs(x) + root), x) - law->first) * per_step;
    }
    for (int i = 0; i < count; i++) {
        const double held = place[i] > 0.0 ? place[i] : 0.0; /* also where it is no number */
        of->row[i] = (int)(held < last ? held : last);
    }
    for (int i = 0; i < count; i++) {
        const double t = place[i] - of->row[i], behind = taper_positive(t), s = behind - taper_positive(behind - 1.0);
        of->within[i] = s;
        of->beyond[i] = t - s;
    }
}

/* Cubics between rows of a column of the table and its slope; straight beyond the ends. */
EHD_INLINE void taper_cubics(const double *table, int count, const taper_places *of, double *value, double *slope) {
    double low[TAPER_CHUNK], high[TAPER_CHUNK], low_rise[TAPER_CHUNK], high_rise[TAPER_CHUNK];
    for (int i = 0; i < count; i++) {
        const double *row = table + 4 * (int64_t)of->row[i];
        low[i] = row[0];
        low_rise[i] = row[1];
        high[i] = row[4];
        high_rise[i] = row[5];
    }
    for (int i = 0; i < count; i++) {
        const double s = of->within[i], r = 1.0 - s, change = high[i] - low[i], sr = s * r;
        slope[i] = 6.0 * sr * change + low_rise[i] * r * (r - 2.0 * s) + high_rise[i] * s * (s - 2.0 * r);
        value[i] = low[i] + s * s * (3.0 - 2.0 * s) * change + sr * (low_rise[i] * r - high_rise[i] * s) +
                   slope[i] * of->beyond[i];
    }
}

/* Load and stiffness at rest of slices with a film, times n. */
EHD_INLINE void taper_film(const ehd_pair_law *law, int count, const double *g, double *load, double *stiffness) {
    const double factor = 1.5 / (law->scale * law->step);
    taper_places places;
    taper_places_of(law, count, g, &places);
    taper_cubics(law->table, count, &places, load, stiffness);
    for (int i = 0; i < count; i++) {
        load[i] = law->coefficient * plain_exp(taper_held(1.5 * load[i]));
        stiffness[i] = factor * load[i] * stiffness[i] / places.root[i];
    }
}

/* The same at the end of a step with memory: with p the load at rest and m the force that is held p + m, or
 * m + sqrt(m^2 + p^2) where it pulls; held: what that is more than p. */
EHD_INLINE void taper_with_held(int count, const double *g, const double *pull, const double *spring,
                                 const double *at, double *load, double *stiffness, double *held) {
    for (int i = 0; i < count; i++) {
        const double more = pull[i] + spring[i] * (g[i] - at[i]), pressed = taper_positive(more), p = load[i];
        const double pulled = more - pressed, size = sqrt(pulled * pulled + p * p), total = p * (p / (size - pulled));
        load[i] = total + pressed;
        held[i] = total - p + pressed;
        stiffness[i] = (spring[i] * total + stiffness[i] * p) / size;
    }
}

/* Whether a slice of a dry line carries load. */
EHD_INLINE int taper_carries(const taper_line *line, int64_t i) {
    return line->approach + line->turn * line->lever[i] - line->profile[i] > 0.0;
}

/* Approaches of some slices of a line. */
EHD_INLINE void taper_approaches(const taper_line *line, int64_t first, int count, double *g) {
    const double *b = line->lever + first, *depth = line->profile + first;
    for (int i = 0; i < count; i++) g[i] = line->approach + line->turn * b[i] - depth[i];
}

/* Add up load and stiffness of slices with their levers, each in as many sums as there are lanes. */
EHD_INLINE void taper_sum(int count, const double *load, const double *stiffness, const double *lever,
                           double sum[5][TAPER_LANES]) {
    int i = 0;
    for (; i + TAPER_LANES <= count; i += TAPER_LANES)
        for (int lane = 0; lane < TAPER_LANES; lane++) {
            const double q = load[i + lane], k = stiffness[i + lane], b = lever[i + lane], each = k * b;
            sum[0][lane] += q;
            sum[1][lane] += q * b;
            sum[2][lane] += k;
            sum[3][lane] += each;
            sum[4][lane] += each * b;
        }
    for (; i < count; i++) {
        const double each = stiffness[i] * lever[i];
        sum[0][0] += load[i];
        sum[1][0] += load[i] * lever[i];
        sum[2][0] += stiffness[i];
        sum[3][0] += each;
        sum[4][0] += each * lever[i];
    }
}

/* Add up what memory adds to the loads of slices, and this with their levers. */
EHD_INLINE void taper_sum_held(int count, const double *held, const double *lever, double sum[2][TAPER_LANES]) {
    int i = 0;
    for (; i + TAPER_LANES <= count; i += TAPER_LANES)
        for (int lane = 0; lane < TAPER_LANES; lane++) {
            sum[0][lane] += held[i + lane];
            sum[1][lane] += held[i + lane] * lever[i + lane];
        }
    for (; i < count; i++) {
        sum[0][0] += held[i];
        sum[1][0] += held[i] * lever[i];
    }
}

/* Sums of load and stiffness of a line. */
EHD_CLONES static void taper_line_sums(const taper_line *line, taper_sums *of) {
    const ehd_pair_law *law = line->law;
    const double part = 1.0 / (double)line->slices;
    double g[TAPER_CHUNK], load[TAPER_CHUNK], stiffness[TAPER_CHUNK], held[TAPER_CHUNK];
    double sum[5][TAPER_LANES] = {{0.0}}, more[2][TAPER_LANES] = {{0.0}}, total[5];
    int64_t first = 0, end = line->slices;
    if (law->rows == 0) { /* what carries nothing at both ends of a dry line */
        while (first < end && !taper_carries(line, first)) first++;
        while (first < end && !taper_carries(line, end - 1)) end--;
    }
    for (; first < end; first += TAPER_CHUNK) {
        const int count = end - first < TAPER_CHUNK ? (int)(end - first) : TAPER_CHUNK;
        taper_approaches(line, first, count, g);
        if (law->rows == 0)
            taper_dry(law, count, g, load, stiffness);
        else
            taper_film(law, count, g, load, stiffness);
        if (line->memory) {
            const double *memory = line->memory + first;
            taper_with_held(count, g, memory + EHD_PAIR_PULL * line->slices, memory + EHD_PAIR_SPRING * line->slices,
                            memory + EHD_PAIR_AT * line->slices, load, stiffness, held);
            taper_sum_held(count, held, line->lever + first, more);
        }
        taper_sum(count, load, stiffness, line->lever + first, sum);
    }
    for (int i = 0; i < 5; i++) total[i] = part * ((sum[i][0] + sum[i][1]) + (sum[i][2] + sum[i][3]));
    of->q = total[0];
    of->qb = total[1];
    for (int i = 0; i < 3; i++) of->k[i] = total[2 + i];
    for (int i = 0; i < 2; i++) of->held[i] = part * ((more[i][0] + more[i][1]) + (more[i][2] + more[i][3]));
}

/* Sums of the damping of a line whose other sums are known; slices with a spring have none of their own. */
EHD_CLONES static void taper_line_dampers(const taper_line *line, taper_sums *of) {
    const ehd_pair_law *law = line->law;
    const double *spring = line->memory ? line->memory + EHD_PAIR_SPRING * line->slices : NULL;
    const double part = 1.0 / (double)line->slices;
    double g[TAPER_CHUNK], damping[TAPER_CHUNK], slope[TAPER_CHUNK], sum[3] = {0.0, 0.0, 0.0};
    int damped = law->rows > 0 ? !spring : law->damping > 0.0;
    for (int64_t i = 0; spring && !damped && i < line->slices; i++) damped = !(spring[i] > 0.0);
    for (int64_t first = 0; damped && first < line->slices; first += TAPER_CHUNK) {
        const int count = line->slices - first < TAPER_CHUNK ? (int)(line->slices - first) : TAPER_CHUNK;
        const double *b = line->lever + first;
        taper_approaches(line, first, count, g);
        if (law->rows == 0) {
            for (int i = 0; i < count; i++) damping[i] = g[i] > 0.0 ? law->damping : 0.0;
        } else {
            taper_places places;
            taper_places_of(law, count, g, &places);
            taper_cubics(law->table + 2, count, &places, damping, slope);
            for (int i = 0; i < count; i++) damping[i] = plain_exp(taper_held(damping[i]));
        }
        for (int i = 0; i < count; i++) {
            const double c = spring && spring[first + i] > 0.0 ? 0.0 : damping[i];
            sum[0] += c;
            sum[1] += c * b[i];
            sum[2] += c * b[i] * b[i];
        }
    }
    for (int i = 0; i < 3; i++) of->c[i] = part * sum[i] + (law->rows == 0 ? law->damping_time * of->k[i] : 0.0);
}
