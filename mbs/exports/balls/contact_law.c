/* ---------------------------------------------------------------------------------------------------------------------
 * The law of a contact
 * ------------------------------------------------------------------------------------------------------------------ */

#define DRY (EHD_ROWS == 0)

static double least(double a, double b) { return a < b ? a : b; }

static double most(double a, double b) { return a > b ? a : b; }

static int is_finite(double x) { return fabs(x) <= DBL_MAX; }

const char *ehd_status_text(int status) {
    if (status & EHD_BAD_ARGUMENT) return "an argument that is not allowed";
    if (status & EHD_NOT_FINITE) return "numbers that are not finite";
    if (status & EHD_TOO_FAR) return "a pose beyond reason, or rings apart where no raceway is";
    if (status & EHD_NO_BALANCE) return "no balance of a ball or roller was found";
    if (status & EHD_OUTSIDE_SPEED) return "a speed outside of those of the films, which are held";
    if (status & EHD_ABOVE_LOAD) return "a load above those of the films";
    return "no problem";
}

size_t ehd_law_size(void) { return sizeof(ehd_law); }

/* Load, stiffness and damping of a contact at rest; with memory, at the end of a step over which the film holds a force
 * [N] and a spring [N/m] beyond an approach [m]. */
typedef struct contact_state {
    double load, stiffness, damping;
} contact_state;

/* A dry contact of the law F = coefficient g^(3/2), with its damper. */
static inline contact_state point_of(double coefficient, double damping, double time, double approach) {
    contact_state found = {0.0, 0.0, 0.0};
    if (approach > 0.0) {
        const double root = coefficient * sqrt(approach);
        found.load = root * approach;
        found.stiffness = 1.5 * root;
        found.damping = damping + time * found.stiffness;
    }
    return found;
}

#if DRY
static contact_state contact_of(const ehd_contact *law, double approach, const double *held) {
    (void)held;
    return point_of(law->coefficient, law->damping, law->damping_time, approach);
}
#else
static contact_state contact_of(const ehd_contact *law, double approach, const double *held) {
    contact_state found;
    const double zeta = (approach - law->centre) / law->scale, place = (asinh(zeta) - law->first) / law->step;
    const int last = EHD_ROWS - 1, at = place > 0.0 ? (place < last ? (int)place : last) : 0;
    const int cell = at < last - 1 ? at : last - 1;
    const double t = place - cell, *low = law->table[cell], *high = law->table[cell + 1];
    double value, slope, damping;
    if (t < 0.0) { /* straight beyond the ends */
        value = low[0] + low[1] * t;
        slope = low[1];
        damping = low[2] + low[3] * t;
    } else if (t > 1.0) {
        value = high[0] + high[1] * (t - 1.0);
        slope = high[1];
        damping = high[2] + high[3] * (t - 1.0);
    } else {
        const double r = 1.0 - t, bend = t * t * (3.0 - 2.0 * t);
        value = low[0] * (1.0 - bend) + high[0] * bend + t * r * (low[1] * r - high[1] * t);
        slope = 6.0 * t * r * (high[0] - low[0]) + low[1] * r * (r - 2.0 * t) + high[1] * t * (t - 2.0 * r);
        damping = low[2] * (1.0 - bend) + high[2] * bend + t * r * (low[3] * r - high[3] * t);
    }
    const double g = exp(value), root = law->coefficient * sqrt(g);
    found.load = root * g;
    found.stiffness = 1.5 * root * g * slope / (law->scale * law->step * sqrt(1.0 + zeta * zeta));
    found.damping = exp(damping);
    if (held && held[1] > 0.0) { /* the film's springs over a step: f beside the load p, and sqrt(f^2 + p^2) if pulled */
        const double more = held[0] + held[1] * (approach - held[2]), load = found.load;
        const double size = sqrt(more * more + load * load);
        found.damping = 0.0;
        found.load = more >= 0.0 ? load + more : load * load / (size - more);
        found.stiffness = more >= 0.0 ? found.stiffness + held[1]
                                      : (held[1] * found.load + found.stiffness * load) / size;
    }
    return found;
}
#endif

#if DRY
static int law_at(ehd_law *law, double u) {
    (void)u;
    law->inner = INNER;
    law->outer = OUTER;
    law->highest = DBL_MAX;
    return EHD_OK;
}
#else
#define SAME_SPEED 1e-5 /* part of a speed within which it is that of the table: as typed with six digits */

/* Most speeds of the table that a place between them takes. */
#define NEIGHBOURS 4

/* Neighbours of a place x in steps from the first speed: the first one, and the weights of the polynomial through them. */
static int weights_of(double x, double weight[NEIGHBOURS]) {
    const int count = EHD_SPEEDS < NEIGHBOURS ? EHD_SPEEDS : NEIGHBOURS, last = EHD_SPEEDS - count;
    const int wanted = (int)floor(x) - (count / 2 - 1), first = wanted < 0 ? 0 : wanted > last ? last : wanted;
    for (int i = 0; i < NEIGHBOURS; i++) weight[i] = i < count ? 1.0 : 0.0;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < count; k++)
            if (k != i) weight[i] *= (x - first - k) / (i - k);
    return first;
}

static void side_at(ehd_contact *side, const double (*table)[EHD_ROWS][4], const double (*place)[2],
                    const ehd_contact *numbers, int count, const double weight[NEIGHBOURS]) {
    double *out = &side->table[0][0];
    *side = *numbers;
    side->centre = side->scale = 0.0;
    memset(side->table, 0, sizeof side->table);
    for (int i = 0; i < count; i++) {
        const double *from = &table[i][0][0];
        side->centre += weight[i] * place[i][0];
        side->scale += weight[i] * place[i][1];
        for (int n = 0; n < 4 * EHD_ROWS; n++) out[n] += weight[i] * from[n];
    }
}

#if EHD_MEMORY
/* Springs of the films at each node: shares of the damping straight between two speeds, and the longest time as all else. */
static void springs_of(ehd_contact *side, const double (*table)[EHD_ROWS][EHD_SPRINGS + 1], double x, int first,
                       int count, const double weight[NEIGHBOURS]) {
    const int low = x < EHD_SPEEDS - 1 ? (int)x : EHD_SPEEDS - 1, high = low + 1 < EHD_SPEEDS ? low + 1 : low;
    for (int row = 0; row < EHD_ROWS; row++) {
        double time = 0.0;
        for (int i = 0; i < count; i++) time += weight[i] * table[first + i][row][EHD_SPRINGS];
        time = exp(time);
        for (int r = 0; r < EHD_SPRINGS; r++) {
            const double share = table[low][row][r] + (x - low) * (table[high][row][r] - table[low][row][r]);
            side->springs[row][r] = share * exp(side->table[row][2]) / (TIMES[r] * time);
        }
        side->springs[row][EHD_SPRINGS] = time;
    }
}
#endif

static int law_at(ehd_law *law, double u) {
    const double held = least(most(u, EHD_LOWEST_SPEED), EHD_HIGHEST_SPEED);
    const int count = EHD_SPEEDS < NEIGHBOURS ? EHD_SPEEDS : NEIGHBOURS;
    const double steps = EHD_SPEEDS > 1 ? (log(held) - FIRST_LOG_SPEED) * SPEEDS_PER_LOG : 0.0;
    const double x = least(most(steps, 0.0), EHD_SPEEDS - 1.0);
    double weight[NEIGHBOURS];
    const int first = weights_of(x, weight);
    side_at(&law->inner, INNER_TABLE + first, INNER_PLACE + first, &INNER, count, weight);
    side_at(&law->outer, OUTER_TABLE + first, OUTER_PLACE + first, &OUTER, count, weight);
#if EHD_MEMORY
    springs_of(&law->inner, INNER_SPRINGS, x, first, count, weight);
    springs_of(&law->outer, OUTER_SPRINGS, x, first, count, weight);
#endif
    law->highest = MOST_LOAD;
    return fabs(u - held) > SAME_SPEED * held ? EHD_OUTSIDE_SPEED : EHD_OK;
}
#endif

int ehd_prepare(ehd_law *law, double u) {
    if (!law) return EHD_BAD_ARGUMENT;
    if (!is_finite(u)) return EHD_NOT_FINITE;
    u = fabs(u);
    if (law->made && law->u == u) return law->status;
    law->status = law_at(law, u);
    law->u = u;
    law->made = 1;
    return law->status;
}

#define FASTEST 2e4 /* speed of a ring [rad/s] */

double ehd_cage(double inner, double outer) { return EHD_CAGE_INNER * inner + EHD_CAGE_OUTER * outer; }

/* Whether a pose is finite, and a velocity, which may be a null pointer. */
static int finite_motion(const double *pose, const double *velocity) {
    int finite = 1;
    for (int i = 0; i < 6; i++) finite = finite && is_finite(pose[i]) && (!velocity || is_finite(velocity[i]));
    return finite;
}

static int no_force(ehd_bearing_force *result, int status) {
    for (int i = 0; i < 6; i++) {
        result->force[i] = NAN;
        for (int k = 0; k < 6; k++) result->stiffness[i][k] = result->damping[i][k] = NAN;
    }
    result->cage_speed = NAN;
    return status;
}
