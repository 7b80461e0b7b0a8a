/* ---------------------------------------------------------------------------------------------------------------------
 * What bearings of five freedoms answer in runs: x, y, z, theta_y, theta_z of the inner ring against the outer one
 * ------------------------------------------------------------------------------------------------------------------ */

#define PAIR_FELT 5

/* Displacements that a bearing feels. */
static const int PAIR_PLACE[PAIR_FELT] = {0, 1, 2, 4, 5};

/* Pose (6,) of an inner ring by what its bearing feels. */
static void pair_read_pose(int64_t first, double offset, const double *motion, double *pose) {
    pose[3] = 0.0;
    for (int p = 0; p < PAIR_FELT; p++) pose[PAIR_PLACE[p]] = motion[first + p];
    pose[0] += offset;
}

/* Moment that a bearing asks of its cage [N m], by pose and force at rest. */
static double pair_turned_by(const double *pose, const double *force) {
    return pose[1] * force[2] - pose[2] * force[1] + (pose[4] * force[5] - pose[5] * force[4]);
}

/* Write the answer of a bearing by its force at rest, stiffness and damping (6, 6), and both powers (2,): what it
 * dissipates, and what its cage brings in, which turns by `turn` of the system. */
static void pair_answer_port(int64_t first, double turn, const ehd_moment *at, const double *motion, const double *pose,
                             const double *force, const double *stiffness, const double *damping, ehd_answers *answers,
                             double *powers) {
    const double *rate = motion + answers->m + first;
    double dissipated = 0.0;
    for (int p = 0; p < PAIR_FELT; p++) {
        const int row = PAIR_PLACE[p];
        double total = force[row], *slopes = answers->slopes + (first + p) * answers->m + first;
        for (int q = 0; q < PAIR_FELT; q++) {
            const int at_column = 6 * row + PAIR_PLACE[q];
            const double slowed = damping[at_column] * rate[q];
            total -= slowed;
            dissipated += rate[p] * slowed;
            slopes[q] = at->by_q * stiffness[at_column] + at->by_v * damping[at_column];
        }
        answers->force[first + p] = total;
    }
    powers[0] = dissipated;
    powers[1] = pair_turned_by(pose, force) * turn * at->speed;
}
