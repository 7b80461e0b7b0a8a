/* ---------------------------------------------------------------------------------------------------------------------
 * Films with memory
 *
 * The table has p, y and G over the approach xi at which a film is in equilibrium, and a over the load, as cubics that
 * rise. k_s = 1/(da/dw) is the stiffness of the contact while its film is locked; with the stiffness k and damping c of
 * the law at rest dy/dxi = 1 - k/k_s and dG/dxi = c/(1 - k/k_s). Load and state: w = x + sqrt(x^2 + p^2), x = G'.
 * ------------------------------------------------------------------------------------------------------------------ */

#define LEAST_DAMPING 1e-12
#define LEAST_FILM 1e-9
#define FILM_STEPS 60
#define FILM_EXACT 1e-13
#define MOST_GROWTH 1.2 /* ratio of steps above which the method is of first order: its formula would no longer rise */
#define NO_CHANGE 1e-30
#define NOTHING 1e-60
#define NO_LOAD_LEFT 1e-20
#define FILM_PI 3.141592653589793

/* Compliance that locked oil takes off a contact, in 4/E' for each ln(1 + 2 h R/b^2): the first number, and the second
 * one times -d(ln h)/d(ln w), which is 1 for a rigid film of constant viscosity, and falls where its inlet is
 * piezoviscous or it is elastic. Fitted with FVA 3, as the longest relaxation time c/(k_s - k) is, in natural times
 * sqrt(b^2 + 2 h R)/u: the complex stiffness is right within 7 % up to ten natural frequencies, and with other oils
 * within 6 % up to L = 40 and 9 % above. A factor from the map makes that 5 % and 7 %. */
#define LOCKED 0.02
#define LOCKED_BY_LOAD 0.087
#define LONGEST_MEMORY 1.4
#define MOST_LOCKED 0.6 /* part of the structure's compliance that locked oil takes off at most */

/* Cubics of a cell. */
enum { P_OF, Y_OF, G_OF };

/* Rows of ehd_film_nodes: place z, load p, stiffness k, y and G at the nodes; slopes of y and G by the approach; what a
 * has beyond the structure, and its slope by the load. */
enum { NODE_Z, NODE_P, NODE_K, NODE_Y, NODE_G, NODE_BY_Y, NODE_BY_C, NODE_BEYOND, NODE_SLOPE };

/* A value that is read from a cell, and its slope. */
typedef struct reading {
    double value, slope;
} reading;

/* Weights of a discrete step: 1/h, and those of the change of G over this step and over the last one. */
typedef struct weights {
    double rate, ahead, back;
} weights;

size_t ehd_film_size(void) { return sizeof(ehd_film); }

/* Cubic through values and slopes at the ends of a cell of the width h; slopes are held so that it rises. */
static void rising_cubic(double y0, double y1, double s0, double s1, double h, double cubic[4]) {
    const double secant = (y1 - y0) / h;
    s0 = least(most(s0, 0.0), 3.0 * secant);
    s1 = least(most(s1, 0.0), 3.0 * secant);
    cubic[0] = y0;
    cubic[1] = s0;
    cubic[2] = (3.0 * secant - 2.0 * s0 - s1) / h;
    cubic[3] = (s0 + s1 - 2.0 * secant) / (h * h);
}

/* Factors of the closed formula of the locked film at one speed and temperature: rows over the load at the speeds and
 * temperatures beside it, and the weights of the second ones. */
typedef struct locked_factors {
    const double *row[2][2];
    double by_speed, by_temperature;
} locked_factors;

/* The nearest two of so many places of an axis: number of the first one, and the weight of the second. */
static int64_t between(double place, int64_t places, double *weight) {
    const double last = (double)places - 1.0, held = least(most(place, 0.0), last);
    const int64_t first = (int64_t)least(held, most(last - 1.0, 0.0));
    *weight = held - (double)first;
    return first;
}

/* Factors over the load at a speed and temperature within the map, straight in ln u and in 1/(T - COLDEST). */
static locked_factors factors_at(const ehd_film_data *film, double log_speed, double T) {
    locked_factors found;
    const int64_t i = between((log_speed - film->log_speed_start) * film->log_speed_step, film->speeds, &found.by_speed);
    const int64_t j = between((1.0 / (T - COLDEST) - film->temperature_start) * film->temperature_step,
                              film->temperatures, &found.by_temperature);
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            found.row[a][b] = film->factors + ((i + (a && film->speeds > 1)) * film->temperatures + j +
                                               (b && film->temperatures > 1)) * film->loads;
    return found;
}

/* The factor at one of the loads. */
static double factor_at(const locked_factors *of, int64_t n) {
    const double low = of->row[0][0][n] + of->by_temperature * (of->row[0][1][n] - of->row[0][0][n]);
    const double high = of->row[1][0][n] + of->by_temperature * (of->row[1][1][n] - of->row[1][0][n]);
    return low + of->by_speed * (high - low);
}

/* The factor at a load: straight between its places in ln of the load. */
static double locked_factor(const ehd_film_data *film, const locked_factors *of, double load) {
    if (film->loads == 1) return factor_at(of, 0);
    const double place =
        least(most((log(load) - film->log_load_start) * film->log_load_step, 0.0), (double)film->loads - 1.0);
    const int64_t cell = (int64_t)least(place, (double)film->loads - 2.0);
    const double first = factor_at(of, cell);
    return first + (place - (double)cell) * (factor_at(of, cell + 1) - first);
}

/* Compliance that locked oil takes off contacts by the closed formula [m2/N]: film offset [m], load > 0 [N/m] and film
 * compliance [m2/N] of all together. */
static double locked_compliance(const ehd_film_contacts *contacts, double offset, double load, double compliance) {
    const double each = most(offset, 0.0) / contacts->count;
    const double square = 8.0 * load * contacts->radius / (FILM_PI * contacts->modulus);
    const double exponent = each > 0.0 ? least(most(compliance * load / offset, 0.0), 1.0) : 0.0;
    const double part = (LOCKED + LOCKED_BY_LOAD * exponent) * 4.0 / contacts->modulus;
    return contacts->count * part * log1p(2.0 * each * contacts->radius / square);
}

/* Stiffness of a contact whose film is locked: offset of the film, load, stiffness and damping at rest, compliance of
 * the structure, factor of the closed formula. */
static double locked_stiffness(const ehd_film_contacts *contacts, double speed, double offset, double load, double k,
                               double c, double solids, double factor) {
    const double locked = factor * locked_compliance(contacts, offset, load, 1.0 / k - solids);
    const double stiff = 1.0 / (solids - least(locked, MOST_LOCKED * solids));
    const double square = 8.0 * load * contacts->radius / (FILM_PI * contacts->modulus);
    const double per_natural = speed / sqrt(square + 2.0 * most(offset, 0.0) / contacts->count * contacts->radius);
    return most(most(stiff, k), k + c * per_natural / LONGEST_MEMORY);
}

/* Values at the nodes: p, y, G and their slopes over the approach; what a has beyond the structure. */
static void fill_film_nodes(const ehd_film_data *data, const locked_factors *factors, const ehd_law_point *point,
                            ehd_film_nodes at_nodes, ehd_film_table *film) {
    double *p = at_nodes[NODE_P], *z = at_nodes[NODE_Z], *k = at_nodes[NODE_K], *y = at_nodes[NODE_Y];
    double *g = at_nodes[NODE_G], *by_y = at_nodes[NODE_BY_Y], *by_c = at_nodes[NODE_BY_C];
    double *beyond = at_nodes[NODE_BEYOND], *slope = at_nodes[NODE_SLOPE];
    double last_approach = 0.0;
    for (int i = 0; i < EHD_NODES; i++) {
        z[i] = node_place(i);
        const double approach = film->centre + z[i] / film->inverse_scale;
        const contact_state rest = held_state(point, approach);
        p[i] = rest.w;
        k[i] = rest.dw;
        y[i] = approach;
        by_y[i] = 1.0;
        g[i] = by_c[i] = beyond[i] = slope[i] = 0.0;
        if (p[i] <= 0.0) {
            film->lift_off = approach; /* the law lifts off within the cell that begins here */
        } else {
            double solids;
            const double dry = structural_approach(point->data, 0.0, p[i], &solids);
            const double c = most(rest.w * rest.ratio, LEAST_DAMPING * k[i]);
            const double stiff = locked_stiffness(&data->contacts, point->entrainment_speed, dry - approach, p[i], k[i],
                                                  c, solids, locked_factor(data, factors, p[i]));
            by_y[i] = 1.0 - k[i] / stiff;
            by_c[i] = by_y[i] > LEAST_FILM ? c / by_y[i] : 0.0; /* without film nothing is squeezed */
            slope[i] = 1.0 / stiff - solids;
            const double before = i > 0 ? p[i - 1] : 0.0, slope_before = before > 0.0 ? slope[i - 1] : slope[i];
            beyond[i] = (i > 0 ? beyond[i - 1] : 0.0) + 0.5 * (slope_before + slope[i]) * (p[i] - before);
            y[i] = approach - dry - beyond[i];
        }
        if (i > 0) {
            y[i] = most(y[i], y[i - 1]); /* it rises, but for rounding where the film hardly gives way */
            g[i] = g[i - 1] + 0.5 * (by_c[i - 1] + by_c[i]) * (approach - last_approach);
        }
        last_approach = approach;
    }
}

/* Cells of p, y and G. */
static void fill_film_cells(ehd_film_nodes n, ehd_film_table *film) {
    const double per = 1.0 / film->inverse_scale;
    for (int row = 0; row < 2 * EHD_ROWS; row++) {
        const int above = row < EHD_ROWS, i = above ? EHD_ROWS + row : 2 * EHD_ROWS - row, j = above ? i + 1 : i - 1;
        const double h = n[NODE_Z][j] - n[NODE_Z][i];
        double(*cell)[4] = film->cell[row];
        rising_cubic(n[NODE_P][i], n[NODE_P][j], n[NODE_K][i] * per, n[NODE_K][j] * per, h, cell[P_OF]);
        rising_cubic(n[NODE_Y][i], n[NODE_Y][j], n[NODE_BY_Y][i] * per, n[NODE_BY_Y][j] * per, h, cell[Y_OF]);
        rising_cubic(n[NODE_G][i], n[NODE_G][j], n[NODE_BY_C][i] * per, n[NODE_BY_C][j] * per, h, cell[G_OF]);
    }
}

/* Cells of a: the structure and what is beyond it, which is straight in its slope between the nodes of p. */
static void fill_load_cells(const ehd_law_data *law, ehd_film_nodes at_nodes, ehd_film_table *film) {
    const double *p = at_nodes[NODE_P], *beyond = at_nodes[NODE_BEYOND], *slopes = at_nodes[NODE_SLOPE];
    double before = 0.0, slope_before = INFINITY;
    int i = 0;
    while (i < EHD_NODES - 1 && p[i + 1] <= 0.0) i++;
    if (i == EHD_NODES - 1) i--; /* nothing is carried at all */
    for (int row = 1; row <= EHD_LOAD_ROWS; row++) {
        double solids;
        const double load = cell_end(row) - 1.0, dry = structural_approach(law, 0.0, load, &solids);
        while (i + 2 < EHD_NODES && p[i + 1] < load) i++;
        const double begin = p[i] > 0.0 ? slopes[i] : slopes[i + 1];
        const double t = least((load - p[i]) / (p[i + 1] - p[i]), 1.0), slope = begin + t * (slopes[i + 1] - begin);
        const double more = beyond[i] + 0.5 * (begin + slope) * least(load - p[i], p[i + 1] - p[i]) +
                            slope * most(load - p[i + 1], 0.0);
        const double value = dry + more, per_load = solids + slope;
        rising_cubic(before, value, slope_before, per_load, cell_end(row) - cell_end(row - 1), film->load_cell[row - 1]);
        before = value;
        slope_before = per_load;
    }
}

/* Cubic at a place in its cell. */
static reading read_cubic(const double cubic[4], double t) {
    const double bend = cubic[2] + t * cubic[3], mean = cubic[1] + t * bend;
    const reading found = {cubic[0] + t * mean, mean + t * (bend + t * cubic[3])};
    return found;
}

/* p, y and G of a film that is in equilibrium at an approach, with their slopes by it. */
static void equilibrium(const ehd_film_table *film, double approach, reading found[3]) {
    double t;
    const int row = row_of((approach - film->centre) * film->inverse_scale, &t);
    for (int n = 0; n < 3; n++) {
        found[n] = read_cubic(film->cell[row][n], t);
        found[n].slope *= film->inverse_scale;
    }
}

/* a of a load, and its slope. */
static reading stretch(const ehd_film_table *film, double load) {
    double above;
    const int row = cell_from(1.0 + load, EHD_LOAD_ROWS, &above);
    return read_cubic(film->load_cell[row], above);
}

/* Fill a table with the law of a point without centrifugal load. */
static void fill_film(const ehd_film_data *data, const locked_factors *factors, const ehd_law_point *point,
                      ehd_film_nodes at_nodes, ehd_film_table *film) {
    /* a faded film takes its part of the offset, and of the approach of lift-off */
    film->centre = point->film * point->own.offset;
    film->lift_off = point->film * point->lift_off;
    film->inverse_scale = point->own.inverse_scale;
    film->highest = point->highest_load * (1.0 + LOAD_TOLERANCE);
    fill_film_nodes(data, factors, point, at_nodes, film);
    fill_film_cells(at_nodes, film);
    fill_load_cells(point->data, at_nodes, film);
    film->least_damping = EHD_SHORTEST_MEMORY / stretch(film, point->highest_load).slope;
}

int ehd_film_make(const ehd_film_data *data, double u, double T, ehd_law_point *room, ehd_film *film) {
    if (!film) return EHD_BAD_ARGUMENT;
    if (film->table.inverse_scale > 0.0 && film->entrainment_speed == fabs(u) && film->temperature == T)
        return (int)film->status;
    const ehd_law_data *law = data->law;
    const int status = ehd_law_make(law, u, T, 0.0, room);
    film->law = law;
    film->entrainment_speed = fabs(u);
    film->temperature = T;
    film->status = status;
    film->table.inverse_scale = 0.0;
    if (refuses(law, status)) return status;
    const double speed = least(most(fabs(u), most(data->lowest_speed, law->lowest_speed)), law->highest_speed);
    const locked_factors factors = factors_at(data, log(speed), least(most(T, law->counted_cold), law->counted_hot));
    fill_film(data, &factors, room, film->node, &film->table);
    return status;
}

/* Whether a status of a film refuses; one that was not made always does. */
static int film_refuses(const ehd_film *film, int status) { return !film->law || refuses(film->law, status); }

/* What a film refuses before it is asked anything. */
static int film_status(const ehd_film *film) {
    if (!film->law) return EHD_BAD_ARGUMENT;
    if (refuses(film->law, (int)film->status)) return (int)film->status;
    return film->table.inverse_scale > 0.0 ? (int)film->status : EHD_BAD_ARGUMENT;
}

/* w = x + sqrt(x^2 + p^2), without cancellation, and its slope, for slopes of p and x. */
static reading load_of(reading p, reading x) {
    const double root = sqrt(x.value * x.value + p.value * p.value + NOTHING);
    const double w = x.value >= 0.0 ? x.value + root : p.value * p.value / (root - x.value);
    const reading found = {w, (w * x.slope + p.value * p.slope) / root};
    return found;
}

/* Weights of a step: backward differences of second order, or of first order at the first step and after a short one. */
static weights weights_of(double step, double last_step) {
    const double r = step / last_step;
    const weights first = {1.0 / step, 1.0, 0.0}, second = {1.0 / step, (1.0 + 2.0 * r) / (1.0 + r), r * r / (1.0 + r)};
    return last_step <= 0.0 || step > MOST_GROWTH * last_step ? first : second;
}

/* 1.5 by the size of the last change of G: what squeeze fades with. */
static double fading_of(double last) { return 1.5 / (fabs(last) + NO_CHANGE); }

/* x = G' at the end of a step, and its slope by G. Where the change falls below two thirds of the last one, the share of
 * the last one fades with it: so x has the sign of the change, and rises with it, whatever the step. */
static reading squeeze(weights step, double change, double last, double fading) {
    const double t = least(fabs(change) * fading, 1.0), turn = 9.0 * t * (1.0 - t);
    const reading found = {step.rate * (step.ahead * change - step.back * last * t * t * (3.0 - 2.0 * t)),
                           step.rate * (step.ahead - step.back * (change * last >= 0.0 ? turn : -turn))};
    return found;
}

/* End of a step: load, its slope by the approach, and the state. */
typedef struct film_end {
    double load, tangent, approach;
} film_end;

/* End of a step for a film with its G at the beginning, the change of G over the step before, and its state there.
 * Newton's method for the approach of equilibrium, in a bracket: a film that is squeezed lags behind the approach, one
 * that is relieved behind its last state. */
static film_end end_of_step(const ehd_film_table *film, weights step, double approach, double begun, double last,
                            double start) {
    reading at[3];
    const double scale = film->inverse_scale, fading = fading_of(last);
    double left = film->lift_off, xi = most(start, left), right = most(approach, xi);
    double before_last = INFINITY, moved = INFINITY, w = 0.0, tangent = 0.0;
    right += right - left;
    for (int n = 0; n < FILM_STEPS; n++) {
        equilibrium(film, xi, at);
        reading x = squeeze(step, at[G_OF].value - begun, last, fading);
        x.slope *= at[G_OF].slope;
        const reading load = load_of(at[P_OF], x), a = stretch(film, load.value);
        const double rise = a.slope * load.slope + at[Y_OF].slope, gap = approach - a.value - at[Y_OF].value;
        w = load.value;
        tangent = load.slope > 0.0 && rise > 0.0 ? load.slope / rise : 0.0; /* zero where the film has ended */
        if (gap > 0.0)
            left = xi;
        else
            right = xi;
        double following = xi + gap / rise;
        if (!(left <= following && following <= right && 2.0 * fabs(following - xi) <= before_last))
            following = 0.5 * (left + right);
        before_last = moved;
        moved = fabs(following - xi);
        if (moved * scale <= FILM_EXACT * (1.0 + fabs(xi - film->centre) * scale)) break;
        xi = following;
    }
    const film_end found = {w, tangent, xi};
    return found;
}

/* G of a film that is in equilibrium at an approach. */
static double squeezing(const ehd_film_table *film, double approach) {
    reading at[3];
    equilibrium(film, approach, at);
    return at[G_OF].value;
}

/* Load and state at the end of a step; see ehd_film_advance. */
static void advance_film(const ehd_film_table *film, weights step, double approach, const ehd_film_state *before,
                         ehd_film_state *after, ehd_force *force) {
    const double begun = squeezing(film, before->approach);
    const film_end end = end_of_step(film, step, approach, begun, before->change, before->approach);
    after->approach = end.approach;
    after->change = squeezing(film, end.approach) - begun;
    after->load = force->load = end.load > NO_LOAD_LEFT ? end.load : 0.0;
    force->stiffness = end.load > NO_LOAD_LEFT ? end.tangent : 0.0;
    force->damping = 0.0;
}

/* A film in equilibrium at an approach. */
static void settle_film(const ehd_film_table *film, double approach, ehd_film_state *state) {
    reading at[3];
    state->approach = most(approach, film->lift_off);
    equilibrium(film, state->approach, at);
    state->change = 0.0;
    state->load = at[P_OF].value > NO_LOAD_LEFT ? at[P_OF].value : 0.0;
}

int ehd_film_settled(const ehd_film *film, double approach, ehd_film_state *state) {
    if (!film || !state) return EHD_BAD_ARGUMENT;
    state->approach = state->change = state->load = NAN;
    const int status = film_status(film);
    if (film_refuses(film, status)) return status;
    if (!is_finite(approach)) return status | EHD_NOT_FINITE;
    settle_film(&film->table, approach, state);
    return status;
}

int ehd_film_advance(const ehd_film *film, double step, double last_step, double approach, const ehd_film_state *before,
                     ehd_film_state *after, ehd_force *force) {
    if (!film || !before || !after || !force) return EHD_BAD_ARGUMENT;
    const ehd_film_state begun = *before;
    no_force(force);
    after->approach = after->change = after->load = NAN;
    int status = film_status(film);
    if (film_refuses(film, status)) return status;
    if (!(is_finite(approach) && is_finite(begun.approach) && is_finite(begun.change) && is_finite(last_step)))
        return status | EHD_NOT_FINITE;
    if (!(step > 0.0 && is_finite(1.0 / step))) return status | EHD_BAD_ARGUMENT;
    advance_film(&film->table, weights_of(step, last_step), approach, &begun, after, force);
    if (force->load > film->table.highest) status |= EHD_ABOVE_LOAD;
    if (!is_finite(fabs(after->approach) + fabs(after->change))) status |= EHD_NOT_FINITE;
    status = settled(film->law, status, force);
    if (film_refuses(film, status)) after->approach = after->change = after->load = NAN;
    return status;
}

/* Place in a cell, from 0 to its width, at which a cubic that rises has a value. */
static double place_in(const double cubic[4], double width, double value) {
    double low = 0.0, high = width, t = 0.5 * width;
    for (int n = 0; n < FILM_STEPS; n++) {
        const reading at = read_cubic(cubic, t);
        if (at.value > value)
            high = t;
        else
            low = t;
        double following = at.slope > 0.0 ? t - (at.value - value) / at.slope : INFINITY;
        if (!(low <= following && following <= high)) following = 0.5 * (low + high);
        const double moved = fabs(following - t);
        t = following;
        if (moved <= FILM_EXACT * width) break;
    }
    return t;
}

/* Load whose a is an approach, and its slope by it; none for an approach below zero, held at the end of the table. */
static reading load_at(const ehd_film_table *film, double approach) {
    int low = 0, high = EHD_LOAD_ROWS;
    const double end = cell_end(high) - cell_end(high - 1);
    reading found = {0.0, 0.0};
    if (approach <= 0.0) return found;
    if (approach >= read_cubic(film->load_cell[high - 1], end).value) {
        found.value = cell_end(high) - 1.0;
        return found;
    }
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (film->load_cell[middle][0] <= approach)
            low = middle;
        else
            high = middle;
    }
    const double width = cell_end(low + 1) - cell_end(low), t = place_in(film->load_cell[low], width, approach);
    found.value = cell_end(low) - 1.0 + t;
    const double slope = read_cubic(film->load_cell[low], t).slope;
    found.slope = slope > 0.0 ? 1.0 / slope : 0.0;
    return found;
}

/* Load and rate; see ehd_film_rate. x = (w^2 - p^2)/(2 m), xi' = x/(dG/dxi), with m = w, but for an opening contact,
 * below w = 2 e p with e = EHD_OPENING: m = e p + w^2/(4 e p), which goes on smoothly to e p. */
static void rate_film(const ehd_film_table *film, double approach, double state, ehd_film_rates *rates) {
    double t;
    const double scale = film->inverse_scale, xi = most(state, film->lift_off);
    const int row = row_of((xi - film->centre) * scale, &t), held = state < film->lift_off;
    const reading at = read_cubic(film->cell[row][P_OF], t), y = read_cubic(film->cell[row][Y_OF], t);
    const double *cubic = film->cell[row][G_OF];
    const double p = most(at.value, 0.0), dp = held ? 0.0 : at.slope * scale, dy = held ? 0.0 : y.slope * scale;
    const double c = most(read_cubic(cubic, t).slope, 0.0) * scale + film->least_damping;
    const double dc = held ? 0.0 : (2.0 * cubic[2] + 6.0 * t * cubic[3]) * scale * scale;
    const reading w = load_at(film, approach - y.value);
    const double edge = EHD_OPENING * p, part = w.value < 2.0 * edge ? 0.5 * w.value / edge : 1.0;
    const double m = part < 1.0 ? edge * (1.0 + part * part) : w.value;
    const double x = m > 0.0 ? 0.5 * (w.value - p) * (w.value + p) / m : 0.0;
    const double x_by_w = m > 0.0 ? (w.value - x * part) / m : 0.5;
    const double x_by_p = m > 0.0 ? -(p + x * EHD_OPENING * (part < 1.0 ? 1.0 - part * part : 0.0)) / m : 0.0;
    rates->load = w.value;
    rates->stiffness = w.slope;
    rates->by_state = -w.slope * dy;
    rates->rate = x / c;
    rates->rate_by_approach = x_by_w * w.slope / c;
    rates->rate_by_state = (x_by_p * dp + x_by_w * rates->by_state - rates->rate * dc) / c;
}

int ehd_film_rate(const ehd_film *film, double approach, double state, ehd_film_rates *rates) {
    if (!film || !rates) return EHD_BAD_ARGUMENT;
    int status = film_status(film);
    if (!(is_finite(approach) && is_finite(state))) status |= EHD_NOT_FINITE;
    if (!film_refuses(film, status)) {
        rate_film(&film->table, approach, state, rates);
        if (rates->load > film->table.highest) status |= EHD_ABOVE_LOAD;
        if (!is_finite(rates->load + fabs(rates->rate) + fabs(rates->rate_by_approach) + fabs(rates->rate_by_state)))
            status |= EHD_NOT_FINITE;
    }
    if (film_refuses(film, status)) rates->load = rates->stiffness = rates->by_state = NAN;
    if (film_refuses(film, status & ~EHD_ABOVE_LOAD)) rates->rate = rates->rate_by_approach = rates->rate_by_state = NAN;
    return status;
}
