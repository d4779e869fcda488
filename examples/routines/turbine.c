/*
 * Wind on the blades of a turbine, and what drives it, for datasets that NREL's FAST has written:
 * they ask for routines by numbers of their own, and these answer in the simplest way.
 *
 *   GFORCE    USER(blade, section): forces of a blade element in a uniform wind along x of ground;
 *             I is its marker, x along the span, z towards the leading edge
 *   SFORCE    the generator: torque that grows with the square of its speed, up to a largest one
 *   VARIABLE  pitch demands (10000 and above): the last number of USER; others: zero
 *
 * ARRAY/5 of these datasets has the number of sections, the gear ratio and the radius of the tip.
 * The wind is not slowed down by the rotor, and the airfoils are one that nobody has measured: it
 * turns the rotor as a wind does, and is no model of any turbine. Forces are in kN, as these
 * datasets have them.
 */
#include "cognate_routines.h"
#include <math.h>

adams_c_Gfosub Gfosub;
adams_c_Sfosub Sfosub;
adams_c_Varsub Varsub;

static const double WIND = 12.0;     /* along x of ground   [m/s] */
static const double DENSITY = 1.225; /* of air   [kg/m3] */
static const double CHORD = 0.07;    /* as a part of the radius of the tip */
static const double KILO = 1e3;

static double ask(const char *name, int a, int b, int c) {
    int failed, ids[] = {a, b, c};
    double value;
    c_sysfnc(name, ids, 3, &value, &failed);
    c_errmes(failed, name, a, "STOP");
    return value;
}

void Gfosub(const struct sAdamsGforce *gforce, double time, int dflag, int iflag, double *out) {
    (void)time, (void)dflag, (void)iflag;
    int i = gforce->I, failed, n, frame[] = {i, 0, i}, angles[] = {i, 0};
    double sections = ask("ARYVAL", 5, 2, 0), radius = ask("ARYVAL", 5, 12, 0);
    double v[3], a[3];
    c_sysary("TVEL", frame, 3, v, &n, &failed);
    c_errmes(failed, "no velocity", gforce->ID, "STOP");
    c_sysary("RDISP", angles, 2, a, &n, &failed);
    c_errmes(failed, "no angles", gforce->ID, "STOP");
    /* air against the section: x of ground in its axes, after 3-1-3 angles */
    double y = WIND * (-cos(a[0]) * sin(a[2]) - sin(a[0]) * cos(a[1]) * cos(a[2])) - v[1];
    double z = WIND * sin(a[0]) * sin(a[1]) - v[2];
    double speed = sqrt(y * y + z * z + 1e-6);
    double sine = -y / speed, cosine = -z / speed;
    double lift = 6 * sine * cosine / (1 + 8 * sine * sine), drag = 0.01 + 1.3 * sine * sine;
    double area = CHORD * radius * radius / (sections > 0 ? sections : 1);
    double force = 0.5 * DENSITY * area * speed / KILO;
    out[1] = force * (lift * z + drag * y);
    out[2] = force * (drag * z - lift * y);
}

/* USER(…, efficiency, rated speed, rated torque, torque over speed squared, …) */
void Sfosub(const struct sAdamsSforce *sforce, double time, int dflag, int iflag, double *out) {
    (void)time, (void)dflag, (void)iflag;
    double gears = ask("ARYVAL", 5, 11, 0);
    double speed = gears * ask("WZ", sforce->I, sforce->J, sforce->J);
    if (sforce->NPAR < 11) return; /* a generator of the user's, whom nobody knows */
    double most = sforce->PAR[9], square = sforce->PAR[10];
    *out = -gears * copysign(fmin(square * speed * speed, most), speed) / KILO;
}

void Varsub(const struct sAdamsVariable *variable, double time, int dflag, int iflag, double *out) {
    (void)time, (void)dflag, (void)iflag;
    *out = variable->ID >= 10000 ? variable->PAR[variable->NPAR - 1] : 0;
}
