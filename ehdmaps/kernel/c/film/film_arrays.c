/* ---------------------------------------------------------------------------------------------------------------------
 * Many films with memory at once, for Python: arrays of n numbers, one a film
 * ------------------------------------------------------------------------------------------------------------------ */

EHD_SIZE_OF(ehd_film_table)

/* Fill a table with the law of a point without centrifugal load. The factors of the closed formula are those of one
 * speed and temperature; node: room for (9, EHD_NODES) numbers. */
void ehd_film_fill(const ehd_film_data *data, const ehd_law_point *point, double *node, ehd_film_table *table);

/* Factors of the closed formula at loads, out (n), of data of one speed and temperature. */
void ehd_film_factors(const ehd_film_data *data, int64_t n, const double *load, double *out);

/* p, y and G of films in equilibrium at approaches, each followed by its slope: out (6, n). */
void ehd_film_equilibria(const ehd_film_table *table, int64_t n, const double *approach, double *out);

/* a of loads, and its slope: out (2, n). */
void ehd_film_stretches(const ehd_film_table *table, int64_t n, const double *load, double *out);

/* A discrete step of all films: loads, their slopes by the approach, states, and changes of G: out (4, n). */
void ehd_film_steps(const ehd_film_table *table, double step, double last_step, int64_t n, const double *approach,
                    const double *before, const double *change, double *out);

/* x = G' at the end of a step by the changes of G over it and over the last one, and its slope: out (2, n). */
void ehd_film_squeezes(double step, double last_step, int64_t n, const double *change, const double *last,
                       double *out);

/* Energy that contacts store, out (n). */
void ehd_film_energies(const ehd_film_table *table, int64_t n, const double *state, const double *load, double *out);

/* Energy that films take up over a step, out (n). */
void ehd_film_spent(const ehd_film_table *table, int64_t n, const double *before, const double *load_before,
                    const double *state, const double *load, double *out);

/* Compliance that locked oil takes off, by the closed formula, out (n). */
void ehd_film_locked(const ehd_film_contacts *contacts, int64_t n, const double *offset, const double *load,
                     const double *compliance, double *out);

/* Stiffness of the locked film, out (n); see locked_stiffness. */
void ehd_film_stiff(const ehd_film_contacts *contacts, double speed, int64_t n, const double *offset,
                    const double *load, const double *k, const double *c, const double *solids, const double *factor,
                    double *out);

void ehd_film_fill(const ehd_film_data *data, const ehd_law_point *point, double *node, ehd_film_table *table) {
    const locked_factors factors = factors_at(data, 0.0, COLDEST + 1.0);
    fill_film(data, &factors, point, (double(*)[EHD_NODES])node, table);
}

void ehd_film_factors(const ehd_film_data *data, int64_t n, const double *load, double *out) {
    const locked_factors factors = factors_at(data, 0.0, COLDEST + 1.0);
    for (int64_t i = 0; i < n; i++) out[i] = locked_factor(data, &factors, load[i]);
}

void ehd_film_equilibria(const ehd_film_table *table, int64_t n, const double *approach, double *out) {
    for (int64_t i = 0; i < n; i++) {
        reading at[3];
        equilibrium(table, approach[i], at);
        for (int k = 0; k < 3; k++) {
            out[2 * k * n + i] = at[k].value;
            out[(2 * k + 1) * n + i] = at[k].slope;
        }
    }
}

void ehd_film_stretches(const ehd_film_table *table, int64_t n, const double *load, double *out) {
    for (int64_t i = 0; i < n; i++) {
        const reading a = stretch(table, load[i]);
        out[i] = a.value;
        out[n + i] = a.slope;
    }
}

void ehd_film_steps(const ehd_film_table *table, double step, double last_step, int64_t n, const double *approach,
                    const double *before, const double *change, double *out) {
    const weights by = weights_of(step, last_step);
    for (int64_t i = 0; i < n; i++) {
        const double begun = squeezing(table, before[i]);
        const film_end end = end_of_step(table, by, approach[i], begun, change[i], before[i]);
        out[i] = end.load > NO_LOAD_LEFT ? end.load : 0.0;
        out[n + i] = end.tangent;
        out[2 * n + i] = end.approach;
        out[3 * n + i] = squeezing(table, end.approach) - begun;
    }
}

void ehd_film_squeezes(double step, double last_step, int64_t n, const double *change, const double *last,
                       double *out) {
    const weights by = weights_of(step, last_step);
    for (int64_t i = 0; i < n; i++) {
        const reading x = squeeze(by, change[i], last[i], fading_of(last[i]));
        out[i] = x.value;
        out[n + i] = x.slope;
    }
}

void ehd_film_energies(const ehd_film_table *table, int64_t n, const double *state, const double *load, double *out) {
    for (int64_t i = 0; i < n; i++) out[i] = film_energy(table, state[i]) + load_energy(table, load[i]);
}

void ehd_film_spent(const ehd_film_table *table, int64_t n, const double *before, const double *load_before,
                    const double *state, const double *load, double *out) {
    for (int64_t i = 0; i < n; i++) out[i] = spent_by_film(table, before[i], load_before[i], state[i], load[i]);
}

void ehd_film_locked(const ehd_film_contacts *contacts, int64_t n, const double *offset, const double *load,
                     const double *compliance, double *out) {
    for (int64_t i = 0; i < n; i++) out[i] = locked_compliance(contacts, offset[i], load[i], compliance[i]);
}

void ehd_film_stiff(const ehd_film_contacts *contacts, double speed, int64_t n, const double *offset,
                    const double *load, const double *k, const double *c, const double *solids, const double *factor,
                    double *out) {
    for (int64_t i = 0; i < n; i++)
        out[i] = locked_stiffness(contacts, speed, offset[i], load[i], k[i], c[i], solids[i], factor[i]);
}
