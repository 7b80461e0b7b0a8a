/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings with cylindrical rollers and films that have a memory: a state for each slice of each roller, number
 * roller * slices + slice, where rollers are counted in the cage. Their force does not depend on the velocity of the
 * ring: damping is zero here, and stiffness = -dforce/dpose is that of a step, or of an instant with its states held
 * fixed.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Films in equilibrium at a pose. states: rollers * slices. */
int ehd_cylinder_settled(const ehd_cylinder *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                         ehd_film_state states[]);

/* A discrete step of all films, see ehd_film_advance; pose, cage angle and film are those of its end. */
int ehd_cylinder_advance(const ehd_cylinder *bearing, const ehd_film *film, double step, double last_step,
                         const double pose[6], double cage_angle, const ehd_film_state before[], ehd_film_state after[],
                         ehd_bearing_force *result);

/* Force of an instant and all that ehd_film_rate gives, for states xi; rates: rollers * slices. */
int ehd_cylinder_rates(const ehd_cylinder *bearing, const ehd_film *film, const double pose[6], double cage_angle,
                       const double states[], ehd_film_rates rates[], ehd_bearing_force *result);

/* Direction of the force of a slice: column[0..3] are its shares in y, z, theta_y and theta_z of the approach of slice i
 * of roller j by the pose; the force on the ring has those of the load times roller_length/slices, negative. */
void ehd_cylinder_direction(const ehd_cylinder *bearing, double cage_angle, int j, int i, double column[4]);
