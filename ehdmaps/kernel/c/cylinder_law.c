/* ---------------------------------------------------------------------------------------------------------------------
 * The law made ready for bearings: a table of load and damping over the approach, at one speed, temperature and
 * centrifugal load
 * ------------------------------------------------------------------------------------------------------------------ */

/* Kinds of prepared laws: none yet, a formula, cells at even places around a centre, cells between knots for faded
 * films, and the law itself for each slice where no table reaches down to lift-off. */
enum { UNPREPARED = 0, POWER, CELLS, KNOTS, BY_SLICES };

/* Rows of ehd_cylinder_law.node. */
enum { Z, APPROACH, LOAD, SLOPE, DAMPING, BEND };

size_t ehd_cylinder_law_size(const ehd_law_data *data) {
    return sizeof(ehd_cylinder_law) - sizeof(ehd_law_point) + ehd_law_point_size(data);
}

/* Approach around which a law is finest. */
static double centre_of(const ehd_law_point *point) {
    if (point->centrifugal_load > 0.0) {
        const double load = line_state(&point->inner, point->inner.offset).w + point->centrifugal_load;
        return point->inner.offset + line_approach(&point->outer, load);
    }
    return point->own.offset;
}

/* States of the whole film at all nodes. Above the first node beyond the hold the law goes on straight. Returns the
 * first loaded node; fills approach and damping of the held load. */
static int fill_nodes(ehd_cylinder_law *law, double *held_damping) {
    const ehd_law_point *point = &law->point;
    double *z = law->node[Z], *delta = law->node[APPROACH];
    double *w = law->node[LOAD], *dw = law->node[SLOPE], *c = law->node[DAMPING], *dc = law->node[BEND];
    const double centre = centre_of(point), inverse = point->own.inverse_scale;
    double held = line_approach(&point->own, point->held_load);
    int first = 0, end = 0;
    if (point->centrifugal_load > 0.0)
        held = line_approach(&point->inner, point->held_load) +
               line_approach(&point->outer, point->held_load + point->centrifugal_load);
    for (int i = 0; i < EHD_NODES; i++) {
        z[i] = node_place(i);
        delta[i] = centre + z[i] / inverse;
        if (delta[i] <= point->lift_off) {
            first = i + 1;
            w[i] = dw[i] = c[i] = dc[i] = 0.0;
        }
        if (i > 0 && delta[i - 1] <= held) end = i + 1;
    }
    for (int i = first; i < end; i++) {
        const contact_state found = full_state(point, delta[i]);
        w[i] = found.w;
        dw[i] = found.dw;
        c[i] = found.w * found.ratio;
        dc[i] = found.dc;
    }
    for (int i = end; i > 0 && i < EHD_NODES; i++) {
        w[i] = w[end - 1] + dw[end - 1] * (delta[i] - delta[end - 1]);
        dw[i] = dw[end - 1];
        c[i] = c[end - 1];
        dc[i] = 0.0;
    }
    *held_damping = full_state(point, held).ratio * point->held_load;
    law->held_approach = held;
    return first;
}

/* Cubic through values and slopes at both ends of a cell that is h wide, number f of it. */
static void write_cubic(double cell[4][2], int f, double y0, double y1, double s0, double s1, double by) {
    const double secant = (y1 - y0) * by;
    cell[0][f] = y0;
    cell[1][f] = s0;
    cell[2][f] = (3.0 * secant - 2.0 * s0 - s1) * by;
    cell[3][f] = (s0 + s1 - 2.0 * secant) * by * by;
}

/* Cells of the whole film. Slopes are held so that the load never falls and the damping is never negative. */
static void fill_cells(ehd_cylinder_law *law) {
    const double inverse = law->point.own.inverse_scale;
    const double *z = law->node[Z], *w = law->node[LOAD], *c = law->node[DAMPING];
    double *dw = law->node[SLOPE], *dc = law->node[BEND];
    for (int i = 0; i < EHD_NODES; i++) {
        double slope = most(dw[i] / inverse, 0.0), change = dc[i] / inverse;
        if (i > 0) {
            const double h = z[i] - z[i - 1];
            slope = least(slope, 3.0 * (w[i] - w[i - 1]) / h);
            change = least(change, 3.0 * c[i] / h);
        }
        if (i < EHD_NODES - 1) {
            const double h = z[i + 1] - z[i];
            slope = least(slope, 3.0 * (w[i + 1] - w[i]) / h);
            change = most(change, -3.0 * c[i] / h);
        }
        dw[i] = most(slope, 0.0);
        dc[i] = change;
    }
    for (int k = 0; k < 2 * EHD_ROWS; k++) {
        const int above = k < EHD_ROWS, near = above ? EHD_ROWS + k : 2 * EHD_ROWS - k;
        const int far = above ? near + 1 : near - 1;
        const double by = 1.0 / (z[far] - z[near]);
        write_cubic(law->cell[k], 0, w[near], w[far], dw[near], dw[far], by);
        write_cubic(law->cell[k], 1, c[near], c[far], dc[near], dc[far], by);
    }
}

/* Cells of a part of the film. At equal load the approach is that part of the one with the whole film, and the rest of
 * that without any. So the nodes of the whole film serve all parts, as knots that move. */
static void fill_knots(ehd_cylinder_law *law, double held_damping, double most_load) {
    const ehd_law_point *point = &law->point;
    const ehd_law_data *D = point->data;
    const double part = point->film, rest = 1.0 - part, q = point->centrifugal_load;
    const double *whole = law->node[APPROACH], *w = law->node[LOAD], *c = law->node[DAMPING];
    double *dw = law->node[SLOPE], *dc = law->node[BEND], *knot = law->knot, compliance, safe = 0.0;
    const int last = 2 * EHD_ROWS - 1;
    for (int i = 0; i < last; i++) {
        const int k = i + 1; /* the outermost nodes have no knots */
        const double dry = structural_approach(D, q, w[k], &compliance);
        const double stretch = w[k] > 0.0 ? rest * compliance * dw[k] + part : 1.0;
        knot[i] = rest * dry + part * whole[k];
        dw[k] /= stretch;
        dc[k] *= part / stretch;
        if (w[k] <= most_load) safe = knot[i];
    }
    knot[last] = INFINITY;
    for (int i = 0; i < last - 1; i++) {
        const double h = knot[i + 1] - knot[i];
        /* without film all nodes without load are one */
        const double rise = h > 0.0 ? 3.0 * (w[i + 2] - w[i + 1]) / h : 0.0;
        dw[i + 1] = least(dw[i + 1], rise);
        dw[i + 2] = least(dw[i + 2], rise);
        if (h > 0.0) {
            dc[i + 1] = most(dc[i + 1], -3.0 * part * c[i + 1] / h);
            dc[i + 2] = least(dc[i + 2], 3.0 * part * c[i + 2] / h);
        }
    }
    for (int i = 0; i < last - 1; i++) {
        const double h = knot[i + 1] - knot[i], by = h > 0.0 ? 1.0 / h : 0.0;
        write_cubic(law->cell[i], 0, w[i + 1], w[i + 2], dw[i + 1], dw[i + 2], by);
        write_cubic(law->cell[i], 1, part * c[i + 1], part * c[i + 2], dc[i + 1], dc[i + 2], by);
    }
    memset(law->cell[last - 1], 0, 2 * sizeof law->cell[0]);
    law->safe_approach = safe;
    law->held_approach = rest * structural_approach(D, q, point->held_load, &compliance) + part * law->held_approach;
    law->held_damping = part * held_damping;
}

/* Whether dry contacts in series are one power law, approach = (a_1 + a_2) w^b; fills it. */
static int one_power(ehd_cylinder_law *law) {
    double a = 0.0;
    const ehd_law_data *D = law->point.data;
    const double b = D->structure[2];
    for (int i = 0; i < D->contacts; i++) {
        const double *contact = D->structure + 3 * i;
        if (contact[0] != 0.0 || fabs(contact[2] - b) >= 1e-12) return 0;
        a += contact[1];
    }
    law->coefficient = pow(a, -1.0 / b);
    law->exponent = 1.0 / b;
    return 1;
}

int ehd_cylinder_prepare(const ehd_law_data *data, double u, double T, double q, ehd_cylinder_law *law) {
    double held_damping;
    if (!law) return EHD_BAD_ARGUMENT;
    const ehd_law_point *point = &law->point;
    const int status = ehd_law_make(data, u, T, q, &law->point);
    law->kind = BY_SLICES;
    law->lift_off = -DBL_MAX;
    law->safe_approach = law->held_approach = DBL_MAX;
    law->highest = DBL_MAX; /* the law itself counts its loads */
    law->slope = 1.0;
    law->held_damping = 0.0;
    if (refuses(data, status)) return status;
    const double highest = point->highest_load * (1.0 + LOAD_TOLERANCE), most_load = least(highest, point->held_load);
    if (point->film == 0.0 && q == 0.0 && one_power(law)) {
        law->kind = POWER;
        law->lift_off = 0.0;
        law->highest = highest;
        law->held_approach = point->held_approach;
        law->held_damping = point->held_damping;
        law->safe_approach = least(pow(highest / law->coefficient, 1.0 / law->exponent), point->held_approach);
        return status;
    }
    const double held_approach = law->held_approach;
    const int first = fill_nodes(law, &held_damping), faded = fabs(u) < data->film_speed;
    if (first < (faded ? 2 : 1)) { /* the table does not reach down to lift-off */
        law->held_approach = held_approach;
        return status;
    }
    law->highest = highest;
    if (faded) {
        law->kind = KNOTS;
        fill_knots(law, held_damping, most_load);
        law->lift_off = law->knot[first - 2];
        return status;
    }
    law->kind = CELLS;
    law->centre = centre_of(point);
    law->inverse_scale = law->slope = point->own.inverse_scale;
    law->lift_off = law->node[APPROACH][first - 1];
    law->held_damping = held_damping;
    for (int i = 0; i < EHD_NODES; i++)
        if (i == 0 || law->node[LOAD][i] <= most_load) law->safe_approach = law->node[APPROACH][i];
    fill_cells(law);
    return status;
}
