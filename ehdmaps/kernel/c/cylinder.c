/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings with cylindrical rollers
 * ------------------------------------------------------------------------------------------------------------------ */

#define MOST_TILT 0.5  /* [rad]; the largest accepted displacement is the roller diameter */
#define NO_APPROACH 1e-30

/* First digits of a = 1 and -1, less the rows of their cells. */
#define FIRST_ABOVE (UINT64_C(0x3ff) << CELL_BITS)
#define FIRST_BELOW ((UINT64_C(0xbff) << CELL_BITS) - EHD_ROWS)

/* Directions in which a bearing has forces: y, z, theta_y and theta_z. */
static const int LOADED[4] = {1, 2, 4, 5};

/* Where a roller stands and how it moves: direction, approach in its middle and its growth along the roller, the rates
 * of both, and a bound that no approach of a slice is above. */
typedef struct roller {
    double cosine, sine, gap, tilt, rate, tilt_rate, deepest;
} roller;

/* States of the slices of a roller at rest: load and damping in turns, as in the cells, and the slopes of both; and
 * where they are in the cells. A mirrored roller has the same on both sides: only the first half is filled, with the
 * middle. */
typedef struct slices {
    double value[EHD_MOST_SLICES][2], slope[EHD_MOST_SLICES][2], place[EHD_MOST_SLICES + 1];
    uint64_t row[EHD_MOST_SLICES + 1];
    int count, mirrored;
} slices;

/* Sums over the slices of a roller: loads and loads times place; stiffness and damping times 1, x and x^2. */
typedef struct sums {
    double w[2], k[3], c[3];
} sums;

static const sums NO_SUMS = {{0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};

/* Depth of the roller's profile at a distance from its middle, on one side [m]. */
static double roller_profile(const ehd_cylinder_data *D, double x) {
    if (!D->iso_profile) return 0.0; /* straight */
    /* ISO/TS 16281: logarithmic; rollers longer than 2.5 diameters are straight in the middle */
    const int is_short = D->roller_length <= 2.5 * D->roller_diameter;
    const double crowned = is_short ? D->roller_length : 2.5 * D->roller_diameter;
    const double part = most(2.0 * fabs(x) - (D->roller_length - crowned), 0.0) / crowned;
    return -(is_short ? 0.00035 : 0.0005) * D->roller_diameter * log1p(-part * part);
}

int ehd_cylinder_make(const ehd_cylinder_data *D, double clearance, int count, const double *profile,
                      ehd_cylinder *bearing) {
    if (!bearing || count < 1 || count > EHD_MOST_SLICES || !is_finite(clearance)) return EHD_BAD_ARGUMENT;
    bearing->data = D;
    bearing->slices = count;
    bearing->clearance = clearance;
    bearing->slice_length = D->roller_length / count;
    bearing->least_profile = DBL_MAX;
    bearing->most_profile = -DBL_MAX;
    bearing->position[count] = bearing->profile[count] = 0.0;
    for (int i = 0; i < count; i++) {
        const double x = (2 * i + 1 - count) / (2.0 * count) * D->roller_length; /* alike on both sides, to the bit */
        const double depth = profile ? profile[i] : roller_profile(D, x);
        if (!(fabs(depth) < D->roller_diameter)) return EHD_BAD_ARGUMENT;
        bearing->position[i] = x;
        bearing->profile[i] = 2.0 * depth;
        bearing->least_profile = least(bearing->least_profile, 2.0 * depth);
        bearing->most_profile = most(bearing->most_profile, 2.0 * depth);
    }
    bearing->symmetric = 1;
    for (int i = 0; i < count; i++)
        if (bearing->profile[i] != bearing->profile[count - 1 - i]) bearing->symmetric = 0;
    return EHD_OK;
}

size_t ehd_cylinder_size(void) { return sizeof(ehd_cylinder); }

static roller roller_of(const ehd_cylinder *bearing, const double pose[6], const double velocity[6], double cage_cosine,
                        double cage_sine, int j) {
    const ehd_cylinder_data *D = bearing->data;
    const double cosine = D->cosine[j], sine = D->sine[j];
    roller r;
    r.cosine = cage_cosine * cosine - cage_sine * sine;
    r.sine = cage_sine * cosine + cage_cosine * sine;
    r.gap = pose[1] * r.cosine + pose[2] * r.sine - 0.5 * bearing->clearance;
    r.tilt = pose[5] * r.cosine - pose[4] * r.sine;
    r.rate = velocity[1] * r.cosine + velocity[2] * r.sine;
    r.tilt_rate = velocity[5] * r.cosine - velocity[4] * r.sine;
    r.deepest = r.gap + (0.5 * D->roller_length * fabs(r.tilt) - bearing->least_profile);
    return r;
}

static double approach_of(const ehd_cylinder *bearing, const roller *r, int i) {
    return r->gap + bearing->position[i] * r->tilt - bearing->profile[i];
}

/* Cell between knots of an approach, found from the one before. */
static int knot_of(const ehd_cylinder_law *law, double approach, int found) {
    int low = 0, high = 2 * EHD_ROWS - 1;
    if (law->knot[found] <= approach && approach < law->knot[found + 1]) return found;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (law->knot[middle] <= approach)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* States of the slices of a roller at rest, by a power law. */
static void power_states(const ehd_cylinder *bearing, const ehd_cylinder_law *law, const roller *r, slices *s) {
    for (int i = 0; i < s->count; i++) {
        const double approach = approach_of(bearing, r, i), safe = most(approach, NO_APPROACH);
        const double slope = law->coefficient * law->exponent * pow(safe, law->exponent - 1.0);
        s->value[i][0] = approach > 0.0 ? slope * safe / law->exponent : 0.0;
        s->slope[i][0] = approach > 0.0 ? slope : 0.0;
        s->value[i][1] = s->slope[i][1] = 0.0;
    }
}

/* Where slices are in cells around a centre. The sign of z goes with 1 + |z|, so that nothing branches; two slices at a
 * time, as compilers put into vector instructions without being asked. */
static void find_cells(const ehd_cylinder *bearing, const ehd_cylinder_law *law, const roller *r, slices *s) {
    const double inverse = law->inverse_scale, start = (r->gap - law->centre) * inverse, tilt = r->tilt * inverse;
    const double *position = bearing->position, *profile = bearing->profile;
    const double lowest = r->gap - 0.5 * bearing->data->roller_length * fabs(r->tilt) - bearing->most_profile;
    const double limit = cell_end(EHD_ROWS) - 2.0;
    if (!(fabs(r->deepest - law->centre) * inverse < limit && fabs(lowest - law->centre) * inverse < limit)) {
        for (int i = 0; i < s->count; i++) /* some slice may be beyond the cells */
            s->row[i] = (uint64_t)row_of(start + position[i] * tilt - profile[i] * inverse, &s->place[i]);
        return;
    }
    for (int i = 0; i < s->count; i += 2) {
        for (int k = i; k < i + 2; k++) {
            const double z = start + position[k] * tilt - profile[k] * inverse;
            const uint64_t sign = bits_of(z) & UINT64_C(1) << 63;
            const double a = z + number_of_bits(bits_of(1.0) | sign);
            const uint64_t cell = bits_of(a) >> (52 - CELL_BITS);
            s->place[k] = a - number_of_bits(cell << (52 - CELL_BITS));
            s->row[k] = cell - (a < 0.0 ? FIRST_BELOW : FIRST_ABOVE);
        }
    }
}

/* The same between knots. */
static void find_knots(const ehd_cylinder *bearing, const ehd_cylinder_law *law, const roller *r, slices *s) {
    int found = 0;
    for (int i = 0; i < s->count; i++) {
        const double approach = approach_of(bearing, r, i);
        const int loaded = approach > law->knot[0];
        if (loaded) found = knot_of(law, approach, found);
        s->row[i] = loaded ? (uint64_t)found : 0;
        s->place[i] = loaded ? approach - law->knot[found] : 0.0;
    }
}

/* States of the slices in their cells: cubics. A loop of its own: what it waits for is then at hand. */
static void read_cells(const ehd_cylinder_law *law, slices *s) {
    for (int i = 0; i < s->count; i++) {
        const double(*cell)[2] = law->cell[s->row[i]], t = s->place[i];
        for (int f = 0; f < 2; f++) {
            const double bend = cell[2][f] + t * cell[3][f], mean = cell[1][f] + t * bend;
            s->value[i][f] = cell[0][f] + t * mean;
            s->slope[i][f] = mean + t * (bend + t * cell[3][f]);
        }
    }
}

/* Put slices above the held load on the tangent; returns whether any is above the mapped load. */
static int hold(const ehd_cylinder *bearing, const ehd_cylinder_law *law, const roller *r, slices *s) {
    int status = EHD_OK;
    for (int i = 0; i < s->count; i++) {
        const double above = approach_of(bearing, r, i) - law->held_approach;
        if (above > 0.0) {
            s->value[i][0] = law->point.held_load + law->point.held_stiffness * above;
            s->slope[i][0] = law->point.held_stiffness / law->slope;
            s->value[i][1] = law->held_damping;
            s->slope[i][1] = 0.0;
        }
        if (s->value[i][0] > law->highest) status = EHD_ABOVE_LOAD;
    }
    return status;
}

/* States by the law itself, at the rates of the slices: the rates are in the loads then, and the damping is given as it
 * acts. */
static int law_states(const ehd_cylinder *bearing, const ehd_cylinder_law *law, roller *r, slices *s) {
    int status = EHD_OK;
    for (int i = 0; i < s->count; i++) {
        ehd_force found;
        const double rate = r->rate + bearing->position[i] * r->tilt_rate;
        status |= ehd_law_force(&law->point, approach_of(bearing, r, i), rate, &found);
        s->value[i][0] = found.load;
        s->slope[i][0] = found.stiffness;
        s->value[i][1] = found.damping;
        s->slope[i][1] = 0.0;
    }
    r->rate = r->tilt_rate = 0.0;
    return status;
}

/* States of the slices of a roller. Where it is level they are the same on both sides. */
static int states_of(const ehd_cylinder *bearing, const ehd_cylinder_law *law, roller *r, slices *s) {
    s->mirrored = bearing->symmetric && r->tilt == 0.0 && r->tilt_rate == 0.0;
    s->count = s->mirrored ? (bearing->slices + 1) / 2 : bearing->slices;
    if (law->kind == BY_SLICES) return law_states(bearing, law, r, s);
    if (law->kind == POWER) {
        power_states(bearing, law, r, s);
    } else {
        if (law->kind == CELLS)
            find_cells(bearing, law, r, s);
        else
            find_knots(bearing, law, r, s);
        read_cells(law, s);
    }
    return r->deepest > law->safe_approach ? hold(bearing, law, r, s) : EHD_OK;
}

/* Sums over the slices of a roller that all have c rate >= -w/2, where the rule of the damping is linear: load
 * w + c rate, stiffness dw + dc rate, damping c. Slices at the same distance from the middle go together. Returns
 * whether all are so. */
static int moderate_sums(const ehd_cylinder *bearing, const roller *r, const slices *s, sums *sum) {
    const int half = bearing->slices / 2, last = bearing->slices - 1;
    double w0 = 0.0, w1 = 0.0, k0 = 0.0, k1 = 0.0, k2 = 0.0, c0 = 0.0, c1 = 0.0, c2 = 0.0, lowest = 0.0;
    if (bearing->slices % 2) {
        const double *value = s->value[half], *slope = s->slope[half], part = value[1] * r->rate;
        w0 = value[0] + part;
        k0 = slope[0] + slope[1] * r->rate;
        c0 = value[1];
        lowest = least(w0 + part, lowest);
    }
    for (int i = 0; i < half; i++) {
        const double *value = s->value[i], *right_value = s->value[last - i];
        const double *slope = s->slope[i], *right_slope = s->slope[last - i];
        const double x = bearing->position[i], xx = x * x, change = x * r->tilt_rate;
        const double rate = r->rate + change, part = value[1] * rate;
        const double right_rate = r->rate - change, right_part = right_value[1] * right_rate;
        const double w = value[0] + part, k = slope[0] + slope[1] * rate;
        const double right_w = right_value[0] + right_part, right_k = right_slope[0] + right_slope[1] * right_rate;
        const double even_k = k + right_k, even_c = value[1] + right_value[1];
        lowest = least(w + part, lowest);
        lowest = least(right_w + right_part, lowest);
        w0 += w + right_w;
        w1 += x * (w - right_w);
        k0 += even_k;
        k1 += x * (k - right_k);
        k2 += xx * even_k;
        c0 += even_c;
        c1 += x * (value[1] - right_value[1]);
        c2 += xx * even_c;
    }
    sum->w[0] = w0;
    sum->w[1] = w1;
    sum->k[0] = k0;
    sum->k[1] = k1;
    sum->k[2] = k2;
    sum->c[0] = c0;
    sum->c[1] = c1;
    sum->c[2] = c2;
    return lowest >= 0.0;
}

/* The same of a mirrored roller: each slice stands for two, but for that in the middle. */
static int mirrored_sums(const ehd_cylinder *bearing, const roller *r, const slices *s, sums *sum) {
    const double rate = r->rate;
    double w0 = 0.0, k0 = 0.0, k2 = 0.0, c0 = 0.0, c2 = 0.0, lowest = 0.0, w = 0.0, k = 0.0, c = 0.0;
    for (int i = 0; i < s->count; i++) {
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

/* The same at any rates, by the whole rule without tension. */
static void lifting_sums(const ehd_cylinder *bearing, const roller *r, const slices *s, sums *sum) {
    *sum = NO_SUMS;
    for (int i = 0; i < bearing->slices; i++) {
        const int k = i < s->count ? i : bearing->slices - 1 - i;
        const double x = bearing->position[i], *value = s->value[k], *slope = s->slope[k];
        ehd_force found;
        unilateral(value[0], slope[0], value[1], slope[1], r->rate + x * r->tilt_rate, &found);
        sum->w[0] += found.load;
        sum->w[1] += found.load * x;
        sum->k[0] += found.stiffness;
        sum->k[1] += found.stiffness * x;
        sum->k[2] += found.stiffness * x * x;
        sum->c[0] += found.damping;
        sum->c[1] += found.damping * x;
        sum->c[2] += found.damping * x * x;
    }
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

/* Add a roller to the force on the ring and its derivatives. */
static void add_roller(const roller *r, const sums *sum, ehd_bearing_force *result) {
    result->force[1] -= r->cosine * sum->w[0];
    result->force[2] -= r->sine * sum->w[0];
    result->force[4] += r->sine * sum->w[1];
    result->force[5] -= r->cosine * sum->w[1];
    add_matrix(result->stiffness, r, sum->k);
    add_matrix(result->damping, r, sum->c);
}

static void no_bearing_force(ehd_bearing_force *result) {
    for (int i = 0; i < 6; i++) {
        result->force[i] = NAN;
        for (int k = 0; k < 6; k++) result->stiffness[i][k] = result->damping[i][k] = NAN;
    }
}

/* What is wrong about a motion. */
static int check_motion(const ehd_cylinder_data *D, const double pose[6], const double velocity[6], double cage_angle) {
    double total = fabs(cage_angle);
    for (int i = 0; i < 6; i++) total += fabs(pose[i]) + fabs(velocity[i]);
    if (!is_finite(total)) return EHD_NOT_FINITE;
    if (fabs(pose[1]) <= D->roller_diameter && fabs(pose[2]) <= D->roller_diameter && fabs(pose[4]) <= MOST_TILT &&
        fabs(pose[5]) <= MOST_TILT)
        return EHD_OK;
    return EHD_TOO_FAR;
}

/* Multiply the sums by the length of a slice, and stiffness by a slope besides; refuse what is not finite after all. */
static int finish(const ehd_cylinder *bearing, double slope, int status, ehd_bearing_force *result) {
    double force = 0.0, stiffness = 0.0, damping = 0.0;
    finish_matrix(result->stiffness, slope * bearing->slice_length);
    finish_matrix(result->damping, bearing->slice_length);
    for (int i = 0; i < 4; i++) {
        result->force[LOADED[i]] *= bearing->slice_length;
        force += fabs(result->force[LOADED[i]]);
        for (int k = i; k < 4; k++) {
            stiffness += fabs(result->stiffness[LOADED[i]][LOADED[k]]);
            damping += fabs(result->damping[LOADED[i]][LOADED[k]]);
        }
    }
    if (!is_finite(force + stiffness + damping)) status |= EHD_NOT_FINITE;
    if (refuses(bearing->data->law, status)) no_bearing_force(result);
    return status;
}

int ehd_cylinder_at(const ehd_cylinder *bearing, const ehd_cylinder_law *law, const double pose[6],
                    const double velocity[6], double cage_angle, ehd_bearing_force *result) {
    static const double at_rest[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    slices s;
    sums sum;
    if (!result) return EHD_BAD_ARGUMENT;
    no_bearing_force(result);
    if (!bearing || !law || !pose || law->kind == UNPREPARED) return EHD_BAD_ARGUMENT;
    if (!velocity) velocity = at_rest;
    int status = (int)law->point.status | check_motion(bearing->data, pose, velocity, cage_angle);
    if (refuses(law->point.data, status)) return status;
    const double cage_cosine = cos(cage_angle), cage_sine = sin(cage_angle);
    memset(result, 0, sizeof *result);
    for (int j = 0; j < bearing->data->rollers; j++) {
        roller r = roller_of(bearing, pose, velocity, cage_cosine, cage_sine, j);
        if (r.deepest <= law->lift_off) continue;
        status |= states_of(bearing, law, &r, &s);
        if (!(s.mirrored ? mirrored_sums(bearing, &r, &s, &sum) : moderate_sums(bearing, &r, &s, &sum)))
            lifting_sums(bearing, &r, &s, &sum);
        add_roller(&r, &sum, result);
    }
    return finish(bearing, law->slope, status, result);
}

int ehd_cylinder_call(const ehd_cylinder *bearing, ehd_cylinder_law *law, const double pose[6], const double velocity[6],
                      double cage_angle, double u, double T, double q, ehd_bearing_force *result) {
    if (!law || !bearing) return EHD_BAD_ARGUMENT;
    const ehd_law_point *point = &law->point;
    const int same = law->kind != UNPREPARED && point->entrainment_speed == fabs(u) && point->temperature == T &&
                     point->centrifugal_load == q;
    if (!same) ehd_cylinder_prepare(bearing->data->law, u, T, q, law);
    return ehd_cylinder_at(bearing, law, pose, velocity, cage_angle, result);
}
