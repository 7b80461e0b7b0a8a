/* ---------------------------------------------------------------------------------------------------------------------
 * The balance of a ball
 *
 * With e_o = v/|v|, e_i = (d - v)/|d - v| the ball is in balance where
 *
 *     Q_i e_i - Q_o e_o + P = 0,    P = F_c (0, 1) + t k (-cos a_o, sin a_o),    a_o the angle of e_o.
 *
 * F_c is its centrifugal load, t k the traction that holds its gyroscopic moment, at the outer raceway where the inner one
 * has no share of it (ball_shared): both by its speed around the axis, at which it rolls at both raceways. Its own axis is
 * a hypothesis. It does not drill at the outer raceway (outer race control) where, with g = Dw/d_m and
 * c = cos(a_i - a_o), w_c = (w_i (1 - g cos a_i) + w_o (c + g cos a_i))/(1 + c) and k = sin a_o; of others see
 * ball_turn_about.
 *
 * With K_i, K_o the stiffness of the contacts (their rotation included), L = K_i + dP/dd, M = K_i + K_o - dP/dv,
 * S = M^-1 L and S' = K_i M^-1 slow motion has
 *
 *     stiffness  K_i - K_i S = S' (M - L),        damping  C_i - C_i S - S' C_i + S' (C_i + C_o) S.
 *
 * A ball begins where it was, moved by S as d has moved since. Approaches a_i and a_o that deviations add are those of grooves
 * that come closer: d moves by e_i a_i + e_o a_o, and v is seen from an outer groove that has moved by -e_o a_o.
 *
 * A. B. Jones, Journal of Basic Engineering 82 (1960) 309. T. A. Harris, M. N. Kotzalas, Advanced Concepts of Bearing
 * Technology, CRC, 2007, chapter 3.
 * ------------------------------------------------------------------------------------------------------------------ */

#define BALL_STEPS 12      /* of Newton's method until the angle is searched */
#define BALL_LAST_STEPS 6  /* and after that */
#define BALL_CUTS 12
/* Force out of balance over the sizes of its parts at which Newton's method ends: its last step is gone by the derivatives
 * alone, so that forces are exact to the square of it, stiffness and damping to itself. */
#define BALL_BALANCE 1e-11
#define BALL_ROUGH_BALANCE 1e-9
#define BALL_ROUND_OFF 1e-15
#define BALL_NOTHING 1e-7 /* force of an idle ball that hardly goes around [N] */
#define BALL_NEAR 0.3     /* force out of balance over its parts from which Newton's method begins at once */

/* What acts on a ball. */
typedef struct ball_given {
    double dx, dr;                             /* d */
    double inner_arm, outer_arm, rest;         /* as of ehd_ball_data */
    ehd_ball_drive drive;
    const ehd_pair_law *inner, *outer;
    double inner_scale, inner_step, outer_scale, outer_step; /* one over those of the laws */
    const double *held_inner, *held_outer;     /* three numbers each of contacts with memory, or null */
    const double *added;                       /* what deviations add to both contacts, (2, 2), or null */
    double *by_rates;                          /* (4,): force of the inner ring by the rates of that; the last two of
                                                * EHD_PAIR_BY_RATES; written */
    int inside;                                /* whether the inner raceway lies inside of the ball; washers lie beside it */
} ball_given;

/* Forces on a ball at a place, and what they come from. */
typedef struct ball_state {
    double x, r, fx, fr, size;             /* v; force that is left; sum of the sizes of its parts [N] */
    double m00, m01, m10, m11;             /* minus its derivative by the place [N/m] */
    double qi, qo, ki, ko, at_i, at_o;     /* loads, stiffness, places on tables */
    double held_i, held_o;                 /* parts of the loads that memory adds [N] */
    double ix, ir, ox, orr;                /* e_i and e_o */
    double distance, reach;                /* of v from both groove centres [m] */
    double speed, centrifugal, traction;   /* around the axis [rad/s], F_c and T = t k [N] */
    double by_i, by_o, share;              /* dT/da_i, dT/da_o [N]; part of T at the inner raceway */
    double d00, d01, d10, d11;             /* dP/dd [N/m] */
} ball_state;

/* A ball that turns: its speed around the axis [rad/s], k of its traction t k, and their derivatives by both angles. */
typedef struct ball_turn {
    double speed, by_i, by_o, k, k_i, k_o;
} ball_turn;

/* Part of the traction that the inner raceway takes of a ball without load, and its derivatives by both loads; it goes with
 * the load: a ball that is thrown off the inner raceway is held by the outer one. */
EHD_INLINE double ball_shared(const ehd_ball_drive *of, double qi, double qo, double *by_i, double *by_o) {
    const double most_of = of->axis == EHD_AXIS_INNER ? 2.0 : of->axis == EHD_AXIS_BISECTOR ? 1.0 : 0.0;
    const double one = most_of > 0.0 && qi > 0.0 ? 1.0 / (qi + qo) : 0.0;
    *by_i = most_of * qo * one * one;
    *by_o = -most_of * qi * one * one;
    return most_of * qi * one;
}

/* How a ball turns by its contact angles, outer race control. */
EHD_INLINE ball_turn ball_turn_outer(const ehd_ball_drive *of, double ix, double ir, double ox, double orr) {
    double c = ix * ox + ir * orr, s = ix * orr - ir * ox;
    ball_turn r = {of->cage, 0.0, 0.0, ox, 0.0, orr};
    if (of->cage == of->cage) return r;
    if (!(c > 0.0)) c = s = 0.0; /* no inner raceway is there that could drive it */
    const double one = 1.0 / (1.0 + c), slow = of->outer - of->inner;
    r.speed = of->inner + slow * (c + of->ratio * ir) * one;
    r.by_o = s * (of->outer - r.speed) * one;
    r.by_i = -r.by_o - slow * of->ratio * ix * one;
    return r;
}

/* The same about another axis n = (n_x, n_r), radial and axial: with p = 1 - g cos a_i, q = 1 + g cos a_o and
 * v = e_i.n, y = e_o.n it is w_c = (w_i p y + w_o q v)/(q v + p y), and k = q n_x/y. */
static ball_turn ball_turn_about(const ehd_ball_drive *of, double ix, double ir, double ox, double orr) {
    const int inner = of->axis == EHD_AXIS_INNER;
    const double g = of->ratio, p = 1.0 - g * ir, q = 1.0 + g * orr, p_i = g * ix, q_o = -g * ox;
    const double nx = inner ? ix : ix + ox, nr = inner ? ir - g : ir + orr; /* by a_i: (ir, -ix) */
    const double nx_o = inner ? 0.0 : orr, nr_o = inner ? 0.0 : -ox;
    const double v = ix * nx + ir * nr, v_i = ir * nx - ix * nr, v_o = ix * nx_o + ir * nr_o; /* e_i.n_i = 0 */
    const double y = ox * nx + orr * nr, y_i = ox * ir - orr * ix, y_o = orr * nx - ox * nr + ox * nx_o + orr * nr_o;
    const double one = 1.0 / (q * v + p * y), moment = of->axis != EHD_AXIS_NO_MOMENT;
    ball_turn r = {of->cage, 0.0, 0.0, 0.0, 0.0, 0.0};
    if (!(of->cage == of->cage)) {
        const double slow = of->outer - of->inner, part = q * v * one; /* of the outer ring */
        r.speed = of->inner + slow * part;
        r.by_i = slow * one * (q * v_i - part * (q * v_i + p_i * y + p * y_i));
        r.by_o = slow * one * (q_o * v + q * v_o - part * (q_o * v + q * v_o + p * y_o));
    }
    r.k = moment * q * nx / y;
    r.k_i = moment * q * ir / y - r.k * y_i / y;
    r.k_o = moment * (q_o * nx + q * nx_o) / y - r.k * y_o / y;
    return r;
}

EHD_INLINE ball_turn ball_turned(const ehd_ball_drive *of, double ix, double ir, double ox, double orr) {
    /* a ball on the outer raceway alone is turned by that */
    if (of->axis == EHD_AXIS_OUTER || !(ix * ox + ir * orr > 0.0)) return ball_turn_outer(of, ix, ir, ox, orr);
    return ball_turn_about(of, ix, ir, ox, orr);
}

/* F_c of a ball and t of its traction t k by its speed [N], and their derivatives by it [N s]; out (4,). The ball turns
 * against the cage, and its spin is turned by w_c: the gyroscopic moment is J w_c (w_c - w_o) (d_m/Dw) k. Traction of rings
 * that turn against each other would drive an idle ball out of its groove: t >= -F_c/2. */
EHD_INLINE void ball_loads(const ehd_ball_drive *of, double speed, double *out) {
    double traction = of->gyroscopic * speed * (speed - of->outer);
    double by_traction = of->gyroscopic * (2.0 * speed - of->outer);
    out[0] = of->centrifugal * speed * speed;
    out[2] = 2.0 * of->centrifugal * speed;
    if (traction < -0.5 * out[0]) {
        traction = -0.5 * out[0];
        by_traction = -0.5 * out[2];
    }
    out[1] = traction;
    out[3] = by_traction;
}

/* Approach of the inner contact; a gap where its groove would press from beyond the outer one: there it has no raceway. */
EHD_INLINE double ball_inner_approach(const ball_given *of, double distance) {
    return of->inside && of->dr < 0.0 ? -of->inner_arm : distance - of->inner_arm;
}

EHD_INLINE ball_state ball_state_at(const ball_given *of, double x, double r) {
    ball_state s;
    double ix = of->dx - x, ir = of->dr - r, load[4];
    const double reach = sqrt(x * x + r * r), distance = most(sqrt(ix * ix + ir * ir), 1e-300);
    const ehd_pair_load outer =
        pair_carried_by(of->outer, of->outer_scale, of->outer_step, reach - of->outer_arm, of->held_outer);
    const double pressed = ball_inner_approach(of, distance);
    const ehd_pair_load inner = pair_carried_by(of->inner, of->inner_scale, of->inner_step, pressed, of->held_inner);
    const double qo = outer.load, ko = outer.stiffness, qi = inner.load, ki = inner.stiffness;
    const double one_o = 1.0 / reach, one_i = 1.0 / distance, ox = x * one_o, orr = r * one_o;
    ix *= one_i;
    ir *= one_i;
    const double to = qo * one_o, ti = qi * one_i;
    const ball_turn turn = ball_turned(&of->drive, ix, ir, ox, orr);
    s.speed = turn.speed;
    ball_loads(&of->drive, s.speed, load);
    const double centrifugal = load[0], t = load[1], traction = t * turn.k;
    double share_i, share_o;
    s.share = ball_shared(&of->drive, qi, qo, &share_i, &share_o);
    s.by_i = load[3] * turn.k * turn.by_i + t * turn.k_i;
    s.by_o = load[3] * turn.k * turn.by_o + t * turn.k_o;
    /* P = (0, F_c) + T u, u = (1 - share) (-cos a_o, sin a_o) + share (cos a_i, -sin a_i), by both angles */
    const double held = 1.0 - s.share, ux = s.share * ir - held * orr, ur = held * ox - s.share * ix;
    const double px_i = s.by_i * ux - s.share * traction * ix, px_o = s.by_o * ux + held * traction * ox;
    const double pr_i = load[2] * turn.by_i + s.by_i * ur - s.share * traction * ir;
    const double pr_o = load[2] * turn.by_o + s.by_o * ur + held * traction * orr;
    /* a_i and a_o follow d - v and v by (cos, -sin) over the distance */
    const double ax = ir * one_i, ar = -ix * one_i, bx = orr * one_o, br = -ox * one_o;
    s.d00 = px_i * ax;
    s.d01 = px_i * ar;
    s.d10 = pr_i * ax;
    s.d11 = pr_i * ar;
    double e00 = px_o * bx - s.d00, e01 = px_o * br - s.d01, e10 = pr_o * bx - s.d10, e11 = pr_o * br - s.d11;
    if (s.share > 0.0) { /* which follows the loads */
        const double wx = traction * (ir + orr), wr = -traction * (ix + ox);
        const double dx = share_i * ki * ix, dr = share_i * ki * ir;
        const double vx = share_o * ko * ox - dx, vr = share_o * ko * orr - dr;
        s.d00 += wx * dx;
        s.d01 += wx * dr;
        s.d10 += wr * dx;
        s.d11 += wr * dr;
        e00 += wx * vx;
        e01 += wx * vr;
        e10 += wr * vx;
        e11 += wr * vr;
    }
    const double mixed = (ko - to) * ox * orr + (ki - ti) * ix * ir;
    s.x = x;
    s.r = r;
    s.fx = qi * ix - qo * ox + traction * ux;
    s.fr = qi * ir - qo * orr + centrifugal + traction * ur;
    s.size = qi + qo + centrifugal;
    s.m00 = (ko - to) * ox * ox + to + (ki - ti) * ix * ix + ti - e00;
    s.m01 = mixed - e01;
    s.m10 = mixed - e10;
    s.m11 = (ko - to) * orr * orr + to + (ki - ti) * ir * ir + ti - e11;
    s.qi = qi;
    s.qo = qo;
    s.ki = ki;
    s.ko = ko;
    s.at_i = inner.place;
    s.at_o = outer.place;
    s.held_i = inner.held;
    s.held_o = outer.held;
    s.ix = ix;
    s.ir = ir;
    s.ox = ox;
    s.orr = orr;
    s.distance = distance;
    s.reach = reach;
    s.centrifugal = centrifugal;
    s.traction = traction;
    return s;
}

/* Force that is left [N]. */
EHD_INLINE double ball_left(const ball_state *s) { return sqrt(s->fx * s->fx + s->fr * s->fr); }

/* Newton's method from a state: whether it ends in the balance. */
EHD_INLINE int ball_newton(const ball_given *of, ball_state *s, int steps) {
    double allowed = 0.0;
    for (int step = 0; step < steps; step++) {
        const double norm = ball_left(s), trace = s->m00 + s->m11;
        allowed = BALL_ROUND_OFF * trace * s->reach; /* what the rounding of lengths leaves of small loads */
        if (norm <= BALL_BALANCE * s->size + 0.1 * allowed) return 1;
        double m00 = s->m00, m11 = s->m11, determinant = m00 * m11 - s->m01 * s->m10;
        if (!(determinant > 1e-14 * trace * trace)) {
            const double more = 1e-6 * trace + 1e-300;
            m00 += more;
            m11 += more;
            determinant = m00 * m11 - s->m01 * s->m10;
        }
        const double one = 1.0 / determinant;
        const double sx = (m11 * s->fx - s->m01 * s->fr) * one, sr = (m00 * s->fr - s->m10 * s->fx) * one;
        /* the step is gone around the outer groove's centre, and not straight: its contact is stiff */
        const double along = (sx * s->ox + sr * s->orr) / s->reach;
        const double turn = least(most((sx * s->orr - sr * s->ox) / s->reach, -0.5), 0.5);
        const double x = s->x, r = s->r;
        double part = 1.0;
        ball_state ahead;
        int moved = 0;
        for (int cut = 0; cut < BALL_CUTS; cut++) {
            const double angle = part * turn, square = angle * angle, far = 1.0 + part * along;
            double sine, cosine;
            if (fabs(angle) < 1e-3) {
                sine = angle * (1.0 - square / 6.0);
                cosine = 1.0 - 0.5 * square * (1.0 - square / 12.0);
            } else {
                cosine = cos(angle);
                sine = sin(angle);
            }
            ahead = ball_state_at(of, far * (x * cosine + r * sine), far * (r * cosine - x * sine));
            if (ball_left(&ahead) < (1.0 - 1e-4 * part) * norm) {
                moved = 1;
                break;
            }
            part *= 0.5;
        }
        if (!moved) break;
        *s = ahead;
    }
    return ball_left(s) <= BALL_ROUGH_BALANCE * s->size + allowed + BALL_NOTHING;
}

/* Distance of a ball from the outer groove's centre by which forces along e_o at an angle are in balance [m]. The force
 * falls with the distance: Newton's method between bounds, whose slope leaves turns aside. */
static double ball_reach_at(const ball_given *of, double angle, double place) {
    const double c = cos(angle), i = sin(angle);
    double low = 0.0, high = DBL_MAX;
    for (int step = 0; step < 100; step++) {
        const ball_state s = ball_state_at(of, place * i, place * c);
        const double force = s.fx * i + s.fr * c;
        if (force > 0.0)
            low = place;
        else
            high = place;
        if (fabs(force) <= 1e-14 * s.size) break;
        const double slope = s.m00 * i * i + (s.m01 + s.m10) * i * c + s.m11 * c * c;
        double ahead = slope > 0.0 ? place + force / slope : DBL_MAX;
        if (!(low < ahead && ahead < high)) ahead = high < DBL_MAX ? 0.5 * (low + high) : place + 1e-2 * of->outer_arm;
        if (fabs(ahead - place) <= 1e-15 * place) break;
        place = ahead;
    }
    return place;
}

/* Force on a ball across e_o, towards larger angles [N]. */
static double ball_across_at(const ball_given *of, double angle, double reach) {
    const double c = cos(angle), i = sin(angle);
    const ball_state s = ball_state_at(of, reach * i, reach * c);
    return s.fx * c - s.fr * i;
}

/* A ball by its angle a_o, which lies between zero and the direction of d: slow and safe. At each angle the balance along
 * e_o gives the distance, and what is left across e_o has one zero. */
static void ball_searched(const ball_given *of, ball_state *s) {
    double low = 0.0, high = atan2(of->dx, of->dr);
    const double sign = high >= 0.0 ? 1.0 : -1.0;
    double reach = ball_reach_at(of, low, of->outer_arm), angle = low, at_low = sign * ball_across_at(of, low, reach);
    if (at_low > 0.0) {
        reach = ball_reach_at(of, high, reach);
        angle = high;
        double at_high = sign * ball_across_at(of, high, reach);
        if (at_high < 0.0) {
            const double first = least(at_low, -at_high);
            for (int step = 0; step < 100; step++) {
                /* regula falsi (Illinois), and halves in between */
                const double share = step % 4 ? at_low / (at_low - at_high) : 0.5;
                angle = low + share * (high - low);
                reach = ball_reach_at(of, angle, reach);
                const double here = sign * ball_across_at(of, angle, reach);
                if (here > 0.0) {
                    low = angle;
                    at_low = here;
                    at_high *= 0.5;
                } else {
                    high = angle;
                    at_high = here;
                    at_low *= 0.5;
                }
                if (fabs(high - low) <= 1e-12 || fabs(here) <= 1e-12 * first) break;
            }
        }
    }
    *s = ball_state_at(of, reach * sin(angle), reach * cos(angle));
}

/* Part of an overlap that the outer contact takes, both dry and in line. */
static double ball_share(const ehd_pair_law *inner, const ehd_pair_law *outer) {
    return 1.0 / (1.0 + pow(outer->coefficient / inner->coefficient, 2.0 / 3.0));
}

/* A ball from the best of some starts, and whether its balance was found: where it was; in line between the grooves; on
 * the outer raceway alone, in line and at its bottom. */
static int ball_anew(const ball_given *of, const ehd_ball_start *start, ball_state *s) {
    const double length = sqrt(of->dx * of->dx + of->dr * of->dr), bottom = of->outer_arm + of->rest;
    double best = INFINITY;
    *s = ball_state_at(of, 0.0, bottom);
    for (int n = 0; n < 4; n++) {
        double x = 0.0, r = bottom;
        if (n == 0) {
            x = start->centre[0];
            r = start->centre[1];
        } else if (n < 3) {
            const double overlap = length - of->inner_arm - of->outer_arm;
            const double more = n == 1 ? ball_share(of->inner, of->outer) * overlap : of->rest;
            x = (of->outer_arm + more) / length * of->dx;
            r = (of->outer_arm + more) / length * of->dr;
        }
        if (!(x * x + r * r > 0.0)) continue;
        const ball_state here = ball_state_at(of, x, r);
        if (!(here.qo > 0.0)) continue; /* a ball between both raceways, without load, would not know where to go */
        const double error = ball_left(&here) / here.size;
        if (error < best || (n == 3 && error < 1e-3)) { /* at the bottom: no inner contact, and in balance */
            best = error;
            *s = here;
        }
        if (best < BALL_NEAR && n == 0) break;
    }
    if (ball_newton(of, s, BALL_STEPS)) return 1;
    ball_searched(of, s);
    return ball_newton(of, s, BALL_LAST_STEPS);
}

/* Derivatives of the traction of the inner raceway, share T (cos a_i, -sin a_i), by v, and by d and v together. */
static void ball_inner_slopes(const ball_given *of, const ball_state *s, double *by_v, double *by_both) {
    double share_i, share_o;
    ball_shared(&of->drive, s->qi, s->qo, &share_i, &share_o);
    const double ux = s->ir, ur = -s->ix, T = s->traction, along = s->share * s->by_o / s->reach;
    const double ax = s->ir / s->distance, ar = -s->ix / s->distance;
    const double gx = s->share * (s->by_i * ux - T * s->ix), gr = s->share * (s->by_i * ur - T * s->ir);
    const double i = T * share_i * s->ki, o = T * share_o * s->ko;
    by_both[0] = ux * (along * s->orr + o * s->ox);
    by_both[1] = ux * (o * s->orr - along * s->ox);
    by_both[2] = ur * (along * s->orr + o * s->ox);
    by_both[3] = ur * (o * s->orr - along * s->ox);
    by_v[0] = by_both[0] - gx * ax - ux * i * s->ix;
    by_v[1] = by_both[1] - gx * ar - ux * i * s->ir;
    by_v[2] = by_both[2] - gr * ax - ur * i * s->ix;
    by_v[3] = by_both[3] - gr * ar - ur * i * s->ir;
}

/* What rates of deviations do: ball and dampers follow to first order, with v' = M^-1 (k_i e_i r_i - k_o e_o r_o) of the
 * ball. on_inner and on_outer: how forces of the dampers along the contacts come to the ring. The traction keeps its loads. */
static void ball_by_rates(const ball_given *of, const ball_state *s, double ci, double co, const double inverse[4],
                          const double on_inner[2], const double on_outer[2]) {
    const double inner = of->added[1], outer = of->added[3], *n = inverse;
    const double px = s->ki * inner * s->ix - s->ko * outer * s->ox, pr = s->ki * inner * s->ir - s->ko * outer * s->orr;
    const double vx = n[0] * px + n[1] * pr, vr = n[2] * px + n[3] * pr;
    const double at_i = inner - (s->ix * vx + s->ir * vr), at_o = outer + (s->ox * vx + s->orr * vr);
    for (int i = 0; i < 2; i++) of->by_rates[i] = ci * at_i * on_inner[i] + co * at_o * on_outer[i];
    of->by_rates[2] = ci * at_i * at_i + co * at_o * at_o;
}

/* Force, stiffness and damping of a ball in balance, and where it begins the next time. */
EHD_INLINE void ball_answer(const ball_given *of, const ball_state *s, ehd_ball_start *start, ehd_ball_found *out) {
    const double qi = s->qi, ki = s->ki, ix = s->ix, ir = s->ir, ox = s->ox, orr = s->orr, ti = qi / s->distance;
    const double k00 = (ki - ti) * ix * ix + ti, k01 = (ki - ti) * ix * ir, k11 = (ki - ti) * ir * ir + ti;
    const double m00 = s->m00, m01 = s->m01, m10 = s->m10, m11 = s->m11, determinant = m00 * m11 - m01 * m10;
    const double l00 = k00 + s->d00, l01 = k01 + s->d01, l10 = k01 + s->d10, l11 = k11 + s->d11;
    /* the traction of the inner ring by v, and by d and v together, [4] each */
    double by_v[4] = {0.0, 0.0, 0.0, 0.0}, by_both[4] = {0.0, 0.0, 0.0, 0.0};
    if (s->share > 0.0) ball_inner_slopes(of, s, by_v, by_both);
    start->centre[0] = s->x;
    start->centre[1] = s->r;
    start->groove[0] = of->dx;
    start->groove[1] = of->dr;
    for (int i = 0; i < 4; i++) start->share[i] = 0.0;
    const double inner_traction = s->share * s->traction;
    out->force[0] = qi * ix + inner_traction * ir;
    out->force[1] = qi * ir - inner_traction * ix;
    out->load[0] = qi;
    out->load[1] = s->qo;
    out->angle[0] = out->angle[1] = 0.0;
    out->approach[0] = ball_inner_approach(of, s->distance);
    out->approach[1] = s->reach - of->outer_arm;
    out->inner[0] = ix;
    out->inner[1] = ir;
    out->outer[0] = ox;
    out->outer[1] = orr;
    out->place[0] = s->at_i;
    out->place[1] = s->at_o;
    out->speed = s->speed;
    out->centrifugal = s->centrifugal;
    out->traction = (1.0 - s->share) * s->traction;
    out->inner_traction = inner_traction;
    out->held[0] = s->held_i;
    out->held[1] = s->held_o;
    start->added[0] = of->added ? of->added[0] : 0.0;
    start->added[1] = of->added ? of->added[2] : 0.0;
    if (of->added) of->by_rates[3] = qi * of->added[1] + s->qo * of->added[3];
    if (qi <= 0.0 || determinant == 0.0) {
        for (int i = 0; i < 4; i++) out->stiffness[i] = out->damping[i] = 0.0;
        return;
    }
    const double ci = pair_slowed(of->inner, ki, s->at_i, of->held_inner);
    const double co = pair_slowed(of->outer, s->ko, s->at_o, of->held_outer);
    const double one = 1.0 / determinant, n00 = m11 * one, n01 = -m01 * one, n10 = -m10 * one, n11 = m00 * one;
    const double s00 = n00 * l00 + n01 * l10, s01 = n00 * l01 + n01 * l11;
    const double s10 = n10 * l00 + n11 * l10, s11 = n10 * l01 + n11 * l11;
    const double g00 = k00 - by_v[0], g01 = k01 - by_v[1], g10 = k01 - by_v[2], g11 = k11 - by_v[3];
    const double p00 = g00 * n00 + g01 * n10, p01 = g00 * n01 + g01 * n11;
    const double p10 = g10 * n00 + g11 * n10, p11 = g10 * n01 + g11 * n11;
    start->share[0] = s00;
    start->share[1] = s01;
    start->share[2] = s10;
    start->share[3] = s11;
    /* what is left out of balance moves the ball by one step more */
    start->centre[0] += n00 * s->fx + n01 * s->fr;
    start->centre[1] += n10 * s->fx + n11 * s->fr;
    out->force[0] -= p00 * s->fx + p01 * s->fr;
    out->force[1] -= p10 * s->fx + p11 * s->fr;
    /* K_i (1 - S), without the difference of nearly equal numbers: S' (M - L) */
    const double b00 = m00 - l00, b01 = m01 - l01, b10 = m10 - l10, b11 = m11 - l11;
    out->stiffness[0] = p00 * b00 + p01 * b10 + by_both[0];
    out->stiffness[1] = p00 * b01 + p01 * b11 + by_both[1];
    out->stiffness[2] = p10 * b00 + p11 * b10 + by_both[2];
    out->stiffness[3] = p10 * b01 + p11 * b11 + by_both[3];
    /* dampers act along the contacts: their rates are u.(1 - S) and w.S, and their forces come back by S' */
    const double ux = ix - (ix * s00 + ir * s10), ur = ir - (ix * s01 + ir * s11);
    const double vx = ix - (p00 * ix + p01 * ir), vr = ir - (p10 * ix + p11 * ir);
    const double wx = ox * s00 + orr * s10, wr = ox * s01 + orr * s11;
    const double yx = p00 * ox + p01 * orr, yr = p10 * ox + p11 * orr;
    if (of->added)
        ball_by_rates(of, s, ci, co, (double[4]){n00, n01, n10, n11}, (double[2]){vx, vr}, (double[2]){yx, yr});
    out->damping[0] = ci * vx * ux + co * yx * wx;
    out->damping[1] = ci * vx * ur + co * yx * wr;
    out->damping[2] = ci * vr * ux + co * yr * wx;
    out->damping[3] = ci * vr * ur + co * yr * wr;
}

/* Find the balance of a ball; whether it was found. share: of two dry contacts of a bearing that stands, see ball_share;
 * else below zero. */
EHD_INLINE int ball_place(const ball_given *of, double share, ehd_ball_start *start, ehd_ball_found *out) {
    ball_state s;
    if (share >= 0.0) {
        const double length = sqrt(of->dx * of->dx + of->dr * of->dr), one = 1.0 / length;
        const double line = length - of->inner_arm - of->outer_arm;
        const double overlap = of->dr < 0.0 && of->inside ? least(line, 0.0) : line;
        if (overlap > 0.0) { /* two dry contacts in line share the overlap */
            const double reach = (of->outer_arm + share * overlap) / length;
            s = ball_state_at(of, reach * of->dx, reach * of->dr);
            ball_answer(of, &s, start, out);
            return 1;
        }
        const double reach = of->outer_arm + 0.5 * overlap;
        memset(start, 0, sizeof *start);
        memset(out, 0, sizeof *out);
        start->centre[0] = reach * of->dx * one;
        start->centre[1] = reach * of->dr * one;
        start->groove[0] = of->dx;
        start->groove[1] = of->dr;
        out->approach[0] = out->approach[1] = 0.5 * overlap;
        out->inner[0] = out->outer[0] = of->dx * one;
        out->inner[1] = out->outer[1] = of->dr * one;
        return 1;
    }
    double mx = of->dx - start->groove[0], mr = of->dr - start->groove[1], x = start->centre[0], r = start->centre[1];
    const double *by = start->share, reach = sqrt(x * x + r * r);
    if (of->added && reach > 0.0) { /* as grooves do that come closer by it */
        const double ix = start->groove[0] - x, ir = start->groove[1] - r, more = of->added[2] - start->added[1];
        const double part = (of->added[0] - start->added[0]) / most(sqrt(ix * ix + ir * ir), 1e-300);
        const double ox = more / reach * x, orr = more / reach * r;
        mx += part * ix + ox;
        mr += part * ir + orr;
        x -= ox;
        r -= orr;
    }
    x += by[0] * mx + by[1] * mr;
    r += by[2] * mx + by[3] * mr;
    int found = 0;
    if (x * x + r * r > 0.0) {
        s = ball_state_at(of, x, r);
        const double near = BALL_NEAR * s.size;
        /* a ball between both raceways, without load, would not know where to go */
        if (s.qo > 0.0 && s.fx * s.fx + s.fr * s.fr < near * near) found = ball_newton(of, &s, BALL_STEPS);
    }
    if (!found) found = ball_anew(of, start, &s);
    ball_answer(of, &s, start, out);
    return found;
}
