/* ---------------------------------------------------------------------------------------------------------------------
 * Dense algebra of time steps: for a dozen coordinates calling numpy costs more than computing
 *
 * Matrices are rows one behind the other. Sums of products are made in eight parts, which a processor can do at once: in
 * the same order whether it does two or four of them.
 *
 * The steps of mbs.transient.stepping have the acceleration a at their end as unknown, and the forces out of balance
 *
 *     r = M a + D v + K q - loads - T^T f,    with the Jacobian M + by_v D + by_q K + T^T (by_q K_e + by_v C_e) T,
 *
 * T the displacements of the ports by the coordinates, f, K_e, C_e what the elements answer.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Linear part and elements of a step in Python. */
typedef struct ehd_stepper_data {
    int64_t n, m;                              /* coordinates, ports */
    const double *mass, *damping, *stiffness;  /* (n, n) */
    const double *linear;                      /* (n, n), the Jacobian without the elements */
    const double *transform;                   /* (m, n), T */
    const double *weight;                      /* (n,), makes forces and moments comparable */
    const double *port_stiffness, *port_damping; /* (m, m) */
    double *room;                              /* (n, n) */
} ehd_stepper_data;

EHD_SIZE_OF(ehd_stepper_data)

static inline double dense_dot(int64_t n, const double *a, const double *x) {
    double t[8] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, rest = 0.0;
    int64_t j = 0;
    for (; j + 8 <= n; j += 8)
        for (int k = 0; k < 8; k++) t[k] += a[j + k] * x[j + k];
    if (j + 4 <= n) {
        for (int k = 0; k < 4; k++) t[k] += a[j + k] * x[j + k];
        j += 4;
    }
    for (; j < n; j++) rest += a[j] * x[j];
    return (((t[0] + t[4]) + (t[2] + t[6])) + ((t[1] + t[5]) + (t[3] + t[7]))) + rest;
}

/* Matrix (rows, n) times vector. */
EHD_CLONES static void dense_times(int64_t rows, int64_t n, const double *a, const double *x, double *out) {
    for (int64_t i = 0; i < rows; i++) out[i] = dense_dot(n, a + i * n, x);
}

/* (M0 + by M1 + by^2 M2) times vector, of three matrices (n, n) one behind the other. */
EHD_CLONES static void dense_expanded_times(int64_t n, const double *matrices, double by, const double *x,
                                              double *out) {
    for (int64_t i = 0; i < n; i++) {
        const double *row = matrices + i * n;
        const double t0 = dense_dot(n, row, x), t1 = dense_dot(n, row + n * n, x);
        const double t2 = dense_dot(n, row + 2 * n * n, x);
        out[i] = t0 + by * (t1 + by * t2);
    }
}

static double dense_norm(int64_t n, const double *x) { return sqrt(dense_dot(n, x, x)); }

/* Root of x^T M x. */
static double dense_size(int64_t n, const double *a, const double *x) {
    double total = 0.0;
    for (int64_t i = 0; i < n; i++) total += dense_dot(n, a + i * n, x) * x[i];
    return total > 0.0 ? sqrt(total) : 0.0;
}

/* Gaussian elimination with partial pivoting, in place: matrix (n, n) is overwritten, right (n,) becomes the solution;
 * 0 where it is singular or not finite. */
int ehd_eliminate(int64_t n, double *matrix, double *right) {
    for (int64_t k = 0; k < n; k++) {
        int64_t pivot = k;
        for (int64_t i = k + 1; i < n; i++)
            if (fabs(matrix[i * n + k]) > fabs(matrix[pivot * n + k])) pivot = i;
        const double size = fabs(matrix[pivot * n + k]);
        if (!(size > 0.0 && size < INFINITY)) return 0;
        double *upper = matrix + k * n;
        if (pivot != k) {
            double *other = matrix + pivot * n;
            for (int64_t j = k; j < n; j++) {
                const double kept = upper[j];
                upper[j] = other[j];
                other[j] = kept;
            }
            const double kept = right[k];
            right[k] = right[pivot];
            right[pivot] = kept;
        }
        const double inverse = 1.0 / upper[k];
        for (int64_t i = k + 1; i < n; i++) {
            double *restrict row = matrix + i * n;
            const double factor = row[k] * inverse;
            if (factor == 0.0) continue;
            for (int64_t j = k + 1; j < n; j++) row[j] -= factor * upper[j];
            right[i] -= factor * right[k];
        }
    }
    for (int64_t k = n - 1; k >= 0; k--) {
        double total = right[k];
        for (int64_t j = k + 1; j < n; j++) total -= matrix[k * n + j] * right[j];
        right[k] = total / matrix[k * n + k];
    }
    return 1;
}

/* Displacement and velocity of all ports, into motion (2, m), by those of the coordinates. */
void ehd_port_motion(const ehd_stepper_data *data, const double *q, const double *v, double *motion) {
    dense_times(data->m, data->n, data->transform, q, motion);
    dense_times(data->m, data->n, data->transform, v, motion + data->m);
}

/* Forces that are out of balance (n,), into force; their weighted size, and that of the forces that balance, into
 * sizes. */
void ehd_unbalanced(const ehd_stepper_data *data, const double *q, const double *v, const double *a,
                    const double *loads, const double *port_force, double *force, double *sizes) {
    const int64_t n = data->n, m = data->m;
    double size = 0.0, by_load = 0.0, by_contact = 0.0, by_inertia = 0.0;
    for (int64_t i = 0; i < n; i++) {
        const double inertia = dense_dot(n, data->mass + i * n, a);
        const double linear = dense_dot(n, data->damping + i * n, v) + dense_dot(n, data->stiffness + i * n, q);
        double contact = 0.0;
        for (int64_t j = 0; j < m; j++) contact += data->transform[j * n + i] * port_force[j];
        const double w = data->weight[i];
        force[i] = inertia + linear - loads[i] - contact;
        size += (w * force[i]) * (w * force[i]);
        by_load += (w * loads[i]) * (w * loads[i]);
        by_contact += (w * contact) * (w * contact);
        by_inertia += (w * inertia) * (w * inertia);
    }
    sizes[0] = sqrt(size);
    sizes[1] = by_load;
    if (by_contact > sizes[1]) sizes[1] = by_contact;
    if (by_inertia > sizes[1]) sizes[1] = by_inertia;
    sizes[1] = sqrt(sizes[1]);
}

/* Newton's change of the acceleration, into change (n,), which begins as the forces out of balance; 0 if there is
 * none. */
int ehd_correction(const ehd_stepper_data *data, double by_q, double by_v, double *change) {
    const int64_t n = data->n, m = data->m;
    double *matrix = data->room;
    memcpy(matrix, data->linear, sizeof(double) * (size_t)(n * n));
    for (int64_t i = 0; i < m; i++) {
        for (int64_t k = 0; k < m; k++) {
            const double slope = by_q * data->port_stiffness[i * m + k] + by_v * data->port_damping[i * m + k];
            if (slope == 0.0) continue;
            const double *moved = data->transform + k * n;
            for (int64_t a = 0; a < n; a++) {
                const double part = slope * data->transform[i * n + a];
                if (part == 0.0) continue;
                for (int64_t b = 0; b < n; b++) matrix[a * n + b] += part * moved[b];
            }
        }
    }
    return ehd_eliminate(n, matrix, change);
}
