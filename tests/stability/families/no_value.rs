//! Expressions that lose their value on the way.

use crate::laws::{push, slider};
use crate::scene::{Scene, scene};

/// The scenes of this family.
pub fn no_value() -> Vec<Scene> {
    let f = "no value";
    let one = |name: &str, function: &str, words: &'static str| {
        scene(f, name, slider(1.0, 0.0, 0.0) + &push(function)).ends(words)
    };
    let mut all = vec![
        one("a root of what becomes negative", "SQRT(0.5-TIME)", "SQRT"),
        one(
            "a logarithm of what becomes negative",
            "LOG(0.5-TIME)",
            "LOG",
        ),
        one("an arc sine beyond one", "ASIN(2*TIME)", "ASIN"),
        one("a pole", "1/(TIME-0.5)", "SFORCE/1"),
        one("a tangent", "TAN(PI*TIME)", "SFORCE/1"),
        one("a power of what becomes negative", "(0.5-TIME)**1.5", "**"),
        one("a root of its own position", "SQRT(0.1-DX(20,1))", "SQRT"),
        one("an overflow", "EXP(2000*TIME)", "no finite value"),
        scene(
            f,
            "a side that is not taken has no value",
            slider(1.0, 0.0, 0.0) + &push("IF(TIME-2: 1, SQRT(TIME-2), SQRT(TIME-2))"),
        )
        .follows("DX(20,1)", |t| t * t / 2.0, 1e-9),
        scene(
            f,
            "a differential equation explodes",
            "DIFF/1, IC=1, FUNCTION=DIF(1)**2\n",
        )
        .end(2.0)
        .ends("DIFF/1"),
    ];
    for error in [1e-4, 1e-3, 1e-2, 1e-1] {
        for (name, function) in [("a pole", "1/(TIME-0.5)"), ("a tangent", "TAN(PI*TIME)")] {
            all.push(
                one(name, function, "SFORCE/1")
                    .method("RADAU5")
                    .error(error),
            );
        }
    }
    all
}
