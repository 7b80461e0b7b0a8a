/* ---------------------------------------------------------------------------------------------------------------------
 * Statuses in words
 * ------------------------------------------------------------------------------------------------------------------ */

static void no_force(ehd_force *force) { force->load = force->stiffness = force->damping = NAN; }

const char *ehd_status_text(int status) {
    if (status & EHD_BAD_ARGUMENT) return "an argument that is not allowed";
    if (status & EHD_NOT_FINITE) return "numbers that are not finite";
    if (status & EHD_TOO_FAR) return "a pose beyond reason: check its units";
    if (status & EHD_BAD_CENTRIFUGAL) return "a centrifugal load that is not allowed";
    if (status & EHD_ABOVE_LOAD) return "a load above the map";
    if (status & EHD_ABOVE_SPEED) return "an entrainment speed above the map";
    if (status & EHD_OUTSIDE_TEMPERATURE) return "a temperature outside the map";
    return "no problem";
}
