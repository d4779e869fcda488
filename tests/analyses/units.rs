//! Laws of units and of neighbours: models whose lengths, masses and times are larger or smaller by any factor do the same, and
//! what nothing couples to a mechanism has no say in where it rests nor in how it swings there.

use crate::running;

use cognate::analysis::linear::Wanted;
use running::{Analysis, Options, Session, begin, go, model, rest, values};

/// A model whose numbers stand as `<value quantity>`, what is read of it, and how it is solved.
struct Kind {
    name: &'static str,
    text: String,
    columns: &'static [(&'static str, char)],
    /// d: dynamics, k: kinematics, s: statics and small motions
    ways: &'static str,
}

/// Exponents of length, mass and time of a quantity.
fn dimension(quantity: char) -> [i32; 3] {
    match quantity {
        '1' => [0, 0, 0],
        'L' => [1, 0, 0],
        'M' => [0, 1, 0],
        'I' => [2, 1, 0],
        'K' => [0, 1, -2],
        'C' => [0, 1, -1],
        'Q' => [2, 1, -2],
        'D' => [2, 1, -1],
        'F' => [1, 1, -2],
        'G' => [1, 0, -2],
        'V' => [1, 0, -1],
        'W' => [0, 0, -1],
        'T' => [0, 0, 1],
        'A' => [2, 0, 0],
        'J' => [4, 0, 0],
        'E' => [-1, 1, -2],
        _ => unreachable!("a quantity of the models below"),
    }
}

/// Length, mass and time over those of the models as they are written.
type Factors = [f64; 3];

fn factor(by: Factors, quantity: char) -> f64 {
    let exponents = dimension(quantity);
    (by.iter().zip(exponents)).fold(1.0, |all, (x, n)| all * x.powi(n))
}

fn scaled(text: &str, by: Factors) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, more)) = rest.split_once('<') {
        let (number, after) = more.split_once('>').expect("a number");
        let (value, quantity) = number.split_once(' ').expect("a quantity");
        let quantity = quantity.chars().next().expect("a letter");
        let value: f64 = value.parse().expect("a value");
        out += &format!("{before}{:?}", value * factor(by, quantity));
        rest = after;
    }
    out + rest
}

/// Part k at a place with its centre of mass k0 there.
fn part(k: u32, x: f64, y: f64, z: f64) -> String {
    format!(
        "PART/{k}, MASS=<1 M>, CM={k}0, IP=<0.1 I>,<0.12 I>,<0.15 I>, QG=<{x} L>,<{y} L>,<{z} L>\nMARKER/{k}0, PART={k}\n"
    )
}

fn marker(id: u32, part: u32, [x, y, z]: [f64; 3]) -> String {
    format!("MARKER/{id}, PART={part}, QP=<{x} L>,<{y} L>,<{z} L>\n")
}

/// Bars from corner to corner: parts 2 …, with markers 21, 22; 31, 32 … at their ends.
fn bars(corners: &[[f64; 2]]) -> String {
    let bar = |(k, ends): (u32, &[[f64; 2]])| {
        let [a, b] = [ends[0], ends[1]];
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let end = |p: [f64; 2]| [p[0] - middle[0], p[1] - middle[1], 0.0];
        part(k, middle[0], middle[1], 0.0)
            + &marker(10 * k + 1, k, end(a))
            + &marker(10 * k + 2, k, end(b))
    };
    (2..).zip(corners.windows(2)).map(bar).collect()
}

fn kind(
    name: &'static str,
    text: String,
    columns: &'static [(&'static str, char)],
    ways: &'static str,
) -> Kind {
    Kind {
        name,
        text,
        columns,
        ways,
    }
}

fn linkages() -> Vec<Kind> {
    let gravity = "ACCGRAV/JGRAV=<-9.81 G>\n";
    let four_bar = marker(2, 1, [3.0, 0.0, 0.0])
        + &marker(3, 1, [1.0, 4.0, 0.0])
        + &bars(&[[0.0, 0.0], [0.3, 1.1], [2.2, 1.9], [3.0, 0.0]])
        + "JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=41, J=32\nJOINT/4, REVOLUTE, I=42, J=2\n\
           SPRINGDAMPER/1, TRANSLATION, I=30, J=3, K=<20 K>, L=<1 L>, C=<0.5 C>\n"
        + gravity;
    let slider_crank = bars(&[[0.0, 0.0], [1.0, 0.0], [3.0, 0.0]])
        + &part(4, 3.0, 0.0, 0.0)
        + "MARKER/41, PART=4, REULER=90D,90D,0\nMARKER/6, PART=1, REULER=90D,90D,0\n\
           JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=32, J=40\nJOINT/4, TRANSLATIONAL, I=41, J=6\n\
           MOTION/1, JOINT=1, ROTATION, FUNCTION=<2 W>*TIME\nSFORCE/1, I=40, J=1, TRANSLATION, FUNCTION=-<3 C>*VX(40,1)\n"
        + gravity;
    let chain = bars(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]])
        + "JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, REVOLUTE, I=31, J=22\nJOINT/3, REVOLUTE, I=41, J=32\n\
           SPRINGDAMPER/1, ROTATION, I=21, J=1, CT=<0.2 D>\nSPRINGDAMPER/2, ROTATION, I=31, J=22, CT=<0.2 D>\n\
           SPRINGDAMPER/3, ROTATION, I=41, J=32, CT=<0.2 D>\n"
        + gravity;
    let spatial = part(2, 0.0, 0.5, 0.0)
        + &marker(21, 2, [0.0, -0.5, 0.0])
        + &marker(22, 2, [0.0, 0.5, 0.0])
        + &part(3, 1.0, 1.0, 0.5)
        + &marker(31, 3, [-1.0, 0.0, -0.5])
        + &marker(32, 3, [1.0, 0.0, 0.5])
        + &part(4, 2.0, 0.5, 1.0)
        + &marker(42, 4, [0.0, 0.5, 0.0])
        + "MARKER/2, PART=1, QP=<2 L>,0,<1 L>, REULER=90D,30D,0\nMARKER/43, PART=4, QP=0,<-0.5 L>,0, REULER=90D,30D,0\n\
           JOINT/1, REVOLUTE, I=21, J=1\nJOINT/2, SPHERICAL, I=31, J=22\nJOINT/3, SPHERICAL, I=32, J=42\nJOINT/4, REVOLUTE, I=43, J=2\n\
           ACCGRAV/JGRAV=<-9.81 G>, KGRAV=<2 G>\n\
           SFORCE/1, I=20, J=1, ROTATION, FUNCTION=-<0.3 D>*WZ(20,1)-<0.5 Q>*AZ(21,1)\n";
    vec![
        kind(
            "four-bar",
            four_bar,
            &[
                ("DX(30,1)", 'L'),
                ("AZ(30,1)", '1'),
                ("VX(30,1)", 'V'),
                ("FX(21,1)", 'F'),
            ],
            "ds",
        ),
        kind(
            "driven slider-crank",
            slider_crank,
            &[
                ("DX(40,1)", 'L'),
                ("VX(40,1)", 'V'),
                ("MOTION(1,0,8,0)", 'Q'),
                ("FY(21,1)", 'F'),
            ],
            "k",
        ),
        kind(
            "chain",
            chain,
            &[("DX(42,1)", 'L'), ("DY(42,1)", 'L'), ("WZ(40,1)", 'W')],
            "ds",
        ),
        kind(
            "spatial four-bar",
            spatial,
            &[("DX(30,1)", 'L'), ("AZ(20,1)", '1'), ("FX(22,31)", 'F')],
            "ds",
        ),
    ]
}

fn carried() -> Vec<Kind> {
    let bushings = part(2, 0.2, 0.1, 0.3)
        + &marker(2, 1, [0.2, 0.1, 0.3])
        + &marker(21, 2, [0.3, 0.2, 0.1])
        + &marker(3, 1, [0.5, 0.3, 0.4])
        + "BUSHING/1, I=20, J=2, K=<100 K>,<200 K>,<150 K>, KT=<10 Q>,<12 Q>,<8 Q>, C=<1 C>,<1 C>,<1 C>, CT=<0.1 D>,<0.1 D>,<0.1 D>\n\
           BUSHING/2, I=21, J=3, K=<50 K>,<20 K>,<15 K>, KT=<1 Q>,<2 Q>,<8 Q>, C=<0.1 C>,<0.1 C>,<0.1 C>, CT=<0.1 D>,<0.1 D>,<0.1 D>\n\
           ACCGRAV/JGRAV=<-9.81 G>, IGRAV=<1 G>\n";
    let beams = part(2, 1.0, 0.0, 0.0)
        + &part(3, 2.0, 0.0, 0.0)
        + "BEAM/1, I=20, J=1, LENGTH=<1 L>, IXX=<2e-4 J>, IYY=<1e-4 J>, IZZ=<1e-4 J>, AREA=<0.01 A>, EMOD=<1e6 E>, GMOD=<4e5 E>, CRATIO=<0.01 T>\n\
           BEAM/2, I=30, J=20, LENGTH=<1 L>, IXX=<2e-4 J>, IYY=<1e-4 J>, IZZ=<1e-4 J>, AREA=<0.01 A>, EMOD=<1e6 E>, GMOD=<4e5 E>, CRATIO=<0.01 T>\n\
           ACCGRAV/JGRAV=<-9.81 G>\n";
    let states = part(2, 0.5, 0.0, 0.0)
        + &marker(21, 2, [-0.5, 0.0, 0.0])
        + "JOINT/1, REVOLUTE, I=21, J=1\nDIFF/1, IC=0.2, FUNCTION=(AZ(21,1)-DIF(1))/<0.3 T>\nVARIABLE/1, FUNCTION=<3 Q>*DIF(1)\n\
           SFORCE/1, I=20, J=1, ROTATION, FUNCTION=-VARVAL(1)-<0.1 D>*WZ(21,1)\nACCGRAV/JGRAV=<-9.81 G>\n";
    let stop = part(2, 0.0, 1.0, 0.0)
        + "MARKER/21, PART=2, REULER=0,-90D,0\nMARKER/2, PART=1, REULER=0,-90D,0\nJOINT/1, TRANSLATIONAL, I=21, J=2\n\
           SFORCE/1, I=20, J=1, TRANSLATION, FUNCTION=IMPACT(DY(20,1),VY(20,1),<0.1 L>,<1e4 K>,1,<10 C>,<0.01 L>)\nACCGRAV/JGRAV=<-9.81 G>\n";
    let friction = part(2, 0.0, 0.0, 0.0)
        + &marker(3, 1, [2.0, 0.0, 0.0])
        + "MARKER/21, PART=2, REULER=90D,90D,0\nMARKER/2, PART=1, REULER=90D,90D,0\nJOINT/1, TRANSLATIONAL, I=21, J=2\n\
           FRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=<0.01 V>, MAX_STICTION_DEFORMATION=<0.001 L>\n\
           SFORCE/1, I=20, J=3, TRANSLATION, FUNCTION=<4 F>*SIN(<3 W>*TIME)\nACCGRAV/JGRAV=<-9.81 G>\n\
           SPRINGDAMPER/1, TRANSLATION, I=20, J=3, K=<2 K>, L=<1 L>\n";
    let ball = format!(
        "{}{}{}",
        part(2, 0.0, 0.6, 0.0).replace("PART/2,", "PART/2, VX=<1 V>,"),
        marker(3, 1, [-10.0, -0.5, -10.0]),
        "GRAPHICS/1, BOX, CORNER=3, X=<20 L>, Y=<0.5 L>, Z=<20 L>\nGRAPHICS/2, ELLIPSOID, CM=20, XSCALE=<1 L>, YSCALE=<1 L>, ZSCALE=<1 L>\n\
         CONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=<1e3 K>, DAMPING=<20 C>, EXPONENT=1, DMAX=<0.01 L>, COULOMB_FRICTION=ON, MU_STATIC=0.3, \
         MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=<0.01 V>, FRICTION_TRANSITION_VELOCITY=<0.1 V>\nACCGRAV/JGRAV=<-9.81 G>\n",
    );
    vec![
        kind(
            "bushings",
            bushings,
            &[
                ("DX(20,1)", 'L'),
                ("AZ(20,1)", '1'),
                ("FX(20,2)", 'F'),
                ("TY(20,2)", 'Q'),
            ],
            "ds",
        ),
        kind(
            "beams",
            beams,
            &[("DY(30,1)", 'L'), ("AZ(30,1)", '1')],
            "ds",
        ),
        kind(
            "states",
            states,
            &[("AZ(21,1)", '1'), ("DIF(1)", '1'), ("VARVAL(1)", 'Q')],
            "ds",
        ),
        kind("stop", stop, &[("DY(20,1)", 'L'), ("VY(20,1)", 'V')], "ds"),
        kind(
            "friction",
            friction,
            &[("DX(20,1)", 'L'), ("VX(20,1)", 'V')],
            "d",
        ),
        kind(
            "ball",
            ball,
            &[("DX(20,1)", 'L'), ("DY(20,1)", 'L'), ("AZ(20,1)", '1')],
            "d",
        ),
    ]
}

fn kinds() -> impl Iterator<Item = Kind> {
    linkages().into_iter().chain(carried())
}

fn without_numbers(sentence: &str) -> String {
    let words = sentence.split(' ');
    let words: Vec<&str> = words
        .filter(|word| !word.contains(|c: char| c.is_ascii_digit()))
        .collect();
    words.join(" ")
}

impl Kind {
    fn session(&self, more: &str, by: Factors) -> Session {
        let columns = self.columns.iter().map(|(column, _)| (*column).to_owned());
        let options = Options {
            columns: columns.collect(),
            error: Some(1e-8),
            ..Options::default()
        };
        let text = scaled(&format!("{}{more}", self.text), by);
        begin(model(&text), self.name, options)
    }

    /// All columns over four outputs in a unit of time, and eigenvalues at rest, as they are in the units of the kind; what is
    /// told, but for its numbers.
    fn solved(&self, way: char, more: &str, by: Factors) -> (Vec<Vec<f64>>, Vec<String>) {
        let mut s = self.session(more, by);
        match way {
            's' => rest(&mut s),
            'k' => go(&mut s, Analysis::Kinematic, by[2], 4),
            _ => go(&mut s, Analysis::Dynamic, by[2], 4),
        }
        let columns = self.columns.iter();
        let mut all: Vec<Vec<f64>> = columns
            .map(|(column, quantity)| {
                let unit = factor(by, *quantity);
                values(&s, column).iter().map(|x| x / unit).collect()
            })
            .collect();
        if way == 's' {
            let found = s.linearize(&Wanted::default()).expect("modes");
            let pairs = found.modes.iter().flat_map(|m| [m.re, m.im]);
            all.push(pairs.map(|x| x * by[2]).collect());
        }
        let told = s.run.record.warned().into_iter();
        (
            all,
            told.map(|sentence| without_numbers(&sentence)).collect(),
        )
    }
}

#[test]
fn no_number_of_ours_has_a_dimension() {
    for kind in kinds() {
        for way in kind.ways.chars() {
            let (usual, told) = kind.solved(way, "", [1.0; 3]);
            let mut all: Vec<Factors> = Vec::new();
            for dimension in 0..3 {
                for size in [1e-9, 1e-3, 1e3, 1e9] {
                    let mut by = [1.0; 3];
                    by[dimension] = size;
                    all.push(by);
                }
            }
            all.extend([[1e-3, 1e3, 1e-6], [1e6, 1e-6, 1e3]]);
            for by in all {
                let name = format!("{} {way} {by:?}", kind.name);
                let (found, told_then) = kind.solved(way, "", by);
                assert_eq!(told, told_then, "{name}");
                assert_eq!(usual.len(), found.len());
                for (k, (a, b)) in usual.iter().zip(&found).enumerate() {
                    assert_eq!(a.len(), b.len(), "{name}");
                    let size = a.iter().fold(1e-6, |m: f64, x| m.max(x.abs()));
                    for (x, y) in a.iter().zip(b) {
                        assert!((x - y).abs() < 2e-6 * size, "{name} {k}: {x} {y}");
                    }
                }
            }
        }
    }
}

/// A pendulum with a gap, a heavy body on stiff bushings, a driven wheel, a state by itself.
const NEIGHBOURS: [&str; 4] = [
    "MARKER/2002, PART=1, QP=-900,20,3\nPART/200, QG=-900.5,20.2,3.1, MASS=1, CM=2000, IP=1,1,1\nMARKER/2000, PART=200, QP=1,0,0\n\
     MARKER/2001, PART=200\nJOINT/201, REVOLUTE, I=2001, J=2002\n",
    "MARKER/2002, PART=1, QP=-9,20,3\nPART/200, QG=-9.5,20.2,3.1, MASS=1E6, CM=2000, IP=1E6,1E6,1E6\nMARKER/2000, PART=200\n\
     BUSHING/201, I=2000, J=2002, K=1E9,1E9,1E9, KT=1E8,1E8,1E8, C=1E4,1E4,1E4, CT=1E3,1E3,1E3\n",
    "MARKER/2002, PART=1, QP=-9,20,3\nPART/200, QG=-9,20,3, MASS=1, CM=2000, IP=1,1,1\nMARKER/2000, PART=200\n\
     JOINT/201, REVOLUTE, I=2000, J=2002\nMOTION/201, JOINT=201, ROTATION, FUNCTION=3*SIN(7*TIME)\n",
    "DIFF/201, IC=1, FUNCTION=-3*DIF(201)\n",
];

#[test]
fn what_nothing_couples_to_a_mechanism_changes_no_bit_of_its_rest_and_no_mode() {
    for kind in kinds().filter(|kind| kind.ways.contains('s')) {
        let (alone, _) = kind.solved('s', "", [1.0; 3]);
        for (n, more) in NEIGHBOURS.iter().enumerate() {
            let (beside, _) = kind.solved('s', more, [1.0; 3]);
            let ([rest @ .., modes], [rest_then @ .., modes_then]) =
                (alone.as_slice(), beside.as_slice())
            else {
                unreachable!("columns and modes");
            };
            for ((column, _), (a, b)) in kind.columns.iter().zip(rest.iter().zip(rest_then)) {
                let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
                assert_eq!(bits(a), bits(b), "{} {n} {column}: {a:?} {b:?}", kind.name);
            }
            // more modes, among them its own
            let pairs = |x: &[f64]| x.chunks(2).map(|z| [z[0], z[1]]).collect::<Vec<[f64; 2]>>();
            for own in pairs(modes) {
                let size = own[0].hypot(own[1]);
                let is_own = |z: &[f64; 2]| (z[0] - own[0]).hypot(z[1] - own[1]) <= 1e-14 * size;
                assert!(
                    pairs(modes_then).iter().any(is_own),
                    "{} {n}: {own:?} is not among {modes_then:?}",
                    kind.name
                );
            }
        }
    }
}
