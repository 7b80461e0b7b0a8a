#include <math.h>

/* Nodes of a cubic about x among first ... last: their first one, how many (four, or all), and their weights. */
static int about(const double *axis, int first, int last, double x, int *count, double *weight) {
    int low = first, high = last, a, b;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (x >= axis[middle])
            low = middle;
        else
            high = middle;
    }
    *count = last - first < 3 ? last - first + 1 : 4;
    if (--low < first)
        low = first;
    if (low > last - *count + 1)
        low = last - *count + 1;
    for (a = 0; a < *count; a++) {
        weight[a] = 1.0;
        for (b = 0; b < *count; b++)
            if (b != a)
                weight[a] *= (x - axis[low + b]) / (axis[low + a] - axis[low + b]);
    }
    return low;
}

int ehd_small(double approach, double rate, double speed, double temperature, double *result) {
    double u = log(fabs(speed)), t = -1.0 / (temperature - EHD_COLDEST), s, p, value[3], wu[4], wt[4], wp[4];
    int a, b, c, q, nu, nt, np, iu, it, ip, first, last;
    result[0] = result[1] = result[2] = NAN;
    if (!(u >= ehd_u[0] && u <= ehd_u[EHD_NU - 1] && t >= ehd_t[0] && t <= ehd_t[EHD_NT - 1] && isfinite(rate)))
        return 1;
    iu = about(ehd_fine_u, 0, EHD_FU - 1, u, &nu, wu);
    it = about(ehd_fine_t, 0, EHD_FT - 1, t, &nt, wt);
    for (q = 0; q < 3; q++)
        for (value[q] = 0.0, a = 0; a < nu; a++)
            for (b = 0; b < nt; b++)
                value[q] += wu[a] * wt[b] * ehd_place[(q * EHD_FU + iu + a) * EHD_FT + it + b];
    s = asinh((approach - value[0]) / value[1]);
    p = s / (s > 0.0 ? value[2] : EHD_BOTTOM);
    if (!(p <= 1.0))
        return 1;
    if (p <= -1.0) {
        result[0] = result[1] = result[2] = 0.0;
        return 0;
    }
    /* cubics do not cross the bottom of the valley of damping */
    first = p >= 0.0 ? EHD_ZERO : 0;
    last = p >= 0.0 ? EHD_NP - 1 : EHD_ZERO;
    ip = about(ehd_p, first, last, p, &np, wp);
    iu = about(ehd_u, 0, EHD_NU - 1, u, &nu, wu);
    it = about(ehd_t, 0, EHD_NT - 1, t, &nt, wt);
    for (q = 0; q < 3; q++) {
        for (value[q] = 0.0, a = 0; a < np; a++)
            for (b = 0; b < nu; b++)
                for (c = 0; c < nt; c++)
                    value[q] +=
                        wp[a] * wu[b] * wt[c] * ehd_log[((q * EHD_NP + ip + a) * EHD_NU + iu + b) * EHD_NT + it + c];
        result[q] = exp(value[q]);
    }
    s = result[0] + result[2] * rate;
    result[0] = s >= 0.5 * result[0] ? s : -result[0] * result[0] / (4.0 * result[2] * rate);
    return 0;
}
