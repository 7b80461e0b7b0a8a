/* Stand-in for the header of Adams Solver: what its documentation says of GFOSUB, SYSARY, SYSFNC, ERRMES and USRMES. */
#ifndef SLV_C_UTILS_H
#define SLV_C_UTILS_H

struct sAdamsGforce {
    int ID, NPAR;
    const double *PAR;
    int I, RM, JFLOAT;
};

typedef void adams_c_Gfosub(const struct sAdamsGforce *, double, int, int, double *);

void c_sysary(const char *function, const int *ids, int count, double *values, int *states, int *failed);
void c_sysfnc(const char *function, const int *ids, int count, double *value, int *failed);
void c_errmes(int failed, const char *message, int id, const char *stop);
void c_usrmes(int wanted, const char *message, int id, const char *kind);

#endif
