/* ---------------------------------------------------------------------------------------------------------------------
 * The law of a roller made ready for a bearing; see cylinder_law.h
 * ------------------------------------------------------------------------------------------------------------------ */

/* Bytes of ehd_cylinder_law.marks that hold the cells, behind those of the nodes. */
#define CELL_MARKS(law) ((unsigned char *)(law)->marks + EHD_NODES)
#define NODE_MARKS(law) ((unsigned char *)(law)->marks)

/* Columns of a node of a whole film, and of one of a faded film: approach with the whole film and without [m], growth of
 * the latter by the former; load [N/m] and damping [N s/m2], each with its slope by the approach with the whole film. */
enum { CELL_LOAD, CELL_SLOPE, CELL_DAMPING, CELL_BEND };
enum { FADED_WHOLE, FADED_DRY, FADED_RISE, FADED_LOAD, FADED_SLOPE, FADED_DAMPING, FADED_BEND };

#define ANCHORS 16 /* nodes from one at which an equilibrium of both contacts is sought by itself to the next one */

/* Load above which slices are outside the map. */
static double counted_load(const ehd_law_point *point) { return point->highest_load * (1.0 + LOAD_TOLERANCE); }

/* Approach around which a law is finest. */
static double centre_of(const ehd_law_point *point) {
    if (point->centrifugal_load == 0.0) return point->own.offset;
    const double load = line_state(&point->inner, point->inner.offset).w + point->centrifugal_load;
    return point->inner.offset + line_approach(&point->outer, load);
}

/* Approach at which a point with its whole film carries a load. */
static double whole_approach(const ehd_law_point *point, double load) {
    if (point->centrifugal_load == 0.0) return line_approach(&point->own, load);
    return line_approach(&point->inner, load) + line_approach(&point->outer, load + point->centrifugal_load);
}

/* Number of the nodes that lie at or below an approach. */
static int nodes_up_to(const ehd_cylinder_numbers *numbers, double approach) {
    const double scale = 1.0 / numbers->inverse_scale;
    int low = 0, high = EHD_NODES;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (numbers->centre + node_place(middle) * scale <= approach)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Find where the cells of a point with its whole film lie, and the limits of its law. Returns the number of nodes up to
 * lift-off: 0 where the nodes do not reach down to it. */
static int place_cells(const ehd_law_point *point, ehd_cylinder_numbers *numbers) {
    const double inverse = point->own.inverse_scale, scale = 1.0 / inverse, highest = counted_load(point);
    memset(numbers, 0, sizeof *numbers);
    numbers->kind = EHD_CELLS;
    numbers->centre = centre_of(point);
    numbers->inverse_scale = numbers->slope = inverse;
    numbers->highest = highest;
    numbers->held_approach = point->held_approach;
    numbers->held_damping = point->held_damping;
    numbers->held_load = point->held_load;
    numbers->held_stiffness = point->held_stiffness;
    if (point->film < 1.0) {
        numbers->held_approach = whole_approach(point, point->held_load);
        numbers->held_damping = full_state(point, numbers->held_approach).ratio * point->held_load;
    }
    const int below = nodes_up_to(numbers, point->lift_off);
    const double up_to = point->held_load <= highest ? numbers->held_approach : whole_approach(point, highest);
    const int safe = nodes_up_to(numbers, up_to);
    numbers->safe_approach = numbers->centre + node_place(safe > 0 ? safe - 1 : 0) * scale;
    numbers->lift_off = below > 0 ? numbers->centre + node_place(below - 1) * scale : INFINITY;
    return below;
}

static double node_approach(const ehd_cylinder_numbers *numbers, int64_t i) {
    return numbers->centre + node_place((int)i) / numbers->inverse_scale;
}

/* Division of the approach at a node. */
static division divided_at(const ehd_law_point *point, const ehd_cylinder_numbers *numbers, int64_t i) {
    division found = {0.0, 0.0, 0.0};
    balanced_state(point, node_approach(numbers, i), &found);
    return found;
}

/* Where searches for the equilibrium of both contacts begin, at nodes that rise: on cubics between equilibria at every
 * so-manieth node, so that it does not matter which nodes are asked for. */
static void first_divisions(const ehd_law_point *point, const ehd_cylinder_numbers *numbers, int64_t first, int64_t end,
                            int count, const int *asked, const double *approach, double *inner) {
    int64_t left = -1, right = -1;
    double x = 0.0, h = 0.0;
    division low = {0.0, 0.0, 0.0}, high = low;
    for (int i = 0; i < count; i++) {
        const int64_t begin = asked[i] - asked[i] % ANCHORS;
        const int64_t below = begin > first ? begin : first, above = begin + ANCHORS < end ? begin + ANCHORS : end - 1;
        if (below != left || above != right) {
            low = below == right ? high : divided_at(point, numbers, below);
            high = above > below ? divided_at(point, numbers, above) : low;
            left = below;
            right = above;
            x = node_approach(numbers, below);
            h = node_approach(numbers, above) - x;
        }
        if (h > 0.0) {
            const double t = (approach[i] - x) / h, secant = (high.inner - low.inner) / h;
            const double bend = (1.0 - t) * (low.part - secant) - t * (high.part - secant);
            inner[i] = low.inner + t * h * (secant + (1.0 - t) * bend);
        } else {
            inner[i] = low.inner;
        }
    }
}

/* States of the whole film at nodes that rise, at most MANY, up to one before `end`, as if there were no hold; nothing
 * below the first one that may carry a load. */
static void node_states(const ehd_law_point *point, const ehd_cylinder_numbers *numbers, int64_t first, int64_t end,
                        int count, const int *asked, double (*const values[])[4]) {
    double approach[MANY], inner[MANY];
    block_states found;
    int below = 0;
    while (below < count && asked[below] < first) memset(*values[below++], 0, sizeof *values[0]);
    asked += below;
    values += below;
    count -= below;
    if (count < 1) return;
    for (int i = 0; i < count; i++) approach[i] = node_approach(numbers, asked[i]);
    if (point->centrifugal_load > 0.0) first_divisions(point, numbers, first, end, count, asked, approach, inner);
    full_states(point, count, approach, inner, &found);
    for (int i = 0; i < count; i++) {
        double *at = *values[i];
        at[CELL_LOAD] = found.w[i];
        at[CELL_SLOPE] = found.dw[i];
        at[CELL_DAMPING] = found.w[i] * found.ratio[i];
        at[CELL_BEND] = found.dc[i];
    }
}

/* State at a node beyond the hold: the law goes on straight from the first one there, number end - 1, whose state is
 * given. */
static void straight_node(const ehd_cylinder_numbers *numbers, int64_t end, const double last[4], int64_t i,
                          double values[4]) {
    const double ahead = (node_place((int)i) - node_place((int)end - 1)) / numbers->inverse_scale;
    values[CELL_LOAD] = last[CELL_LOAD] + last[CELL_SLOPE] * ahead;
    values[CELL_SLOPE] = last[CELL_SLOPE];
    values[CELL_DAMPING] = last[CELL_DAMPING];
    values[CELL_BEND] = 0.0;
}

/* First node that may carry a load, and the one behind the first node beyond the hold. */
static void loaded_nodes(const ehd_law_point *point, const ehd_cylinder_numbers *numbers, int64_t *first, int64_t *end) {
    *first = nodes_up_to(numbers, point->lift_off);
    *end = nodes_up_to(numbers, numbers->held_approach) + 1;
    if (*end > EHD_NODES) *end = EHD_NODES;
}

/* Cubic through values and slopes at both ends of a cell, number f of it; by is the inverse of its width. */
static void write_cubic(double cell[4][2], int f, double y0, double y1, double s0, double s1, double by) {
    const double secant = (y1 - y0) * by;
    cell[0][f] = y0;
    cell[1][f] = s0;
    cell[2][f] = (3.0 * secant - 2.0 * s0 - s1) * by;
    cell[3][f] = (s0 + s1 - 2.0 * secant) * by * by;
}

/* Inverse of the distance from a node to the next one, in scales: a power of two. */
static double node_step(int low) {
    const int64_t cell = low >= EHD_ROWS ? low - EHD_ROWS : EHD_ROWS - 1 - low;
    return number_of_bits((uint64_t)(1023 + CELL_BITS - (cell >> CELL_BITS)) << 52);
}

/* Slopes of load and damping by z at a node, held so that neither falls below where it must not. */
static void held_slopes(const double (*values)[4], double scale, int i, double held[2]) {
    const int last = EHD_NODES - 1;
    const double w = values[i][CELL_LOAD], c = values[i][CELL_DAMPING];
    double slope = values[i][CELL_SLOPE] * scale, bend = values[i][CELL_BEND] * scale;
    if (i > 0) {
        const double before = 3.0 * node_step(i - 1);
        slope = least(slope, (w - values[i - 1][CELL_LOAD]) * before);
        bend = least(bend, c * before);
    }
    if (i < last) {
        const double after = 3.0 * node_step(i);
        slope = least(slope, (values[i + 1][CELL_LOAD] - w) * after);
        bend = most(bend, -c * after);
    }
    held[0] = most(slope, 0.0);
    held[1] = bend;
}

/* First of the two nodes between which a cell lies, and the cell between a node and the next one. */
static int node_of_row(int row) { return row < EHD_ROWS ? EHD_ROWS + row : 2 * EHD_ROWS - 1 - row; }

static int row_of_node(int low) { return low < EHD_ROWS ? 2 * EHD_ROWS - 1 - low : low - EHD_ROWS; }

/* Cubics of the cell between two nodes, low and the next one, whose slopes are held: over the distance from the one that
 * is nearer to the centre, in scales. */
static void write_cell(const ehd_cylinder_law *law, int low, const double at_low[2], const double at_high[2]) {
    const double(*values)[4] = (const double(*)[4])law->nodes;
    double(*cell)[2] = (double(*)[2])(law->cells + 8 * (size_t)row_of_node(low));
    const int above = low >= EHD_ROWS, near = above ? low : low + 1, far = above ? low + 1 : low;
    const double *at_near = above ? at_low : at_high, *at_far = above ? at_high : at_low;
    const double by = above ? node_step(low) : -node_step(low);
    write_cubic(cell, 0, values[near][CELL_LOAD], values[far][CELL_LOAD], at_near[0], at_far[0], by);
    write_cubic(cell, 1, values[near][CELL_DAMPING], values[far][CELL_DAMPING], at_near[1], at_far[1], by);
}

/* Whether a node or a cell is there, in marks. */
enum { UNKNOWN, WANTED, KNOWN };

static void want_node(const ehd_cylinder_law *law, int64_t i) {
    if (NODE_MARKS(law)[i] == UNKNOWN) NODE_MARKS(law)[i] = WANTED;
}

/* States at the nodes that are wanted, of those from one up to another. */
static void know_nodes(const ehd_cylinder_law *law, int64_t low, int64_t high) {
    unsigned char *known = NODE_MARKS(law);
    double(*values)[4] = (double(*)[4])law->nodes, (*places[MANY])[4];
    const int64_t end = law->end;
    int wanted[MANY], count = 0;
    if (high > end) want_node(law, end - 1);
    if (high > end && end - 1 < low) low = end - 1;
    for (int64_t i = low; i < high && i < end; i++) {
        if (known[i] == WANTED) {
            known[i] = KNOWN;
            wanted[count] = (int)i;
            places[count++] = &values[i];
        }
        if (count > 0 && (count == MANY || i + 1 == high || i + 1 == end)) {
            node_states(law->point, law->numbers, law->first, end, count, wanted, places);
            count = 0;
        }
    }
    for (int64_t i = most(low, end); i < high; i++) {
        if (known[i] != WANTED) continue;
        known[i] = KNOWN;
        straight_node(law->numbers, end, values[end - 1], i, values[i]);
    }
}

/* Begin a table of the point whose cells are made as slices need them; returns 0 where it does not reach lift-off. */
static int begin_cells(ehd_cylinder_law *law) {
    if (place_cells(law->point, law->numbers) == 0) return 0;
    loaded_nodes(law->point, law->numbers, &law->first, &law->end);
    memset(law->marks, UNKNOWN, 2 * EHD_NODES);
    return 1;
}

/* Make the cells that are wanted, of those between one node and another. */
static void make_cells(const ehd_cylinder_law *law, int low, int high) {
    const double(*values)[4] = (const double(*)[4])law->nodes, scale = 1.0 / law->numbers->inverse_scale;
    unsigned char *made = CELL_MARKS(law);
    double held[2][2];
    int there = -1; /* the node whose slopes are held already */
    for (int i = low; i < high; i++)
        for (int k = i > 0 ? i - 1 : 0; made[row_of_node(i)] == WANTED && k < i + 3 && k < EHD_NODES; k++) want_node(law, k);
    know_nodes(law, low > 0 ? low - 1 : 0, high + 2 < EHD_NODES ? high + 2 : EHD_NODES);
    for (int i = low; i < high; i++) {
        double *at_low = held[i % 2], *at_high = held[(i + 1) % 2];
        if (made[row_of_node(i)] != WANTED) continue;
        made[row_of_node(i)] = KNOWN;
        if (there != i) held_slopes(values, scale, i, at_low);
        held_slopes(values, scale, i + 1, at_high);
        there = i + 1;
        write_cell(law, i, at_low, at_high);
    }
}

/* Nodes of a film of which only a part is there, into film (2 EHD_ROWS, 8): what holds for every part of it.
 *
 * At equal load the approach is that part of the one with the whole film, and the rest of that without any. So the nodes
 * of a whole film serve all parts, as knots that move. Columns are FADED_WHOLE to FADED_BEND of all nodes but the
 * outermost; the held load is in the last row. `lift_off` and `safe_approach` are the numbers of their nodes. Returns 0
 * where the nodes do not reach down to lift-off. */
static int write_film(const ehd_law_point *point, double *film, ehd_cylinder_numbers *numbers) {
    const int last = 2 * EHD_ROWS - 1;
    int64_t first, end;
    int safe = 0;
    double values[MANY][4], (*places[MANY])[4], last_node[4] = {0.0, 0.0, 0.0, 0.0}, compliance;
    int asked[MANY];
    ehd_cylinder_numbers whole;
    place_cells(point, &whole);
    loaded_nodes(point, &whole, &first, &end);
    if (first < 2) return 0;
    const double highest = whole.highest, up_to = least(highest, point->held_load), q = point->centrifugal_load;
    for (int i = 0; i < last; i++) {
        double *row = film + 8 * (size_t)i, *at = values[i % MANY];
        if (i % MANY == 0) { /* of so many nodes at once, from number i + 1 on */
            int count = 0;
            for (; count < MANY && i + count < last && i + 1 + count < end; count++) {
                asked[count] = i + 1 + count;
                places[count] = &values[count];
            }
            node_states(point, &whole, first, end, count, asked, places);
        }
        if (i + 1 >= end) straight_node(&whole, end, last_node, i + 1, at);
        if (i + 2 == end) memcpy(last_node, at, sizeof last_node);
        row[FADED_WHOLE] = node_approach(&whole, i + 1);
        row[FADED_DRY] = structural_approach(point->data, q, at[CELL_LOAD], &compliance);
        row[FADED_RISE] = compliance * at[CELL_SLOPE];
        memcpy(row + FADED_LOAD, at, 4 * sizeof at[0]);
        if (at[CELL_LOAD] <= up_to) safe = i;
    }
    double *held = film + 8 * (size_t)last;
    held[FADED_WHOLE] = whole.held_approach;
    held[FADED_DRY] = structural_approach(point->data, q, point->held_load, &compliance);
    held[FADED_LOAD] = point->held_load;
    held[FADED_DAMPING] = whole.held_damping;
    memset(numbers, 0, sizeof *numbers);
    numbers->kind = EHD_KNOTS;
    numbers->highest = highest;
    numbers->safe_approach = safe;
    numbers->lift_off = (double)(first - 2);
    numbers->slope = 1.0;
    numbers->held_load = point->held_load;
    numbers->held_stiffness = point->held_stiffness;
    return 1;
}

/* The table of a part of a film, 0 to 1, from what write_film wrote: film and given. */
static void fade(const double *film, const ehd_cylinder_numbers *given, double part, double *cells, double *knots,
                 ehd_cylinder_numbers *numbers) {
    const double(*values)[8] = (const double(*)[8])film, rest = 1.0 - part;
    double(*cell)[4][2] = (double(*)[4][2])cells;
    const int last = 2 * EHD_ROWS - 1;
    /* slopes of the load are in cell[i][1][0], those of the damping in cell[i][1][1], where cubics have them */
    for (int i = 0; i < last; i++) {
        const double stretch = values[i][FADED_LOAD] > 0.0 ? rest * values[i][FADED_RISE] + part : 1.0;
        knots[i] = rest * values[i][FADED_DRY] + part * values[i][FADED_WHOLE];
        cell[i][1][0] = values[i][FADED_SLOPE] / stretch;
        cell[i][1][1] = part * values[i][FADED_BEND] / stretch;
    }
    knots[last] = INFINITY;
    for (int i = 0; i < last - 1; i++) {
        const double h = knots[i + 1] - knots[i];
        /* without film all nodes without load are one */
        const double rise = h > 0.0 ? 3.0 * (values[i + 1][FADED_LOAD] - values[i][FADED_LOAD]) / h : 0.0;
        cell[i][1][0] = least(cell[i][1][0], rise);
        cell[i + 1][1][0] = least(cell[i + 1][1][0], rise);
        if (h > 0.0) {
            cell[i][1][1] = most(cell[i][1][1], -3.0 * part * values[i][FADED_DAMPING] / h);
            cell[i + 1][1][1] = least(cell[i + 1][1][1], 3.0 * part * values[i + 1][FADED_DAMPING] / h);
        }
    }
    for (int i = 0; i < last - 1; i++) {
        const double h = knots[i + 1] - knots[i], by = h > 0.0 ? 1.0 / h : 0.0;
        write_cubic(cell[i], 0, values[i][FADED_LOAD], values[i + 1][FADED_LOAD], cell[i][1][0], cell[i + 1][1][0], by);
        write_cubic(cell[i], 1, part * values[i][FADED_DAMPING], part * values[i + 1][FADED_DAMPING], cell[i][1][1],
                    cell[i + 1][1][1], by);
    }
    memset(cell[last - 1], 0, 2 * sizeof cell[0]);
    const int safe = (int)given->safe_approach, lift_off = (int)given->lift_off;
    *numbers = *given;
    numbers->safe_approach = knots[safe];
    numbers->lift_off = knots[lift_off];
    numbers->held_approach = rest * values[last][FADED_DRY] + part * values[last][FADED_WHOLE];
    numbers->held_damping = part * values[last][FADED_DAMPING];
}

/* Whether dry contacts in series are one power law, approach = (a_1 + a_2) w^b; its coefficient and exponent. */
static int one_power(const ehd_law_data *data, double *coefficient, double *exponent) {
    double a = 0.0;
    const double b = data->structure[2];
    for (int64_t i = 0; i < data->contacts; i++) {
        const double *contact = data->structure + 3 * i;
        if (contact[0] != 0.0 || fabs(contact[2] - b) >= 1e-12) return 0;
        a += contact[1];
    }
    *coefficient = pow(a, -1.0 / b);
    *exponent = 1.0 / b;
    return 1;
}

/* Numbers of a law that is asked for each slice: loads are counted there. */
static void by_slices(ehd_cylinder_numbers *numbers) {
    memset(numbers, 0, sizeof *numbers);
    numbers->kind = EHD_BY_SLICES;
    numbers->lift_off = -DBL_MAX;
    numbers->safe_approach = numbers->held_approach = numbers->held_load = numbers->highest = DBL_MAX;
    numbers->slope = 1.0;
}

/* Numbers of dry contacts that are one power law, held where the point is. */
static void by_power(const ehd_law_point *point, double coefficient, double exponent, ehd_cylinder_numbers *numbers) {
    const double highest = counted_load(point);
    memset(numbers, 0, sizeof *numbers);
    numbers->kind = EHD_POWER;
    numbers->coefficient = coefficient;
    numbers->exponent = exponent;
    numbers->highest = highest;
    numbers->slope = 1.0;
    numbers->safe_approach = least(pow(highest / coefficient, 1.0 / exponent), point->held_approach);
    numbers->held_approach = point->held_approach;
    numbers->held_load = point->held_load;
    numbers->held_stiffness = point->held_stiffness;
    numbers->held_damping = point->held_damping;
}

int ehd_cylinder_prepare(const ehd_law_data *data, double u, double T, double q, int64_t asked, ehd_cylinder_law *law) {
    ehd_cylinder_numbers given;
    double coefficient, exponent;
    if (!data || !law || !law->point || !law->numbers) return EHD_BAD_ARGUMENT;
    const ehd_law_point *point = law->point;
    const int status = ehd_law_make(data, u, T, q, law->point);
    law->grows = 0;
    by_slices(law->numbers);
    if (refuses(data, status)) return status;
    if (!(asked & EHD_FILM_ALONE) && point->film == 0.0 && q == 0.0 && one_power(data, &coefficient, &exponent)) {
        by_power(point, coefficient, exponent, law->numbers);
    } else if (fabs(u) < data->film_speed) {
        if ((asked & EHD_WITHOUT_KNOTS) || !write_film(point, law->film, &given)) return status;
        if (asked & EHD_FILM_ALONE)
            *law->numbers = given;
        else
            fade(law->film, &given, point->film, law->cells, law->knots, law->numbers);
    } else if (!begin_cells(law)) {
        by_slices(law->numbers);
    } else if (asked & EHD_GROWING) {
        law->grows = 1;
    } else {
        memset(CELL_MARKS(law), WANTED, 2 * EHD_ROWS);
        make_cells(law, 0, EHD_NODES - 1);
    }
    return status;
}
