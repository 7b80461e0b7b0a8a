/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings with cylindrical rollers in runs, whose films follow at once, or which are dry; see cylinder_block.h
 * ------------------------------------------------------------------------------------------------------------------ */

/* A view of a row of bearings: all rollers of one with massless rollers, or those of one side of its contacts, one by one,
 * where rollers are bodies. */
typedef struct block_rollers {
    ehd_cylinder shape;
    ehd_cylinder_work work;
    const ehd_cylinder_law *law;
} block_rollers;

static block_rollers rollers_of_block(const ehd_cylinder_block *block, int64_t b, int64_t side, const ehd_moment *at) {
    const ehd_rings *rings = &block->rings;
    const double *sizes = ring_sizes(rings, b), *profile = block->profiles + b * rings->most_slices;
    const int64_t slices = rings->slices[b], row = b * rings->sides + side;
    double lowest = DBL_MAX, highest = -DBL_MAX;
    for (int64_t i = 0; i < slices; i++) {
        lowest = least(lowest, profile[i]);
        highest = most(highest, profile[i]);
    }
    const block_rollers found = {
        {rings->rollers[b], slices, 0, sizes[RING_HALF_CLEARANCE], sizes[RING_SLICE_LENGTH], sizes[RING_MOST_TRAVEL],
         sizes[RING_MOST_TILT], sizes[RING_HALF_LENGTH], lowest, highest, rings->positions + b * rings->most_slices,
         profile, rings->cosine + b * rings->most_rollers, rings->sine + b * rings->most_rollers,
         rings->felt[b] == RING_LEVEL ? rings->weights + b * rings->most_slices : NULL,
         deviations_of(rings->deviations, b, at),
         rings->row_places + b * rings->most_rollers},
        {block->states + row * block->room, block->place, block->row, 4 * slices, 0},
        &block->laws[rings->films_of[row]].law,
    };
    return found;
}

/* Motion of the inner ring of a bearing with massless rollers; motion (2, m). */
static ehd_ring_motion block_motion(const ehd_rings *rings, int64_t b, const ehd_moment *at, const double *motion,
                                    int64_t m) {
    const double *x = motion + rings->firsts[b], *v = x + m;
    double cage[2];
    ring_cage(rings, b, at->angle, cage);
    ehd_ring_motion ring = {x[0], x[1], 0.0, 0.0, v[0], v[1], 0.0, 0.0, cage[0], cage[1]};
    if (rings->felt[b] > RING_LEVEL) {
        ring.theta_y = x[2];
        ring.theta_z = x[3];
        ring.theta_y_rate = v[2];
        ring.theta_z_rate = v[3];
    }
    return ring;
}

/* Straight between the numbers of two laws; bounds stay bounds. */
static void blend_numbers(const ehd_cylinder_numbers *low, const ehd_cylinder_numbers *high, double weight,
                          ehd_cylinder_numbers *out) {
    const double *a = (const double *)low, *b = (const double *)high, aside = fabs(high->lift_off - low->lift_off);
    double *mixed = (double *)out;
    for (size_t i = 0; i < sizeof *out / sizeof(double); i++) mixed[i] = a[i] + weight * (b[i] - a[i]);
    /* nodes of the cells move with centre and scale */
    out->safe_approach = least(low->safe_approach, high->safe_approach) - aside;
    out->lift_off = least(low->lift_off, high->lift_off) - aside;
}

void ehd_course_law_blend(ehd_course_law *law, int64_t node, double weight) {
    const ehd_cylinder_numbers *numbers = (const ehd_cylinder_numbers *)law->numbers, *low = numbers + node;
    const int64_t size = 8 * law->rows, other = (node + 1) % law->slots;
    const double *first = law->tables + node * size, *second = law->tables + other * size;
    double *cells = law->law.cells;
    if (law->in_use[0] == (double)node && law->in_use[1] == weight) return;
    law->in_use[0] = (double)node;
    law->in_use[1] = weight;
    if (low->kind == EHD_KNOTS) {
        fade(first, low, weight, cells, law->law.knots, law->law.numbers);
        return;
    }
    if (weight == 0.0)
        *law->law.numbers = *low;
    else
        blend_numbers(low, numbers + other, weight, law->law.numbers);
    if (low->kind != EHD_CELLS) return;
    if (weight == 0.0) {
        memcpy(cells, first, (size_t)size * sizeof(double));
        return;
    }
    for (int64_t i = 0; i < size; i++) cells[i] = first[i] + weight * (second[i] - first[i]);
}

/* Write the answer of a bearing with massless rollers, all of them at once. */
static int answer_massless(const ehd_cylinder_block *block, int64_t b, const ehd_moment *at, const double *motion,
                           ehd_answers *answers) {
    const ehd_rings *rings = &block->rings;
    const block_rollers rollers = rollers_of_block(block, b, 0, at);
    const ehd_ring_motion ring = block_motion(rings, b, at, motion, answers->m);
    const int64_t first = rings->firsts[b], felt = rings->felt[b];
    ehd_bearing_force found;
    int status = check_motion(&rollers.shape, &ring);
    if (status) return status;
    status = cylinder_force(&rollers.shape, rollers.law, &ring, &rollers.work, &found);
    for (int64_t i = 0; i < felt; i++) {
        double *slopes = answers->slopes + (first + i) * answers->m + first;
        const double *k = found.stiffness[LOADED[i]], *c = found.damping[LOADED[i]];
        answers->force[first + i] = found.force[LOADED[i]];
        for (int64_t n = 0; n < felt; n++) slopes[n] = at->by_q * k[LOADED[n]] + at->by_v * c[LOADED[n]];
    }
    return status;
}

/* Add deviations to where the contacts of a roller that is a body stand, and to how they move. */
static void deviate(const double *added, int64_t j, ring_roller *placed, ring_roller *moving) {
    for (int side = 0; added && side < 2; side++) {
        placed->approach[side] += added[4 * j + 2 * side];
        moving->approach[side] += added[4 * j + 2 * side + 1];
    }
}

/* A contact of a roller that is a body, as a roller by itself; placed and moving: what approaches and grows in it, and the
 * rates of that. */
static roller contact_roller(const ehd_cylinder *shape, const ring_roller *placed, const ring_roller *moving, int side) {
    const roller r = {1.0, 0.0, placed->approach[side], placed->tilt, moving->approach[side], moving->tilt,
                      placed->approach[side] + (shape->half_length * fabs(placed->tilt) - shape->least_profile),
                      placed->row};
    return r;
}

/* What is wrong about the motion of such a roller. */
static int check_contact(const ehd_cylinder *shape, const roller *r) {
    const double total = fabs(r->gap) + fabs(r->tilt) + fabs(r->rate) + fabs(r->tilt_rate);
    if (!is_finite(total)) return EHD_NOT_FINITE;
    const int within = fabs(r->gap + shape->half_clearance) <= shape->most_travel && fabs(r->tilt) <= shape->most_tilt;
    return within ? EHD_OK : EHD_TOO_FAR;
}

/* Write the answer of a bearing whose rollers are bodies, contact by contact. */
static int answer_bodies(const ehd_cylinder_block *block, int64_t b, const ehd_moment *at, const double *motion,
                         ehd_answers *answers) {
    const ehd_rings *rings = &block->rings;
    const block_rollers sides[2] = {rollers_of_block(block, b, 0, at), rollers_of_block(block, b, 1, at)};
    int status = EHD_OK;
    double cage[2];
    ring_cage(rings, b, at->angle, cage);
    begin_bodies(rings, b, at, answers);
    for (int64_t j = 0; j < rings->rollers[b]; j++) {
        ring_roller placed = body_roller(rings, b, j, cage, motion);
        ring_roller moving = body_motion(rings, b, j, cage, motion + answers->m);
        deviate(sides[0].shape.added, j, &placed, &moving);
        for (int side = 0; side < 2; side++) {
            const ehd_cylinder *shape = &sides[side].shape;
            const ehd_cylinder_law *law = sides[side].law;
            roller r = contact_roller(shape, &placed, &moving, side);
            slices s = roller_slices(shape, &sides[side].work, j);
            sums sum;
            const int wrong = check_contact(shape, &r);
            if (wrong) return wrong;
            if (r.deepest <= law->numbers->lift_off) continue;
            status |= states_of(shape, law, &r, &s);
            sums_of(shape, &r, &s, &sum);
            const double length = shape->slice_length, q = at->by_q * law->numbers->slope * length;
            const double v = at->by_v * length;
            const ring_contact contact = {
                sum.w[0] * length, sum.w[1] * length, q * sum.k[0] + v * sum.c[0], q * sum.k[1] + v * sum.c[1],
                q * sum.k[2] + v * sum.c[2],
            };
            add_body(rings, b, j, side, &placed, &contact, answers);
        }
    }
    return status;
}

int ehd_cylinder_block_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    const ehd_cylinder_block *block = data;
    const ehd_rings *rings = &block->rings;
    const ehd_film_course *course = &block->course;
    const int64_t step = at->step * course->films;
    for (int64_t film = 0; film < course->films; film++)
        ehd_course_law_blend(&block->laws[film], course->nodes[step + film], course->weights[step + film]);
    for (int64_t b = 0; b < rings->count; b++) {
        const int status = rings->sides == 1 ? answer_massless(block, b, at, motion, answers)
                                             : answer_bodies(block, b, at, motion, answers);
        int64_t outside = status != EHD_OK;
        if (status & ~EHD_ABOVE_LOAD) return EHD_NO_SOLUTION;
        if (status && block->strict[b]) return EHD_IN_PYTHON;
        for (int64_t side = 0; side < rings->sides; side++)
            if (course->outside[step + rings->films_of[b * rings->sides + side]]) outside = 1;
        answers->outside[rings->places[b]] += outside;
    }
    return EHD_FOUND;
}

/* Power that a roller dissipates, its load at rest, that load times its places, and its load; for each length of a slice. */
static void roller_power(const ehd_cylinder *bearing, const roller *r, const slices *s, double out[4]) {
    out[0] = out[1] = out[2] = out[3] = 0.0;
    for (int64_t i = 0; i < s->count; i++) {
        const double weight = bearing->weight ? bearing->weight[i] : 1.0, x = bearing->position[i];
        const double w = s->value[i][0], rate = r->rate + x * r->tilt_rate, part = s->value[i][1] * rate;
        /* the rule of `unilateral`, less the load at rest */
        const double more = part < -0.5 * w ? -0.25 * w * w / part - w : part;
        out[0] += weight * more * rate;
        out[1] += weight * w;
        out[2] += weight * w * x;
        out[3] += weight * (w + more);
    }
    out[2] += r->row * out[1];
}

/* Power that the contacts of a bearing with massless rollers dissipate, the moment that it asks of its cage, and the power
 * that deviations bring in, for each length of a slice: turning the cage by dphi moves the loads at rest by
 * y' = -y sin + z cos in the approach; that work is stored. */
static void massless_powers(const ehd_cylinder_block *block, int64_t b, const ehd_moment *at, const double *motion,
                            int64_t m, double out[3]) {
    const block_rollers rollers = rollers_of_block(block, b, 0, at);
    const ehd_ring_motion ring = block_motion(&block->rings, b, at, motion, m);
    for (int64_t j = 0; j < block->rings.rollers[b]; j++) {
        const roller r = roller_of(&rollers.shape, &ring, j);
        const slices s = roller_slices(&rollers.shape, &rollers.work, j);
        double power[4];
        if (r.deepest <= rollers.law->numbers->lift_off) continue;
        roller_power(&rollers.shape, &r, &s, power);
        out[0] += power[0];
        out[1] += power[1] * (ring.z * r.cosine - ring.y * r.sine) -
                  power[2] * (ring.theta_z * r.sine + ring.theta_y * r.cosine);
        if (rollers.shape.added) out[2] += power[3] * (rollers.shape.added[4 * j + 1] + rollers.shape.added[4 * j + 3]);
    }
}

/* The same of one whose rollers are bodies. */
static void body_powers(const ehd_cylinder_block *block, int64_t b, const ehd_moment *at, const double *motion,
                        int64_t m, double out[3]) {
    const ehd_rings *rings = &block->rings;
    const block_rollers sides[2] = {rollers_of_block(block, b, 0, at), rollers_of_block(block, b, 1, at)};
    const double *x = motion + rings->firsts[b];
    double cage[2];
    ring_cage(rings, b, at->angle, cage);
    for (int64_t j = 0; j < rings->rollers[b]; j++) {
        ring_roller placed = body_roller(rings, b, j, cage, motion);
        ring_roller moving = body_motion(rings, b, j, cage, motion + m);
        const double c = placed.cosine, s = placed.sine, *added = sides[0].shape.added;
        deviate(added, j, &placed, &moving);
        for (int side = 0; side < 2; side++) {
            const ehd_cylinder *shape = &sides[side].shape;
            const roller r = contact_roller(shape, &placed, &moving, side);
            const slices found = roller_slices(shape, &sides[side].work, j);
            const double across = x[2 * side + 1] * c - x[2 * side] * s;
            double power[4];
            if (r.deepest <= sides[side].law->numbers->lift_off) continue;
            roller_power(shape, &r, &found, power);
            out[0] += power[0];
            out[1] += (side == 0 ? across : -across) * power[1] - 0.5 * (x[5] * s + x[4] * c) * power[2];
            if (added) out[2] += power[3] * added[4 * j + 2 * side + 1];
        }
    }
}

void ehd_cylinder_block_powers(void *data, const ehd_moment *at, const double *motion, const ehd_answers *answers,
                               double *out) {
    const ehd_cylinder_block *block = data;
    const ehd_rings *rings = &block->rings;
    const int64_t m = answers->m;
    for (int64_t b = 0; b < rings->count; b++) {
        const double length = ring_sizes(rings, b)[RING_SLICE_LENGTH];
        double found[3] = {0.0, 0.0, 0.0}, *row = out + 3 * rings->places[b];
        if (rings->sides == 1)
            massless_powers(block, b, at, motion, m, found);
        else
            body_powers(block, b, at, motion, m, found);
        row[0] = found[0] * length;
        row[1] = found[1] * length * rings->cage_rates[b] * at->speed + ring_outward_power(rings, b, at, motion, m) +
                 found[2] * length;
    }
}

EHD_SIZE_OF(ehd_course_law)
EHD_SIZE_OF(ehd_cylinder_block)
