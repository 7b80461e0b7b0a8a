/* ---------------------------------------------------------------------------------------------------------------------
 * Force of a gear mesh along its line of action, and gear meshes in runs
 *
 * Each flank feels one compression p and its rate. Stiffness k and damping c act while it is compressed, by the rule
 * that knows no tension. Within TOUCH of first contact the stiffness rises from zero in a straight line and the damping
 * by 3 s^2 - 2 s^3, so that the force is C1 in compression and rate, at any rate. A compressed flank is thereby offset
 * by TOUCH/2, which is far below the roughness of a ground flank.
 *
 * By the angle phi of the system, with the phase x = teeth phi + phase, the stiffness is mean (1 + sum a_j cos(j x +
 * b_j)) and the transmission error e = sum e_j cos(j x + f_j). The driving flank is compressed by e less, the other one
 * by the backlash less e. With the energy k(t) G(p) the force F does -F dp/dt - F de/dt on the gears, and stores F_rest
 * dp/dt + G dk/dt: dissipated is (F - F_rest) dp/dt, brought in G dk/dt - F de/dt.
 * ------------------------------------------------------------------------------------------------------------------ */

#define MESH_TOUCH 1e-7 /* compression over which contact becomes whole [m] */

/* constants (5,): mean stiffness [N/m], damping [N s/m], backlash [m], mesh phase for each angle of the system, and its
 * beginning [rad]; series (4, harmonics): amplitudes and phases of stiffness, then of error [m]. */
typedef struct ehd_gear_mesh {
    int64_t harmonics;
    const double *constants, *series;
} ehd_gear_mesh;

/* Meshes of a run: first of what each feels, its place among all elements, (count, 5) and (count, 4, harmonics). */
typedef struct ehd_gear_block {
    int64_t count, harmonics;
    const int64_t *firsts, *places;
    const double *constants, *series;
} ehd_gear_block;

EHD_SIZE_OF(ehd_gear_mesh)
EHD_SIZE_OF(ehd_gear_block)

/* Force of a flank [N] and its derivatives by compression and rate [N/m], [N s/m], into out. */
void ehd_gear_flank(double compression, double rate, double stiffness, double damping, double *out) {
    double w, k, c, bend;
    out[0] = out[1] = out[2] = 0.0;
    if (compression <= 0.0) return;
    if (compression < MESH_TOUCH) {
        const double s = compression / MESH_TOUCH;
        w = 0.5 * stiffness * compression * s;
        k = stiffness * s;
        c = damping * s * s * (3.0 - 2.0 * s);
        bend = 6.0 * damping * s * (1.0 - s) / MESH_TOUCH;
    } else {
        w = stiffness * (compression - 0.5 * MESH_TOUCH);
        k = stiffness;
        c = damping;
        bend = 0.0;
    }
    ehd_force force;
    unilateral(w, k, c, bend, rate, &force);
    out[0] = force.load;
    out[1] = force.stiffness;
    out[2] = force.damping;
}

/* Stiffness [N/m] and its rate [N/(m s)], transmission error [m] and its rate [m/s], at an angle and speed. */
typedef struct mesh_course {
    double stiffness, change, error, error_rate;
} mesh_course;

static mesh_course mesh_course_at(const ehd_gear_mesh *mesh, double angle, double speed) {
    const int64_t h = mesh->harmonics;
    const double *size = mesh->series, *begin = size + h, *error_size = begin + h, *error_begin = error_size + h;
    const double phase = mesh->constants[3] * angle + mesh->constants[4], pace = mesh->constants[3] * speed;
    mesh_course at = {1.0, 0.0, 0.0, 0.0};
    for (int64_t j = 0; j < h; j++) {
        const double order = (double)j + 1.0, place = order * phase + begin[j];
        const double error_place = order * phase + error_begin[j];
        at.stiffness += size[j] * cos(place);
        at.change -= order * pace * size[j] * sin(place);
        at.error += error_size[j] * cos(error_place);
        at.error_rate -= error_size[j] * order * pace * sin(error_place);
    }
    at.stiffness *= mesh->constants[0];
    at.change *= mesh->constants[0];
    return at;
}

/* Compression of a flank, by that without error and backlash. */
static double mesh_compression(const ehd_gear_mesh *mesh, const mesh_course *at, int flank, double motion) {
    return motion - (flank == 0 ? at->error : mesh->constants[2] - at->error);
}

/* Forces of both flanks and their derivatives, into out (2, 3); motion and rate (2,) are the compressions of the
 * driving and of the other flank without error and backlash [m], and their rates [m/s]. */
void ehd_gear_force(const ehd_gear_mesh *mesh, double angle, double speed, const double *motion, const double *rate,
                    double *out) {
    const mesh_course at = mesh_course_at(mesh, angle, speed);
    for (int flank = 0; flank < 2; flank++) {
        const double moving = rate[flank] - (flank == 0 ? at.error_rate : -at.error_rate);
        ehd_gear_flank(mesh_compression(mesh, &at, flank, motion[flank]), moving, at.stiffness, mesh->constants[1],
                       out + 3 * flank);
    }
}

/* Energy of a flank at rest for each stiffness [m2]: the integral of its load over the compression [m]. */
static double mesh_flank_energy(double compression) {
    if (compression <= 0.0) return 0.0;
    if (compression < MESH_TOUCH) return compression * compression * compression / (6.0 * MESH_TOUCH);
    const double middle = compression - 0.5 * MESH_TOUCH;
    return MESH_TOUCH * MESH_TOUCH / 6.0 + 0.5 * (middle * middle - 0.25 * MESH_TOUCH * MESH_TOUCH);
}

/* Power that both flanks dissipate, and that stiffness and error bring in as they turn [W], into out (2,). */
void ehd_gear_powers(const ehd_gear_mesh *mesh, double angle, double speed, const double *motion, const double *rate,
                     double *out) {
    const mesh_course at = mesh_course_at(mesh, angle, speed);
    out[0] = out[1] = 0.0;
    for (int flank = 0; flank < 2; flank++) {
        const double error_rate = flank == 0 ? at.error_rate : -at.error_rate, moving = rate[flank] - error_rate;
        const double compression = mesh_compression(mesh, &at, flank, motion[flank]);
        double in_motion[3], at_rest[3];
        ehd_gear_flank(compression, moving, at.stiffness, mesh->constants[1], in_motion);
        ehd_gear_flank(compression, 0.0, at.stiffness, mesh->constants[1], at_rest);
        out[0] += (in_motion[0] - at_rest[0]) * moving;
        out[1] += at.change * mesh_flank_energy(compression) - in_motion[0] * error_rate;
    }
}

/* Energy that both flanks store [J]. */
double ehd_gear_energy(const ehd_gear_mesh *mesh, double angle, const double *motion) {
    const mesh_course at = mesh_course_at(mesh, angle, 0.0);
    double stored = 0.0;
    for (int flank = 0; flank < 2; flank++)
        stored += mesh_flank_energy(mesh_compression(mesh, &at, flank, motion[flank]));
    return at.stiffness * stored;
}

static ehd_gear_mesh mesh_of(const ehd_gear_block *block, int64_t g) {
    const ehd_gear_mesh mesh = {block->harmonics, block->constants + 5 * g, block->series + 4 * block->harmonics * g};
    return mesh;
}

int ehd_gear_block_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    const ehd_gear_block *block = data;
    const int64_t m = answers->m;
    for (int64_t g = 0; g < block->count; g++) {
        const int64_t first = block->firsts[g];
        const ehd_gear_mesh mesh = mesh_of(block, g);
        double flanks[6];
        ehd_gear_force(&mesh, at->angle, at->speed, motion + first, motion + m + first, flanks);
        for (int i = 0; i < 2; i++) {
            answers->force[first + i] = -flanks[3 * i];
            answers->slopes[(first + i) * (m + 1)] = at->by_q * flanks[3 * i + 1] + at->by_v * flanks[3 * i + 2];
        }
    }
    return EHD_FOUND;
}

void ehd_gear_block_powers(void *data, const ehd_moment *at, const double *motion, const ehd_answers *answers,
                           double *out) {
    const ehd_gear_block *block = data;
    for (int64_t g = 0; g < block->count; g++) {
        const double *felt = motion + block->firsts[g];
        const ehd_gear_mesh mesh = mesh_of(block, g);
        ehd_gear_powers(&mesh, at->angle, at->speed, felt, felt + answers->m, out + 3 * block->places[g]);
    }
}
