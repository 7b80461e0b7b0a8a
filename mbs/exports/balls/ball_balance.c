/* ---------------------------------------------------------------------------------------------------------------------
 * The balance of a ball
 *
 * All of a ball happens in the plane of the axis and the ball. There the centre of the outer groove is the origin, d the
 * centre of the inner groove, v that of the ball, each (axial, radial). With e_o = v/|v|, e_i = (d - v)/|d - v| the ball
 * is in balance where
 *
 *     Q_i e_i - Q_o e_o + P = 0,    P = F_c (0, 1) + t sin(a_o) (-cos a_o, sin a_o),    a_o the angle of e_o.
 *
 * F_c is its centrifugal load, t sin(a_o) the traction at the outer raceway that holds its gyroscopic moment: both by its
 * speed around the axis, at which it rolls at both raceways and does not drill at the outer one (outer race control). With
 * g = Dw/d_m and c = cos(a_i - a_o) that is w_c = (w_i (1 - g cos a_i) + w_o (c + g cos a_i))/(1 + c).
 * ------------------------------------------------------------------------------------------------------------------ */

#define NEWTON_STEPS 12 /* until the angle is searched */
#define LAST_STEPS 6    /* and after that */
#define CUTS 12
#define BALANCE 1e-13
#define ROUGH_BALANCE 1e-9
#define ROUND_OFF 1e-15
#define NOTHING 1e-7 /* force of an idle ball that hardly goes around [N] */

/* Approach at which a contact carries a load, from a start near it [m]; zero without load. */
static double approach_of(const ehd_contact *law, double load, double start) {
    if (!(load > 0.0)) return 0.0;
    const double g = pow(load / law->coefficient, 2.0 / 3.0);
#if DRY
    (void)start;
    return g;
#else
    double low = law->centre - 1e3 * law->scale, high = g + 1e3 * law->scale;
    for (int i = 0; i < 20; i++) {
        const contact_state found = contact_of(law, start, NULL);
        if (!(found.load > 0.0 && found.stiffness > 0.0)) break;
        const double lacking = log(load / found.load);
        if (fabs(lacking) <= 1e-12) return start;
        start += lacking * found.load / found.stiffness;
    }
    for (int i = 0; i < 200 && high - low > 1e-15 * law->scale; i++) {
        const double middle = 0.5 * (low + high);
        if (contact_of(law, middle, NULL).load < load)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
#endif
}

/* Speeds of the rings [rad/s], and that of a cage that holds the balls, or null; where a ball with its centrifugal load
 * alone is in its approach [m], and the place of the inner groove's centre [m]. */
typedef struct given {
    double d[2], inner_speed, outer_speed, rest;
    const double *cage;
    const ehd_contact *inner, *outer;
    const double *held_inner, *held_outer; /* see contact_of */
} given;

/* Forces on a ball at a place, and what they come from: what is left of them, and the sum of their sizes [N]; minus the
 * derivative by the place [N/m]; loads, stiffness, damping; directions e_i and e_o; distances from both centres [m]; speed
 * around the axis [rad/s], derivative of P by it [N s], and its own one by d [rad/(s m)]. */
typedef struct state {
    double x, r, fx, fr, size, m00, m01, m10, m11, qi, qo, ki, ci, co, ix, ir, ox, orr, inner_distance, reach;
    double speed, px, pr, dx, dr;
} state;

/* Speed of a ball around the axis by its contact angles, and its derivatives by both. */
static double orbit(const given *of, double ix, double ir, double ox, double orr, double by_angle[2]) {
    const double ratio = EHD_BALL_DIAMETER / EHD_PITCH_DIAMETER, slow = of->outer_speed - of->inner_speed;
    double c = ix * ox + ir * orr, s = ix * orr - ir * ox;
    by_angle[0] = by_angle[1] = 0.0;
    if (of->cage) return *of->cage;
    if (!(c > 0.0)) c = s = 0.0; /* no inner raceway is there that could drive it */
    const double speed = of->inner_speed + slow * (c + ratio * ir) / (1.0 + c);
    by_angle[1] = s * (of->outer_speed - speed) / (1.0 + c);
    by_angle[0] = -by_angle[1] - slow * ratio * ix / (1.0 + c);
    return speed;
}

/* Centrifugal load F_c and t of a ball [N] by its speed, and their derivatives by it. Traction of rings that turn against
 * each other would drive an idle ball out of its groove: t >= -F_c/2. */
static void speed_loads(const given *of, double speed, double load[2], double by_speed[2]) {
    load[0] = CENTRIFUGAL * speed * speed;
    load[1] = GYROSCOPIC * speed * (speed - of->outer_speed);
    by_speed[0] = 2.0 * CENTRIFUGAL * speed;
    by_speed[1] = GYROSCOPIC * (2.0 * speed - of->outer_speed);
    if (load[1] < -0.5 * load[0]) {
        load[1] = -0.5 * load[0];
        by_speed[1] = -0.5 * by_speed[0];
    }
}

static state state_at(const given *of, double x, double r) {
    state s;
    const double reach = sqrt(x * x + r * r), dx = of->d[0] - x, dr = of->d[1] - r;
    const double distance = most(sqrt(dx * dx + dr * dr), 1e-300);
    const contact_state outer = contact_of(of->outer, reach - OUTER_ARM, of->held_outer);
    const contact_state inner = contact_of(of->inner, distance - INNER_ARM, of->held_inner);
    const double qo = outer.load, ko = outer.stiffness, qi = inner.load, ki = inner.stiffness;
    const double one_o = 1.0 / reach, one_i = 1.0 / distance;
    const double ox = x * one_o, orr = r * one_o, ix = dx * one_i, ir = dr * one_i;
    const double to = qo * one_o, ti = qi * one_i;
    double by_angle[2], load[2], by_speed[2];
    s.speed = orbit(of, ix, ir, ox, orr, by_angle);
    speed_loads(of, s.speed, load, by_speed);
    const double centrifugal = load[0], traction = load[1];
    s.px = -by_speed[1] * ox * orr;
    s.pr = by_speed[0] + by_speed[1] * ox * ox;
    /* a_i and a_o follow d and v by (cos, -sin) over the distance */
    s.dx = by_angle[0] * ir * one_i;
    s.dr = -by_angle[0] * ix * one_i;
    const double vx = by_angle[1] * orr * one_o - s.dx, vr = -by_angle[1] * ox * one_o - s.dr;
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
    s.ci = inner.damping;
    s.co = outer.damping;
    s.ix = ix;
    s.ir = ir;
    s.ox = ox;
    s.orr = orr;
    s.inner_distance = distance;
    s.reach = reach;
    return s;
}

static double left_of(const state *s) { return sqrt(s->fx * s->fx + s->fr * s->fr); }

/* Newton's method from a state: whether it ends in the balance. */
static int newton(const given *of, state *s, int steps) {
    double allowed = 0.0;
    for (int step = 0; step < steps; step++) {
        const double norm = left_of(s), trace = s->m00 + s->m11;
        allowed = ROUND_OFF * trace * s->reach; /* what the rounding of lengths leaves of small loads */
        if (norm <= BALANCE * s->size + 0.1 * allowed) return 1;
        double m00 = s->m00, m11 = s->m11, determinant = m00 * m11 - s->m01 * s->m10;
        if (!(determinant > 1e-14 * trace * trace)) {
            const double more = 1e-6 * trace + 1e-300;
            m00 += more;
            m11 += more;
            determinant = m00 * m11 - s->m01 * s->m10;
        }
        const double sx = (m11 * s->fx - s->m01 * s->fr) / determinant;
        const double sr = (m00 * s->fr - s->m10 * s->fx) / determinant;
        /* the step is gone around the outer groove's centre, and not straight: its contact is stiff */
        const double along = (sx * s->ox + sr * s->orr) / s->reach;
        const double turn = least(most((sx * s->orr - sr * s->ox) / s->reach, -0.5), 0.5);
        double part = 1.0;
        int moved = 0;
        for (int cut = 0; cut < CUTS && !moved; cut++, part *= 0.5) {
            const double c = cos(part * turn), i = sin(part * turn), far = 1.0 + part * along;
            const state ahead = state_at(of, far * (s->x * c + s->r * i), far * (s->r * c - s->x * i));
            if (left_of(&ahead) < (1.0 - 1e-4 * part) * norm) {
                *s = ahead;
                moved = 1;
            }
        }
        if (!moved) break;
    }
    return left_of(s) <= ROUGH_BALANCE * s->size + allowed + NOTHING;
}

/* Distance of a ball from the outer groove's centre by which forces along e_o at an angle are in balance [m]. The force
 * falls with the distance: Newton's method between bounds, whose slope leaves turns aside. */
static double reach_at(const given *of, double angle, double place) {
    const double c = cos(angle), i = sin(angle);
    double low = 0.0, high = DBL_MAX;
    for (int step = 0; step < 100; step++) {
        const state s = state_at(of, place * i, place * c);
        const double force = s.fx * i + s.fr * c;
        if (force > 0.0)
            low = place;
        else
            high = place;
        if (fabs(force) <= 1e-14 * s.size) break;
        const double slope = s.m00 * i * i + (s.m01 + s.m10) * i * c + s.m11 * c * c;
        double ahead = slope > 0.0 ? place + force / slope : DBL_MAX;
        if (!(low < ahead && ahead < high)) ahead = high < DBL_MAX ? 0.5 * (low + high) : place + 1e-2 * OUTER_ARM;
        if (fabs(ahead - place) <= 1e-15 * place) break;
        place = ahead;
    }
    return place;
}

/* Force on a ball across e_o, towards larger angles [N]. */
static double across_at(const given *of, double angle, double reach) {
    const state s = state_at(of, reach * sin(angle), reach * cos(angle));
    return s.fx * cos(angle) - s.fr * sin(angle);
}

/* Place of a ball by its angle a_o, which lies between zero and the direction of d: slow and safe. At each angle the
 * balance along e_o gives the distance, and what is left across e_o has one zero. */
static state searched(const given *of) {
    double low = 0.0, high = atan2(of->d[0], of->d[1]);
    const double sign = high >= 0.0 ? 1.0 : -1.0;
    double reach = reach_at(of, low, OUTER_ARM), at_low = sign * across_at(of, low, reach);
    if (at_low <= 0.0) return state_at(of, 0.0, reach);
    reach = reach_at(of, high, reach);
    double at_high = sign * across_at(of, high, reach), angle = high;
    if (at_high < 0.0) {
        const double first = least(at_low, -at_high);
        for (int step = 0; step < 100; step++) {
            /* regula falsi (Illinois), and halves in between */
            const double share = step % 4 ? at_low / (at_low - at_high) : 0.5;
            angle = low + share * (high - low);
            reach = reach_at(of, angle, reach);
            const double here = sign * across_at(of, angle, reach);
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
    return state_at(of, reach * sin(angle), reach * cos(angle));
}

/* Force, stiffness and damping of a ball in balance. With L = K_i + dP/dd, S = M^-1 L and S' = K_i M^-1 slow motion has
 * the stiffness K_i - K_i S and the damping C_i - C_i S - S' C_i + S' (C_i + C_o) S. */
static void answer(const state *s, ehd_ball *ball) {
    const double ix = s->ix, ir = s->ir, ox = s->ox, orr = s->orr, ti = s->qi / s->inner_distance;
    const double k00 = (s->ki - ti) * ix * ix + ti, k01 = (s->ki - ti) * ix * ir, k11 = (s->ki - ti) * ir * ir + ti;
    const double l00 = k00 + s->px * s->dx, l01 = k01 + s->px * s->dr;
    const double l10 = k01 + s->pr * s->dx, l11 = k11 + s->pr * s->dr;
    const double determinant = s->m00 * s->m11 - s->m01 * s->m10;
    ball->speed = s->speed;
    ball->centre[0] = s->x;
    ball->centre[1] = s->r;
    ball->force[0] = s->qi * ix;
    ball->force[1] = s->qi * ir;
    ball->inner_load = s->qi;
    ball->outer_load = s->qo;
    ball->inner_angle = atan2(ix, ir);
    ball->outer_angle = atan2(ox, orr);
    ball->inner_approach = s->inner_distance - INNER_ARM;
    ball->outer_approach = s->reach - OUTER_ARM;
    if (s->qi <= 0.0 || determinant == 0.0) return;
    const double one = 1.0 / determinant;
    const double n00 = s->m11 * one, n01 = -s->m01 * one, n10 = -s->m10 * one, n11 = s->m00 * one;
    const double s00 = n00 * l00 + n01 * l10, s01 = n00 * l01 + n01 * l11;
    const double s10 = n10 * l00 + n11 * l10, s11 = n10 * l01 + n11 * l11;
    const double p00 = k00 * n00 + k01 * n10, p01 = k00 * n01 + k01 * n11;
    const double p10 = k01 * n00 + k11 * n10, p11 = k01 * n01 + k11 * n11;
    /* K_i (1 - S), without the difference of nearly equal numbers: S' (M - L) */
    const double b00 = s->m00 - l00, b01 = s->m01 - l01, b10 = s->m10 - l10, b11 = s->m11 - l11;
    ball->stiffness[0] = p00 * b00 + p01 * b10;
    ball->stiffness[1] = p00 * b01 + p01 * b11;
    ball->stiffness[2] = p10 * b00 + p11 * b10;
    ball->stiffness[3] = p10 * b01 + p11 * b11;
    /* dampers act along the contacts: their rates are u.(1 - S) and w.S, and their forces come back by S' */
    const double ux = ix - (ix * s00 + ir * s10), ur = ir - (ix * s01 + ir * s11);
    const double vx = ix - (p00 * ix + p01 * ir), vr = ir - (p10 * ix + p11 * ir);
    const double wx = ox * s00 + orr * s10, wr = ox * s01 + orr * s11;
    const double yx = p00 * ox + p01 * orr, yr = p10 * ox + p11 * orr;
    ball->damping[0] = s->ci * vx * ux + s->co * yx * wx;
    ball->damping[1] = s->ci * vx * ur + s->co * yx * wr;
    ball->damping[2] = s->ci * vr * ux + s->co * yr * wx;
    ball->damping[3] = s->ci * vr * ur + s->co * yr * wr;
}

/* Find the balance of a ball; whether it was found. */
static int place_ball(const given *of, ehd_ball *ball) {
    const double length = sqrt(of->d[0] * of->d[0] + of->d[1] * of->d[1]);
    const double overlap = length - INNER_ARM - OUTER_ARM, px = ball->centre[0], pr = ball->centre[1];
    const double soft_outer = pow(of->outer->coefficient, -2.0 / 3.0);
    const double share = soft_outer / (soft_outer + pow(of->inner->coefficient, -2.0 / 3.0));
    const int still = of->inner_speed == 0.0 && of->outer_speed == 0.0 && !(of->cage && *of->cage != 0.0);
    memset(ball, 0, sizeof *ball);
    if (DRY && still && overlap <= 0.0) {
        const double reach = OUTER_ARM + 0.5 * overlap;
        ball->centre[0] = reach * of->d[0] / length;
        ball->centre[1] = reach * of->d[1] / length;
        ball->inner_angle = ball->outer_angle = atan2(of->d[0], of->d[1]);
        ball->inner_approach = ball->outer_approach = 0.5 * overlap;
        return 1;
    }
    if (DRY && still) { /* two dry contacts in line share the overlap */
        const double part = (OUTER_ARM + share * overlap) / length;
        const state s = state_at(of, part * of->d[0], part * of->d[1]);
        answer(&s, ball);
        return 1;
    }
    /* starts: where the ball was; in line between the grooves; on the outer raceway alone, in line and at its bottom */
    const double bottom = OUTER_ARM + of->rest;
    double best = DBL_MAX;
    state s = state_at(of, 0.0, bottom);
    for (int start = 0; start < 4; start++) {
        const double part = (start == 1 ? OUTER_ARM + share * overlap : bottom) / length;
        const double x = start == 0 ? px : start == 3 ? 0.0 : part * of->d[0];
        const double r = start == 0 ? pr : start == 3 ? bottom : part * of->d[1];
        if (!(x * x + r * r > 0.0)) continue;
        const state here = state_at(of, x, r);
        if (!(here.qo > 0.0)) continue; /* a ball between both raceways, without load, would not know where to go */
        const double error = left_of(&here) / here.size;
        if (error < best || (start == 3 && error < 1e-3)) { /* at the bottom: no inner contact, and in balance */
            best = error;
            s = here;
        }
        if (best < 0.3 && start == 0) break;
    }
    int found = newton(of, &s, NEWTON_STEPS);
    if (!found) {
        s = searched(of);
        found = newton(of, &s, LAST_STEPS);
    }
    answer(&s, ball);
    return found;
}
