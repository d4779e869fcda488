/* A damper about z: USER(c, I, J) is the torque -c WZ(I, J). */
#include "cognate_routines.h"

adams_c_Sfosub Sfosub;

void Sfosub(const struct sAdamsSforce *sforce, double time, int dflag, int iflag, double *value) {
    (void)time, (void)dflag, (void)iflag;
    int ids[] = {(int)sforce->PAR[1], (int)sforce->PAR[2]};
    int failed;
    double rate;
    c_sysfnc("WZ", ids, 2, &rate, &failed);
    c_errmes(failed, "the damper has no rate", sforce->ID, "STOP");
    *value = -sforce->PAR[0] * rate;
}
