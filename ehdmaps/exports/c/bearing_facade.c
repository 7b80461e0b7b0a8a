/* ---------------------------------------------------------------------------------------------------------------------
 * The bearing with the data of this file
 * ------------------------------------------------------------------------------------------------------------------ */

size_t ehd_bearing_size(void) { return sizeof(ehd_bearing); }

size_t ehd_prepared_size(void) { return sizeof(ehd_prepared); }

/* Depth of the roller's profile at a distance from its middle, on one side [m]. */
static double roller_profile(double x) {
#if EHD_ISO_PROFILE
    /* ISO/TS 16281: logarithmic; rollers longer than 2.5 diameters are straight in the middle */
    const int is_short = EHD_ROLLER_LENGTH <= 2.5 * EHD_ROLLER_DIAMETER;
    const double crowned = is_short ? EHD_ROLLER_LENGTH : 2.5 * EHD_ROLLER_DIAMETER;
    const double part = most(2.0 * fabs(x) - (EHD_ROLLER_LENGTH - crowned), 0.0) / crowned;
    return -(is_short ? 0.00035 : 0.0005) * EHD_ROLLER_DIAMETER * log1p(-part * part);
#else
    (void)x; /* straight */
    return 0.0;
#endif
}

int ehd_bearing_make(ehd_bearing *bearing, double clearance, int count, const double *profile) {
    if (!bearing || count < 1 || count > EHD_MOST_SLICES || !is_finite(clearance)) return EHD_BAD_ARGUMENT;
    bearing->slices = count;
    bearing->clearance = clearance;
    bearing->added = NULL;
    bearing->slice_length = EHD_ROLLER_LENGTH / count;
    bearing->least_profile = DBL_MAX;
    bearing->most_profile = -DBL_MAX;
    bearing->position[count] = bearing->profile[count] = 0.0;
    for (int i = 0; i < count; i++) {
        const double x = (2 * i + 1 - count) / (2.0 * count) * EHD_ROLLER_LENGTH; /* alike on both sides, to the bit */
        const double depth = profile ? profile[i] : roller_profile(x);
        if (!(fabs(depth) < EHD_ROLLER_DIAMETER)) return EHD_BAD_ARGUMENT;
        bearing->position[i] = x;
        bearing->profile[i] = 2.0 * depth;
        bearing->least_profile = least(bearing->least_profile, 2.0 * depth);
        bearing->most_profile = most(bearing->most_profile, 2.0 * depth);
    }
    bearing->symmetric = 1;
    for (int i = 0; i < count; i++)
        if (bearing->profile[i] != bearing->profile[count - 1 - i]) bearing->symmetric = 0;
    return EHD_OK;
}

static const ehd_cylinder NO_SHAPE;

/* The bearing as the functions above take it. */
static ehd_cylinder shape_of(const ehd_bearing *bearing) {
    const ehd_cylinder shape = {
        /* the largest accepted displacement is the roller diameter, the largest tilt 0.5 rad */
        .rollers = EHD_ROLLERS, .slices = bearing->slices, .symmetric = bearing->symmetric,
        .half_clearance = 0.5 * bearing->clearance, .slice_length = bearing->slice_length,
        .most_travel = EHD_ROLLER_DIAMETER, .most_tilt = 0.5, .half_length = 0.5 * EHD_ROLLER_LENGTH,
        .least_profile = bearing->least_profile, .most_profile = bearing->most_profile,
        .position = bearing->position, .profile = bearing->profile, .cosine = COSINES, .sine = SINES,
        .row = ROW_PLACES,
        .added = bearing->added,
    };
    return shape;
}

/* The law as they take it; they write nothing where it is prepared. */
static ehd_cylinder_law law_of(const ehd_prepared *law) {
    ehd_prepared *own = (ehd_prepared *)law;
    const ehd_cylinder_law parts = {
        .numbers = &own->numbers, .cells = own->cell[0][0], .knots = own->knot, .film = own->node[0],
        .nodes = own->node[0], .marks = own->mark, .point = &own->point.law,
    };
    return parts;
}

int ehd_prepare(ehd_prepared *law, double u, double T, double q) {
    if (!law) return EHD_BAD_ARGUMENT;
    ehd_cylinder_law parts = law_of(law);
    law->prepared = 1;
    return ehd_cylinder_prepare(&LAW, u, T, q, EHD_WHOLE, &parts);
}

int ehd_bearing_at(const ehd_bearing *bearing, const ehd_prepared *law, const double pose[6], const double velocity[6],
                   double cage_angle, ehd_bearing_force *result) {
    double states[4 * EHD_MOST_SLICES], place[EHD_MOST_SLICES + 1];
    uint64_t row[EHD_MOST_SLICES + 1];
    const ehd_cylinder_work work = {.states = states, .place = place, .row = row};
    ehd_ring_motion motion;
    if (!result) return EHD_BAD_ARGUMENT;
    no_bearing_force(result);
    if (!bearing || !law || !pose || !law->prepared) return EHD_BAD_ARGUMENT;
    const ehd_cylinder shape = shape_of(bearing);
    const ehd_cylinder_law parts = law_of(law);
    int status = (int)law->point.law.status | given_motion(&shape, pose, velocity ? velocity : AT_REST, cage_angle, &motion);
    if (refuses(&LAW, status)) return status;
    status |= cylinder_force(&shape, &parts, &motion, &work, result);
    return settled_force(&LAW, status, result);
}

int ehd_bearing_call(const ehd_bearing *bearing, ehd_prepared *law, const double pose[6], const double velocity[6],
                     double cage_angle, double u, double T, double q, ehd_bearing_force *result) {
    if (!law) return EHD_BAD_ARGUMENT;
    const ehd_law_point *point = &law->point.law;
    const int same = law->prepared && point->entrainment_speed == fabs(u) && point->temperature == T &&
                     point->centrifugal_load == q;
    if (!same) ehd_prepare(law, u, T, q);
    return ehd_bearing_at(bearing, law, pose, velocity, cage_angle, result);
}

int ehd_bearing_settled(const ehd_bearing *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                        ehd_film_state states[]) {
    const ehd_cylinder shape = bearing ? shape_of(bearing) : NO_SHAPE;
    return ehd_cylinder_settled(bearing ? &shape : NULL, film, pose, cage_angle, states);
}

int ehd_bearing_advance(const ehd_bearing *bearing, const ehd_film *film, double step, double last_step,
                        const double pose[6], double cage_angle, const ehd_film_state before[], ehd_film_state after[],
                        ehd_bearing_force *result) {
    const ehd_cylinder shape = bearing ? shape_of(bearing) : NO_SHAPE;
    return ehd_cylinder_advance(bearing ? &shape : NULL, film, step, last_step, pose, cage_angle, before, after, result);
}

int ehd_bearing_rates(const ehd_bearing *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                      const double states[], ehd_film_rates rates[], ehd_bearing_force *result) {
    const ehd_cylinder shape = bearing ? shape_of(bearing) : NO_SHAPE;
    return ehd_cylinder_rates(bearing ? &shape : NULL, film, pose, cage_angle, states, rates, result);
}

void ehd_bearing_direction(const ehd_bearing *bearing, double cage_angle, int j, int i, double column[4]) {
    const ehd_cylinder shape = shape_of(bearing);
    ehd_cylinder_direction(&shape, cage_angle, j, i, column);
}
