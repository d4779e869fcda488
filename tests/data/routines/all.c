#include "cognate_routines.h"

/* Routines of all kinds that are called, for tests/program/routines.rs. */
static double read(const char *name, int i, int j) {
    int failed, ids[] = {i, j};
    double value;
    c_sysfnc(name, ids, j ? 2 : 1, &value, &failed);
    c_errmes(failed, name, i, "STOP");
    return value;
}
void Vfosub(const struct sAdamsVforce *f, double time, int dflag, int iflag, double *out) {
    (void)time, (void)dflag, (void)iflag;
    int failed, n, ids[] = {f->I, 1};
    double place[6];
    c_sysary("TDISP", ids, 2, place, &n, &failed);
    for (int k = 0; k < n; ++k) out[k] = -f->PAR[k] * place[k];
}
void Vtosub(const struct sAdamsVtorque *f, double time, int dflag, int iflag, double *out) {
    (void)time, (void)dflag, (void)iflag;
    out[2] = -f->PAR[0] * read("WZ", f->I, 1);
}
void Gfosub(const struct sAdamsGforce *f, double time, int dflag, int iflag, double *out) {
    (void)dflag, (void)iflag;
    double v[6];
    int failed, n, ids[] = {f->I, f->RM, f->RM, f->RM};
    c_sysary("VEL", ids, 3, v, &n, &failed);
    for (int k = 0; k < 6; ++k) out[k] = -f->PAR[0] * v[k];
    out[0] += time;
}
void Varsub(const struct sAdamsVariable *v, double time, int dflag, int iflag, double *out) {
    (void)dflag, (void)iflag;
    *out = v->PAR[0] * time + read("DX", 20, 1) + v->IC;
}
void Difsub(const struct sAdamsDiff *d, double time, int dflag, int iflag, double *out) {
    (void)time, (void)dflag, (void)iflag;
    *out = -d->PAR[0] * read("DIF", d->ID, 0) + read("VARVAL", 1, 0);
}
void Motsub(const struct sAdamsMotion *m, double time, int iord, int iflag, double *out) {
    (void)iflag;
    double a = m->PAR[0], all[] = {a * time * time, 2 * a * time, 2 * a};
    *out = all[iord];
}
void Reqsub(const struct sAdamsRequest *r, double time, int iflag, double *out) {
    (void)iflag;
    out[1] = read("DX", (int)r->PAR[0], 1);
    out[2] = time;
}
void Sensub(const struct sAdamsSensor *s, double time, int iflag, double *out) {
    (void)time, (void)iflag;
    *out = read("DY", 20, 1) - s->PAR[0];
}
void Gsesub(const struct sAdamsGSE *g, double time, int dflag, int iflag, int ns, const double *x,
            int ni, const double *u, int no, double *rates, double *y) {
    (void)g, (void)time, (void)dflag, (void)iflag;
    for (int k = 0; k < ns; ++k) rates[k] = -x[k] + (ni ? u[0] : 0.0);
    for (int k = 0; k < no; ++k) y[k] = 2 * x[0];
}
