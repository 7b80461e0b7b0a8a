/* ---------------------------------------------------------------------------------------------------------------------
 * The bearing: sums over its rollers
 *
 * A roller at the angle a, c = cos a, s = sin a, R from the axis and p along it, has D = (x - R turn, c y + s z + p turn,
 * turn), turn = c theta_z - s theta_y.
 * ------------------------------------------------------------------------------------------------------------------ */

#define TAPER_LIGHT 1e-6 /* load on a roller that is left out of dry contacts [N]: approaches by it would be rounding */

/* Add the symmetric matrix of a roller to the upper half of that of the ring. */
static void taper_on_ring(double m[3][3], double c, double s, double radius, double place, double sum[6][6]) {
    const double xx = m[0][0], xr = m[0][1], rr = m[1][1];
    const double x_turn = m[0][2] - radius * xx + place * xr, r_turn = m[1][2] - radius * xr + place * rr;
    const double turn = m[2][2] - radius * (m[0][2] + x_turn) + place * (m[1][2] + r_turn);
    sum[0][0] += xx;
    sum[0][1] += c * xr;
    sum[0][2] += s * xr;
    sum[0][4] -= s * x_turn;
    sum[0][5] += c * x_turn;
    sum[1][1] += c * c * rr;
    sum[1][2] += c * s * rr;
    sum[1][4] -= c * s * r_turn;
    sum[1][5] += c * c * r_turn;
    sum[2][2] += s * s * rr;
    sum[2][4] -= s * s * r_turn;
    sum[2][5] += c * s * r_turn;
    sum[4][4] += s * s * turn;
    sum[4][5] -= c * s * turn;
    sum[5][5] += c * c * turn;
}

/* Add what rates of deviations of a roller do to those of the bearing, EHD_PAIR_BY_RATES. */
static void taper_add_rates(const double own[5], double radius, double place, double c, double s, double *out) {
    const double moment = own[2] - radius * own[0] + place * own[1];
    out[0] -= own[0];
    out[1] -= c * own[1];
    out[2] -= s * own[1];
    out[4] += s * moment;
    out[5] -= c * moment;
    out[EHD_PAIR_OWN] += own[3];
    out[EHD_PAIR_AT_REST] += own[4];
}

/* Force on the inner ring at rest at a pose (6,), and its derivatives; the number of rollers that carry it, or what is
 * wrong: then rollers start from nothing the next time, where a balance was not found.
 *
 * law: of cone and cup, whole rollers; without rows C is that of a dry line [N/m^(10/9)]. cage_angle: of the first
 * roller, from y towards z [rad]. loads: on each roller, axial, radial [N], moment [N m]. memory (rollers, 2,
 * EHD_TAPER_MEMORY, slices): what the slices of cone and cup hold over a step, or null. rollers (rollers,): of the last
 * call; written. */
int ehd_taper_force(const ehd_taper_data *data, const ehd_pair_law law[2], const double pose[6], double cage_angle,
                    const double loads[3], const double *memory, ehd_taper_roller *rollers, ehd_taper_answer *answer) {
    double total = fabs(cage_angle) + fabs(loads[0]) + fabs(loads[1]) + fabs(loads[2]);
    for (int i = 0; i < 6; i++) total += fabs(pose[i]);
    if (!(total <= DBL_MAX)) return EHD_TAPER_NOT_FINITE;
    const double far = data->most_travel, tilt = data->most_tilt, radius = data->pitch_radius;
    if (!(fabs(pose[0]) <= far && fabs(pose[1]) <= far && fabs(pose[2]) <= far && fabs(pose[4]) <= tilt &&
          fabs(pose[5]) <= tilt))
        return EHD_TAPER_TOO_FAR;
    ehd_taper_data own = *data; /* with the ribs of the row */
    taper_given of = {&own, law, NULL, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, fabs(data->lever[data->slices - 1]),
                      NULL, NULL};
    double by_rates[5];
    const int dry = law[0].rows == 0 && law[1].rows == 0;
    if (!dry || fabs(loads[0]) + fabs(loads[1]) + fabs(loads[2]) / of.arm >= TAPER_LIGHT)
        memcpy(of.loads, loads, sizeof of.loads);
    const double turn_c = cos(cage_angle), turn_s = sin(cage_angle);
    int loaded = 0;
    memset(answer, 0, sizeof *answer);
    if (data->added) memset(data->by_rates, 0, EHD_PAIR_BY_RATES * sizeof *data->by_rates);
    for (int64_t j = 0; j < data->rollers; j++) {
        ehd_taper_roller *roller = rollers + j;
        const double c = turn_c * data->cosine[j] - turn_s * data->sine[j];
        const double s = turn_s * data->cosine[j] + turn_c * data->sine[j];
        const double place = data->row[j >= data->held];
        own.ribs = j < data->held ? data->ribs : 0;
        of.d[2] = pose[5] * c - pose[4] * s;
        of.d[0] = pose[0] - radius * of.d[2];
        of.d[1] = pose[1] * c + pose[2] * s + place * of.d[2];
        if (memory) of.memory = memory + j * 2 * EHD_TAPER_MEMORY * data->slices;
        if (data->added) {
            of.added = data->added + 4 * j;
            of.by_rates = memset(by_rates, 0, sizeof by_rates);
        }
        int found = taper_place(&of, roller);
        if (!found) { /* once more, from nothing */
            memset(roller, 0, sizeof *roller);
            found = taper_place(&of, roller);
        }
        if (!found) {
            memset(rollers, 0, (size_t)data->rollers * sizeof *rollers);
            return EHD_TAPER_NO_BALANCE;
        }
        if (data->added) taper_add_rates(by_rates, radius, place, c, s, data->by_rates);
        if (roller->carried <= 0.0) continue;
        loaded++;
        const double moment = roller->force[2] - radius * roller->force[0] + place * roller->force[1];
        answer->force[0] -= roller->force[0];
        answer->force[1] -= c * roller->force[1];
        answer->force[2] -= s * roller->force[1];
        answer->force[4] += s * moment;
        answer->force[5] -= c * moment;
        taper_on_ring(roller->stiffness, c, s, radius, place, answer->stiffness);
        taper_on_ring(roller->damping, c, s, radius, place, answer->damping);
    }
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < i; k++) {
            answer->stiffness[i][k] = answer->stiffness[k][i];
            answer->damping[i][k] = answer->damping[k][i];
        }
    return loaded;
}

/* Largest load of the lines of some rollers [N]. */
double ehd_taper_largest(int64_t count, const ehd_taper_roller *rollers) {
    double largest = 0.0;
    for (int64_t j = 0; j < count; j++)
        largest = most(largest, most(rollers[j].inner_load, rollers[j].outer_load));
    return largest;
}
