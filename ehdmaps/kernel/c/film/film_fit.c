/* ---------------------------------------------------------------------------------------------------------------------
 * Factor of the closed formula of the locked film from the response of the film solver
 *
 * A law in time has stiffness k and damping c of slow motion and the stiffness k_s of the locked film, of which only k_s
 * is open. The factor is the one by which the complex stiffness of the law comes closest to that of the film solver, in
 * the mean square of the relative differences at the frequencies that a map holds. Where the response hardly depends on
 * k_s the factor stays at one: a factor of e is held as likely as the doubt, a relative difference.
 * ------------------------------------------------------------------------------------------------------------------ */

#define FIT_TRIES 41
#define FIT_ROUNDS 25
#define FIT_GOLDEN 0.6180339887498949

/* A point of a map with the response of its film. */
typedef struct ehd_film_response {
    ehd_film_contacts contacts;
    double speed;               /* > 0 [m/s] */
    double load, offset;        /* [N/m], > 0; film offset [m] */
    double solids;              /* compliance of the structure [m2/N] */
    double compliance, loss;    /* of the film in slow motion [m2/N], [m2 s/N] */
    int64_t count;              /* natural frequencies */
    const double *natural;      /* (count): omega sqrt(b^2 + 2 h R)/u */
    const double *response;     /* (count, 2): film compliance there, real and imaginary part [m2/N] */
} ehd_film_response;

/* Factors of points at one speed, between 1/most and most, into factors (points); what they leave, relative differences
 * of the complex stiffness of the law, k + i omega c/(1 + i omega theta), from that of the film solver, into apart
 * (points, count, 2), real and imaginary parts. natural (count); values (points, 6): load, offset, compliance of the
 * structure, film compliance, loss, and the relative difference below which a response says nothing; responses
 * (points, count, 2). */
void ehd_film_fits(const ehd_film_contacts *contacts, double speed, double most_factor, int64_t count,
                   const double *natural, int64_t points, const double *values, const double *responses,
                   double *factors, double *apart);

/* Relative differences with a factor into apart, unless it is null; the sum of their squares, and of `total`. */
static double differences_from(double total, const ehd_film_response *at, double factor, double *apart) {
    const double k = 1.0 / (at->solids + at->compliance), c = at->loss * k * k, radius = at->contacts.radius;
    const double stiff = locked_stiffness(&at->contacts, at->speed, at->offset, at->load, k, c, at->solids, factor);
    const double square = 8.0 * at->load * radius / (FILM_PI * at->contacts.modulus);
    const double time = sqrt(square + 2.0 * at->offset * radius) / at->speed;
    const double theta = stiff > k ? c / (stiff - k) : 0.0;
    for (int64_t n = 0; n < at->count; n++) {
        const double omega = at->natural[n] / time, turn = omega * theta, loss = stiff > k ? omega * c : 0.0;
        /* i loss/(1 + i turn), without overflow */
        const double ratio = turn <= 1.0 ? turn : 1.0 / turn, size = turn <= 1.0 ? 1.0 + turn * ratio : ratio + turn;
        const double real = k + (turn <= 1.0 ? loss * ratio : loss) / size;
        const double imaginary = (turn <= 1.0 ? loss : loss * ratio) / size;
        const double x = at->solids + at->response[2 * n], y = at->response[2 * n + 1];
        const double ahead = real * x - imaginary * y - 1.0, aside = real * y + imaginary * x, far = hypot(ahead, aside);
        total += far * far;
        if (apart) {
            apart[2 * n] = ahead;
            apart[2 * n + 1] = aside;
        }
    }
    return total;
}

/* What is least at the factor: squares of the differences, and what holds it at one. */
static double misfit(const ehd_film_response *at, double doubt, double log_factor) {
    const double held = doubt * log_factor;
    return differences_from(held * held, at, exp(log_factor), NULL);
}

static double tried(int i, double reach) { return reach * (2.0 * i / (FIT_TRIES - 1) - 1.0); }

static double fitted_factor(const ehd_film_response *at, double doubt, double most_factor) {
    const double reach = log(most_factor);
    double lowest = INFINITY;
    int best = 0;
    for (int i = 0; i < FIT_TRIES; i++) {
        const double value = misfit(at, doubt, tried(i, reach));
        if (value < lowest) {
            best = i;
            lowest = value;
        }
    }
    double low = tried(best > 0 ? best - 1 : 0, reach), high = tried(best < FIT_TRIES - 1 ? best + 1 : best, reach);
    for (int n = 0; n < FIT_ROUNDS; n++) {
        const double left = high - FIT_GOLDEN * (high - low), right = low + FIT_GOLDEN * (high - low);
        if (misfit(at, doubt, left) <= misfit(at, doubt, right))
            high = right;
        else
            low = left;
    }
    return exp(0.5 * (low + high));
}

void ehd_film_fits(const ehd_film_contacts *contacts, double speed, double most_factor, int64_t count,
                   const double *natural, int64_t points, const double *values, const double *responses,
                   double *factors, double *apart) {
    for (int64_t i = 0; i < points; i++, values += 6, responses += 2 * count, apart += 2 * count) {
        const ehd_film_response at = {*contacts, speed, values[0], values[1], values[2], values[3], values[4], count,
                                      natural, responses};
        factors[i] = fitted_factor(&at, values[5], most_factor);
        differences_from(0.0, &at, factors[i], apart);
    }
}
