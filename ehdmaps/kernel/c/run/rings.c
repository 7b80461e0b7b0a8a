/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings with cylindrical rollers in a run: how rings and rollers move, and what slices do to them
 * ------------------------------------------------------------------------------------------------------------------ */

enum { RING_HALF_CLEARANCE, RING_SLICE_LENGTH, RING_MOST_TRAVEL, RING_MOST_TILT, RING_HALF_LENGTH, RING_LEAST_PROFILE };

#define RING_LEVEL 2      /* displacements that rings feel which do not tilt */
#define RING_FELT 6       /* displacements of rings that a bearing feels whose rollers are bodies */
#define RING_TILT_PLACE 4 /* where the tilts are among them */

EHD_SIZE_OF(ehd_rings)
EHD_SIZE_OF(ehd_film_course)

/* Where a roller stands, and how it is pressed: direction; approach in the middle of the inner and of the outer contact,
 * without the profile [m], and how it grows along the roller; place of its row. A massless roller has the first approach
 * alone. */
typedef struct ring_roller {
    double cosine, sine, approach[2], tilt, row;
} ring_roller;

/* Sums over the slices of a contact of a roller: loads [N], and loads times their places [N m]; slopes by the approach,
 * and these times the places, once and twice. */
typedef struct ring_contact {
    double load, moment, flat, mixed, tilted;
} ring_contact;

/* Cosine and sine of the angle of the first roller of a bearing. */
static void ring_cage(const ehd_rings *rings, int64_t b, double angle, double cage[2]) {
    const double at = rings->start_angles[b] + rings->cage_rates[b] * angle;
    cage[0] = cos(at);
    cage[1] = sin(at);
}

static const double *ring_sizes(const ehd_rings *rings, int64_t b) { return rings->sizes + 6 * b; }

/* Whether the motion of rings with massless rollers is finite and within reason. */
static int ring_within(const ehd_rings *rings, int64_t b, const double *felt, const double *rate, const double cage[2]) {
    const double *sizes = ring_sizes(rings, b);
    double total = fabs(cage[0]);
    int within = 1;
    for (int64_t i = 0; i < rings->felt[b]; i++) {
        total += fabs(felt[i]) + fabs(rate[i]);
        within = within && fabs(felt[i]) <= sizes[i < RING_LEVEL ? RING_MOST_TRAVEL : RING_MOST_TILT];
    }
    return within && total < INFINITY;
}

static ring_roller ring_direction(const ehd_rings *rings, int64_t b, int64_t j, const double cage[2]) {
    const double c = rings->cosine[b * rings->most_rollers + j], s = rings->sine[b * rings->most_rollers + j];
    const ring_roller found = {cage[0] * c - cage[1] * s, cage[1] * c + cage[0] * s, {0.0, 0.0}, 0.0,
                               rings->row_places[b * rings->most_rollers + j]};
    return found;
}

/* A massless roller; felt: displacements of the rings. */
static ring_roller massless_roller(const ehd_rings *rings, int64_t b, int64_t j, const double cage[2],
                                   const double *felt) {
    ring_roller found = ring_direction(rings, b, j, cage);
    const double c = found.cosine, s = found.sine;
    found.tilt = rings->felt[b] > RING_LEVEL ? felt[3] * c - felt[2] * s : 0.0;
    found.approach[0] = felt[0] * c + felt[1] * s - ring_sizes(rings, b)[RING_HALF_CLEARANCE] + found.row * found.tilt;
    return found;
}

/* Where a roller that is a body moves its contacts: approaches without the clearance, and how they grow along it. It is
 * linear in the displacements of all elements, so that their rates give those of the approaches. */
static ring_roller body_motion(const ehd_rings *rings, int64_t b, int64_t j, const double cage[2],
                               const double *motion) {
    const double *felt = motion + rings->firsts[b], own = motion[rings->alone[b] + j];
    ring_roller found = ring_direction(rings, b, j, cage);
    const double c = found.cosine, s = found.sine;
    found.tilt = 0.5 * (felt[5] * c - felt[4] * s);
    found.approach[0] = felt[0] * c + felt[1] * s - own + found.row * found.tilt;
    found.approach[1] = own - felt[2] * c - felt[3] * s + found.row * found.tilt;
    return found;
}

/* A roller that is a body; motion: displacements of all elements. */
static ring_roller body_roller(const ehd_rings *rings, int64_t b, int64_t j, const double cage[2],
                               const double *motion) {
    /* half the clearance of the bearing, which is that of both contacts */
    const double half_clearance = 0.5 * ring_sizes(rings, b)[RING_HALF_CLEARANCE];
    ring_roller found = body_motion(rings, b, j, cage, motion);
    found.approach[0] -= half_clearance;
    found.approach[1] -= half_clearance;
    return found;
}

/* Whether the approaches of a roller that is a body are finite and within reason. */
static int roller_within(const ring_roller *roller, const double *sizes) {
    const double far = sizes[RING_MOST_TRAVEL];
    return fabs(roller->approach[0]) <= far && fabs(roller->approach[1]) <= far &&
           fabs(roller->tilt) <= sizes[RING_MOST_TILT];
}

/* Sums over the slices of a contact from their loads [N/m] and slopes [N/m2], for each length of a slice. */
static ring_contact sum_slices(const ehd_rings *rings, int64_t b, const double *load, const double *slope) {
    const double *x = rings->positions + b * rings->most_slices, *weight = rings->weights + b * rings->most_slices;
    ring_contact sum = {0.0, 0.0, 0.0, 0.0, 0.0};
    for (int64_t i = 0; i < rings->slices[b]; i++) {
        const double w = weight[i] * load[i], k = weight[i] * slope[i];
        sum.load += w;
        sum.moment += w * x[i];
        sum.flat += k;
        sum.mixed += k * x[i];
        sum.tilted += k * x[i] * x[i];
    }
    return sum;
}

/* The same about the middle of the bearing, of a roller whose row stands at p. */
static ring_contact ring_about_middle(const ring_contact *of, double p) {
    const ring_contact found = {of->load, of->moment + p * of->load, of->flat, of->mixed + p * of->flat,
                                of->tilted + p * (2.0 * of->mixed + p * of->flat)};
    return found;
}

/* Begin the answer of a bearing with massless rollers. */
static void begin_massless(const ehd_rings *rings, int64_t b, ehd_answers *answers) {
    const int64_t first = rings->firsts[b], felt = rings->felt[b];
    for (int64_t i = first; i < first + felt; i++) {
        answers->force[i] = 0.0;
        for (int64_t k = first; k < first + felt; k++) answers->slopes[i * answers->m + k] = 0.0;
    }
}

/* Add what a massless roller does to the rings; its slopes are those that are asked for. */
static void add_massless(const ehd_rings *rings, int64_t b, const ring_roller *roller, const ring_contact *slices,
                         ehd_answers *answers) {
    const int64_t first = rings->firsts[b], felt = rings->felt[b];
    const ring_contact about = ring_about_middle(slices, roller->row), *contact = &about;
    const double flat[4] = {roller->cosine, roller->sine, 0.0, 0.0};
    const double tilted[4] = {0.0, 0.0, -roller->sine, roller->cosine};
    for (int64_t p = 0; p < felt; p++) {
        double *row = answers->slopes + (first + p) * answers->m + first;
        const double by_flat = flat[p] * contact->flat + tilted[p] * contact->mixed;
        const double by_tilt = flat[p] * contact->mixed + tilted[p] * contact->tilted;
        answers->force[first + p] -= flat[p] * contact->load + tilted[p] * contact->moment;
        for (int64_t q = 0; q < felt; q++) row[q] += by_flat * flat[q] + by_tilt * tilted[q];
    }
}

/* Begin the answer of a bearing whose rollers are bodies: centrifugal forces, and nothing else yet. */
static void begin_bodies(const ehd_rings *rings, int64_t b, const ehd_moment *at, ehd_answers *answers) {
    const int64_t first = rings->firsts[b], own = rings->alone[b], m = answers->m;
    const double outward = rings->outward[b] * at->speed * at->speed;
    for (int64_t i = first; i < first + RING_FELT; i++) {
        answers->force[i] = 0.0;
        for (int64_t k = first; k < first + RING_FELT; k++) answers->slopes[i * m + k] = 0.0;
    }
    for (int64_t r = own; r < own + rings->rollers[b]; r++) {
        answers->force[r] = outward;
        answers->slopes[r * m + r] = 0.0;
        for (int64_t i = first; i < first + RING_FELT; i++)
            answers->slopes[r * m + i] = answers->slopes[i * m + r] = 0.0;
    }
}

/* Add what a contact of a roller that is a body does to the ring and to the roller. */
static void add_body(const ehd_rings *rings, int64_t b, int64_t j, int64_t side, const ring_roller *roller,
                     const ring_contact *slices, ehd_answers *answers) {
    const int64_t first = rings->firsts[b], ring = first + 2 * side, tilts = first + RING_TILT_PLACE;
    const ring_contact about = ring_about_middle(slices, roller->row), *contact = &about;
    const int64_t place[5] = {ring, ring + 1, tilts, tilts + 1, rings->alone[b] + j};
    const double sign = side == 0 ? 1.0 : -1.0;
    const double flat[5] = {sign * roller->cosine, sign * roller->sine, 0.0, 0.0, -sign};
    const double tilted[5] = {0.0, 0.0, -0.5 * roller->sine, 0.5 * roller->cosine, 0.0};
    for (int p = 0; p < 5; p++) {
        double *row = answers->slopes + place[p] * answers->m;
        const double by_flat = flat[p] * contact->flat + tilted[p] * contact->mixed;
        const double by_tilt = flat[p] * contact->mixed + tilted[p] * contact->tilted;
        answers->force[place[p]] -= flat[p] * contact->load + tilted[p] * contact->moment;
        for (int q = 0; q < 5; q++) row[place[q]] += by_flat * flat[q] + by_tilt * tilted[q];
    }
}

/* Moment that a bearing asks of its cage [N m]: sum of y f_z - z f_y over pairs of what it feels, tilts likewise. Turning
 * cage and rings together does no work, so that what the cage needs is what the rings give. */
static double ring_turned_by(const ehd_rings *rings, int64_t b, const double *motion, const ehd_answers *answers) {
    const double *x = motion + rings->firsts[b], *force = answers->force + rings->firsts[b];
    double total = 0.0;
    for (int64_t i = 0; i + 1 < rings->felt[b]; i += 2) total += x[i] * force[i + 1] - x[i + 1] * force[i];
    return total;
}

/* Power of the centrifugal forces on the rollers of a bearing [W]; none on massless ones. */
static double ring_outward_power(const ehd_rings *rings, int64_t b, const ehd_moment *at, const double *motion,
                                 int64_t m) {
    double total = 0.0;
    if (rings->sides == 1) return 0.0;
    for (int64_t r = rings->alone[b]; r < rings->alone[b] + rings->rollers[b]; r++) total += motion[m + r];
    return total * rings->outward[b] * at->speed * at->speed;
}
