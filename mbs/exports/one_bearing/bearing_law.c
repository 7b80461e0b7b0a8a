/* ---------------------------------------------------------------------------------------------------------------------
 * What bearings share: statuses, laws at a speed
 * ------------------------------------------------------------------------------------------------------------------ */

#define DRY (EHD_ROWS == 0)
#define FASTEST 2e4 /* speed of a ring [rad/s] */

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

/* A law as the functions on contacts read it. */
static ehd_pair_law pair_of(const ehd_contact *law) {
    const ehd_pair_law found = {law->coefficient, law->damping, law->damping_time, law->centre, law->scale,
                                law->first,       law->step,    EHD_ROWS,          &law->table[0][0]};
    return found;
}

#if DRY
static int law_at(ehd_law *law, double u) {
    (void)u;
    law->inner = INNER;
    law->outer = OUTER;
    law->highest = DBL_MAX;
    return EHD_OK;
}
#else
static int law_at(ehd_law *law, double u) {
    ehd_contact *const sides[2] = {&law->inner, &law->outer};
    int status = EHD_OK;
    law->inner = INNER;
    law->outer = OUTER;
    law->highest = SPEEDS.most_load;
    for (int side = 0; side < 2; side++) {
        ehd_contact *contact = sides[side];
        ehd_pair_law found = pair_of(contact);
        status |= ehd_pair_law_at(&SPEEDS, side, u, &found, &contact->table[0][0], &contact->springs[0][0]);
        contact->centre = found.centre;
        contact->scale = found.scale;
    }
    return status;
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
