/* Films with memory of all slices: what they have kept of the steps before; begun by ehd_films_begin. */
typedef struct ehd_films {
    double memory[EHD_ROLLERS][2][8][EHD_SLICES]; /* of cone and cup, rows as of EHD_PAIR_MEMORY in the source */
} ehd_films;

/* Films at rest, with the rollers of a call of ehd_bearing_call. */
void ehd_films_begin(const ehd_law *law, const ehd_rollers *rollers, ehd_films *films);

/* A step in time [s], >= 0, to a pose: the force at its end. The stiffness is that by the pose at the end, the damping is
 * in it. Where the status refuses, films are as before. */
int ehd_films_step(const ehd_bearing *bearing, const ehd_law *law, ehd_rollers *rollers, ehd_films *films, double step,
                   const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result);

/* The same, with films that stay as they are; after no time they are springs. */
int ehd_films_look(const ehd_bearing *bearing, const ehd_law *law, ehd_rollers *rollers, const ehd_films *films,
                   double step, const double pose[6], double cage_angle, double inner_speed, double outer_speed,
                   ehd_bearing_force *result);

size_t ehd_films_size(void);
