/* ---------------------------------------------------------------------------------------------------------------------
 * Law of a contact of a bearing over its approach
 *
 * With memory a contact holds over a step three numbers: a force f [N], a spring K [N/m] and an approach a [m], by which
 * its load is p + m where m = f + K (approach - a) >= 0, else m + sqrt(m^2 + p^2), p the load at rest: never a tension.
 * Without a spring, or a null pointer instead of them, it is at rest.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Row before a place on a table. */
EHD_INLINE int64_t pair_cell(const ehd_pair_law *law, double place) {
    const int64_t last = law->rows - 2;
    const int64_t cell = place > 0.0 ? (place < (double)last ? (int64_t)place : last) : 0;
    return cell < 0 ? 0 : cell;
}

/* A cubic between two rows, by values and slopes (column, column + 1); straight beyond the ends. */
EHD_INLINE double pair_value(const double *low, const double *high, double t) {
    if (t < 0.0) return low[0] + low[1] * t;
    if (t > 1.0) return high[0] + high[1] * (t - 1.0);
    const double r = 1.0 - t;
    return low[0] + t * t * (3.0 - 2.0 * t) * (high[0] - low[0]) + t * r * (low[1] * r - high[1] * t);
}

/* Load and stiffness of a dry point, F = C g^(3/2). */
EHD_INLINE ehd_pair_load pair_point(double coefficient, double approach) {
    ehd_pair_load found = {0.0, 0.0, 0.0, 0.0};
    if (approach > 0.0) {
        const double root = coefficient * sqrt(approach);
        found.load = root * approach;
        found.stiffness = 1.5 * root;
    }
    return found;
}

/* Load and stiffness at the end of a step by those at rest, a force m beside them and its spring. */
EHD_INLINE void pair_with_held(ehd_pair_load *of, double held, double spring) {
    const double load = of->load;
    if (held >= 0.0) {
        of->load = load + held;
        of->stiffness += spring;
        of->held = held;
        return;
    }
    const double size = sqrt(held * held + load * load);
    of->load = load * load / (size - held);
    of->stiffness = (spring * of->load + of->stiffness * load) / size;
    of->held = of->load - load;
}

/* Place of an approach on the table. */
EHD_INLINE double pair_place(const ehd_pair_law *law, double approach) {
    const double x = (approach - law->centre) * (1.0 / law->scale), size = log(fabs(x) + sqrt(1.0 + x * x));
    return ((x >= 0.0 ? size : -size) - law->first) * (1.0 / law->step);
}

/* Load and stiffness at an approach, by one over scale and step of the table; held: three numbers of a contact with memory,
 * or null. */
EHD_INLINE ehd_pair_load pair_carried_by(const ehd_pair_law *law, double one_scale, double one_step, double approach,
                                          const double *held) {
    if (law->rows == 0) return pair_point(law->coefficient, approach);
    ehd_pair_load found;
    const double x = (approach - law->centre) * one_scale, root = sqrt(1.0 + x * x);
    const double size = log(fabs(x) + root), z = x >= 0.0 ? size : -size;
    found.place = (z - law->first) * one_step;
    const int64_t cell = pair_cell(law, found.place);
    const double t = found.place - (double)cell, *low = law->table + 4 * cell, *high = low + 4;
    double slope;
    if (t < 0.0)
        slope = low[1];
    else if (t > 1.0)
        slope = high[1];
    else {
        const double r = 1.0 - t;
        slope = 6.0 * t * r * (high[0] - low[0]) + low[1] * r * (r - 2.0 * t) + high[1] * t * (t - 2.0 * r);
    }
    found.load = law->coefficient * exp(1.5 * pair_value(low, high, t));
    found.stiffness = 1.5 * found.load * slope / (law->scale * law->step * root);
    found.held = 0.0;
    if (held && held[1] > 0.0) pair_with_held(&found, held[0] + held[1] * (approach - held[2]), held[1]);
    return found;
}

/* The same. */
EHD_INLINE ehd_pair_load pair_carried(const ehd_pair_law *law, double approach, const double *held) {
    return pair_carried_by(law, 1.0 / law->scale, 1.0 / law->step, approach, held);
}

/* Damping by stiffness and place of pair_carried; none of a contact with memory, which has it in its stiffness. */
EHD_INLINE double pair_slowed(const ehd_pair_law *law, double stiffness, double place, const double *held) {
    if (law->rows == 0) return stiffness > 0.0 ? law->damping + law->damping_time * stiffness : 0.0;
    if (held && held[1] > 0.0) return 0.0;
    const int64_t cell = pair_cell(law, place);
    return exp(pair_value(law->table + 4 * cell + 2, law->table + 4 * cell + 6, place - (double)cell));
}

/* Load, stiffness and damping at an approach; held as of pair_carried. */
EHD_INLINE ehd_pair_state pair_at(const ehd_pair_law *law, double approach, const double *held) {
    const ehd_pair_load of = pair_carried(law, approach, held);
    const ehd_pair_state found = {of.load, of.stiffness, pair_slowed(law, of.stiffness, of.place, held)};
    return found;
}

/* Load, stiffness and damping at n approaches, out (n, 3); held as of pair_carried, of all of them. */
void ehd_pair_contacts(const ehd_pair_law *law, int64_t n, const double *approach, const double *held, double *out) {
    for (int64_t i = 0; i < n; i++) {
        const ehd_pair_state found = pair_at(law, approach[i], held);
        out[3 * i] = found.load;
        out[3 * i + 1] = found.stiffness;
        out[3 * i + 2] = found.damping;
    }
}

/* Approach at which a contact of balls carries a load at rest [m], from a start near it, or NaN for a search without one;
 * zero without load. */
double ehd_pair_approach(const ehd_pair_law *law, double load, double start) {
    if (!(load > 0.0)) return 0.0;
    const double g = pow(load / law->coefficient, 2.0 / 3.0);
    if (law->rows == 0) return g;
    for (int i = 0; i < 20; i++) {
        const ehd_pair_load found = pair_carried(law, start, NULL);
        if (!(found.load > 0.0 && found.stiffness > 0.0)) break;
        const double lacking = log(load / found.load);
        if (fabs(lacking) <= 1e-12) return start;
        start += lacking * found.load / found.stiffness;
    }
    double low = law->centre - 1e3 * law->scale, high = g + 1e3 * law->scale;
    for (int i = 0; i < 200; i++) {
        const double middle = 0.5 * (low + high);
        if (pair_carried(law, middle, NULL).load < load)
            low = middle;
        else
            high = middle;
        if (high - low <= 1e-15 * law->scale) break;
    }
    return 0.5 * (low + high);
}

EHD_SIZE_OF(ehd_pair_law)
