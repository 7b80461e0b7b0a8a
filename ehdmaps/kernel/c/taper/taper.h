/* ---------------------------------------------------------------------------------------------------------------------
 * A bearing of tapered rollers, or of cylindrical ones between ribs: structures
 *
 * Frame O is that of the outer ring, in the plane of the middles of the rollers, or in the middle between two rows; x is
 * the axis of the bearing. Of two rows one leans on ribs (NNCF). All of a
 * roller happens in the plane of the axis and the roller: V = (axial, radial, rotation from the axis outwards) of its
 * middle, D the same of what the inner ring does there. The inner ring is the cone, the outer one the cup. All in SI
 * units.
 * ------------------------------------------------------------------------------------------------------------------ */

#define EHD_TAPER_RIBS 4 /* most ribs that a roller may lean on */

/* What ehd_taper_force found instead of an answer. */
enum { EHD_TAPER_NOT_FINITE = -1, EHD_TAPER_TOO_FAR = -2, EHD_TAPER_NO_BALANCE = -3 };

/* A rib: normal, axial and radial; its lever about the middle of the roller, and the distance from the end where
 * nothing moved [m]; C of Q = C g^(3/2) [N/m^1.5]; 1 for a rib of the outer ring, else 0. */
typedef struct ehd_taper_rib {
    double x, r, lever, play, coefficient, outer;
} ehd_taper_rib;

/* What does not change of a bearing. */
typedef struct ehd_taper_data {
    int64_t rollers, slices, ribs;
    int64_t held;                  /* rollers that lean on ribs: the first ones */
    double row[2];                 /* places along x of those, and of others [m] */
    double pitch_radius;           /* distance of the middles of rollers from the axis [m] */
    double cup[2], cone[2];        /* normals of the lines: axial, radial */
    double play;                   /* of each raceway, beside the profile [m] */
    double most_travel, most_tilt; /* largest accepted displacement [m] and tilt [rad] */
    double hard;                   /* C of both dry lines of a roller [N/m^(10/9)] */
    double damping, damping_time;  /* of a rib that carries load [N s/m]; the same over its stiffness [s] */
    const double *rib;             /* (ribs, 6), see ehd_taper_rib */
    const double *lever, *profile; /* (slices,): levers on both lines, depths of the profile on one side [m] */
    const double *cosine, *sine;   /* (rollers,): directions of the rollers in the cage */
    const double *added;           /* (rollers, 2, 2): what deviations add to cone and cup, see ../run/deviations.h; null: none */
    double *by_rates;              /* (8,): what the rates of that do, see EHD_PAIR_BY_RATES; null where nothing is added */
} ehd_taper_data;

/* A roller in balance. All zero before the first call. */
typedef struct ehd_taper_roller {
    double force[3];               /* on the roller, of the inner ring: axial, radial [N], moment [N m] */
    double inner_load, outer_load; /* of cone and cup [N] */
    double inner_ribs;             /* of all ribs of the inner ring [N] */
    double centre[2];              /* where along the roller the lines carry, cone and cup [m] */
    double outer_ribs;             /* of all ribs of the outer ring [N] */
    double place[3], ring[3];      /* V and D: axial, radial [m], turn [rad] */
    double rib_load[EHD_TAPER_RIBS];       /* [N] */
    double share[3][3];                    /* S, by which V follows D */
    double carried;                        /* of cone and ribs of the inner ring [N] */
    double play;                           /* of each raceway [m] */
    double made;                           /* not 0: the next call starts here */
    double stiffness[3][3], damping[3][3]; /* of the force by D and by its rate */
    double added[2];               /* what deviations add to the approaches of cone and cup [m] */
    double held[2][2];             /* what the memory of films adds to the loads of cone and cup at rest: sums over the slices
                                    * of that [N], and of it times their levers [N m] */
} ehd_taper_roller;

/* Force on the inner ring at rest [N], [N m], -dforce/dpose and -dforce/dvelocity. */
typedef struct ehd_taper_answer {
    double force[6], stiffness[6][6], damping[6][6];
} ehd_taper_answer;

#define EHD_TAPER_SPRINGS 1 /* of a slice of films with memory */
#define EHD_TAPER_MEMORY EHD_PAIR_MEMORY(EHD_TAPER_SPRINGS)
