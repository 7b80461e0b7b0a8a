/* ---------------------------------------------------------------------------------------------------------------------
 * The balance of a roller
 *
 * Displacements are small against the roller, so that normals stand still. A contact with the normal e (axial, radial)
 * and the lever b about the middle of the roller has the approach
 *
 *     n.V at the cup and its ribs,    n.(D - V) at the cone and its ribs,    n = (e, b),
 *
 * less the depth of its profile, or the play of a rib. With A and B the sums of k n n' over the contacts with the inner
 * ring and with the outer one, and M = A + B, the roller is in balance where
 *
 *     sum Q n (cup) - sum Q n (cone) = F,
 *
 * F its centrifugal load and gyroscopic moment: the minimum of a convex potential, found by Newton's method, with
 * shorter steps where they lead beyond the minimum along them. Slow motion has
 *
 *     stiffness  A - A M^-1 A,        damping  (1 - S)' A_c (1 - S) + S' B_c S,        S = M^-1 A,
 *
 * with the dampers' sums A_c and B_c. A rib has Q = C g^(3/2).
 * ------------------------------------------------------------------------------------------------------------------ */

#define TAPER_STEPS 80
#define TAPER_CUTS 40
/* Force out of balance over the sizes of its parts at which Newton's method ends: its last step is gone by the derivatives
 * alone, so that forces are exact to the square of it, stiffness and damping to itself. */
#define TAPER_BALANCE 1e-10
#define TAPER_ROUND_OFF 1e-13 /* the same of a way */
#define TAPER_ROUGH 1e-9
#define TAPER_NOTHING 1e-10 /* load below which a contact counts as unloaded [N] */
#define TAPER_NEAR 0.1      /* part of the forces that may be left where Newton's method begins at once */
#define TAPER_SOFT 2e-14    /* stiffness, over that of both lines, that holds rollers which nothing holds */

/* What acts on a roller: D, and F [N], [N m]; the laws of cone and cup; the memory of their slices, or null. */
typedef struct taper_given {
    const ehd_taper_data *data;
    const ehd_pair_law *law;
    const double *memory;
    double d[3], loads[3], arm;
    const double *added; /* what deviations add to cone and cup, (2, 2), or null */
    double *by_rates;    /* (5,): force of the inner ring by the rates of that; the last two of EHD_PAIR_BY_RATES; written */
} taper_given;

/* Contacts at a place of the roller, and what is left of the forces on it; the sum of their sizes [N]. */
typedef struct taper_state {
    double place[3], rest[3], size;
    taper_line lines[2];
    taper_sums line[2], rib[EHD_TAPER_RIBS];
} taper_state;

static double taper_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

EHD_INLINE const ehd_taper_rib *taper_rib_of(const ehd_taper_data *data, int64_t m) {
    return (const ehd_taper_rib *)(data->rib + 6 * m);
}

/* The line of the cone, 0, or the cup, 1, by what it feels of the roller. */
static taper_line taper_line_of(const taper_given *of, int side, const double moved[3]) {
    const ehd_taper_data *data = of->data;
    const double *normal = side ? data->cup : data->cone;
    taper_line line = {of->law + side, data->lever, data->profile, NULL, data->slices, 0.0, moved[2]};
    line.approach = normal[0] * moved[0] + normal[1] * moved[1] - data->play;
    if (of->added) line.approach += of->added[2 * side];
    if (of->memory && line.law->rows > 0) line.memory = of->memory + side * EHD_TAPER_MEMORY * data->slices;
    return line;
}

static void taper_state_at(const taper_given *of, const double v[3], taper_state *s) {
    const ehd_taper_data *data = of->data;
    const double moved[3] = {of->d[0] - v[0], of->d[1] - v[1], of->d[2] - v[2]};
    taper_sums *cone = &s->line[0], *cup = &s->line[1];
    memcpy(s->place, v, sizeof s->place);
    s->lines[0] = taper_line_of(of, 0, moved);
    s->lines[1] = taper_line_of(of, 1, v);
    taper_line_sums(&s->lines[0], cone);
    taper_line_sums(&s->lines[1], cup);
    for (int i = 0; i < 2; i++) s->rest[i] = of->loads[i] + cone->q * data->cone[i] - cup->q * data->cup[i];
    s->rest[2] = of->loads[2] + cone->qb - cup->qb;
    s->size = cup->q + cone->q + fabs(of->loads[0]) + fabs(of->loads[1]) + fabs(of->loads[2]) / of->arm;
    for (int64_t m = 0; m < data->ribs; m++) {
        const ehd_taper_rib *at = taper_rib_of(data, m);
        const double b = at->lever, *by = at->outer != 0.0 ? v : moved, sign = at->outer != 0.0 ? -1.0 : 1.0;
        const ehd_pair_load found = pair_point(at->coefficient, at->x * by[0] + at->r * by[1] + b * by[2] - at->play);
        const double q = found.load, k = found.stiffness, c = q > 0.0 ? data->damping + data->damping_time * k : 0.0;
        const taper_sums here = {q, q * b, {k, k * b, k * b * b}, {c, c * b, c * b * b}, {0.0, 0.0}};
        s->rib[m] = here;
        s->rest[0] += sign * q * at->x;
        s->rest[1] += sign * q * at->r;
        s->rest[2] += sign * q * b;
        s->size += q;
    }
}

/* Size of the force that is left [N]; moments over half of the length of the roller. */
static double taper_left(const taper_state *s, double arm) {
    return most(most(fabs(s->rest[0]), fabs(s->rest[1])), fabs(s->rest[2]) / arm);
}

/* Add k n n' of a contact. */
static void taper_add(double matrix[3][3], const double part[3], double x, double r) {
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
static void taper_matrices(const ehd_taper_data *data, const taper_state *s, int damping, double inner[3][3],
                           double outer[3][3]) {
    memset(inner, 0, 9 * sizeof(double));
    memset(outer, 0, 9 * sizeof(double));
    taper_add(inner, damping ? s->line[0].c : s->line[0].k, data->cone[0], data->cone[1]);
    taper_add(outer, damping ? s->line[1].c : s->line[1].k, data->cup[0], data->cup[1]);
    for (int64_t m = 0; m < data->ribs; m++) {
        const ehd_taper_rib *at = taper_rib_of(data, m);
        if (s->rib[m].q > 0.0)
            taper_add(at->outer != 0.0 ? outer : inner, damping ? s->rib[m].c : s->rib[m].k, at->x, at->r);
    }
}

/* M, with what holds rollers that nothing holds. */
static void taper_whole(const taper_given *of, double inner[3][3], double outer[3][3], double whole[3][3]) {
    const double soft = TAPER_SOFT * of->data->hard;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) whole[i][k] = inner[i][k] + outer[i][k];
    for (int i = 0; i < 3; i++) whole[i][i] += soft * (i < 2 ? 1.0 : of->arm * of->arm);
}

/* Solve M out = b by Cholesky factors. */
static void taper_solve(double m[3][3], const double b[3], double out[3]) {
    const double l00 = sqrt(m[0][0]), l10 = m[1][0] / l00, l20 = m[2][0] / l00;
    const double l11 = sqrt(most(m[1][1] - l10 * l10, 1e-30 * m[1][1]));
    const double l21 = (m[2][1] - l20 * l10) / l11;
    const double l22 = sqrt(most(m[2][2] - l20 * l20 - l21 * l21, 1e-30 * m[2][2]));
    const double y0 = b[0] / l00, y1 = (b[1] - l10 * y0) / l11, y2 = (b[2] - l20 * y0 - l21 * y1) / l22;
    out[2] = y2 / l22;
    out[1] = (y1 - l21 * out[2]) / l11;
    out[0] = (y0 - l10 * out[1] - l20 * out[2]) / l00;
}

/* Newton's method from a state: whether it ends in the balance. */
static int taper_newton(const taper_given *of, taper_state *s) {
    const double *d = of->d, furthest = 1e-5 + fabs(d[0]) + fabs(d[1]) + fabs(d[2]) * of->arm;
    for (int turn = 0; turn < TAPER_STEPS; turn++) {
        double inner[3][3], outer[3][3], whole[3][3], step[3], place[3];
        if (taper_left(s, of->arm) <= TAPER_BALANCE * s->size + TAPER_NOTHING) return 1;
        taper_matrices(of->data, s, 0, inner, outer);
        taper_whole(of, inner, outer, whole);
        taper_solve(whole, s->rest, step);
        /* no further than makes sense: a roller that nothing holds would go anywhere */
        const double reach = most(most(fabs(step[0]), fabs(step[1])), fabs(step[2]) * of->arm);
        const double slope = taper_dot(s->rest, step);
        double part = least(1.0, furthest / reach), low = 0.0, high = DBL_MAX;
        memcpy(place, s->place, sizeof place);
        for (int cut = 0; cut < TAPER_CUTS; cut++) {
            double trial[3];
            for (int i = 0; i < 3; i++) trial[i] = place[i] + part * step[i];
            taper_state_at(of, trial, s);
            const double here = taper_dot(s->rest, step);
            if (fabs(here) <= TAPER_ROUND_OFF * s->size * reach) break;
            if (here >= -0.5 * slope && (here <= 0.5 * slope || high == DBL_MAX)) break;
            /* an idle roller meets its contacts as walls: they are come to from behind, by their stiffness there */
            if (here < 0.0) {
                high = part;
                taper_matrices(of->data, s, 0, inner, outer);
                taper_whole(of, inner, outer, whole);
                const double column[3] = {taper_dot(whole[0], step), taper_dot(whole[1], step),
                                          taper_dot(whole[2], step)};
                part += here / taper_dot(step, column);
            } else
                low = part;
            if (!(low < part && part < high)) part = 0.5 * (low + high);
        }
        if (!(part * reach > 1e-16 * furthest)) break;
    }
    return taper_left(s, of->arm) <= TAPER_ROUGH * s->size + 10.0 * TAPER_NOTHING;
}

/* Move a contact by its derivatives; sign: of the outer ring 1, of the inner one -1. */
static void taper_moved(taper_sums *sum, double x, double r, double sign, const double step[3]) {
    const double along = sign * (x * step[0] + r * step[1]), turn = sign * step[2];
    sum->q = most(sum->q + sum->k[0] * along + sum->k[1] * turn, 0.0);
    sum->qb += sum->k[1] * along + sum->k[2] * turn;
}

/* Newton's last step, with loads by their derivatives. */
static void taper_last_step(const taper_given *of, taper_state *s) {
    const ehd_taper_data *data = of->data;
    double inner[3][3], outer[3][3], whole[3][3], step[3];
    taper_matrices(data, s, 0, inner, outer);
    taper_whole(of, inner, outer, whole);
    taper_solve(whole, s->rest, step);
    for (int i = 0; i < 3; i++) s->place[i] += step[i];
    taper_moved(&s->line[0], data->cone[0], data->cone[1], -1.0, step);
    taper_moved(&s->line[1], data->cup[0], data->cup[1], 1.0, step);
    for (int64_t m = 0; m < data->ribs; m++) {
        const ehd_taper_rib *at = taper_rib_of(data, m);
        taper_moved(&s->rib[m], at->x, at->r, at->outer != 0.0 ? 1.0 : -1.0, step);
    }
}

/* What rates of deviations do: the roller follows to first order, M V' = r_i times the sums of k n of the cone less those
 * of the cup times r_o, and forces of the dampers, by the sums A_c and B_c, come to the ring by F_i - S' (F_i - F_o). */
static void taper_by_rates(const taper_given *of, const taper_state *s, const ehd_taper_roller *roller, double whole[3][3],
                           double inner[3][3], double outer[3][3]) {
    const ehd_taper_data *data = of->data;
    const double rate[2] = {of->added[1], of->added[3]}, *normal[2] = {data->cone, data->cup};
    double(*part[2])[3] = {inner, outer}, spring[2][3], damper[2][3], force[2][3], pushed[3], v[3];
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < 3; i++) {
            const taper_sums *sum = &s->line[side];
            spring[side][i] = rate[side] * (i < 2 ? sum->k[0] * normal[side][i] : sum->k[1]);
            damper[side][i] = rate[side] * (i < 2 ? sum->c[0] * normal[side][i] : sum->c[1]);
        }
    for (int i = 0; i < 3; i++) pushed[i] = spring[0][i] - spring[1][i];
    taper_solve(whole, pushed, v);
    double own = 0.0;
    for (int side = 0; side < 2; side++) {
        const double sign = side ? 1.0 : -1.0;
        for (int i = 0; i < 3; i++) force[side][i] = damper[side][i] + sign * taper_dot(part[side][i], v);
        own += sign * taper_dot(force[side], v) + rate[side] * rate[side] * s->line[side].c[0] +
               sign * taper_dot(damper[side], v);
    }
    for (int i = 0; i < 3; i++) {
        of->by_rates[i] = force[0][i];
        for (int k = 0; k < 3; k++) of->by_rates[i] -= roller->share[k][i] * (force[0][k] - force[1][k]);
    }
    of->by_rates[3] = own;
}

/* S, stiffness and damping of a roller in balance that carries the inner ring. */
static void taper_slow_motion(const taper_given *of, const taper_state *s, ehd_taper_roller *roller) {
    double inner[3][3], outer[3][3], whole[3][3], stiff[3][3], damp[3][3], keep[3][3], push[3][3], pull[3][3];
    double(*share)[3] = roller->share;
    taper_matrices(of->data, s, 0, inner, outer);
    taper_whole(of, inner, outer, whole);
    for (int k = 0; k < 3; k++) {
        const double column[3] = {inner[0][k], inner[1][k], inner[2][k]};
        double found[3];
        taper_solve(whole, column, found);
        for (int i = 0; i < 3; i++) {
            share[i][k] = found[i];
            keep[i][k] = (i == k ? 1.0 : 0.0) - found[i];
        }
    }
    /* A - A M^-1 A = S' B without the difference of nearly equal numbers */
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            stiff[i][k] = 0.0;
            for (int m = 0; m < 3; m++) stiff[i][k] += share[m][i] * (whole[m][k] - inner[m][k]);
        }
    taper_matrices(of->data, s, 1, inner, outer);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            push[i][k] = pull[i][k] = 0.0;
            for (int m = 0; m < 3; m++) {
                push[i][k] += inner[i][m] * keep[m][k];
                pull[i][k] += outer[i][m] * share[m][k];
            }
        }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            damp[i][k] = 0.0;
            for (int m = 0; m < 3; m++) damp[i][k] += keep[m][i] * push[m][k] + share[m][i] * pull[m][k];
        }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) { /* both are symmetric but for round-off */
            roller->stiffness[i][k] = 0.5 * (stiff[i][k] + stiff[k][i]);
            roller->damping[i][k] = 0.5 * (damp[i][k] + damp[k][i]);
        }
    if (of->added) taper_by_rates(of, s, roller, whole, inner, outer);
}

/* Loads of a roller in balance, and how it follows the ring. */
static void taper_tell(const taper_given *of, taper_state *s, ehd_taper_roller *roller) {
    const ehd_taper_data *data = of->data;
    taper_sums *cone = &s->line[0], *cup = &s->line[1];
    memset(roller, 0, sizeof *roller);
    roller->made = 1.0;
    roller->play = data->play;
    memcpy(roller->place, s->place, sizeof roller->place);
    memcpy(roller->ring, of->d, sizeof roller->ring);
    if (of->added) {
        roller->added[0] = of->added[0];
        roller->added[1] = of->added[2];
        of->by_rates[4] = cone->q * of->added[1] + cup->q * of->added[3];
    }
    memcpy(roller->held[0], cone->held, sizeof cone->held);
    memcpy(roller->held[1], cup->held, sizeof cup->held);
    roller->force[0] = cone->q * data->cone[0];
    roller->force[1] = cone->q * data->cone[1];
    roller->force[2] = cone->qb;
    roller->inner_load = cone->q;
    roller->outer_load = cup->q;
    roller->centre[0] = cone->q > 0.0 ? cone->qb / cone->q : 0.0;
    roller->centre[1] = cup->q > 0.0 ? cup->qb / cup->q : 0.0;
    for (int64_t m = 0; m < data->ribs; m++) {
        const ehd_taper_rib *at = taper_rib_of(data, m);
        const double q = roller->rib_load[m] = s->rib[m].q;
        if (at->outer != 0.0) {
            roller->outer_ribs += q;
            continue;
        }
        roller->force[0] += q * at->x;
        roller->force[1] += q * at->r;
        roller->force[2] += q * at->lever;
        roller->inner_ribs += q;
    }
    roller->carried = roller->inner_load + roller->inner_ribs;
    if (roller->carried <= 0.0) return;
    taper_line_dampers(&s->lines[0], cone);
    taper_line_dampers(&s->lines[1], cup);
    taper_slow_motion(of, s, roller);
}

/* Find the balance of a roller; whether it was found. It goes with the ring as it did at the last call, or starts with
 * both raceways pressed alike: rings that press have rollers that are pressed. */
static int taper_place(const taper_given *of, ehd_taper_roller *roller) {
    const double half[3] = {0.5 * of->d[0], 0.5 * of->d[1], 0.5 * of->d[2]};
    double error = DBL_MAX, place[3];
    taper_state s;
    if (roller->made != 0.0) {
        memcpy(place, roller->place, sizeof place);
        double moved[3];
        for (int i = 0; i < 3; i++) moved[i] = of->d[i] - roller->ring[i];
        for (int i = 0; of->added && i < 2; i++) { /* as raceways do that come closer by it */
            const double more = (of->added[2] - roller->added[1]) * of->data->cup[i];
            moved[i] += (of->added[0] - roller->added[0]) * of->data->cone[i] + more;
            place[i] -= more;
        }
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) place[i] += roller->share[i][k] * moved[k];
        taper_state_at(of, place, &s);
        error = taper_left(&s, of->arm) / (s.size + TAPER_NOTHING);
    }
    if (!(error < TAPER_NEAR)) {
        taper_state_at(of, half, &s);
        if (roller->made != 0.0 && error <= taper_left(&s, of->arm) / (s.size + TAPER_NOTHING))
            taper_state_at(of, place, &s);
    }
    const int found = taper_newton(of, &s) && s.size <= DBL_MAX;
    if (found && s.line[0].q > 0.0 && s.line[1].q > 0.0) taper_last_step(of, &s);
    taper_tell(of, &s, roller);
    return found;
}
