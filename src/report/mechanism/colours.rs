//! Colours of a mechanism: red, green, blue.
//!
//! Bodies differ in hue and a little in lightness, so that neighbours are told apart; everything
//! that is no body is grey but forces and torques.

/// Bodies, in turn.
pub const BODIES: [[u8; 3]; 8] = [
    [62, 124, 184],
    [222, 138, 52],
    [70, 158, 110],
    [194, 86, 112],
    [138, 114, 192],
    [200, 164, 48],
    [64, 168, 184],
    [156, 110, 80],
];
/// Ground.
pub const GROUND: [u8; 3] = [150, 156, 164];
/// Pins, balls and rails of joints.
pub const JOINT: [u8; 3] = [66, 72, 82];
/// Springs, beams and bushings.
pub const ELASTIC: [u8; 3] = [104, 110, 122];
/// The axes x, y and z of a marker.
pub const AXES: [[u8; 3]; 3] = [[204, 62, 52], [52, 148, 72], [54, 98, 196]];
/// Action vectors of joints, and dimensions.
pub const MEASURE: [u8; 3] = [24, 96, 128];
/// Forces.
pub const FORCE: [u8; 3] = [208, 52, 44];
