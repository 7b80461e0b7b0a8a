/* ---------------------------------------------------------------------------------------------------------------------
 * The bearing as callers see it: its numbers, its mirror, statuses
 * ------------------------------------------------------------------------------------------------------------------ */

size_t ehd_bearing_size(void) { return sizeof(ehd_bearing); }

size_t ehd_rollers_size(void) { return sizeof(ehd_rollers); }

int ehd_bearing_make(ehd_bearing *bearing, double play, int mirrored) {
    const double two_pi = 6.283185307179586476925;
    if (!bearing || !(fabs(play) <= DATA.most_travel)) return EHD_BAD_ARGUMENT;
    bearing->play = TAPERED ? 0.0 : 0.25 * play;
    bearing->offset = TAPERED ? play : 0.0;
    bearing->mirrored = mirrored != 0;
    bearing->added = NULL;
    for (int j = 0; j < EHD_ROLLERS; j++) {
        bearing->cosine[j] = cos(two_pi * (j % EHD_ROW_ROLLERS) / EHD_ROW_ROLLERS);
        bearing->sine[j] = sin(two_pi * (j % EHD_ROW_ROLLERS) / EHD_ROW_ROLLERS);
    }
    return EHD_OK;
}

/* The numbers of a bearing as the kernel reads them. */
static ehd_taper_data data_of(const ehd_bearing *bearing) {
    ehd_taper_data data = DATA;
    data.play = bearing->play;
    data.cosine = bearing->cosine;
    data.sine = bearing->sine;
    return data;
}

/* What callers may read of a roller. */
static void tell(const ehd_taper_roller *found, ehd_roller *roller) {
    roller->made = found->made != 0.0;
    roller->play = found->play;
    memcpy(roller->place, found->place, sizeof roller->place);
    memcpy(roller->ring, found->ring, sizeof roller->ring);
    memcpy(roller->share, found->share, sizeof roller->share);
    memcpy(roller->force, found->force, sizeof roller->force);
    memcpy(roller->stiffness, found->stiffness, sizeof roller->stiffness);
    memcpy(roller->damping, found->damping, sizeof roller->damping);
    roller->inner_load = found->inner_load;
    roller->outer_load = found->outer_load;
    roller->carried = found->carried;
    for (int m = 0; m < EHD_RIBS; m++) roller->rib_load[m] = found->rib_load[m];
}

/* The force by a law that is prepared; memory: what the films of the slices of cone and cup of each roller hold over a
 * step, or null. A bearing that stands the other way round is that of its mirror, x and turns the other way. */
static int bearing_at(const ehd_bearing *bearing, const ehd_law *law, ehd_rollers *rollers, const double pose[6],
                      const double velocity[6], double cage_angle, double inner_speed, double outer_speed,
                      const double *memory, ehd_bearing_force *result) {
    if (!result) return EHD_BAD_ARGUMENT;
    if (!bearing || !law || !law->made || !rollers || !pose || !(fabs(inner_speed) <= FASTEST) ||
        !(fabs(outer_speed) <= FASTEST))
        return no_force(result, EHD_BAD_ARGUMENT);
    if (!is_finite(cage_angle) || !finite_motion(pose, velocity)) return no_force(result, EHD_NOT_FINITE);
    const double way = bearing->mirrored ? -1.0 : 1.0, sign[6] = {way, 1.0, 1.0, 1.0, way, way};
    const double at[6] = {way * (pose[0] + bearing->offset), pose[1], pose[2], pose[3], way * pose[4], way * pose[5]};
    const double cage = ehd_cage(inner_speed, outer_speed);
    const double spin = ROLLER_SPEED * (inner_speed - outer_speed) + cage * AXIS[0];
    const double loads[3] = {0.0, CENTRIFUGAL * cage * cage,
                             cage * AXIS[1] * (INERTIA[0] * spin - INERTIA[1] * cage * AXIS[0])};
    double by_rates[EHD_PAIR_BY_RATES];
    ehd_taper_data data = data_of(bearing);
    data.added = bearing->added;
    data.by_rates = by_rates;
    const ehd_pair_law pair[2] = {pair_of(&law->inner), pair_of(&law->outer)};
    ehd_taper_roller *own = (ehd_taper_roller *)rollers->own;
    ehd_taper_answer answer;
    const int loaded = ehd_taper_force(&data, pair, at, cage_angle, loads, memory, own, &answer);
    if (loaded < 0) {
        if (loaded == EHD_TAPER_NO_BALANCE) memset(rollers, 0, sizeof *rollers);
        return no_force(result, loaded == EHD_TAPER_NO_BALANCE ? EHD_NO_BALANCE : EHD_TOO_FAR);
    }
    for (int j = 0; j < EHD_ROLLERS; j++) tell(&own[j], &rollers->roller[j]);
    for (int i = 0; i < 6; i++) {
        result->force[i] = sign[i] * answer.force[i];
        if (data.added) result->force[i] += sign[i] * by_rates[i];
        for (int k = 0; k < 6; k++) {
            result->stiffness[i][k] = sign[i] * sign[k] * answer.stiffness[i][k];
            result->damping[i][k] = sign[i] * sign[k] * answer.damping[i][k];
            if (velocity) result->force[i] -= result->damping[i][k] * velocity[k];
        }
    }
    result->cage_speed = cage;
    return law->status | (ehd_taper_largest(EHD_ROLLERS, own) > law->highest ? EHD_ABOVE_LOAD : EHD_OK);
}

int ehd_bearing_call(const ehd_bearing *bearing, ehd_law *law, ehd_rollers *rollers, const double pose[6],
                     const double velocity[6], double cage_angle, double inner_speed, double outer_speed,
                     ehd_bearing_force *result) {
    if (!result) return EHD_BAD_ARGUMENT;
    if (!law || !(fabs(inner_speed) <= FASTEST) || !(fabs(outer_speed) <= FASTEST))
        return no_force(result, EHD_BAD_ARGUMENT);
    ehd_prepare(law, EHD_ENTRAINMENT * (inner_speed - outer_speed));
    return bearing_at(bearing, law, rollers, pose, velocity, cage_angle, inner_speed, outer_speed, NULL, result);
}
