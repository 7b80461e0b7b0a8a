/* ---------------------------------------------------------------------------------------------------------------------
 * The contact law with the data of this file
 * ------------------------------------------------------------------------------------------------------------------ */

size_t ehd_point_size(void) { return sizeof(ehd_point); }

int ehd_at(ehd_point *point, double u, double T, double q) {
    return point ? ehd_law_make(&LAW, u, T, q, &point->law) : EHD_BAD_ARGUMENT;
}

int ehd_law_at(const ehd_point *point, double approach, double rate, ehd_force *force) {
    return point ? ehd_law_force(&point->law, approach, rate, force) : EHD_BAD_ARGUMENT;
}

int ehd_law(double approach, double rate, double u, double T, double q, ehd_force *force) {
    ehd_point point;
    return ehd_law_call(&LAW, approach, rate, u, T, q, &point.law, force);
}

int ehd_film_at(ehd_film *film, double u, double T) {
    ehd_point point;
    return ehd_film_make(&FILMS_WITH_MEMORY, u, T, &point.law, film);
}
