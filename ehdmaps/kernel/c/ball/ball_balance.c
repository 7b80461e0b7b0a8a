/* ---------------------------------------------------------------------------------------------------------------------
 * The balance of a ball
 *
 * With e_o = v/|v|, e_i = (d - v)/|d - v| the ball is in balance where
 *
 *     Q_i e_i - Q_o e_o + P = 0,    P = F_c (0, 1) + t sin(a_o) (-cos a_o, sin a_o),    a_o the angle of e_o.
 *
 * F_c is its centrifugal load, t sin(a_o) the traction at the outer raceway that holds its gyroscopic moment: both by its
 * speed around the axis, at which it rolls at both raceways and does not drill at the outer one (outer race control). With
 * g = Dw/d_m and c = cos(a_i - a_o) that is w_c = (w_i (1 - g cos a_i) + w_o (c + g cos a_i))/(1 + c).
 *
 * With K_i, K_o the stiffness of the contacts (their rotation included), L = K_i + dP/dd, M = K_i + K_o - dP/dv,
 * S = M^-1 L and S' = K_i M^-1 slow motion has
 *
 *     stiffness  K_i - K_i S = S' (M - L),        damping  C_i - C_i S - S' C_i + S' (C_i + C_o) S.
 *
 * A ball begins where it was, moved by S as d has moved since.
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
} ball_given;

/* Forces on a ball at a place, and what they come from. */
typedef struct ball_state {
    double x, r, fx, fr, size;             /* v; force that is left; sum of the sizes of its parts [N] */
    double m00, m01, m10, m11;             /* minus its derivative by the place [N/m] */
    double qi, qo, ki, ko, at_i, at_o;     /* loads, stiffness, places on tables */
    double ix, ir, ox, orr;                /* e_i and e_o */
    double distance, reach;                /* of v from both groove centres [m] */
    double speed, centrifugal, traction;   /* around the axis [rad/s], F_c and t [N] */
    double px, pr, dx, dr;                 /* dP/dspeed [N s], dspeed/dd [rad/(s m)] */
} ball_state;

/* Speed of a ball around the axis [rad/s] by its contact angles, and its derivatives by both, by_i and by_o. */
EHD_INLINE double ball_orbit(const ehd_ball_drive *of, double ix, double ir, double ox, double orr, double *by_i,
                              double *by_o) {
    *by_i = *by_o = 0.0;
    if (of->cage == of->cage) return of->cage;
    double c = ix * ox + ir * orr, s = ix * orr - ir * ox;
    if (!(c > 0.0)) c = s = 0.0; /* no inner raceway is there that could drive it */
    const double one = 1.0 / (1.0 + c), slow = of->outer - of->inner;
    const double speed = of->inner + slow * (c + of->ratio * ir) * one;
    *by_o = s * (of->outer - speed) * one;
    *by_i = -*by_o - slow * of->ratio * ix * one;
    return speed;
}

/* F_c of a ball and t by its speed [N], and their derivatives by it [N s]; out (4,). The ball turns against the cage, and
 * its spin is turned by w_c: the gyroscopic moment is J w_c (w_c - w_o) (d_m/Dw) sin a_o. Traction of rings that turn
 * against each other would drive an idle ball out of its groove: t >= -F_c/2. */
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

EHD_INLINE ball_state ball_state_at(const ball_given *of, double x, double r) {
    ball_state s;
    double ix = of->dx - x, ir = of->dr - r, by_i, by_o, load[4];
    const double reach = sqrt(x * x + r * r), distance = most(sqrt(ix * ix + ir * ir), 1e-300);
    const ehd_pair_load outer =
        pair_carried_by(of->outer, of->outer_scale, of->outer_step, reach - of->outer_arm, of->held_outer);
    const ehd_pair_load inner =
        pair_carried_by(of->inner, of->inner_scale, of->inner_step, distance - of->inner_arm, of->held_inner);
    const double qo = outer.load, ko = outer.stiffness, qi = inner.load, ki = inner.stiffness;
    const double one_o = 1.0 / reach, one_i = 1.0 / distance, ox = x * one_o, orr = r * one_o;
    ix *= one_i;
    ir *= one_i;
    const double to = qo * one_o, ti = qi * one_i;
    s.speed = ball_orbit(&of->drive, ix, ir, ox, orr, &by_i, &by_o);
    ball_loads(&of->drive, s.speed, load);
    const double centrifugal = load[0], traction = load[1];
    s.px = -load[3] * ox * orr;
    s.pr = load[2] + load[3] * ox * ox;
    /* a_i and a_o follow d and v by (cos, -sin) over the distance */
    s.dx = by_i * ir * one_i;
    s.dr = -by_i * ix * one_i;
    const double vx = by_o * orr * one_o - s.dx, vr = -by_o * ox * one_o - s.dr;
    /* the traction turns with the angle a_o, whose derivative by the place is (cos, -sin)/reach */
    const double turn_x = traction * (orr * orr - ox * ox) * one_o, turn_r = -2.0 * traction * ox * orr * one_o;
    const double mixed = (ko - to) * ox * orr + (ki - ti) * ix * ir;
    s.x = x;
    s.r = r;
    s.fx = qi * ix - qo * ox - traction * ox * orr;
    s.fr = qi * ir - qo * orr + centrifugal + traction * ox * ox;
    s.size = qi + qo + centrifugal;
    s.m00 = (ko - to) * ox * ox + to + (ki - ti) * ix * ix + ti + turn_x * orr - s.px * vx;
    s.m01 = mixed - turn_x * ox - s.px * vr;
    s.m10 = mixed + turn_r * orr - s.pr * vx;
    s.m11 = (ko - to) * orr * orr + to + (ki - ti) * ir * ir + ti - turn_r * ox - s.pr * vr;
    s.qi = qi;
    s.qo = qo;
    s.ki = ki;
    s.ko = ko;
    s.at_i = inner.place;
    s.at_o = outer.place;
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

/* Force, stiffness and damping of a ball in balance, and where it begins the next time. */
EHD_INLINE void ball_answer(const ball_given *of, const ball_state *s, ehd_ball_start *start, ehd_ball_found *out) {
    const double qi = s->qi, ki = s->ki, ix = s->ix, ir = s->ir, ox = s->ox, orr = s->orr, ti = qi / s->distance;
    const double k00 = (ki - ti) * ix * ix + ti, k01 = (ki - ti) * ix * ir, k11 = (ki - ti) * ir * ir + ti;
    const double m00 = s->m00, m01 = s->m01, m10 = s->m10, m11 = s->m11, determinant = m00 * m11 - m01 * m10;
    const double l00 = k00 + s->px * s->dx, l01 = k01 + s->px * s->dr;
    const double l10 = k01 + s->pr * s->dx, l11 = k11 + s->pr * s->dr;
    start->centre[0] = s->x;
    start->centre[1] = s->r;
    start->groove[0] = of->dx;
    start->groove[1] = of->dr;
    for (int i = 0; i < 4; i++) start->share[i] = 0.0;
    out->force[0] = qi * ix;
    out->force[1] = qi * ir;
    out->load[0] = qi;
    out->load[1] = s->qo;
    out->angle[0] = out->angle[1] = 0.0;
    out->approach[0] = s->distance - of->inner_arm;
    out->approach[1] = s->reach - of->outer_arm;
    out->inner[0] = ix;
    out->inner[1] = ir;
    out->outer[0] = ox;
    out->outer[1] = orr;
    out->place[0] = s->at_i;
    out->place[1] = s->at_o;
    out->speed = s->speed;
    out->centrifugal = s->centrifugal;
    out->traction = s->traction;
    if (qi <= 0.0 || determinant == 0.0) {
        for (int i = 0; i < 4; i++) out->stiffness[i] = out->damping[i] = 0.0;
        return;
    }
    const double ci = pair_slowed(of->inner, ki, s->at_i, of->held_inner);
    const double co = pair_slowed(of->outer, s->ko, s->at_o, of->held_outer);
    const double one = 1.0 / determinant, n00 = m11 * one, n01 = -m01 * one, n10 = -m10 * one, n11 = m00 * one;
    const double s00 = n00 * l00 + n01 * l10, s01 = n00 * l01 + n01 * l11;
    const double s10 = n10 * l00 + n11 * l10, s11 = n10 * l01 + n11 * l11;
    const double p00 = k00 * n00 + k01 * n10, p01 = k00 * n01 + k01 * n11;
    const double p10 = k01 * n00 + k11 * n10, p11 = k01 * n01 + k11 * n11;
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
    out->stiffness[0] = p00 * b00 + p01 * b10;
    out->stiffness[1] = p00 * b01 + p01 * b11;
    out->stiffness[2] = p10 * b00 + p11 * b10;
    out->stiffness[3] = p10 * b01 + p11 * b11;
    /* dampers act along the contacts: their rates are u.(1 - S) and w.S, and their forces come back by S' */
    const double ux = ix - (ix * s00 + ir * s10), ur = ir - (ix * s01 + ir * s11);
    const double vx = ix - (p00 * ix + p01 * ir), vr = ir - (p10 * ix + p11 * ir);
    const double wx = ox * s00 + orr * s10, wr = ox * s01 + orr * s11;
    const double yx = p00 * ox + p01 * orr, yr = p10 * ox + p11 * orr;
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
        const double overlap = length - of->inner_arm - of->outer_arm;
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
    const double mx = of->dx - start->groove[0], mr = of->dr - start->groove[1], *by = start->share;
    const double x = start->centre[0] + by[0] * mx + by[1] * mr, r = start->centre[1] + by[2] * mx + by[3] * mr;
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
