//! TABLE of functions of the model: DX, VZ, FX, VARVAL … Their arguments are identifiers; their value comes from a host.

/// A function of the model. (Contract: names and order may grow; one row each with arguments, doc and unit.)
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[rustfmt::skip]
pub enum Measure {
    // displacement
    Dm, Dx, Dy, Dz, Ax, Ay, Az, Psi, Theta, Phi, Yaw, Pitch, Roll, Incang,
    // velocity
    Vm, Vr, Vx, Vy, Vz, Wm, Wx, Wy, Wz,
    // acceleration
    Accm, Accx, Accy, Accz, Wdtm, Wdtx, Wdty, Wdtz,
    // generic force at a marker
    Fm, Fx, Fy, Fz, Tm, Tx, Ty, Tz,
    // element force (id, jflag, comp, rm)
    Beam, Bush, Field, Spdp, Sforce, Gforce, Vforce, Vtorq, Ptcv, Cvcv, Joint, Jprim, Motion, Contact, Nforce, Friction,
    // system elements
    Varval, Aryval, Dif, Dif1, Pinval, Pouval, Senval,
}
