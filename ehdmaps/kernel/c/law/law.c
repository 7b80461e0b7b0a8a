/* ---------------------------------------------------------------------------------------------------------------------
 * The contact law
 *
 * The table holds g = w^(1/3) and ln(c/w) over ln u, 1/(T - coldest) and s = asinh((approach - offset)/scale), all
 * evenly spaced: B-splines, quadratic over the first two and cubic over s. At one speed and temperature it is a line of
 * cubics. So the load is C1 and its derivatives are those of the splines.
 * ------------------------------------------------------------------------------------------------------------------ */

#define LOAD_TOLERANCE 1e-3   /* part of the highest load by which it may be passed: the error of a table */
#define EDGE_TOLERANCE 1e-6   /* the same of speeds and temperatures: single precision */
#define COLDEST 170.0         /* [K], where the viscosity of mineral oils tends to infinity, about */
#define LEAST_LOAD 1e-200
#define MOST_STEPS 100
#define CUBICS 64             /* cells of a line that are made in one loop */
#define CLOSE_LOADS 1e-8      /* how far logarithms of loads may be apart before a last step, which leaves its square */

/* State of a contact at rest: w, dw/dapproach, c/w, dc/dapproach. */
typedef struct contact_state {
    double w, dw, ratio, dc;
} contact_state;

/* Number of the nearest node of an axis, and the weights of the quadratic B-splines around it. */
typedef struct node {
    int first;
    double weight[3];
} node;

static const contact_state NO_LOAD = {0.0, 0.0, 0.0, 0.0};

#define CELL_SIZE ((int64_t)(8 * sizeof(double))) /* of a line: two cubics */

/* Whether a status refuses. */
static int refuses(const ehd_law_data *data, int status) { return (status & (int)data->refused) != 0; }

static int64_t cells_of(const ehd_law_table *table) { return table->places - 3; }

/* Cells of a line: double [cells][2][4]. */
static double (*line_cells(const ehd_line *line))[2][4] {
    return (double(*)[2][4])((uintptr_t)line + (uintptr_t)line->to_cells);
}

size_t ehd_law_point_size(const ehd_law_data *data) {
    int64_t cells = cells_of(&data->own);
    if (data->centrifugal) cells += cells_of(&data->inner) + cells_of(&data->outer);
    return sizeof(ehd_law_point) + (size_t)(cells * CELL_SIZE);
}

/* Place in steps from the first node, held to so many cells; zero for NaN. */
static double place_within(double x, int64_t cells) {
    x = x > 0.0 ? x : 0.0;
    return x < (double)cells ? x : (double)cells;
}

static int cell_of(double x, int64_t cells) {
    const int last = cells > 1 ? (int)cells - 1 : 0, cell = (int)x;
    return cell < last ? cell : last;
}

static node node_of(double place, int64_t nodes) {
    const double x = place_within(place, nodes - 3);
    const int first = (int)(x + 0.5);
    const double t = x - first, low = 0.5 - t, high = 0.5 + t;
    const node found = {first, {0.5 * low * low, 0.75 - t * t, 0.5 * high * high}};
    return found;
}

/* asinh(z) and its derivative. */
static double stretched(double z, double *slope) {
    const double root = sqrt(1.0 + z * z), size = log(fabs(z) + root);
    *slope = 1.0 / root;
    return z >= 0.0 ? size : -size;
}

/* The rule by which damping acts in a contact that cannot pull: w + c rate down to half of w, and below it the
 * hyperbola that goes on smoothly and falls to zero as the bodies part faster. */
static void unilateral(double w, double dw, double c, double dc, double rate, ehd_force *force) {
    const double part = c * rate;
    if (part >= -0.5 * w) {
        force->load = w + part;
        force->stiffness = dw + dc * rate;
        force->damping = c;
    } else {
        const double ratio = w / part;
        force->load = -0.25 * w * ratio;
        force->stiffness = 0.25 * ratio * (ratio * dc * rate - 2.0 * dw);
        force->damping = 0.25 * ratio * ratio * c;
    }
}

/* State from g, ln(c/w) and their derivatives by the approach. */
static contact_state state_of(double g, double dg, double log_ratio, double dlog_ratio) {
    contact_state found;
    g = most(g, 0.0);
    found.w = g * g * g;
    found.dw = 3.0 * g * g * dg;
    found.ratio = exp(least(most(log_ratio, -700.0), 700.0));
    found.dc = found.ratio * (found.dw + found.w * dlog_ratio);
    return found;
}

/* Approach of the structure without a film, all contacts together [m], and its derivative by the load; the last contact
 * carries a centrifugal load q besides. A row of the structure says whether a contact is one of half-spaces, then a, b:
 * a w (b - ln(w)/2) of a half-space, else a w^b [m], w in N/m. */
static double structural_approach(const ehd_law_data *D, double q, double load, double *compliance) {
    double approach = 0.0;
    *compliance = 0.0;
    for (int i = 0; i < D->contacts; i++) {
        const double *law = D->structure + 3 * i, w = i == D->contacts - 1 ? load + q : load, a = law[1], b = law[2];
        double part;
        if (w <= LEAST_LOAD) continue;
        if (law[0] != 0.0) {
            part = a * w * (b - 0.5 * log(w));
            *compliance += part / w - 0.5 * a;
        } else {
            part = a * exp(b * log(w));
            *compliance += b * part / w;
        }
        approach += part;
    }
    return approach;
}

/* Mean of a row of the table by the weights of 3 x 3 speeds and temperatures: number m of `numbers` in each. */
EHD_INLINE double mixed(const double *values, int64_t temperatures, int64_t numbers, const node *i, const node *j,
                    int64_t m) {
    double sum = 0.0;
    for (int a = 0; a < 3; a++) {
        const double *row = values + ((i->first + a) * temperatures + j->first) * numbers + m;
        sum += i->weight[a] *
               (j->weight[0] * row[0] + j->weight[1] * row[numbers] + j->weight[2] * row[2 * numbers]);
    }
    return sum;
}

static void place_of(const ehd_law_table *table, double log_speed, double T, node *i, node *j) {
    *i = node_of((log_speed - table->log_speed_start) * table->log_speed_step, table->speeds);
    *j = node_of((1.0 / (T - COLDEST) - table->temperature_start) * table->temperature_step, table->temperatures);
}

/* Nodes beside a place of an axis, which has one every `stride` numbers, and the weight of the second one. */
static double beside(const double *nodes, int64_t stride, int64_t count, double x, int64_t *first, int64_t *second) {
    int64_t i = 0;
    *first = *second = x > nodes[0] ? count - 1 : 0;
    if (!(x > nodes[0]) || x >= nodes[stride * (count - 1)]) return 0.0;
    while (nodes[stride * (i + 1)] <= x) i++;
    *first = i;
    *second = i + 1;
    return (x - nodes[stride * i]) / (nodes[stride * (i + 1)] - nodes[stride * i]);
}

/* Highest mapped load at a speed and temperature: its logarithm is straight over ln u and T. */
static double end_at(const ehd_law_data *D, double log_speed, double T) {
    int64_t i, j, up, on;
    const int64_t columns = D->end_columns;
    const double a = beside(D->ends + columns, columns, D->end_rows - 1, log_speed, &i, &up);
    const double b = beside(D->ends + 1, 1, columns - 1, T, &j, &on);
    const double *row = D->ends + (i + 1) * columns + 1, *next = D->ends + (up + 1) * columns + 1, corner = row[j];
    if (row[on] == corner && next[j] == corner && next[on] == corner) return corner;
    const double low = (1.0 - b) * log(corner) + b * log(row[on]);
    const double high = (1.0 - b) * log(next[j]) + b * log(next[on]);
    return exp((1.0 - a) * low + a * high);
}

/* Cubics of so many cells of a table, at most CUBICS, from one of them on, at one speed and temperature. */
EHD_CLONES static void write_cubics(const ehd_law_table *table, const node *i, const node *j, int64_t first,
                                    int64_t count, double (*cell)[2][4]) {
    const int64_t numbers = 2 * table->places;
    double c[2 * (CUBICS + 3)];
    for (int64_t m = 0; m < 2 * (count + 3); m++)
        c[m] = mixed(table->coefficients, table->temperatures, numbers, i, j, 2 * first + m);
    for (int64_t k = 0; k < count; k++) {
        for (int f = 0; f < 2; f++) {
            const double *at = c + 2 * k + f;
            cell[k][f][0] = (at[0] + 4.0 * at[2] + at[4]) / 6.0;
            cell[k][f][1] = 0.5 * (at[4] - at[0]);
            cell[k][f][2] = 0.5 * (at[0] + at[4]) - at[2];
            cell[k][f][3] = (at[6] - at[0]) / 6.0 + 0.5 * (at[2] - at[4]);
        }
    }
}

/* A table at one speed and temperature; its cells go to a place in memory. Returns the first byte after them. */
static uintptr_t collapse(const ehd_law_table *table, double log_speed, double T, ehd_line *line, uintptr_t at) {
    node i, j;
    place_of(table, log_speed, T, &i, &j);
    line->offset = mixed(table->place, table->temperatures, 2, &i, &j, 0);
    line->inverse_scale = mixed(table->place, table->temperatures, 2, &i, &j, 1);
    line->start = table->start;
    line->step = table->step;
    line->cells = cells_of(table);
    line->to_cells = (int64_t)(at - (uintptr_t)line);
    for (int64_t first = 0; first < line->cells; first += CUBICS)
        write_cubics(table, &i, &j, first, line->cells - first < CUBICS ? line->cells - first : CUBICS,
                     line_cells(line) + first);
    return at + (uintptr_t)(line->cells * CELL_SIZE);
}

/* Value of a cubic at a place t of its cell, and its slope by t. */
static double cubic_at(const double a[4], double t, double *slope) {
    *slope = a[1] + t * (2.0 * a[2] + 3.0 * t * a[3]);
    return a[0] + t * (a[1] + t * (a[2] + t * a[3]));
}

/* State of a line at an approach, and the second derivative of its load. */
static contact_state bent_state(const ehd_line *line, double approach, double *curvature) {
    const double z = (approach - line->offset) * line->inverse_scale;
    double ds, dg, dlog_ratio;
    const double s = stretched(z, &ds);
    const double x = place_within((s - line->start) * line->step, line->cells);
    const int cell = cell_of(x, line->cells);
    const double t = x - cell, per_s = ds * line->inverse_scale, scale = line->step * per_s;
    const double(*cubics)[4] = (const double(*)[4])line_cells(line)[cell];
    const double g = most(cubic_at(cubics[0], t, &dg), 0.0);
    const double log_ratio = cubic_at(cubics[1], t, &dlog_ratio);
    const double slope = dg * scale, per_cell = 2.0 * cubics[0][2] + 6.0 * t * cubics[0][3];
    const double bend = per_cell * scale * scale - slope * z * ds * per_s;
    *curvature = 3.0 * g * (2.0 * slope * slope + g * bend);
    return state_of(g, slope, log_ratio, dlog_ratio * scale);
}

/* State of a line at an approach. */
static contact_state line_state(const ehd_line *line, double approach) {
    double curvature;
    return bent_state(line, approach, &curvature);
}

/* State of a table at one place, without making a line of it. */
static contact_state table_state(const ehd_law_table *table, double approach, double log_speed, double T) {
    node i, j;
    double ds, value[2] = {0.0, 0.0}, slope[2] = {0.0, 0.0};
    const int64_t cells = cells_of(table);
    place_of(table, log_speed, T, &i, &j);
    const double offset = mixed(table->place, table->temperatures, 2, &i, &j, 0);
    const double inverse_scale = mixed(table->place, table->temperatures, 2, &i, &j, 1);
    const double s = stretched((approach - offset) * inverse_scale, &ds);
    const double x = place_within((s - table->start) * table->step, cells);
    const int cell = cell_of(x, cells);
    const double t = x - cell, r = 1.0 - t, scale = table->step * ds * inverse_scale;
    const double spline[4] = {r * r * r / 6.0, 2.0 / 3.0 - t * t * (1.0 - 0.5 * t), 2.0 / 3.0 - r * r * (1.0 - 0.5 * r),
                              t * t * t / 6.0};
    const double change[4] = {-0.5 * r * r, t * (1.5 * t - 2.0), -r * (1.5 * r - 2.0), 0.5 * t * t};
    for (int n = 0; n < 4; n++) {
        for (int f = 0; f < 2; f++) {
            const double c =
                mixed(table->coefficients, table->temperatures, 2 * table->places, &i, &j, 2 * (cell + n) + f);
            value[f] += spline[n] * c;
            slope[f] += change[n] * c;
        }
    }
    return state_of(value[0], slope[0] * scale, value[1], slope[1] * scale);
}

/* Load of a line at an approach, and its slope: all that an equilibrium of contacts asks for. */
static double line_load(const ehd_line *line, double approach, double *slope) {
    double ds, dg;
    const double s = stretched((approach - line->offset) * line->inverse_scale, &ds);
    const double x = place_within((s - line->start) * line->step, line->cells);
    const int cell = cell_of(x, line->cells);
    const double g = most(cubic_at(line_cells(line)[cell][0], x - cell, &dg), 0.0);
    *slope = 3.0 * g * g * (dg * (line->step * ds * line->inverse_scale));
    return g * g * g;
}

/* Approach at which a line carries a load [m]; for zero the highest one without. */
static double line_approach(const ehd_line *line, double load) {
    const double wanted = pow(load, 1.0 / 3.0);
    double(*cell)[2][4] = line_cells(line);
    int64_t low = 0, high = line->cells;
    while (high - low > 1) {
        const int64_t middle = (low + high) / 2;
        if (cell[middle][0][0] <= wanted)
            low = middle;
        else
            high = middle;
    }
    /* Newton's method within a closing bracket. */
    double left = 0.0, right = 1.0, t = 0.5;
    for (int n = 0; n < MOST_STEPS; n++) {
        double slope;
        const double g = cubic_at(cell[low][0], t, &slope);
        if (g > wanted)
            right = t;
        else
            left = t;
        double following = slope > 0.0 ? t - (g - wanted) / slope : -1.0;
        if (!(left <= following && following <= right)) following = 0.5 * (left + right);
        const double moved = fabs(following - t);
        t = following;
        if (moved < 1e-15) break;
    }
    return line->offset + sinh(line->start + (low + t) / line->step) / line->inverse_scale;
}

/* Approach of the inner contact of two in equilibrium, the part that it takes of a growing approach of both, and how that
 * part changes; the part is zero where nothing is known. */
typedef struct division {
    double inner, part, change;
} division;

/* Division to begin with at an approach, where no neighbour's is known. */
static double first_division(const ehd_law_point *point, double approach) {
    const ehd_line *inner = &point->inner, *outer = &point->outer;
    const double high = approach - point->outer_start;
    double di, dwo;
    const double wi = line_load(inner, high, &di);
    if (wi < 0.3 * point->centrifugal_load) { /* the outer contact hardly moves */
        line_load(outer, point->outer_start, &dwo);
        return high - wi / (di + dwo);
    }
    /* both alike, as their scales are */
    const double share = outer->inverse_scale / (inner->inverse_scale + outer->inverse_scale);
    return inner->offset + (approach - inner->offset - outer->offset) * share;
}

/* State of two contacts in equilibrium from those of each and the second derivatives of their loads; how the approach
 * divides, but for the approach itself. */
EHD_INLINE contact_state joined(const contact_state *i, double curve_i, const contact_state *o, double curve_o,
                                division *divided) {
    const double sum = i->dw + o->dw, part_i = o->dw / sum, part_o = i->dw / sum;
    const double change = (curve_o * part_o * i->dw - o->dw * curve_i * part_i) / (sum * sum);
    contact_state found;
    found.w = i->w;
    found.dw = i->dw * part_i;
    found.ratio = i->ratio * part_i * part_i + o->w / i->w * o->ratio * part_o * part_o;
    found.dc = i->dc * part_i * part_i * part_i + o->dc * part_o * part_o * part_o +
               2.0 * change * (i->w * i->ratio * part_i - o->w * o->ratio * part_o);
    divided->part = part_i;
    divided->change = change;
    return found;
}

/* State of a roller between its two contacts, the outer one of which carries the centrifugal load q besides.
 *
 * The approach divides into a and approach - a so that W_inner(a) + q = W_outer(approach - a): Newton's method in the
 * logarithm of the loads, within a closing bracket. `divided` is what is known of the division, and becomes what it is. */
static contact_state balanced_state(const ehd_law_point *point, double approach, division *divided) {
    const ehd_line *inner = &point->inner, *outer = &point->outer;
    const double q = point->centrifugal_load;
    double low = point->inner_lift_off, high = approach - point->outer_start, curve_i, curve_o;
    double a = divided->part > 0.0 ? divided->inner : NAN;
    int last = 0;
    divided->part = 0.0;
    if (approach <= point->lift_off) return NO_LOAD;
    if (!(low <= a && a <= high)) a = first_division(point, approach);
    for (int n = 0; n < MOST_STEPS; n++) {
        double di, dwo;
        if (!(low <= a && a <= high)) a = 0.5 * (low + high);
        if (last) break;
        const double wi = line_load(inner, a, &di), wo = line_load(outer, approach - a, &dwo);
        if (wo <= 0.0) {
            high = a;
            a = 0.5 * (low + high);
            continue;
        }
        const double excess = log((wi + q) / wo);
        if (excess > 0.0)
            high = a;
        else
            low = a;
        a -= excess / (di / (wi + q) + dwo / wo);
        last = fabs(excess) <= CLOSE_LOADS;
    }
    const contact_state i = bent_state(inner, a, &curve_i), o = bent_state(outer, approach - a, &curve_o);
    if (i.w < LEAST_LOAD || o.w < LEAST_LOAD) return NO_LOAD;
    divided->inner = a;
    return joined(&i, curve_i, &o, curve_o, divided);
}

/* State with the whole film. */
static contact_state full_state(const ehd_law_point *point, double approach) {
    division divided = {0.0, 0.0, 0.0};
    if (point->centrifugal_load > 0.0) return balanced_state(point, approach, &divided);
    return line_state(&point->own, approach);
}

/* State with a part of the film, below the lowest mapped speed: film offset and c at equal load are that part of the
 * whole ones. With the approach y of the whole film, (1 - part) E(w(y)) + part y = approach, E that of the structure. */
static contact_state faded_state(const ehd_law_point *point, double approach) {
    const ehd_law_data *D = point->data;
    const double part = point->film, q = point->centrifugal_load;
    const double offset = point->own.offset, scale = 1.0 / point->own.inverse_scale;
    double compliance, ds, slope = 1.0;
    int last = 0;
    contact_state found = NO_LOAD;
    if (approach <= (1.0 - part) * structural_approach(D, q, 0.0, &compliance) + part * point->lift_off) return NO_LOAD;
    double low = stretched((point->lift_off - offset) * point->own.inverse_scale, &ds);
    double high = most(stretched((approach - offset) * point->own.inverse_scale, &ds), low), place = high;
    for (int n = 0; n < MOST_STEPS; n++) {
        const double growth = exp(least(most(place, -700.0), 700.0));
        const double y = offset + 0.5 * scale * (growth - 1.0 / growth);
        found = full_state(point, y);
        const double dry = structural_approach(D, q, found.w, &compliance);
        const double excess = (1.0 - part) * dry + part * y - approach;
        slope = part;
        if (found.w > 0.0) slope += (1.0 - part) * compliance * found.dw;
        if (last) break;
        if (excess > 0.0) {
            high = place;
        } else {
            low = place;
            if (place >= high) high = place + 1.0; /* only a table's error makes y larger than the approach */
        }
        const double per_place = 0.5 * slope * scale * (growth + 1.0 / growth);
        double following = per_place > 0.0 ? place - excess / per_place : low - 1.0;
        if (!(low <= following && following <= high)) following = 0.5 * (low + high);
        last = fabs(following - place) <= 1e-9;
        place = following;
    }
    if (found.w < LEAST_LOAD) return NO_LOAD;
    found.dw /= slope;
    found.ratio *= part;
    found.dc *= part / slope;
    return found;
}

/* State at rest, as if the law went on above the highest load. */
static contact_state rest_state(const ehd_law_point *point, double approach) {
    return point->film < 1.0 ? faded_state(point, approach) : full_state(point, approach);
}

/* State at rest: above the held load the law is its tangent. */
static contact_state held_state(const ehd_law_point *point, double approach) {
    contact_state found;
    if (approach <= point->held_approach) return rest_state(point, approach);
    found.w = point->held_load + point->held_stiffness * (approach - point->held_approach);
    found.dw = point->held_stiffness;
    found.ratio = point->held_damping / found.w;
    found.dc = 0.0;
    return found;
}

/* Part of the film that is there: 0 at standstill, 1 from `film_speed` on. */
static double film_part(const ehd_law_data *D, double speed) {
    const double part = speed >= D->film_speed ? 1.0 : speed / D->film_speed;
    return part * part * part * (10.0 - part * (15.0 - 6.0 * part));
}

/* Which of speed and temperature lie outside the map. */
static int outside_map(const ehd_law_data *D, double speed, double T) {
    int status = EHD_OK;
    if (speed > D->counted_speed * (1.0 + EDGE_TOLERANCE)) status |= EHD_ABOVE_SPEED;
    if (!(D->counted_cold * (1.0 - EDGE_TOLERANCE) <= T && T <= D->counted_hot * (1.0 + EDGE_TOLERANCE)))
        status |= EHD_OUTSIDE_TEMPERATURE;
    return status;
}

int ehd_law_make(const ehd_law_data *D, double u, double T, double q, ehd_law_point *point) {
    double compliance, held, log_speed, end, held_load;
    if (!point) return EHD_BAD_ARGUMENT;
    point->data = D;
    point->entrainment_speed = fabs(u);
    point->temperature = T;
    point->centrifugal_load = q;
    if (!(is_finite(u) && is_finite(T) && is_finite(q)))
        point->status = EHD_NOT_FINITE;
    else if (q < 0.0 || q >= D->highest_load || (q > 0.0 && !D->centrifugal))
        point->status = EHD_BAD_CENTRIFUGAL;
    else
        point->status = outside_map(D, fabs(u), T);
    if (refuses(D, (int)point->status)) return (int)point->status;
    T = least(most(T, D->lowest_temperature), D->highest_temperature);
    log_speed = log(most(least(fabs(u), D->highest_speed), D->lowest_speed));
    point->film = film_part(D, least(fabs(u), D->highest_speed));
    end = end_at(D, log_speed, T);
    held_load = D->held_load * (end / D->highest_load);
    if (q >= (refuses(D, EHD_BAD_CENTRIFUGAL) ? end : held_load)) { /* as where points of the map are missing */
        point->status |= EHD_BAD_CENTRIFUGAL;
        if (refuses(D, (int)point->status)) return (int)point->status;
        point->centrifugal_load = q = 0.5 * held_load;
    }
    point->highest_load = end - q;
    point->held_load = held_load - q;
    uintptr_t at = collapse(&D->own, log_speed, T, &point->own, (uintptr_t)(point + 1));
    point->inner_lift_off = point->outer_start = 0.0;
    point->lift_off = line_approach(&point->own, 0.0);
    if (q > 0.0) {
        at = collapse(&D->inner, log_speed, T, &point->inner, at);
        collapse(&D->outer, log_speed, T, &point->outer, at);
        point->inner_lift_off = line_approach(&point->inner, 0.0);
        point->outer_start = line_approach(&point->outer, q);
        point->lift_off = point->inner_lift_off + point->outer_start;
        held = line_approach(&point->inner, point->held_load) + line_approach(&point->outer, point->held_load + q);
    } else {
        held = line_approach(&point->own, point->held_load);
    }
    point->held_approach =
        (1.0 - point->film) * structural_approach(D, q, point->held_load, &compliance) + point->film * held;
    point->held_stiffness = 1.0 / compliance;
    point->held_damping = rest_state(point, point->held_approach).ratio * point->held_load;
    return (int)point->status;
}

/* Finish a call: what is refused, or is not finite after all, is NaN. */
static int settled(const ehd_law_data *D, int status, ehd_force *force) {
    if (!(is_finite(force->load) && is_finite(force->stiffness) && is_finite(force->damping))) status |= EHD_NOT_FINITE;
    if (refuses(D, status)) no_force(force);
    return status;
}

/* Force at a point, of finite numbers; whether the load is above the map. */
static int point_force(const ehd_law_point *point, double approach, double rate, ehd_force *force) {
    const contact_state found = held_state(point, approach);
    force->load = force->stiffness = force->damping = 0.0;
    if (found.w <= 0.0) return EHD_OK;
    unilateral(found.w, found.dw, found.w * found.ratio, found.dc, rate, force);
    return found.w > point->highest_load * (1.0 + LOAD_TOLERANCE) ? EHD_ABOVE_LOAD : EHD_OK;
}

int ehd_law_force(const ehd_law_point *point, double approach, double rate, ehd_force *force) {
    if (!point || !force) return EHD_BAD_ARGUMENT;
    const ehd_law_data *D = point->data;
    const int status = (int)point->status;
    no_force(force);
    if (refuses(D, status)) return status;
    if (!(is_finite(approach) && is_finite(rate))) return status | EHD_NOT_FINITE;
    return settled(D, status | point_force(point, approach, rate, force), force);
}

int ehd_law_call(const ehd_law_data *D, double approach, double rate, double u, double T, double q,
                 ehd_law_point *room, ehd_force *force) {
    const double speed = fabs(u);
    if (!force) return EHD_BAD_ARGUMENT;
    no_force(force);
    if (!(is_finite(approach) && is_finite(rate) && is_finite(u) && is_finite(T) && is_finite(q))) return EHD_NOT_FINITE;
    if (D->film_speed <= speed && D->lowest_speed <= speed && speed <= D->counted_speed && D->counted_cold <= T &&
        T <= D->counted_hot && q == 0.0) {
        const contact_state found = table_state(&D->own, approach, log(speed), T);
        if (found.w <= D->known_load) {
            unilateral(found.w, found.dw, found.w * found.ratio, found.dc, rate, force);
            return settled(D, EHD_OK, force);
        }
    }
    const int status = ehd_law_make(D, u, T, q, room);
    if (refuses(D, status)) return status;
    return ehd_law_force(room, approach, rate, force);
}

double ehd_law_approach(const ehd_law_point *point, double load) {
    const double q = point->centrifugal_load;
    if (q > 0.0) return line_approach(&point->inner, load) + line_approach(&point->outer, load + q);
    return line_approach(&point->own, load);
}
