"""A damper about z: USER(c, I, J) is the torque -c WZ(I, J)."""


def Sfosub(sforce, time, dflag, iflag):
    c, i, j = sforce.PAR
    return -c * sysfnc("WZ", [i, j])
