#include "cognate_routines.h"
#include <math.h>

/* Constraints and contacts, for tests/program/routines.rs. */
adams_c_Cousub Cousub;
adams_c_Couxx Couxx;
adams_c_Couxx2 Couxx2;
adams_c_Cursub Cursub;
adams_c_Cnfsub Cnfsub;
adams_c_Cffsub Cffsub;

/* q2 + q1 q2 / 2 - a sin q1 */
void Cousub(const struct sAdamsCoupler *c, double time, const double *q, int iflag, double *phi) {
    (void)time, (void)iflag;
    *phi = q[1] + 0.5 * q[0] * q[1] - c->PAR[0] * sin(q[0]);
}
void Couxx(const struct sAdamsCoupler *c, double time, const double *q, int iflag, double *out) {
    (void)time, (void)iflag;
    out[0] = 0.5 * q[1] - c->PAR[0] * cos(q[0]);
    out[1] = 1 + 0.5 * q[0];
}
void Couxx2(const struct sAdamsCoupler *c, double time, const double *q, int iflag, double *out) {
    (void)time, (void)iflag;
    out[0] = c->PAR[0] * sin(q[0]);
    out[1] = out[2] = c->NJOINT == 2 && c->TYPE[0] == 'R' ? 0.5 : 0.0;
}
/* A circle of radius PAR(1). */
void Cursub(const struct sAdamsCurve *c, double alpha, int iord, int iflag, double *out) {
    (void)iflag;
    double r = c->PAR[0], x = r * cos(alpha), y = r * sin(alpha);
    double all[3][2] = {{x, y}, {-y, x}, {-x, -y}};
    for (int k = 0; k < 2; ++k) out[k] = all[iord][k];
}
static double step(double x, double x0, double h0, double x1, double h1) {
    double u = x <= x0 ? 0 : x >= x1 ? 1 : (x - x0) / (x1 - x0);
    return h0 + (h1 - h0) * u * u * (3 - 2 * u);
}
/* IMPACT: stiffness, exponent, damping and its depth. */
void Cnfsub(const struct sAdamsContactFriction *c, double time, const double *loci,
            const double *ni, const double *locj, const double *nj, double gap, double gapdot,
            double gapdotdot, double area, int dflag, int iflag, double *force) {
    (void)time, (void)loci, (void)locj, (void)ni, (void)nj, (void)gapdotdot, (void)area;
    (void)dflag, (void)iflag;
    const double *p = c->PAR;
    double g = gap < 0 ? -gap : 0;
    double n = p[0] * pow(g, p[1]) - step(g, 0, 0, p[3], p[2]) * gapdot;
    force[0] = gap < 0 && n > 0 ? n : 0;
}
/* COULOMB_FRICTION: two coefficients and two velocities. */
void Cffsub(const struct sAdamsContactFriction *c, double time, const double *loci,
            const double *locj, const double *x, const double *xdot, double nforce, double area,
            int dflag, int iflag, double *force) {
    (void)time, (void)loci, (void)locj, (void)x, (void)area, (void)dflag, (void)iflag;
    const double *p = c->PAR;
    double v = xdot[0];
    double mu = v < p[2] ? step(v, -p[2], -p[0], p[2], p[0]) : step(v, p[2], p[0], p[3], p[1]);
    force[0] = -mu * nforce;
}
