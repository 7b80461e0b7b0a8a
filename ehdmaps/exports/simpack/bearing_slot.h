/* ---------------------------------------------------------------------------------------------------------------------
 * Bearings of a model by the number of the element that asks for them, so that each keeps its prepared law.
 *
 * The slots are the only memory that outlives a call. They are not protected: the solver has to evaluate these elements
 * in one thread.
 * ------------------------------------------------------------------------------------------------------------------ */
#ifndef BEARING_SLOT_H
#define BEARING_SLOT_H

enum { SLOT_MOST = 256, SLOT_FULL = 1024 };

/* Force and moment on the inner ring in the frame of the outer one (x along the axis), in SI.
 *
 * number: of the element, any whole one. axis: direction of the axis of the inner ring in that frame, either way; place:
 * of its centre [m]; speed: of the centre [m/s]; turning: angular velocity of the inner ring against the outer one, its
 * spin included [rad/s]; cage_angle: of the first roller from y towards z [rad]; T: temperature of the raceways [K];
 * clearance: diametral [m].
 *
 * Returns the status of the kernel; SLOT_FULL where there are more than SLOT_MOST bearings. Where it refuses, all results
 * are NaN. */
int bearing_slot(int number, const double axis[3], const double place[3], const double speed[3],
                 const double turning[3], double cage_angle, double T, double clearance, double force[6]);

/* The same with films that have a memory, at a time [s] (film_history.h).
 * Their damping is in their states, so that speed has no part in the force. SLOT_FULL also where there is no room. */
int bearing_slot_memory(int number, const double axis[3], const double place[3], const double turning[3],
                        double cage_angle, double T, double clearance, double time, double force[6]);

/* Name of a status, for messages. */
const char *bearing_slot_text(int status);

#endif /* BEARING_SLOT_H */
