/* ---------------------------------------------------------------------------------------------------------------------
 * The law of a roller made ready for a bearing: at one speed, temperature and centrifugal load, as a table of load and
 * damping over the approach that is read in nanoseconds.
 *
 * The cells of the table are the binary digits of a = 1 + |z|, z = (approach - centre) inverse_scale: no logarithm is
 * needed to find one. In a cell load [N/m] and damping [N s/m2] are cubics through the values and slopes of the law at
 * its ends: C1, and with slopes held so that the load never falls with the approach and the damping is never negative.
 *
 * A cell follows from the law at its ends and, as slopes are held by what the neighbours carry, at the ends of these. So
 * each can be made alone: all at once for a law that stays, or only those in which there are slices. Both are the same.
 *
 * Below the lowest mapped speed only a part of the film is there: its cells lie between knots, which move with the part.
 * ------------------------------------------------------------------------------------------------------------------ */

/* Kinds of prepared laws: a formula, cells at even places around a centre, cells between knots for faded films, and the
 * law itself for each slice where no table reaches down to lift-off. */
enum { EHD_POWER = 0, EHD_CELLS = 1, EHD_KNOTS = 2, EHD_BY_SLICES = 3 };

/* The numbers of a prepared law; those of two laws of one kind may be blended. */
typedef struct ehd_cylinder_numbers {
    double kind;
    double coefficient, exponent;       /* of EHD_POWER: w = coefficient approach^exponent [N/m] */
    double damping, damping_time;       /* of it: c = damping + damping_time dw/dapproach, [N s/m2], [s] */
    double centre, inverse_scale;       /* of EHD_CELLS [m], [1/m] */
    double highest;                     /* load above which slices are outside the map [N/m] */
    double safe_approach;               /* up to it no slice is, nor above the held load [m] */
    double lift_off;                    /* up to it there is no load [m] */
    double slope;                       /* what slopes are multiplied by */
    double held_approach, held_load;    /* above these the law is its tangent [m], [N/m] */
    double held_stiffness, held_damping; /* of the tangent [N/m2], [N s/m2] */
} ehd_cylinder_numbers;

/* A prepared law, in arrays of the caller. */
typedef struct ehd_cylinder_law {
    ehd_cylinder_numbers *numbers;
    double *cells;        /* (2 EHD_ROWS, 4, 2): cubics of load and damping, in turns, over the distance in scales, or in m */
    double *knots;        /* (2 EHD_ROWS): where cells of EHD_KNOTS begin [m], the last one infinite */
    double *film;         /* (2 EHD_ROWS, 8): what holds for every part of a faded film, see cylinder_law.c */
    double *nodes;        /* (EHD_NODES, 4): load, slope, damping, its slope at ends of cells */
    int64_t *marks;       /* 2 EHD_NODES bytes: nodes that are known, cells that are made */
    ehd_law_point *point; /* room of ehd_law_point_size bytes; of EHD_BY_SLICES it is the law */
    int64_t first, end;   /* first node that may carry a load; the one behind the first node beyond the hold */
    int64_t grows;        /* whether cells are made as slices need them */
} ehd_cylinder_law;

/* What ehd_cylinder_prepare is asked for, a sum of these: all cells at once, or as slices need them; no knots, but the law
 * by slices in their place; of a faded film its nodes alone. */
enum { EHD_WHOLE = 0, EHD_GROWING = 1, EHD_WITHOUT_KNOTS = 2, EHD_FILM_ALONE = 4 };

/* Make a law ready for a bearing, at an entrainment speed [m/s], temperature [K] and centrifugal load [N/m], see
 * ehd_law_make. Takes some tens of microseconds. Arrays that the kind of the law does not need may be null. */
int ehd_cylinder_prepare(const ehd_law_data *data, double u, double T, double q, int64_t asked, ehd_cylinder_law *law);
