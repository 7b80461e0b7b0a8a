/* ---------------------------------------------------------------------------------------------------------------------
 * The bearing
 * ------------------------------------------------------------------------------------------------------------------ */

size_t ehd_bearing_size(void) { return sizeof(ehd_bearing); }

size_t ehd_rollers_size(void) { return sizeof(ehd_rollers); }

int ehd_bearing_make(ehd_bearing *bearing, double play, int mirrored) {
    const double two_pi = 6.283185307179586476925;
    if (!bearing || !(fabs(play) <= MOST_TRAVEL)) return EHD_BAD_ARGUMENT;
    bearing->play = TAPERED ? 0.0 : 0.25 * play;
    bearing->offset = TAPERED ? play : 0.0;
    bearing->mirrored = mirrored != 0;
    for (int j = 0; j < EHD_ROLLERS; j++) {
        bearing->cosine[j] = cos(two_pi * j / EHD_ROLLERS);
        bearing->sine[j] = sin(two_pi * j / EHD_ROLLERS);
    }
    return EHD_OK;
}

/* Add way matrix way' of a roller to a matrix of the bearing. way: of each displacement of the ring, what it does to the
 * middle of the roller. */
static void add_matrix(double sum[6][6], double m[3][3], double way[6][3]) {
    for (int k = 0; k < 6; k++) {
        const double column[3] = {dot(m[0], way[k]), dot(m[1], way[k]), dot(m[2], way[k])};
        for (int i = 0; i < 6; i++) sum[i][k] += dot(way[i], column);
    }
}

/* The force by a law that is prepared; held: what the films of the slices of cone and cup of each roller hold over a
 * step, or null. */
static int bearing_at(const ehd_bearing *bearing, const ehd_law *law, ehd_rollers *rollers, const double pose[6],
                      const double velocity[6], double cage_angle, double inner_speed, double outer_speed,
                      const double (*held)[2][EHD_SLICES][3], ehd_bearing_force *result) {
    if (!result) return EHD_BAD_ARGUMENT;
    if (!bearing || !law || !law->made || !rollers || !pose || !(fabs(inner_speed) <= FASTEST) ||
        !(fabs(outer_speed) <= FASTEST))
        return no_force(result, EHD_BAD_ARGUMENT);
    if (!is_finite(cage_angle) || !finite_motion(pose, velocity)) return no_force(result, EHD_NOT_FINITE);
    const double x = pose[0] + bearing->offset, way = bearing->mirrored ? -1.0 : 1.0;
    if (!(fabs(x) <= MOST_TRAVEL && fabs(pose[1]) <= MOST_TRAVEL && fabs(pose[2]) <= MOST_TRAVEL &&
          fabs(pose[4]) <= MOST_TILT && fabs(pose[5]) <= MOST_TILT))
        return no_force(result, EHD_TOO_FAR);
    const double cage = ehd_cage(inner_speed, outer_speed);
    const double spin = ROLLER_SPEED * (inner_speed - outer_speed) + cage * AXIS[0];
    const double turn_c = cos(cage_angle), turn_s = sin(cage_angle);
    given of = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, bearing->play, law, NULL};
    of.loads[1] = CENTRIFUGAL * cage * cage;
    of.loads[2] = cage * AXIS[1] * (INERTIA[0] * spin - INERTIA[1] * cage * AXIS[0]);
    if (DRY && fabs(of.loads[1]) + fabs(of.loads[2]) / ARM < LIGHT) of.loads[1] = of.loads[2] = 0.0;
    double largest = 0.0;
    memset(result, 0, sizeof *result);
    for (int j = 0; j < EHD_ROLLERS; j++) {
        ehd_roller *roller = &rollers->roller[j];
        const double c = turn_c * bearing->cosine[j] - turn_s * bearing->sine[j];
        const double s = turn_s * bearing->cosine[j] + turn_c * bearing->sine[j];
        const double arm = 0.5 * EHD_PITCH_DIAMETER * way;
        double ways[6][3] = {{way, 0.0, 0.0}, {0.0, c, 0.0}, {0.0, s, 0.0}, {0.0, 0.0, 0.0},
                                   {arm * s, 0.0, -way * s}, {-arm * c, 0.0, way * c}};
        of.d[2] = way * (pose[5] * c - pose[4] * s);
        of.d[0] = way * x - 0.5 * EHD_PITCH_DIAMETER * of.d[2];
        of.d[1] = pose[1] * c + pose[2] * s;
        if (held) of.held = held[j];
        int found = place_roller(&of, roller);
        if (!found) { /* once more, from nothing */
            memset(roller, 0, sizeof *roller);
            found = place_roller(&of, roller);
        }
        if (!found) {
            memset(rollers, 0, sizeof *rollers);
            return no_force(result, EHD_NO_BALANCE);
        }
        largest = most(largest, most(roller->inner_load, roller->outer_load));
        if (roller->carried <= 0.0) continue;
        for (int i = 0; i < 6; i++) result->force[i] -= dot(ways[i], roller->force);
        add_matrix(result->stiffness, roller->stiffness, ways);
        add_matrix(result->damping, roller->damping, ways);
    }
    for (int i = 0; velocity && i < 6; i++)
        for (int k = 0; k < 6; k++) result->force[i] -= result->damping[i][k] * velocity[k];
    result->cage_speed = cage;
    return law->status | (largest > law->highest ? EHD_ABOVE_LOAD : EHD_OK);
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
