/* Numbers of any kind, and memory of exactly some size. */
#include <stdio.h>
#include <stdlib.h>

static uint64_t seed = 88172645463325252u;

static uint64_t any(void) {
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return seed;
}

static int64_t up_to(int64_t most_of) { return 1 + (int64_t)(any() % (uint64_t)most_of); }

static double part(void) { return (double)(any() >> 11) / 9007199254740992.0; }

/* NaN, infinities, zeros, denormals, huge and tiny numbers, and numbers around a size. */
static double number(double size) {
    static const double odd[] = {0.0, -0.0, 1e-310, -4.9e-324, 1e-30, 1e30, -1e300, 1.7e308};
    const unsigned kind = (unsigned)(any() % 64);
    if (kind == 0) return NAN;
    if (kind == 1) return INFINITY;
    if (kind == 2) return -INFINITY;
    if (kind < 8) return odd[any() % 8];
    if (kind < 16) return (part() - 0.5) * size * pow(10.0, (double)(any() % 13) - 4.0);
    return (part() - 0.5) * 2.0 * size;
}

static double *room(int64_t count) { return malloc((size_t)count * sizeof(double)); }
