/* ---------------------------------------------------------------------------------------------------------------------
 * What calls find, and the force of a contact
 * ------------------------------------------------------------------------------------------------------------------ */

/* What a call found: a sum of these, 0 where all is well. Which of them refuse is told by the data of each law: all
 * results of such a call are NaN. The other ones hold at the edge of the map. */
enum {
    EHD_OK = 0,
    EHD_ABOVE_LOAD = 1,          /* more load than is mapped */
    EHD_ABOVE_SPEED = 2,         /* faster than is mapped */
    EHD_OUTSIDE_TEMPERATURE = 4, /* colder or hotter than is mapped */
    EHD_NOT_FINITE = 8,          /* an argument, or what follows from it, is NaN or infinite */
    EHD_BAD_CENTRIFUGAL = 16,    /* a centrifugal load that is negative, too high, or not in the data */
    EHD_TOO_FAR = 32,            /* a pose beyond reason */
    EHD_BAD_ARGUMENT = 64,       /* a null pointer, a number of slices or a step that is not allowed */
    EHD_NO_LOADS = 128           /* slices that are coupled, and are found no loads */
};

/* Load of a contact and its derivatives by approach and rate: w [N/m], k [N/m2], c [N s/m2]. */
typedef struct ehd_force {
    double load, stiffness, damping;
} ehd_force;

/* Name of the gravest part of a status, for messages; never null. */
const char *ehd_status_text(int status);
