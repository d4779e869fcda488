"""Routines of all kinds that read the model: what all.c has."""


def Vfosub(f, time, dflag, iflag):
    return [-k * x for k, x in zip(f.PAR, sysary("TDISP", [f.I, 1]))]


def Vtosub(f, time, dflag, iflag):
    return 0, 0, -f.PAR[0] * sysfnc("WZ", (f.I, 1))


def Gfosub(f, time, dflag, iflag):
    out = [-f.PAR[0] * v for v in sysary("VEL", [f.I, f.RM, f.RM])]
    out[0] += time
    return out


def Varsub(v, time, dflag, iflag):
    return v.PAR[0] * time + sysfnc("DX", [20, 1]) + v.IC


def Difsub(d, time, dflag, iflag):
    return -d.PAR[0] * sysfnc("DIF", d.ID) + sysfnc("VARVAL", 1)


def Motsub(motion, time, iord, iflag):
    a = motion.PAR[0]
    return (a * time**2, 2 * a * time, 2 * a)[iord]


def Reqsub(request, time, iflag):
    return 0, sysfnc("DX", [request.PAR[0], 1]), time, 0, 0, 0, 0, 0


def Sensub(sensor, time, iflag):
    return sysfnc("DY", [20, 1]) - sensor.PAR[0]


def Gsesub(gse, time, dflag, iflag, states, inputs):
    return [u - x for x, u in zip(states, inputs)], [2 * states[0]]
