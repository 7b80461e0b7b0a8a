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

static double least(double a, double b) { return a < b ? a : b; }

static double most(double a, double b) { return a > b ? a : b; }

static int is_finite(double x) { return fabs(x) <= DBL_MAX; }

static void no_force(ehd_force *force) { force->load = force->stiffness = force->damping = NAN; }

const char *ehd_status_text(int status) {
    if (status & EHD_BAD_ARGUMENT) return "an argument that is not allowed";
    if (status & EHD_NOT_FINITE) return "numbers that are not finite";
    if (status & EHD_TOO_FAR) return "a pose beyond reason: check its units";
    if (status & EHD_BAD_CENTRIFUGAL) return "a centrifugal load that is not allowed";
    if (status & EHD_ABOVE_LOAD) return "a load above the map";
    if (status & EHD_ABOVE_SPEED) return "an entrainment speed above the map";
    if (status & EHD_OUTSIDE_TEMPERATURE) return "a temperature outside the map";
    return "no problem";
}

size_t ehd_point_size(void) { return sizeof(ehd_point); }

/* Place in steps from the first node, held to so many cells; zero for NaN. */
static double place_within(double x, int cells) {
    x = x > 0.0 ? x : 0.0;
    return x < (double)cells ? x : (double)cells;
}

static int cell_of(double x, int cells) {
    const int last = cells > 1 ? cells - 1 : 0, cell = (int)x;
    return cell < last ? cell : last;
}

static node node_of(double place, int nodes) {
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
 * carries a centrifugal load q besides. */
static double structural_approach(double q, double load, double *compliance) {
    double approach = 0.0;
    *compliance = 0.0;
    for (int i = 0; i < EHD_CONTACTS; i++) {
        const double w = i == EHD_CONTACTS - 1 ? load + q : load, a = STRUCTURE[i].a, b = STRUCTURE[i].b;
        double part;
        if (w <= LEAST_LOAD) continue;
        if (STRUCTURE[i].half_space) {
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
static double mixed(const double *values, int temperatures, int numbers, const node *i, const node *j, int m) {
    double sum = 0.0;
    for (int a = 0; a < 3; a++) {
        const double *row = values + ((size_t)(i->first + a) * temperatures + j->first) * numbers + m;
        sum += i->weight[a] *
               (j->weight[0] * row[0] + j->weight[1] * row[numbers] + j->weight[2] * row[2 * (size_t)numbers]);
    }
    return sum;
}

static void place_of(const axes *table, double log_speed, double T, node *i, node *j) {
    *i = node_of((log_speed - table->log_speed_start) * table->log_speed_step, table->speeds);
    *j = node_of((1.0 / (T - COLDEST) - table->temperature_start) * table->temperature_step, table->temperatures);
}

/* Nodes beside a place of an axis, and the weight of the second one. */
static double beside(const double *nodes, int count, double x, int *first, int *second) {
    int i = 0;
    *first = *second = x > nodes[0] ? count - 1 : 0;
    if (!(x > nodes[0]) || x >= nodes[count - 1]) return 0.0;
    while (nodes[i + 1] <= x) i++;
    *first = i;
    *second = i + 1;
    return (x - nodes[i]) / (nodes[i + 1] - nodes[i]);
}

/* Highest mapped load at a speed and temperature: its logarithm is straight over ln u and T. */
static double end_at(double log_speed, double T) {
    int i, j, up, on;
    const double a = beside(END_LOG_SPEEDS, END_SPEEDS, log_speed, &i, &up);
    const double b = beside(END_KELVINS, END_TEMPERATURES, T, &j, &on);
    const double corner = ENDS[i][j];
    double low, high;
    if (ENDS[i][on] == corner && ENDS[up][j] == corner && ENDS[up][on] == corner) return corner;
    low = (1.0 - b) * log(corner) + b * log(ENDS[i][on]);
    high = (1.0 - b) * log(ENDS[up][j]) + b * log(ENDS[up][on]);
    return exp((1.0 - a) * low + a * high);
}

/* A table at one speed and temperature. */
static void collapse(const axes *table, double log_speed, double T, ehd_line *line) {
    node i, j;
    const int numbers = 2 * table->places;
    double c[4][2];
    place_of(table, log_speed, T, &i, &j);
    line->offset = mixed(table->place, table->temperatures, 2, &i, &j, 0);
    line->inverse_scale = mixed(table->place, table->temperatures, 2, &i, &j, 1);
    line->start = table->start;
    line->step = table->step;
    line->cells = table->places - 3;
    for (int k = 0; k < table->places; k++) {
        for (int f = 0; f < 2; f++) {
            for (int n = 0; n < 3; n++) c[n][f] = c[n + 1][f];
            c[3][f] = mixed(table->coefficients, table->temperatures, numbers, &i, &j, 2 * k + f);
            if (k < 3) continue;
            double *cubic = line->cell[k - 3][f];
            cubic[0] = (c[0][f] + 4.0 * c[1][f] + c[2][f]) / 6.0;
            cubic[1] = 0.5 * (c[2][f] - c[0][f]);
            cubic[2] = 0.5 * (c[0][f] + c[2][f]) - c[1][f];
            cubic[3] = (c[3][f] - c[0][f]) / 6.0 + 0.5 * (c[1][f] - c[2][f]);
        }
    }
}

/* Value of a cubic at a place t of its cell, and its slope by t. */
static double cubic_at(const double a[4], double t, double *slope) {
    *slope = a[1] + t * (2.0 * a[2] + 3.0 * t * a[3]);
    return a[0] + t * (a[1] + t * (a[2] + t * a[3]));
}

/* State of a line at an approach. */
static contact_state line_state(const ehd_line *line, double approach) {
    double ds, dg, dlog_ratio;
    const double s = stretched((approach - line->offset) * line->inverse_scale, &ds);
    const double x = place_within((s - line->start) * line->step, line->cells);
    const int cell = cell_of(x, line->cells);
    const double scale = line->step * ds * line->inverse_scale;
    const double g = cubic_at(line->cell[cell][0], x - cell, &dg);
    const double log_ratio = cubic_at(line->cell[cell][1], x - cell, &dlog_ratio);
    return state_of(g, dg * scale, log_ratio, dlog_ratio * scale);
}

/* State of a table at one place, without making a line of it. */
static contact_state table_state(const axes *table, double approach, double log_speed, double T) {
    node i, j;
    double ds, value[2] = {0.0, 0.0}, slope[2] = {0.0, 0.0};
    const int cells = table->places - 3;
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

/* Approach at which a line carries a load [m]; for zero the highest one without. */
static double line_approach(const ehd_line *line, double load) {
    const double wanted = pow(load, 1.0 / 3.0);
    int low = 0, high = line->cells;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (line->cell[middle][0][0] <= wanted)
            low = middle;
        else
            high = middle;
    }
    /* Newton's method within a closing bracket. */
    double left = 0.0, right = 1.0, t = 0.5;
    for (int n = 0; n < MOST_STEPS; n++) {
        double slope;
        const double g = cubic_at(line->cell[low][0], t, &slope);
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

#if EHD_HAS_CENTRIFUGAL
/* Second derivative of the load of a line by the approach, where it carries load. */
static double line_curvature(const ehd_line *line, double approach, double dw) {
    const double z = (approach - line->offset) * line->inverse_scale;
    double ds, slope;
    const double s = stretched(z, &ds);
    const double x = place_within((s - line->start) * line->step, line->cells);
    const int cell = cell_of(x, line->cells);
    const double *a = line->cell[cell][0];
    const double g = cubic_at(a, x - cell, &slope), dg = dw / (3.0 * g * g);
    const double per_s = ds * line->inverse_scale, per_cell = line->step * per_s;
    const double ddg = (2.0 * a[2] + 6.0 * (x - cell) * a[3]) * per_cell * per_cell - dg * z * ds * per_s;
    return 6.0 * g * dg * dg + 3.0 * g * g * ddg;
}

/* State of a roller between its two contacts, the outer one of which carries the centrifugal load q besides.
 *
 * The approach divides into a and approach - a so that W_inner(a) + q = W_outer(approach - a): Newton's method in the
 * logarithm of the loads, within a closing bracket. */
static contact_state balanced_state(const ehd_point *point, double approach) {
    const ehd_line *inner = &point->inner, *outer = &point->outer;
    const double q = point->centrifugal_load, scale = 1.0 / inner->inverse_scale;
    if (approach <= point->lift_off) return NO_LOAD;
    double low = line_approach(inner, 0.0), high = approach - line_approach(outer, q), a;
    contact_state i = line_state(inner, high), o = line_state(outer, point->outer_start);
    int last = 0;
    if (i.w < 0.3 * q) { /* the outer contact hardly moves */
        a = high - i.w / (i.dw + o.dw);
    } else { /* both alike, as their scales are */
        const double share = outer->inverse_scale / (inner->inverse_scale + outer->inverse_scale);
        a = inner->offset + (approach - inner->offset - outer->offset) * share;
    }
    for (int n = 0; n < MOST_STEPS; n++) {
        if (!(low <= a && a <= high)) a = 0.5 * (low + high);
        i = line_state(inner, a);
        o = line_state(outer, approach - a);
        if (last) break;
        if (o.w <= 0.0) {
            high = a;
            a = 0.5 * (low + high);
            continue;
        }
        const double excess = log((i.w + q) / o.w);
        if (excess > 0.0)
            high = a;
        else
            low = a;
        const double step = excess / (i.dw / (i.w + q) + o.dw / o.w);
        a -= step;
        last = fabs(step) <= 1e-9 * (fabs(a) + scale);
    }
    if (i.w < LEAST_LOAD || o.w < LEAST_LOAD) return NO_LOAD;
    const double sum = i.dw + o.dw, part_i = o.dw / sum, part_o = i.dw / sum;
    const double bend_i = line_curvature(inner, a, i.dw) * part_i;
    const double bend_o = line_curvature(outer, approach - a, o.dw) * part_o;
    const double change = (bend_o * i.dw - o.dw * bend_i) / (sum * sum);
    contact_state found;
    found.w = i.w;
    found.dw = i.dw * part_i;
    found.ratio = i.ratio * part_i * part_i + o.w / i.w * o.ratio * part_o * part_o;
    found.dc = i.dc * part_i * part_i * part_i + o.dc * part_o * part_o * part_o +
               2.0 * change * (i.w * i.ratio * part_i - o.w * o.ratio * part_o);
    return found;
}
#endif

/* State with the whole film. */
static contact_state full_state(const ehd_point *point, double approach) {
#if EHD_HAS_CENTRIFUGAL
    if (point->centrifugal_load > 0.0) return balanced_state(point, approach);
#endif
    return line_state(&point->own, approach);
}

/* State with a part of the film, below the lowest mapped speed: film offset and c at equal load are that part of the
 * whole ones. With the approach y of the whole film, (1 - part) E(w(y)) + part y = approach, E that of the structure. */
static contact_state faded_state(const ehd_point *point, double approach) {
    const double part = point->film, q = point->centrifugal_load;
    const double offset = point->own.offset, scale = 1.0 / point->own.inverse_scale;
    double compliance, ds, slope = 1.0;
    int last = 0;
    contact_state found = NO_LOAD;
    if (approach <= (1.0 - part) * structural_approach(q, 0.0, &compliance) + part * point->lift_off) return NO_LOAD;
    double low = stretched((point->lift_off - offset) * point->own.inverse_scale, &ds);
    double high = most(stretched((approach - offset) * point->own.inverse_scale, &ds), low), place = high;
    for (int n = 0; n < MOST_STEPS; n++) {
        const double growth = exp(least(most(place, -700.0), 700.0));
        const double y = offset + 0.5 * scale * (growth - 1.0 / growth);
        found = full_state(point, y);
        const double dry = structural_approach(q, found.w, &compliance);
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
static contact_state rest_state(const ehd_point *point, double approach) {
    return point->film < 1.0 ? faded_state(point, approach) : full_state(point, approach);
}

/* State at rest: above the held load the law is its tangent. */
static contact_state held_state(const ehd_point *point, double approach) {
    contact_state found;
    if (approach <= point->held_approach) return rest_state(point, approach);
    found.w = point->held_load + point->held_stiffness * (approach - point->held_approach);
    found.dw = point->held_stiffness;
    found.ratio = point->held_damping / found.w;
    found.dc = 0.0;
    return found;
}

/* Part of the film that is there: 0 at standstill, 1 from `FILM_SPEED` on. */
static double film_part(double speed) {
    const double part = speed >= FILM_SPEED ? 1.0 : speed / FILM_SPEED;
    return part * part * part * (10.0 - part * (15.0 - 6.0 * part));
}

/* Which of speed and temperature lie outside the map. */
static int outside_map(double speed, double T) {
    int status = EHD_OK;
    if (speed > EHD_HIGHEST_SPEED * (1.0 + EDGE_TOLERANCE)) status |= EHD_ABOVE_SPEED;
    if (!(EHD_LOWEST_TEMPERATURE * (1.0 - EDGE_TOLERANCE) <= T && T <= EHD_HIGHEST_TEMPERATURE * (1.0 + EDGE_TOLERANCE)))
        status |= EHD_OUTSIDE_TEMPERATURE;
    return status;
}

int ehd_at(ehd_point *point, double u, double T, double q) {
    double compliance, held, log_speed, end;
    if (!point) return EHD_BAD_ARGUMENT;
    point->entrainment_speed = fabs(u);
    point->temperature = T;
    point->centrifugal_load = q;
    if (!(is_finite(u) && is_finite(T) && is_finite(q)))
        point->status = EHD_NOT_FINITE;
    else if (q < 0.0 || q >= EHD_HIGHEST_LOAD || (q > 0.0 && !EHD_HAS_CENTRIFUGAL))
        point->status = EHD_BAD_CENTRIFUGAL;
    else
        point->status = outside_map(fabs(u), T);
    if (EHD_REFUSES(point->status)) return point->status;
    T = least(most(T, LOWEST_TEMPERATURE), HIGHEST_TEMPERATURE);
    log_speed = log(most(least(fabs(u), HIGHEST_SPEED), LOWEST_SPEED));
    point->film = film_part(least(fabs(u), HIGHEST_SPEED));
    end = end_at(log_speed, T);
    if (q >= end) {
        point->status |= EHD_BAD_CENTRIFUGAL;
        return point->status;
    }
    point->highest_load = end - q;
    point->held_load = HELD_LOAD * (end / EHD_HIGHEST_LOAD) - q;
    collapse(&OWN, log_speed, T, &point->own);
    point->inner_lift_off = point->outer_start = 0.0;
    point->lift_off = line_approach(&point->own, 0.0);
#if EHD_HAS_CENTRIFUGAL
    if (q > 0.0) {
        collapse(&INNER, log_speed, T, &point->inner);
        collapse(&OUTER, log_speed, T, &point->outer);
        point->inner_lift_off = line_approach(&point->inner, 0.0);
        point->outer_start = line_approach(&point->outer, q);
        point->lift_off = point->inner_lift_off + point->outer_start;
        held = line_approach(&point->inner, point->held_load) + line_approach(&point->outer, point->held_load + q);
    } else
#endif
        held = line_approach(&point->own, point->held_load);
    point->held_approach =
        (1.0 - point->film) * structural_approach(q, point->held_load, &compliance) + point->film * held;
    point->held_stiffness = 1.0 / compliance;
    point->held_damping = rest_state(point, point->held_approach).ratio * point->held_load;
    return point->status;
}

/* Finish a call: what is refused, or is not finite after all, is NaN. */
static int settled(int status, ehd_force *force) {
    if (!(is_finite(force->load) && is_finite(force->stiffness) && is_finite(force->damping))) status |= EHD_NOT_FINITE;
    if (EHD_REFUSES(status)) no_force(force);
    return status;
}

int ehd_law_at(const ehd_point *point, double approach, double rate, ehd_force *force) {
    contact_state found;
    if (!point || !force) return EHD_BAD_ARGUMENT;
    int status = point->status;
    no_force(force);
    if (EHD_REFUSES(status)) return status;
    if (!(is_finite(approach) && is_finite(rate))) return status | EHD_NOT_FINITE;
    found = held_state(point, approach);
    if (found.w <= 0.0) {
        force->load = force->stiffness = force->damping = 0.0;
        return status;
    }
    if (found.w > point->highest_load * (1.0 + LOAD_TOLERANCE)) status |= EHD_ABOVE_LOAD;
    unilateral(found.w, found.dw, found.w * found.ratio, found.dc, rate, force);
    return settled(status, force);
}

int ehd_law(double approach, double rate, double u, double T, double q, ehd_force *force) {
    const double speed = fabs(u);
    ehd_point point;
    if (!force) return EHD_BAD_ARGUMENT;
    no_force(force);
    if (!(is_finite(approach) && is_finite(rate) && is_finite(u) && is_finite(T) && is_finite(q))) return EHD_NOT_FINITE;
    if (FILM_SPEED <= speed && LOWEST_SPEED <= speed && speed <= EHD_HIGHEST_SPEED && EHD_LOWEST_TEMPERATURE <= T &&
        T <= EHD_HIGHEST_TEMPERATURE && q == 0.0) {
        const contact_state found = table_state(&OWN, approach, log(speed), T);
        if (found.w <= KNOWN_LOAD) {
            unilateral(found.w, found.dw, found.w * found.ratio, found.dc, rate, force);
            return settled(EHD_OK, force);
        }
    }
    const int status = ehd_at(&point, u, T, q);
    if (EHD_REFUSES(status)) return status;
    return ehd_law_at(&point, approach, rate, force);
}
