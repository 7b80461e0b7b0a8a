/* ---------------------------------------------------------------------------------------------------------------------
 * A cylindrical roller bearing; see cylinder.h
 *
 * Steps are loops of their own over the slices of a roller, which compilers put into vector instructions.
 * ------------------------------------------------------------------------------------------------------------------ */

#define NO_APPROACH 1e-30

/* Slices whose sums are kept apart, so that they are added at once: compilers must not change the order of additions. */
#ifdef EHD_NUMBER
#define LANES 8
#else
#define LANES 2 /* what exports write may be compiled without vector instructions */
#endif

/* First digits of a = 1 and -1, less the rows of their cells. */
#define FIRST_ABOVE (UINT64_C(0x3ff) << CELL_BITS)
#define FIRST_BELOW ((UINT64_C(0xbff) << CELL_BITS) - EHD_ROWS)

/* Directions in which a bearing has forces: y, z, theta_y and theta_z. */
static const int LOADED[4] = {1, 2, 4, 5};

/* Where a roller stands and how it moves: direction, approach in its middle and its growth along the roller, the rates
 * of both, a bound that no approach of a slice is above, and the place of its row. */
typedef struct roller {
    double cosine, sine, gap, tilt, rate, tilt_rate, deepest, row;
} roller;

/* Slices of a roller: so many of them are computed, those of a mirrored one for both sides. */
typedef struct slices {
    double (*value)[2], (*slope)[2], *place;
    uint64_t *row;
    int64_t count, mirrored;
} slices;

/* Sums over the slices of a roller: loads and loads times place; stiffness and damping times 1, x and x^2. */
typedef struct sums {
    double w[2], k[3], c[3];
} sums;

/* The same by lanes, and the lowest of w + 2 c rate, with zero. */
typedef struct lanes {
    double w0[LANES], w1[LANES], k0[LANES], k1[LANES], k2[LANES], c0[LANES], c1[LANES], c2[LANES], lowest[LANES];
} lanes;

static const sums NO_SUMS = {{0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};

/* x^b for a positive normal x, and a result between 1e-300 and 1e300; to some 1e-15 relative. */
EHD_INLINE double slice_power(double x, double b) { return plain_exp(b * plain_log(x)); }

static ehd_ring_motion ring_motion_of(const double pose[6], const double velocity[6], double cage_angle) {
    const ehd_ring_motion motion = {pose[1],     pose[2],     pose[4],     pose[5],         velocity[1],
                                    velocity[2], velocity[4], velocity[5], cos(cage_angle), sin(cage_angle)};
    return motion;
}

/* What is wrong about a motion. */
static int check_motion(const ehd_cylinder *bearing, const ehd_ring_motion *m) {
    const double total = fabs(m->y) + fabs(m->z) + fabs(m->theta_y) + fabs(m->theta_z) + fabs(m->y_rate) +
                         fabs(m->z_rate) + fabs(m->theta_y_rate) + fabs(m->theta_z_rate) + fabs(m->cage_cosine);
    if (!is_finite(total)) return EHD_NOT_FINITE;
    const double far = bearing->most_travel, tilted = bearing->most_tilt;
    if (fabs(m->y) <= far && fabs(m->z) <= far && fabs(m->theta_y) <= tilted && fabs(m->theta_z) <= tilted)
        return EHD_OK;
    return EHD_TOO_FAR;
}

/* Motion that rollers feel, of six numbers of pose and velocity each, and what is wrong about it. */
static int given_motion(const ehd_cylinder *bearing, const double pose[6], const double velocity[6], double cage_angle,
                        ehd_ring_motion *motion) {
    double total = fabs(cage_angle);
    for (int i = 0; i < 6; i++) total += fabs(pose[i]) + fabs(velocity[i]);
    if (!is_finite(total)) return EHD_NOT_FINITE;
    *motion = ring_motion_of(pose, velocity, cage_angle);
    return check_motion(bearing, motion);
}

static roller roller_of(const ehd_cylinder *bearing, const ehd_ring_motion *m, int64_t j) {
    roller r;
    r.cosine = m->cage_cosine * bearing->cosine[j] - m->cage_sine * bearing->sine[j];
    r.sine = m->cage_sine * bearing->cosine[j] + m->cage_cosine * bearing->sine[j];
    r.row = bearing->row ? bearing->row[j] : 0.0;
    r.tilt = m->theta_z * r.cosine - m->theta_y * r.sine;
    r.gap = m->y * r.cosine + m->z * r.sine - bearing->half_clearance + r.row * r.tilt;
    r.tilt_rate = m->theta_z_rate * r.cosine - m->theta_y_rate * r.sine;
    r.rate = m->y_rate * r.cosine + m->z_rate * r.sine + r.row * r.tilt_rate;
    if (bearing->added) {
        const double *added = bearing->added + 4 * j;
        r.gap += added[0] + added[2];
        r.rate += added[1] + added[3];
    }
    r.deepest = r.gap + (bearing->half_length * fabs(r.tilt) - bearing->least_profile);
    return r;
}

static double approach_of(const ehd_cylinder *bearing, const roller *r, int64_t i) {
    return r->gap + bearing->position[i] * r->tilt - bearing->profile[i];
}

/* Where the states of a roller are. */
static slices roller_slices(const ehd_cylinder *bearing, const ehd_cylinder_work *work, int64_t j) {
    double *states = work->states + work->stride * j;
    slices s = {(double(*)[2])states, (double(*)[2])(states + 2 * bearing->slices), work->place, work->row,
                bearing->slices, 0};
    return s;
}

/* Cell between knots of an approach, found from the one before. */
static int64_t knot_of(const double *knot, double approach, int64_t found) {
    int64_t low = 0, high = 2 * EHD_ROWS - 1;
    if (knot[found] <= approach && approach < knot[found + 1]) return found;
    while (high - low > 1) {
        const int64_t middle = (low + high) / 2;
        if (knot[middle] <= approach)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Powers of the approaches of slices that are pressed, factor approach^b, into place; the other ones are those of the
 * smallest approach. All that loops take is given, so that they have no branches. */
EHD_CLONES static void power_slices(int64_t count, double gap, double tilt, const double *restrict position,
                                         const double *restrict profile, double smallest, double factor, double b,
                                         double *restrict place) {
    for (int64_t i = 0; i < count; i++)
        place[i] = factor * slice_power(most(gap + position[i] * tilt - profile[i], smallest), b);
}

/* States of w = a approach^b with c = damping + damping_time dw/dapproach. */
static void power_states(const ehd_cylinder *bearing, const ehd_cylinder_numbers *law, const roller *r, const slices *s) {
    const double b = law->exponent, damping = law->damping, time = law->damping_time, bend = time * (b - 1.0) / b;
    const double *restrict position = bearing->position, *restrict profile = bearing->profile;
    double *restrict place = s->place, *restrict value = s->value[0], *restrict slope = s->slope[0];
    const double gap = r->gap, tilt = r->tilt, by_b = 1.0 / b;
    const int64_t count = s->count;
    power_slices(count, gap, tilt, position, profile, NO_APPROACH, law->coefficient * b, b - 1.0, place);
    for (int64_t i = 0; i < count; i++) {
        const double approach = gap + position[i] * tilt - profile[i], loaded = approach > 0.0 ? 1.0 : 0.0;
        const double dw = loaded * place[i], w = dw * most(approach, NO_APPROACH) * by_b;
        value[2 * i] = w;
        value[2 * i + 1] = loaded * damping + time * dw;
        slope[2 * i] = dw;
        slope[2 * i + 1] = bend * dw * dw / (w + (1.0 - loaded)); /* the second derivative of the power */
    }
}

/* Where slices are in cells around a centre. The sign of z goes with 1 + |z|, so that nothing branches; two slices at a
 * time, as compilers put into vector instructions without being asked. */
EHD_CLONES static void find_cells(const ehd_cylinder *bearing, const ehd_cylinder_numbers *law, const roller *r, const slices *s) {
    const double inverse = law->inverse_scale, start = (r->gap - law->centre) * inverse, tilt = r->tilt * inverse;
    const double *restrict position = bearing->position, *restrict profile = bearing->profile;
    double *restrict place = s->place;
    uint64_t *restrict row = s->row;
    const int64_t count = s->count;
    const double lowest = r->gap - bearing->half_length * fabs(r->tilt) - bearing->most_profile;
    const double limit = cell_end(EHD_ROWS) - 2.0;
    if (!(fabs(r->deepest - law->centre) * inverse < limit && fabs(lowest - law->centre) * inverse < limit)) {
        for (int64_t i = 0; i < count; i++) /* some slice may be beyond the cells */
            row[i] = (uint64_t)row_of(start + position[i] * tilt - profile[i] * inverse, &place[i]);
        return;
    }
    for (int64_t i = 0; i < count; i += 2) {
        for (int64_t k = i; k < i + 2; k++) {
            const double z = start + position[k] * tilt - profile[k] * inverse;
            const uint64_t sign = bits_of(z) & UINT64_C(1) << 63;
            const double a = z + number_of_bits(bits_of(1.0) | sign);
            const uint64_t cell = bits_of(a) >> (52 - CELL_BITS);
            place[k] = a - number_of_bits(cell << (52 - CELL_BITS));
            row[k] = cell - (a < 0.0 ? FIRST_BELOW : FIRST_ABOVE);
        }
    }
}

/* The same between knots. */
static void find_knots(const ehd_cylinder *bearing, const double *knot, const roller *r, const slices *s) {
    int64_t found = 0;
    for (int64_t i = 0; i < s->count; i++) {
        const double approach = approach_of(bearing, r, i);
        const int loaded = approach > knot[0];
        if (loaded) found = knot_of(knot, approach, found);
        s->row[i] = loaded ? (uint64_t)found : 0;
        s->place[i] = loaded ? approach - knot[found] : 0.0;
    }
}

/* States of the slices in their cells: cubics. A loop of its own: what it waits for is then at hand. */
static void read_cells(const double *cells, const slices *s) {
    const double *restrict place = s->place;
    const uint64_t *restrict row = s->row;
    double *restrict value = s->value[0], *restrict slope = s->slope[0];
    const int64_t count = s->count;
    for (int64_t i = 0; i < count; i++) {
        const double *restrict cell = cells + 8 * row[i], t = place[i];
        /* nothing is read again after it is written */
        const double high = t * cell[6], bend = cell[4] + high, mean = cell[2] + t * bend;
        const double other_high = t * cell[7], other_bend = cell[5] + other_high, other_mean = cell[3] + t * other_bend;
        const double w = cell[0] + t * mean, c = cell[1] + t * other_mean;
        value[2 * i] = w;
        value[2 * i + 1] = c;
        slope[2 * i] = mean + t * (bend + high);
        slope[2 * i + 1] = other_mean + t * (other_bend + other_high);
    }
}

/* Put slices above the held load on the tangent; returns whether any is above the mapped load. */
static int hold(const ehd_cylinder *bearing, const ehd_cylinder_numbers *law, const roller *r, const slices *s) {
    int status = EHD_OK;
    for (int64_t i = 0; i < s->count; i++) {
        const double above = approach_of(bearing, r, i) - law->held_approach;
        if (above > 0.0) {
            s->value[i][0] = law->held_load + law->held_stiffness * above;
            s->slope[i][0] = law->held_stiffness / law->slope;
            s->value[i][1] = law->held_damping;
            s->slope[i][1] = 0.0;
        }
        if (s->value[i][0] > law->highest) status = EHD_ABOVE_LOAD;
    }
    return status;
}

/* States by the law itself, at the rates of the slices: the rates are in the loads then, and the damping is given as it
 * acts. */
static int law_states(const ehd_cylinder *bearing, const ehd_law_point *point, roller *r, const slices *s) {
    int status = EHD_OK;
    for (int64_t i = 0; i < s->count; i++) {
        ehd_force found;
        const double rate = r->rate + bearing->position[i] * r->tilt_rate;
        status |= ehd_law_force(point, approach_of(bearing, r, i), rate, &found) & EHD_ABOVE_LOAD;
        s->value[i][0] = found.load;
        s->slope[i][0] = found.stiffness;
        s->value[i][1] = found.damping;
        s->slope[i][1] = 0.0;
    }
    r->rate = r->tilt_rate = 0.0;
    return status;
}

/* Where a roller is level, its slices are the same on both sides. */
static void mirror(const ehd_cylinder *bearing, const roller *r, slices *s) {
    if (!bearing->symmetric || r->tilt != 0.0 || r->tilt_rate != 0.0) return;
    s->mirrored = 1;
    s->count = (bearing->slices + 1) / 2;
}

/* Make the cells of a table that all slices of a bearing need and that are not there yet. */
static void grow_cells(const ehd_cylinder *bearing, const ehd_cylinder_law *law, const ehd_ring_motion *motion,
                       const ehd_cylinder_work *work) {
    unsigned char *made = CELL_MARKS(law);
    int lowest = EHD_NODES, highest = 0;
    for (int64_t j = 0; j < bearing->rollers; j++) {
        const roller r = roller_of(bearing, motion, j);
        slices s = roller_slices(bearing, work, j);
        if (r.deepest <= law->numbers->lift_off) continue;
        mirror(bearing, &r, &s);
        find_cells(bearing, law->numbers, &r, &s);
        for (int64_t i = 0; i < s.count; i++) {
            if (made[s.row[i]] != UNKNOWN) continue;
            const int low = node_of_row((int)s.row[i]);
            made[s.row[i]] = WANTED;
            lowest = low < lowest ? low : lowest;
            highest = low >= highest ? low + 1 : highest;
        }
    }
    if (lowest < highest) make_cells(law, lowest, highest);
}

/* States of the slices of a roller. */
static int states_of(const ehd_cylinder *bearing, const ehd_cylinder_law *law, roller *r, slices *s) {
    const int kind = (int)law->numbers->kind;
    mirror(bearing, r, s);
    if (kind == EHD_BY_SLICES) return law_states(bearing, law->point, r, s);
    if (kind == EHD_POWER) {
        power_states(bearing, law->numbers, r, s);
    } else {
        if (kind == EHD_CELLS)
            find_cells(bearing, law->numbers, r, s);
        else
            find_knots(bearing, law->knots, r, s);
        read_cells(law->cells, s);
    }
    return r->deepest > law->numbers->safe_approach ? hold(bearing, law->numbers, r, s) : EHD_OK;
}

/* Add neighbouring slices, from number i on, to sums of their own: as many as are given, LANES or one. */
EHD_INLINE void add_slices(const ehd_cylinder *bearing, const roller *r, const slices *s, int64_t i, int given,
                           lanes *of) {
    const double *position = bearing->position + i, *value = s->value[i], *slope = s->slope[i];
    for (int l = 0; l < given; l++) {
        const double x = position[l], c = value[2 * l + 1], rate = r->rate + x * r->tilt_rate, part = c * rate;
        const double w = value[2 * l] + part, k = slope[2 * l] + slope[2 * l + 1] * rate, kx = k * x, cx = c * x;
        of->w0[l] += w;
        of->w1[l] += w * x;
        of->k0[l] += k;
        of->k1[l] += kx;
        of->k2[l] += kx * x;
        of->c0[l] += c;
        of->c1[l] += cx;
        of->c2[l] += cx * x;
        of->lowest[l] = least(w + part, of->lowest[l]);
    }
}

/* Sums over the slices of a roller that all have c rate >= -w/2, where the rule of the damping is linear: load
 * w + c rate, stiffness dw + dc rate, damping c. Returns whether all are so. */
EHD_CLONES static int moderate_sums(const ehd_cylinder *bearing, const roller *r, const slices *s, sums *sum) {
    const int64_t count = bearing->slices, whole = count - count % LANES;
    double lowest = 0.0;
    lanes of;
    for (int l = 0; l < LANES; l++) /* compilers fill what is initialised by slow instructions */
        of.w0[l] = of.w1[l] = of.k0[l] = of.k1[l] = of.k2[l] = of.c0[l] = of.c1[l] = of.c2[l] = of.lowest[l] = 0.0;
    for (int64_t i = 0; i < whole; i += LANES) add_slices(bearing, r, s, i, LANES, &of);
    for (int64_t i = whole; i < count; i++) add_slices(bearing, r, s, i, 1, &of);
    *sum = NO_SUMS;
    for (int l = 0; l < LANES; l++) {
        sum->w[0] += of.w0[l];
        sum->w[1] += of.w1[l];
        sum->k[0] += of.k0[l];
        sum->k[1] += of.k1[l];
        sum->k[2] += of.k2[l];
        sum->c[0] += of.c0[l];
        sum->c[1] += of.c1[l];
        sum->c[2] += of.c2[l];
        lowest = least(lowest, of.lowest[l]);
    }
    return lowest >= 0.0;
}

/* The same of a mirrored roller: each slice stands for two, but for that in the middle. */
static int mirrored_sums(const ehd_cylinder *bearing, const roller *r, const slices *s, sums *sum) {
    const double rate = r->rate;
    double w0 = 0.0, k0 = 0.0, k2 = 0.0, c0 = 0.0, c2 = 0.0, lowest = 0.0, w = 0.0, k = 0.0, c = 0.0;
    for (int64_t i = 0; i < s->count; i++) {
        const double x = bearing->position[i], xx = x * x, part = s->value[i][1] * rate;
        c = s->value[i][1];
        w = s->value[i][0] + part;
        k = s->slope[i][0] + s->slope[i][1] * rate;
        lowest = least(w + part, lowest);
        w0 += w;
        k0 += k;
        k2 += xx * k;
        c0 += c;
        c2 += xx * c;
    }
    const double once = bearing->slices % 2 ? 1.0 : 0.0; /* the last one */
    sum->w[0] = 2.0 * w0 - once * w;
    sum->k[0] = 2.0 * k0 - once * k;
    sum->k[2] = 2.0 * k2;
    sum->c[0] = 2.0 * c0 - once * c;
    sum->c[2] = 2.0 * c2;
    sum->w[1] = sum->k[1] = sum->c[1] = 0.0;
    return lowest >= 0.0;
}

/* The same of a level roller whose slices have weights. */
static int weighted_sums(const ehd_cylinder *bearing, const roller *r, const slices *s, sums *sum) {
    const double rate = r->rate, *weight = bearing->weight;
    double w0 = 0.0, k0 = 0.0, c0 = 0.0, lowest = 0.0;
    for (int64_t i = 0; i < s->count; i++) {
        const double c = s->value[i][1], part = c * rate, w = s->value[i][0] + part;
        lowest = least(w + part, lowest);
        w0 += weight[i] * w;
        k0 += weight[i] * (s->slope[i][0] + s->slope[i][1] * rate);
        c0 += weight[i] * c;
    }
    *sum = NO_SUMS;
    sum->w[0] = w0;
    sum->k[0] = k0;
    sum->c[0] = c0;
    return lowest >= 0.0;
}

/* The same at any rates, by the whole rule without tension. */
static void lifting_sums(const ehd_cylinder *bearing, const roller *r, const slices *s, sums *sum) {
    *sum = NO_SUMS;
    for (int64_t i = 0; i < bearing->slices; i++) {
        const int64_t k = i < s->count ? i : bearing->slices - 1 - i;
        const double weight = bearing->weight ? bearing->weight[i] : 1.0, x = bearing->weight ? 0.0 : bearing->position[i];
        const double *value = s->value[k], *slope = s->slope[k];
        ehd_force found;
        unilateral(value[0], slope[0], value[1], slope[1], r->rate + x * r->tilt_rate, &found);
        sum->w[0] += weight * found.load;
        sum->w[1] += found.load * x;
        sum->k[0] += weight * found.stiffness;
        sum->k[1] += found.stiffness * x;
        sum->k[2] += found.stiffness * x * x;
        sum->c[0] += weight * found.damping;
        sum->c[1] += found.damping * x;
        sum->c[2] += found.damping * x * x;
    }
}

/* Sums over the slices of a roller whose states are there. */
static void sums_of(const ehd_cylinder *bearing, const roller *r, const slices *s, sums *sum) {
    const int moderate = bearing->weight ? weighted_sums(bearing, r, s, sum)
                         : s->mirrored   ? mirrored_sums(bearing, r, s, sum)
                                         : moderate_sums(bearing, r, s, sum);
    if (!moderate) lifting_sums(bearing, r, s, sum);
}

/* Add s B B^T of a roller to a matrix of the bearing, B its direction in y, z, theta_y and theta_z; for the sums of s
 * over 1, x and x^2. */
static void add_matrix(double matrix[6][6], const roller *r, const double s[3]) {
    const double cc = r->cosine * r->cosine, cs = r->cosine * r->sine, ss = r->sine * r->sine;
    matrix[1][1] += s[0] * cc;
    matrix[1][2] += s[0] * cs;
    matrix[2][2] += s[0] * ss;
    matrix[1][4] -= s[1] * cs;
    matrix[1][5] += s[1] * cc;
    matrix[2][4] -= s[1] * ss;
    matrix[2][5] += s[1] * cs;
    matrix[4][4] += s[2] * ss;
    matrix[4][5] -= s[2] * cs;
    matrix[5][5] += s[2] * cc;
}

static void finish_matrix(double matrix[6][6], double factor) {
    for (int i = 0; i < 4; i++) {
        for (int k = i; k < 4; k++) {
            const double value = matrix[LOADED[i]][LOADED[k]] * factor;
            matrix[LOADED[i]][LOADED[k]] = matrix[LOADED[k]][LOADED[i]] = value;
        }
    }
}

/* Sums over 1, x and x^2 about the middle of the bearing, from those about the middle of a roller at p. */
EHD_INLINE void about_middle(const double s[3], double p, double out[3]) {
    out[0] = s[0];
    out[1] = s[1] + p * s[0];
    out[2] = s[2] + p * (2.0 * s[1] + p * s[0]);
}

/* Add a roller to the force on the ring and its derivatives. */
static void add_roller(const roller *r, const sums *sum, ehd_bearing_force *answer) {
    const double moment = sum->w[1] + r->row * sum->w[0];
    double k[3], c[3];
    about_middle(sum->k, r->row, k);
    about_middle(sum->c, r->row, c);
    answer->force[1] -= r->cosine * sum->w[0];
    answer->force[2] -= r->sine * sum->w[0];
    answer->force[4] += r->sine * moment;
    answer->force[5] -= r->cosine * moment;
    add_matrix(answer->stiffness, r, k);
    add_matrix(answer->damping, r, c);
}

static void no_bearing_force(ehd_bearing_force *answer) {
    for (int i = 0; i < 6; i++) {
        answer->force[i] = NAN;
        for (int k = 0; k < 6; k++) answer->stiffness[i][k] = answer->damping[i][k] = NAN;
    }
}

/* Finish a call whose results are exported: what is refused, or is not finite after all, is NaN. */
static int settled_force(const ehd_law_data *data, int status, ehd_bearing_force *answer) {
    double force = 0.0, stiffness = 0.0, damping = 0.0;
    for (int i = 0; i < 4; i++) {
        force += fabs(answer->force[LOADED[i]]);
        for (int k = i; k < 4; k++) {
            stiffness += fabs(answer->stiffness[LOADED[i]][LOADED[k]]);
            damping += fabs(answer->damping[LOADED[i]][LOADED[k]]);
        }
    }
    if (!is_finite(force + stiffness + damping)) status |= EHD_NOT_FINITE;
    if (refuses(data, status)) no_bearing_force(answer);
    return status;
}

/* Multiply the sums by the length of a slice, and stiffness by a slope besides. */
static void finish_answer(const ehd_cylinder *bearing, double slope, ehd_bearing_force *answer) {
    for (int i = 0; i < 4; i++) answer->force[LOADED[i]] *= bearing->slice_length;
    finish_matrix(answer->stiffness, slope * bearing->slice_length);
    finish_matrix(answer->damping, bearing->slice_length);
}

/* The states of all slices of a roller, where they are wanted: of one that is mirrored on both sides, none without load. */
static void fill_states(const ehd_cylinder *bearing, const slices *s, int loaded) {
    for (int64_t i = loaded ? s->count : 0; i < bearing->slices; i++) {
        for (int f = 0; f < 2; f++) {
            s->value[i][f] = loaded ? s->value[bearing->slices - 1 - i][f] : 0.0;
            s->slope[i][f] = loaded ? s->slope[bearing->slices - 1 - i][f] : 0.0;
        }
    }
}

/* Force, stiffness and damping of a bearing at a motion that is not wrong. Returns EHD_OK or EHD_ABOVE_LOAD. */
static int cylinder_force(const ehd_cylinder *bearing, const ehd_cylinder_law *law, const ehd_ring_motion *motion,
                          const ehd_cylinder_work *work, ehd_bearing_force *answer) {
    const double lift_off = law->numbers->lift_off;
    int status = EHD_OK;
    memset(answer, 0, sizeof *answer);
    if (law->grows) grow_cells(bearing, law, motion, work);
    for (int64_t j = 0; j < bearing->rollers; j++) {
        roller r = roller_of(bearing, motion, j);
        slices s = roller_slices(bearing, work, j);
        sums sum;
        if (r.deepest <= lift_off) {
            if (work->whole) fill_states(bearing, &s, 0);
            continue;
        }
        status |= states_of(bearing, law, &r, &s);
        sums_of(bearing, &r, &s, &sum);
        add_roller(&r, &sum, answer);
        if (work->whole) fill_states(bearing, &s, 1);
    }
    finish_answer(bearing, law->numbers->slope, answer);
    return status;
}
