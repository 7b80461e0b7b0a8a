/* ---------------------------------------------------------------------------------------------------------------------
 * Laws of contacts over the speed of a run: at nodes, on one grid of approaches, blended straight between two nodes
 * ------------------------------------------------------------------------------------------------------------------ */

#define PAIR_NUMBERS 7 /* of a law beside its table */

/* Laws of some films, both contacts each, at the nodes of a window of speeds; those in use, which pair_blend writes. */
typedef struct ehd_pair_films {
    int64_t films, slots, rows, columns; /* columns: springs of a contact and their time; 0 without memory */
    const double *tables;                /* (films, slots, 2, rows, 4): inner and outer contact */
    const double *numbers;               /* (films, slots, 2, 7): fields of ehd_pair_law in their order */
    const double *most;                  /* (films, slots): highest load for which the law was made [N] */
    const int64_t *lengths;              /* (films, slots): rows that it has, none where it is dry */
    double *table, *current, *highest;   /* (films, 2, rows, 4), (films, 2, 7), (films,): in use */
    int64_t *length;                     /* (films,): in use */
    double *in_use;                      /* (films, 2): node and weight of those */
    const double *springs, *shorter;     /* (films, slots, 2, rows, columns); (columns - 1,): times over the longest */
    int64_t steps;
    const int64_t *nodes;                /* (steps, films): node below the speed of each step */
    const double *weights;               /* (steps, films): part of the way to the next node */
} ehd_pair_films;

EHD_SIZE_OF(ehd_pair_films)

static void pair_mix(int64_t n, const double *low, const double *high, double weight, double *out) {
    for (int64_t i = 0; i < n; i++) out[i] = low[i] + weight * (high[i] - low[i]);
}

/* Slot of the node after one. */
static int64_t pair_after(const ehd_pair_films *of, int64_t node, double weight) {
    return weight > 0.0 ? (node + 1) % of->slots : node;
}

/* Bring the laws in use of a film to the place of a step. */
static void pair_blend(const ehd_pair_films *of, int64_t film, int64_t step) {
    const int64_t node = of->nodes[step * of->films + film];
    const double weight = of->weights[step * of->films + film];
    double *in_use = of->in_use + 2 * film;
    if (in_use[0] == (double)node && in_use[1] == weight) return;
    in_use[0] = (double)node;
    in_use[1] = weight;
    const int64_t first = film * of->slots, low = first + node, high = first + pair_after(of, node, weight);
    const int64_t size = 2 * PAIR_NUMBERS, rows = 8 * of->rows;
    pair_mix(size, of->numbers + size * low, of->numbers + size * high, weight, of->current + size * film);
    of->highest[film] = least(of->most[low], of->most[high]);
    of->length[film] = of->lengths[low];
    if (of->length[film] > 0)
        pair_mix(rows, of->tables + rows * low, of->tables + rows * high, weight, of->table + rows * film);
}

/* The law in use of a contact, side 0 the inner one. */
static ehd_pair_law pair_law_of(const ehd_pair_films *of, int64_t film, int side) {
    const double *n = of->current + PAIR_NUMBERS * (2 * film + side);
    const ehd_pair_law law = {n[0], n[1], n[2], n[3], n[4], n[5], n[6], of->length[film],
                              of->table + 4 * of->rows * (2 * film + side)};
    return law;
}

/* Springs of films with memory at the speed of a step. */
static ehd_pair_springs pair_springs_of(const ehd_pair_films *of, int64_t film) {
    const int64_t node = (int64_t)of->in_use[2 * film], size = of->rows * of->columns;
    const double weight = of->in_use[2 * film + 1];
    const double *slow = of->springs + 2 * size * (film * of->slots + node);
    const double *fast = of->springs + 2 * size * (film * of->slots + pair_after(of, node, weight));
    const ehd_pair_springs found = {of->columns - 1, of->shorter, {slow, slow + size}, {fast, fast + size}, weight};
    return found;
}
