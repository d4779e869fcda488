//! The kinematic measures (DX … WDTZ, AX … PITCH, INCANG) as formulas of marker states.
