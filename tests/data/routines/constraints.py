"""Constraints and contacts: what constraints.c has."""
from math import cos, sin


def Cousub(coupler, time, q, iflag):
    return q[1] + 0.5 * q[0] * q[1] - coupler.PAR[0] * sin(q[0])


def Couxx(coupler, time, q, iflag):
    return 0.5 * q[1] - coupler.PAR[0] * cos(q[0]), 1 + 0.5 * q[0]


def Couxx2(coupler, time, q, iflag):
    mixed = 0.5 if coupler.JOINTS == [1, 2] and coupler.TYPE == "RR" else 0
    return [[coupler.PAR[0] * sin(q[0]), mixed], [mixed, 0]]


def Cursub(curve, alpha, iord, iflag):
    r = curve.PAR[0]
    x, y = r * cos(alpha), r * sin(alpha)
    return [(x, y, 0), (-y, x, 0), (-x, -y, 0)][iord]


def step(x, x0, h0, x1, h1):
    u = min(1, max(0, (x - x0) / (x1 - x0)))
    return h0 + (h1 - h0) * u * u * (3 - 2 * u)


def Cnfsub(contact, time, loci, ni, locj, nj, gap, gapdot, gapdotdot, area, dflag, iflag):
    k, e, c, d = contact.PAR
    g = max(0, -gap)
    return max(0, k * g**e - step(g, 0, 0, d, c) * gapdot) if g > 0 else 0


def Cffsub(contact, time, loci, locj, x, xdot, nforce, area, dflag, iflag):
    stiction, dynamic, slow, fast = contact.PAR
    v = xdot[0]
    mu = step(v, -slow, -stiction, slow, stiction) if v < slow else step(v, slow, stiction, fast, dynamic)
    return -mu * nforce, 0, 0
