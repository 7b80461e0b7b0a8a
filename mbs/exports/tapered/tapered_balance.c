/* ---------------------------------------------------------------------------------------------------------------------
 * The balance of a roller
 *
 * All of a roller happens in the plane of the axis and the roller: V = (axial, radial, rotation from the axis outwards)
 * of its middle, D the same of what the inner ring does there. A contact with the normal e and the lever b about the
 * middle has the approach n.V at the cup and its ribs, n.(D - V) at the cone and its ribs, n = (e, b), less profile or
 * play. A and B are the sums of k n n' over the contacts with the inner ring and the outer one, M = A + B. The balance
 *
 *     sum Q n (cup) - sum Q n (cone) = F,    F the centrifugal load and the gyroscopic moment,
 *
 * is the minimum of a convex potential. Slices of a dry line have q = C g^(10/9)/n, ribs Q = C g^(3/2).
 * ------------------------------------------------------------------------------------------------------------------ */

#define NEWTON_STEPS 80
#define CUTS 40
#define BALANCE 1e-13
#define ROUGH_BALANCE 1e-9
#define NOTHING 1e-10 /* load below which a contact counts as unloaded [N] */
#define NEAR 0.1      /* part of the forces that may be left where Newton's method begins at once */
#define LIGHT 1e-6    /* load on a roller that is left out of dry contacts [N]: approaches by it would be rounding */
#define SOFT 1e-13    /* stiffness over that of a contact that holds rollers which nothing holds */

typedef ehd_pair_state contact_state;

/* A dry contact of the law F = coefficient g^(3/2), with its damper. */
static inline contact_state point_of(double coefficient, double damping, double time, double approach) {
    const ehd_pair_load of = pair_point(coefficient, approach);
    const contact_state found = {of.load, of.stiffness, of.stiffness > 0.0 ? damping + time * of.stiffness : 0.0};
    return found;
}

static inline contact_state contact_of(const ehd_contact *law, double approach, const double *held) {
    const ehd_pair_law pair = pair_of(law);
    return pair_at(&pair, approach, held);
}

/* Sums of a contact: load, load b; stiffness k, k b, k b b; the same of damping. */
typedef struct sums {
    double q, qb, k[3], c[3];
} sums;

/* What acts on a roller: D, and F [N], [N m]; play of both raceways beside the profile [m]; laws; what the films of the
 * slices of cone and cup hold over a step, or null. */
typedef struct given {
    double d[3], loads[3], play;
    const ehd_law *law;
    const double (*held)[EHD_SLICES][3];
} given;

/* Contacts at a place of the roller, and what is left of the forces on it; the sum of their sizes [N]. */
typedef struct state {
    double place[3], rest[3], size;
    sums cup, cone, rib[EHD_RIBS + 1];
} state;

static sums line_of(const ehd_contact *law, const double (*held)[3], double approach, double turn) {
    sums of = {0.0, 0.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    for (int i = 0; i < EHD_SLICES; i++) {
        const double b = LEVER[i], g = approach + turn * b - PROFILE[i];
        double q, k, c;
        if (DRY) {
            if (!(g > 0.0)) continue;
            k = law->coefficient / EHD_SLICES * pow(g, 1.0 / 9.0);
            q = k * g;
            k *= 10.0 / 9.0;
            c = law->damping / EHD_SLICES + law->damping_time * k;
        } else {
            const contact_state found = contact_of(law, g, held ? held[i] : NULL);
            q = found.load / EHD_SLICES;
            k = found.stiffness / EHD_SLICES;
            c = found.damping / EHD_SLICES;
        }
        of.q += q;
        of.qb += q * b;
        of.k[0] += k;
        of.k[1] += k * b;
        of.k[2] += k * b * b;
        of.c[0] += c;
        of.c[1] += c * b;
        of.c[2] += c * b * b;
    }
    return of;
}

static state state_at(const given *of, const double v[3]) {
    state s;
    const double x = of->d[0] - v[0], r = of->d[1] - v[1], turn = of->d[2] - v[2];
    memcpy(s.place, v, sizeof s.place);
    s.cup = line_of(&of->law->outer, of->held ? of->held[1] : NULL, CUP[0] * v[0] + CUP[1] * v[1] - of->play, v[2]);
    s.cone = line_of(&of->law->inner, of->held ? of->held[0] : NULL, CONE[0] * x + CONE[1] * r - of->play, turn);
    for (int i = 0; i < 2; i++) s.rest[i] = of->loads[i] + s.cone.q * CONE[i] - s.cup.q * CUP[i];
    s.rest[2] = of->loads[2] + s.cone.qb - s.cup.qb;
    s.size = s.cup.q + s.cone.q + fabs(of->loads[0]) + fabs(of->loads[1]) + fabs(of->loads[2]) / ARM;
    for (int m = 0; m < EHD_RIBS; m++) {
        const rib *at = &RIB[m];
        const double sign = at->outer ? -1.0 : 1.0, b = at->lever;
        const double g = at->outer ? at->x * v[0] + at->r * v[1] + b * v[2] : at->x * x + at->r * r + b * turn;
        const contact_state found = point_of(at->coefficient, DAMPING, DAMPING_TIME, g - at->play);
        const double k = found.stiffness, c = found.damping;
        const sums here = {found.load, found.load * b, {k, k * b, k * b * b}, {c, c * b, c * b * b}};
        s.rib[m] = here;
        s.rest[0] += sign * found.load * at->x;
        s.rest[1] += sign * found.load * at->r;
        s.rest[2] += sign * found.load * b;
        s.size += found.load;
    }
    return s;
}

/* Size of the force that is left [N]; moments over half of the length of the roller. */
static double left_of(const state *s) { return most(most(fabs(s->rest[0]), fabs(s->rest[1])), fabs(s->rest[2]) / ARM); }

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Add k n n' of a contact. */
static void add(double matrix[3][3], const double part[3], double x, double r) {
    matrix[0][0] += part[0] * x * x;
    matrix[0][1] += part[0] * x * r;
    matrix[1][0] += part[0] * x * r;
    matrix[1][1] += part[0] * r * r;
    matrix[0][2] += part[1] * x;
    matrix[2][0] += part[1] * x;
    matrix[1][2] += part[1] * r;
    matrix[2][1] += part[1] * r;
    matrix[2][2] += part[2];
}

/* A and B of the stiffness, or of the damping. */
static void matrices(const state *s, int damping, double inner[3][3], double outer[3][3]) {
    memset(inner, 0, 9 * sizeof(double));
    memset(outer, 0, 9 * sizeof(double));
    add(inner, damping ? s->cone.c : s->cone.k, CONE[0], CONE[1]);
    add(outer, damping ? s->cup.c : s->cup.k, CUP[0], CUP[1]);
    for (int m = 0; m < EHD_RIBS; m++)
        add(RIB[m].outer ? outer : inner, damping ? s->rib[m].c : s->rib[m].k, RIB[m].x, RIB[m].r);
}

/* M, with what holds rollers that nothing holds. */
static void whole_of(double inner[3][3], double outer[3][3], double whole[3][3]) {
    const double soft = SOFT * 0.2 * HARD;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) whole[i][k] = inner[i][k] + outer[i][k];
    for (int i = 0; i < 3; i++) whole[i][i] += soft * (i < 2 ? 1.0 : ARM * ARM);
}

/* Solve M out = b by Cholesky factors. */
static void solve(double m[3][3], const double b[3], double out[3]) {
    const double l00 = sqrt(m[0][0]), l10 = m[1][0] / l00, l20 = m[2][0] / l00;
    const double l11 = sqrt(most(m[1][1] - l10 * l10, 1e-30 * m[1][1]));
    const double l21 = (m[2][1] - l20 * l10) / l11;
    const double l22 = sqrt(most(m[2][2] - l20 * l20 - l21 * l21, 1e-30 * m[2][2]));
    const double y0 = b[0] / l00, y1 = (b[1] - l10 * y0) / l11, y2 = (b[2] - l20 * y0 - l21 * y1) / l22;
    out[2] = y2 / l22;
    out[1] = (y1 - l21 * out[2]) / l11;
    out[0] = (y0 - l10 * out[1] - l20 * out[2]) / l00;
}

/* Newton's method from a state, with shorter steps where they lead beyond the minimum along them: whether it ends in the
 * balance. */
static int newton(const given *of, state *s) {
    const double *d = of->d, furthest = 1e-5 + fabs(d[0]) + fabs(d[1]) + fabs(d[2]) * ARM;
    for (int turn = 0; turn < NEWTON_STEPS; turn++) {
        double inner[3][3], outer[3][3], whole[3][3], step[3], place[3];
        if (left_of(s) <= BALANCE * s->size + NOTHING) return 1;
        matrices(s, 0, inner, outer);
        whole_of(inner, outer, whole);
        solve(whole, s->rest, step);
        const double reach = most(most(fabs(step[0]), fabs(step[1])), fabs(step[2]) * ARM);
        const double slope = dot(s->rest, step);
        double part = least(1.0, furthest / reach);
        memcpy(place, s->place, sizeof place);
        double low = 0.0, high = DBL_MAX;
        for (int cut = 0; cut < CUTS; cut++) {
            double trial[3];
            for (int i = 0; i < 3; i++) trial[i] = place[i] + part * step[i];
            *s = state_at(of, trial);
            const double here = dot(s->rest, step);
            if (fabs(here) <= BALANCE * s->size * reach) break;
            if (here >= -0.5 * slope && (here <= 0.5 * slope || high == DBL_MAX)) break;
            /* an idle roller meets its contacts as walls: they are come to from behind, by their stiffness there */
            if (here < 0.0) {
                high = part;
                matrices(s, 0, inner, outer);
                whole_of(inner, outer, whole);
                const double column[3] = {dot(whole[0], step), dot(whole[1], step), dot(whole[2], step)};
                part += here / dot(step, column);
            } else
                low = part;
            if (!(low < part && part < high)) part = 0.5 * (low + high);
        }
        if (!(part * reach > 1e-16 * furthest)) break;
    }
    return left_of(s) <= ROUGH_BALANCE * s->size + 10.0 * NOTHING;
}

/* Loads of a roller in balance, and S = M^-1 A, the stiffness S' B and the damping (1 - S)' A_c (1 - S) + S' B_c S. */
static void answer(const given *of, const state *s, ehd_roller *roller) {
    double inner[3][3], outer[3][3], whole[3][3], stiff[3][3], damp[3][3], keep[3][3];
    memset(roller, 0, sizeof *roller);
    roller->made = 1;
    roller->play = of->play;
    memcpy(roller->place, s->place, sizeof roller->place);
    memcpy(roller->ring, of->d, sizeof roller->ring);
    roller->force[0] = s->cone.q * CONE[0];
    roller->force[1] = s->cone.q * CONE[1];
    roller->force[2] = s->cone.qb;
    roller->inner_load = roller->carried = s->cone.q;
    roller->outer_load = s->cup.q;
    for (int m = 0; m < EHD_RIBS; m++) {
        const double q = roller->rib_load[m] = s->rib[m].q;
        if (RIB[m].outer) continue;
        roller->force[0] += q * RIB[m].x;
        roller->force[1] += q * RIB[m].r;
        roller->force[2] += q * RIB[m].lever;
        roller->carried += q;
    }
    if (roller->carried <= 0.0) return;
    matrices(s, 0, inner, outer);
    whole_of(inner, outer, whole);
    for (int k = 0; k < 3; k++) {
        const double column[3] = {inner[0][k], inner[1][k], inner[2][k]};
        double share[3];
        solve(whole, column, share);
        for (int i = 0; i < 3; i++) {
            roller->share[i][k] = share[i];
            keep[i][k] = (i == k ? 1.0 : 0.0) - share[i];
        }
    }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            stiff[i][k] = 0.0;
            for (int m = 0; m < 3; m++) stiff[i][k] += roller->share[m][i] * (whole[m][k] - inner[m][k]);
        }
    matrices(s, 1, inner, outer);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            damp[i][k] = 0.0;
            for (int m = 0; m < 3; m++)
                for (int n = 0; n < 3; n++)
                    damp[i][k] += keep[m][i] * inner[m][n] * keep[n][k] +
                                  roller->share[m][i] * outer[m][n] * roller->share[n][k];
        }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) { /* both are symmetric but for round-off */
            roller->stiffness[i][k] = 0.5 * (stiff[i][k] + stiff[k][i]);
            roller->damping[i][k] = 0.5 * (damp[i][k] + damp[k][i]);
        }
}

/* Find the balance of a roller; whether it was found. It goes with the ring as it did at the last call, or starts with
 * both raceways pressed alike. */
static int place_roller(const given *of, ehd_roller *roller) {
    const double half[3] = {0.5 * of->d[0], 0.5 * of->d[1], 0.5 * of->d[2]};
    double error = DBL_MAX, place[3];
    state s;
    if (roller->made) {
        memcpy(place, roller->place, sizeof place);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) place[i] += roller->share[i][k] * (of->d[k] - roller->ring[k]);
        s = state_at(of, place);
        error = left_of(&s) / (s.size + NOTHING);
    }
    if (!(error < NEAR)) {
        const state other = state_at(of, half);
        if (!roller->made || !(error <= left_of(&other) / (other.size + NOTHING))) s = other;
    }
    const int found = newton(of, &s);
    answer(of, &s, roller);
    return found;
}
