// A user's library: routines with Adams' argument lists, one under the name that Fortran compilers
// give. It is loaded by cognate_session_load.

void c_sysfnc(const char *name, const int *ids, int n, double *value, int *failed);
void c_sysary(const char *name, const int *ids, int n, double *values, int *n_values, int *failed);

void sfosub(const int *id, const double *time, const double *par, const int *npar, const int *dflag,
            const int *iflag, double *value);
void varsub_(const int *id, const double *time, const double *par, const int *npar, const int *dflag,
             const int *iflag, double *value);
void REQSUB(const int *id, const double *time, const double *par, const int *npar, const int *iflag,
            double *results);

void sfosub(const int *id, const double *time, const double *par, const int *npar, const int *dflag,
            const int *iflag, double *value) {
    (void)id, (void)time, (void)npar, (void)dflag, (void)iflag;
    int failed, n, ids[] = {2, 1, 1};
    double place[6];
    c_sysary("DISP", ids, 3, place, &n, &failed);
    *value = par[0] * (1.0 - place[2]);
}

void varsub_(const int *id, const double *time, const double *par, const int *npar, const int *dflag,
             const int *iflag, double *value) {
    (void)id, (void)npar, (void)dflag, (void)iflag;
    *value = par[0] * *time;
}

void REQSUB(const int *id, const double *time, const double *par, const int *npar, const int *iflag,
            double *results) {
    (void)id, (void)time, (void)par, (void)npar, (void)iflag;
    int failed, ids[] = {2, 1, 1};
    c_sysfnc("DZ", ids, 3, &results[1], &failed);
}
