//! Expressions against native code and against the fastest public evaluators, in one interleaved run.
//!
//! `cargo bench --no-default-features --features native --bench expression` prints, for twelve expressions, medians of
//! nanoseconds per evaluation and ratios: the value against a hand-written Rust function, value and gradient against the same
//! function over hand-written dual numbers, batches of 1024 points against the compiled loop, generated code against the
//! interpreter; then what parsing, compiling and translating cost and how often an evaluation allocates. Each round runs
//! every contestant once, so that a busy moment hits all of them.
//!
//! Rules. Every contestant sits behind one boxed call and reads 64 random points of eight numbers (TIME, DX, DY, DZ, VX, VY,
//! VZ, VR). Functions that a peer lacks are native callbacks with their constant arguments built in (fasteval), or custom
//! operators (exmex): the best case for the peer. All values must agree to 1e-9 with the native ones, or the run stops.
//!
//! `COGNATE_BENCH_ROUNDS` sets the number of rounds (201); an argument restricts the run to cases with that in their names.

use cognate::expr::compile::Compiler;
use cognate::expr::interpolation::Bindings;
use cognate::expr::measures::Measure;
use cognate::expr::program::{Engine, Input, Program, Work};
use cognate::expr::{Profile, ast::Dialect, parse};
use std::alloc::{GlobalAlloc, Layout, System};
use std::hint::black_box;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

#[path = "expression/dual.rs"]
mod dual;
#[path = "expression/peers.rs"]
mod peers;

use dual::{Forward, Real};

/// Numbers per point.
const SLOTS: usize = 8;
/// Points that the scalar runs go round.
const POINTS: usize = 64;
/// Points of a batch.
const BATCH: usize = 1024;

// ---------------------------------------------------------------------------------------------------------------- cases

/// One expression: in the language, and by hand over plain numbers, over duals, and over columns.
struct Case {
    name: &'static str,
    text: String,
    /// the slots it reads
    slots: &'static [usize],
    native: fn(&[f64]) -> f64,
    /// value and derivatives with respect to the slots it reads
    native_dual: fn(&[f64], &mut [f64]),
    native_loop: fn(&[Vec<f64>], &mut [f64]),
    /// for fasteval, for exmex; empty where it cannot be said
    peers: [&'static str; 2],
}

/// A case from an expression in Rust that means the same over numbers and over duals.
macro_rules! case {
    ($name:literal, $text:expr, [$($slot:literal $var:ident),+], [$fasteval:expr, $exmex:expr], $body:expr) => {{
        const SLOTS_READ: &[usize] = &[$($slot),+];
        const N: usize = SLOTS_READ.len();
        fn native(x: &[f64]) -> f64 {
            let x: &[f64; SLOTS] = x.try_into().expect("eight numbers");
            $(let $var = x[$slot];)+
            $body
        }
        fn native_dual(x: &[f64], out: &mut [f64]) {
            let x: &[f64; SLOTS] = x.try_into().expect("eight numbers");
            let mut k = 0;
            $(
                let $var = Forward::<N>::variable(x[$slot], k);
                k += 1;
            )+
            let _ = k;
            let value: Forward<N> = $body;
            out[0] = value.re;
            out[1..].copy_from_slice(&value.eps);
        }
        fn native_loop(columns: &[Vec<f64>], out: &mut [f64]) {
            $(let $var = &columns[$slot][..BATCH];)+
            let out = &mut out[..BATCH];
            for k in 0..BATCH {
                $(let $var = $var[k];)+
                out[k] = $body;
            }
        }
        let text: String = $text.into();
        Case { name: $name, text, slots: SLOTS_READ, native, native_dual, native_loop, peers: [$fasteval, $exmex] }
    }};
}

/// The same tokens as Rust and as text of the language.
macro_rules! long {
    ($name:literal, [$($slot:literal $var:ident),+], $($tokens:tt)+) => {{
        let source = stringify!($($tokens)+);
        let one_line: Vec<&str> = source.split_whitespace().collect();
        let plain: &'static str = Box::leak(one_line.join(" ").into_boxed_str());
        case!($name, in_our_words(source), [$($slot $var),+], [plain, plain], $($tokens)+)
    }};
}

/// Rust arithmetic over `t`, `dx` … as text of the language.
fn in_our_words(rust: &str) -> String {
    let mut text = String::new();
    let mut word = String::new();
    for c in rust.chars().chain([' ']) {
        if c.is_ascii_lowercase() {
            word.push(c);
            continue;
        }
        match word.as_str() {
            "" => {}
            "t" => text += "TIME",
            measure => text += &format!("{}(1,2)", measure.to_uppercase()),
        }
        word.clear();
        text.push(c);
    }
    text
}

/// CHEBY, FORCOS: eight coefficients.
const CHEBY: [f64; 8] = [0.3, -1.2, 0.7, 0.05, -0.4, 0.9, -0.15, 0.6];
const FORCOS: [f64; 9] = [0.2, 1.0, -0.5, 0.25, 0.8, -0.3, 0.1, 0.05, -0.15];

fn cases() -> Vec<Case> {
    vec![
        case!(
            "const_poly",
            "(2+3)*TIME**3-(4*2-1)*TIME**2/2+SQRT(16)*TIME-10/4",
            [0 t],
            ["(2+3)*t^3-(4*2-1)*t^2/2+4*t-10/4", "(2+3)*t^3-(4*2-1)*t^2/2+4*t-10/4"],
            5.0 * (t * t * t) - 7.0 * (t * t) / 2.0 + 4.0 * t - 2.5
        ),
        case!(
            "precedence",
            "DX(1,2)+DY(1,2)*DZ(1,2)-VX(1,2)/2*DX(1,2)**2-(-DY(1,2)-VY(1,2))*3/(1+DZ(1,2)**2)",
            [1 dx, 2 dy, 3 dz, 4 vx, 5 vy],
            ["dx+dy*dz-vx/2*dx^2-(-dy-vy)*3/(1+dz^2)", "dx+dy*dz-vx/2*dx^2-(-dy-vy)*3/(1+dz^2)"],
            dx + dy * dz - vx / 2.0 * (dx * dx) - (-dy - vy) * 3.0 / (1.0 + dz * dz)
        ),
        case!(
            "trig",
            "SIN(2*PI*TIME)*COS(3*TIME)+0.5*SIN(5*TIME+0.3)**2-ATAN(DX(1,2)/2)+TAN(0.2*TIME)",
            [0 t, 1 dx],
            [
                "sin(2*pi()*t)*cos(3*t)+0.5*sin(5*t+0.3)^2-atan(dx/2)+tan(0.2*t)",
                "sin(2*PI*t)*cos(3*t)+0.5*sin(5*t+0.3)^2-atan(dx/2)+tan(0.2*t)"
            ],
            (2.0 * std::f64::consts::PI * t).sin() * (3.0 * t).cos() + 0.5 * (5.0 * t + 0.3).sin().squared()
                - (dx / 2.0).atan()
                + (0.2 * t).tan()
        ),
        case!(
            "step_chain",
            "STEP(TIME,0.5,0,1,1)+STEP(TIME,1,0,2,-2)+STEP(TIME,2.5,0,3.2,1.5)+STEP(TIME,3.5,0,4.1,-0.5)",
            [0 t],
            [
                "step_a(t)+step_b(t)+step_c(t)+step_d(t)",
                "smooth((t-0.5)/0.5)-2*smooth(t-1)+1.5*smooth((t-2.5)/0.7)-0.5*smooth((t-3.5)/0.6)"
            ],
            dual::step(t, 0.5, 0.0, 1.0, 1.0)
                + dual::step(t, 1.0, 0.0, 2.0, -2.0)
                + dual::step(t, 2.5, 0.0, 3.2, 1.5)
                + dual::step(t, 3.5, 0.0, 4.1, -0.5)
        ),
        case!(
            "impact",
            "IMPACT(DZ(1,2),VZ(1,2),1.0,1.0E5,1.5,50,0.1)",
            [3 dz, 6 vz],
            ["impact(dz,vz)", "relu(100000*relu(1-dz)^1.5-50*smooth((1-dz)/0.1)*vz)"],
            dual::impact(dz, vz, 1.0, 1.0e5, 1.5, 50.0, 0.1)
        ),
        case!(
            "bistop",
            "BISTOP(DX(1,2),VX(1,2),-0.5,0.5,1.0E5,2.2,50,0.1)",
            [1 dx, 4 vx],
            [
                "bistop(dx,vx)",
                "relu(100000*relu(-0.5-dx)^2.2-50*smooth((-0.5-dx)/0.1)*vx)-relu(100000*relu(dx-0.5)^2.2+50*smooth((dx-0.5)/0.1)*vx)"
            ],
            dual::bistop(dx, vx, -0.5, 0.5, 1.0e5, 2.2, 50.0, 0.1)
        ),
        case!(
            "cheby8",
            "CHEBY(TIME,1,0.3,-1.2,0.7,0.05,-0.4,0.9,-0.15,0.6)",
            [0 t],
            [
                "cheby(t)",
                "0.3-1.2*(t-1)+0.7*(2*(t-1)^2-1)+0.05*(4*(t-1)^3-3*(t-1))-0.4*(8*(t-1)^4-8*(t-1)^2+1)+0.9*(16*(t-1)^5-20*(t-1)^3+5*(t-1))-0.15*(32*(t-1)^6-48*(t-1)^4+18*(t-1)^2-1)+0.6*(64*(t-1)^7-112*(t-1)^5+56*(t-1)^3-7*(t-1))"
            ],
            dual::cheby(t, 1.0, &CHEBY)
        ),
        case!(
            "forcos8",
            "FORCOS(TIME,0.1,360D,0.2,1,-0.5,0.25,0.8,-0.3,0.1,0.05,-0.15)",
            [0 t],
            [
                "forcos(t)",
                "0.2+cos(2*PI*(t-0.1))-0.5*cos(4*PI*(t-0.1))+0.25*cos(6*PI*(t-0.1))+0.8*cos(8*PI*(t-0.1))-0.3*cos(10*PI*(t-0.1))+0.1*cos(12*PI*(t-0.1))+0.05*cos(14*PI*(t-0.1))-0.15*cos(16*PI*(t-0.1))"
            ],
            dual::forcos(t, 0.1, 2.0 * std::f64::consts::PI, &FORCOS)
        ),
        case!(
            "if_chain",
            "IF(TIME-1: DX(1,2)*2, 1, IF(TIME-2: DX(1,2)**2-TIME, 2, IF(TIME-3: 3*TIME-DX(1,2), 3, IF(TIME-4: DX(1,2)/TIME, 4, TIME*DX(1,2)))))",
            [0 t, 1 dx],
            [
                "(t<1)*(dx*2)+(t==1)*1+(t>1)*((t<2)*(dx^2-t)+(t==2)*2+(t>2)*((t<3)*(3*t-dx)+(t==3)*3+(t>3)*((t<4)*(dx/t)+(t==4)*4+(t>4)*(t*dx))))",
                ""
            ],
            dual::if3(t - 1.0, || dx * 2.0, || Real::constant(1.0), || {
                dual::if3(t - 2.0, || dx * dx - t, || Real::constant(2.0), || {
                    dual::if3(t - 3.0, || 3.0 * t - dx, || Real::constant(3.0), || {
                        dual::if3(t - 4.0, || dx / t, || Real::constant(4.0), || t * dx)
                    })
                })
            })
        ),
        case!(
            "nested10",
            "SQRT(1+ABS(2*DX(1,2)-SQRT(1+ABS(3*DY(1,2)-SQRT(1+ABS(TIME-SQRT(1+ABS(0.5*DX(1,2)+(1-(2.5*DY(1,2)-TIME))))))))))",
            [0 t, 1 dx, 2 dy],
            [
                "sqrt(1+abs(2*dx-sqrt(1+abs(3*dy-sqrt(1+abs(t-sqrt(1+abs(0.5*dx+(1-(2.5*dy-t))))))))))",
                "sqrt(1+abs(2*dx-sqrt(1+abs(3*dy-sqrt(1+abs(t-sqrt(1+abs(0.5*dx+(1-(2.5*dy-t))))))))))"
            ],
            (1.0 + (2.0 * dx
                - (1.0
                    + (3.0 * dy - (1.0 + (t - (1.0 + (0.5 * dx + (1.0 - (2.5 * dy - t))).abs()).sqrt()).abs()).sqrt())
                        .abs())
                .sqrt())
            .abs())
            .sqrt()
        ),
        long!(
            "long200",
            [0 t, 1 dx, 2 dy, 3 dz, 4 vx, 5 vy],
            1.1 * dx * t + 2.3 * dy - dz * 0.7 + vx * vy - (dx - 0.3) * (dy + 1.2) + t * t * 0.25 - 3.1 * dz * vx
                + (t + 1.7) * (vx - 0.4) - dy / 2.5 + 0.6 * vy * dz - (dx + dy) * (dz - t) + 1.9 * t - vx / 3.0
                + (vy - 2.2) * (vy + 0.9) * dx - 0.15 * dz + dy * dy * vx + 2.7 * (t - dx) - 1.3 * vy * t
                + (dz * dz - 0.8) * (dx - 1.6) + vx * 4.4 - dy * vy * 0.35 + (t - 0.2) * (dy - 0.5) * 1.4 - vx * vx
                + 0.45 * dx * dz - (vy + t) * 2.1 + dy / 1.7 - dz * vy + 3.3 * (dx + vx) - t * dz * 0.9
                + (dy - vx) * (vy - dx) + 1.25 * t * vy - dx * dx * dx + 0.55 * dz - (vx + 1.05) * dy
                + 2.9 * (dz - vy) * t - dx / 4.2 + vy * 1.15 - (t * 0.65 + dy) * (vx - 0.75) + dz * t * dx
                - 1.45 * (dy - 0.95) + vx * dz - 0.85 * vy * vy + (dx - t) * 3.7 - dz / 2.2 + dy * t
                + (vx * 0.5 - dx) * (vy * 0.3 + dz) - 2.4 * t + dx * vy * 1.85 - (dy + dz) * (vx + vy) * 0.05
                + t * vx - 0.33 * dy * dx + (vy - dz) / 1.9 + 1.65 * dx - vx * t * 0.22 + (dz + 2.05) * (dy - t)
                - dx * 0.48 + vy * vx * dz * 0.07 - (t - 3.3) * 0.11 + dy * 2.6 - dz * dx * dy * 0.13
                + vx / 5.5 - (vy + dx) * (t - dz) * 0.21 + 1.55 * dy - 0.77 * vx * dx + t * t * t * 0.031
                - (dz - 1.35) * vy + dx * 0.62 + (vx - dy) * 0.91 - t / 6.1
        ),
        case!(
            "marker6",
            "-1200*(DX(1,2)-0.2)-35*VX(1,2)+0.5*(DY(1,2)*VY(1,2)+DZ(1,2)*VZ(1,2))/(1+DX(1,2)*DX(1,2)+DY(1,2)*DY(1,2)+DZ(1,2)*DZ(1,2))",
            [1 dx, 2 dy, 3 dz, 4 vx, 5 vy, 6 vz],
            [
                "-1200*(dx-0.2)-35*vx+0.5*(dy*vy+dz*vz)/(1+dx*dx+dy*dy+dz*dz)",
                "-1200*(dx-0.2)-35*vx+0.5*(dy*vy+dz*vz)/(1+dx*dx+dy*dy+dz*dz)"
            ],
            -1200.0 * (dx - 0.2) - 35.0 * vx + 0.5 * (dy * vy + dz * vz) / (1.0 + dx * dx + dy * dy + dz * dz)
        ),
    ]
}

/// The inputs by slot, as the programs are compiled for.
fn layout() -> [Input; SLOTS] {
    use Measure::{Dx, Dy, Dz, Vr, Vx, Vy, Vz};
    let of = |m: Measure| Input::Measure(m, [1, 2, 0, 0]);
    [
        Input::Time,
        of(Dx),
        of(Dy),
        of(Dz),
        of(Vx),
        of(Vy),
        of(Vz),
        of(Vr),
    ]
}

fn compiled(text: &str) -> Program {
    let ast =
        parse(text, Dialect::Function, Profile::Adams).unwrap_or_else(|e| panic!("{text}: {e}"));
    let bindings = Bindings::default();
    let mut compiler = Compiler::new(&bindings);
    let value = compiler.add(&ast).unwrap_or_else(|e| panic!("{text}: {e}"));
    compiler
        .builder()
        .borrow()
        .finish_with_inputs(&[value], &layout())
}

/// Random points: TIME from 0 to 5, lengths so that contacts are met, speeds of either sign.
fn points(n: usize) -> Vec<[f64; SLOTS]> {
    let mut state = 0x1234_5678_9ABC_DEFFu64;
    let mut uniform = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n)
        .map(|_| {
            let [t, dx, dy, dz, vx, vy, vz, vr] = std::array::from_fn(|_| uniform());
            [
                5.0 * t,
                2.0 * dx - 1.0,
                2.0 * dy - 1.0,
                0.5 + 0.8 * dz,
                vx - 0.5,
                vy - 0.5,
                vz - 0.5,
                vr - 0.5,
            ]
        })
        .collect()
}

// -------------------------------------------------------------------------------------------------------------- harness

/// Something that is timed: evaluates the `k`-th point.
type Contestant<'a> = Box<dyn FnMut(usize) -> f64 + 'a>;

/// How long a contestant runs at a stretch.
const SLICE: Duration = Duration::from_micros(60);

/// Medians of nanoseconds per evaluation, and medians of the ratio to the first contestant in the same round. Every round runs each
/// contestant once; processors change their speed between rounds, which ratios within a round do not feel.
fn medians(
    contestants: &mut [Contestant],
    per_round: usize,
    rounds: usize,
) -> (Vec<f64>, Vec<f64>) {
    // evaluations per slice, by a first trial
    let mut counts: Vec<usize> = Vec::new();
    for contestant in contestants.iter_mut() {
        let mut n = 1;
        loop {
            let start = Instant::now();
            for _ in 0..n {
                go_round(contestant, per_round);
            }
            if start.elapsed() >= SLICE {
                break;
            }
            n *= 2;
        }
        counts.push(n);
    }
    let mut times: Vec<Vec<f64>> = contestants
        .iter()
        .map(|_| Vec::with_capacity(rounds))
        .collect();
    for _ in 0..rounds {
        for ((contestant, &n), times) in contestants.iter_mut().zip(&counts).zip(&mut times) {
            go_round(contestant, per_round);
            let start = Instant::now();
            for _ in 0..n {
                go_round(contestant, per_round);
            }
            times.push(start.elapsed().as_secs_f64() * 1e9 / (n * per_round) as f64);
        }
    }
    let ratios = times
        .iter()
        .map(|t| {
            median(
                &mut t
                    .iter()
                    .zip(&times[0])
                    .map(|(t, first)| t / first)
                    .collect::<Vec<_>>(),
            )
        })
        .collect();
    (times.iter_mut().map(|t| median(t)).collect(), ratios)
}

fn go_round(contestant: &mut Contestant, n: usize) {
    for k in 0..n {
        black_box(contestant(black_box(k)));
    }
}

/// Mean microseconds of the processor for one run, over a fifth of a second of runs. What takes longer than a slice of the
/// scheduler would otherwise be measured with whatever else the machine does.
fn mean_of_own_time(mut run: impl FnMut()) -> f64 {
    let own = || {
        let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        text.split(' ').next()?.parse::<f64>().ok()
    };
    run();
    let (start, before) = (Instant::now(), own());
    let mut n = 0;
    while start.elapsed() < Duration::from_millis(200) || n < 20 {
        run();
        n += 1;
    }
    let wall = start.elapsed().as_secs_f64() * 1e6;
    let taken = before.zip(own()).map_or(wall, |(a, b)| (b - a) / 1e3);
    taken / f64::from(n)
}

fn median(x: &mut [f64]) -> f64 {
    x.sort_by(f64::total_cmp);
    x[x.len() / 2]
}

fn geometric_mean(x: &[f64]) -> f64 {
    (x.iter().map(|x| x.ln()).sum::<f64>() / x.len() as f64).exp()
}

fn agree(what: &str, got: f64, want: f64) {
    assert!(
        (got - want).abs() <= 1e-9 * want.abs().max(1.0),
        "{what}: {got}, native {want}"
    );
}

/// Counts allocations.
struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

// SAFETY: hands everything on to the allocator of the system
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as the caller promises
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

// --------------------------------------------------------------------------------------------------------------- tables

struct Table {
    title: &'static str,
    columns: Vec<&'static str>,
    /// name, times, ratios to the first column
    rows: Vec<(&'static str, Vec<f64>, Vec<f64>)>,
    /// what one of ours must keep to the first column: mean, worst
    goal: (f64, f64),
}

impl Table {
    fn print(&self) {
        println!("\n{}", self.title);
        print!("{:<12}", "");
        for column in &self.columns {
            print!("{column:>14}");
        }
        for column in &self.columns[1..] {
            print!("{:>14}", format!("{column} ×"));
        }
        println!();
        let n = self.columns.len();
        let mut ratios: Vec<Vec<f64>> = vec![Vec::new(); n];
        for (name, times, to_first) in &self.rows {
            print!("{name:<12}");
            for t in times {
                if t.is_nan() {
                    print!("{:>14}", "–")
                } else {
                    print!("{t:>14.2}")
                }
            }
            for k in 1..n {
                let ratio = to_first[k];
                if ratio.is_nan() {
                    print!("{:>14}", "–");
                } else {
                    print!("{ratio:>14.2}");
                    ratios[k].push(ratio);
                }
            }
            println!();
        }
        print!("{:<12}", "mean");
        print!("{:>width$}", "", width = 14 * n);
        for r in &ratios[1..] {
            print!("{:>14.2}", geometric_mean(r));
        }
        let ours = &ratios[1];
        let (mean, worst) = (
            geometric_mean(ours),
            ours.iter().fold(0.0f64, |m, &r| m.max(r)),
        );
        let (goal_mean, goal_worst) = self.goal;
        let verdict = if mean <= goal_mean && worst <= goal_worst {
            "met"
        } else {
            "MISSED"
        };
        println!(
            "\ncognate: mean {mean:.2} (goal {goal_mean}), worst {worst:.2} (goal {goal_worst}): {verdict}"
        );
    }
}

fn main() {
    let rounds: usize = std::env::var("COGNATE_BENCH_ROUNDS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(201);
    let only = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    let cases: Vec<Case> = cases()
        .into_iter()
        .filter(|c| only.as_ref().is_none_or(|o| c.name.contains(o.as_str())))
        .collect();
    let points = points(POINTS);
    println!(
        "{} rounds, interleaved; medians in ns per evaluation; × is the ratio to the first column",
        rounds
    );
    values(&cases, &points, rounds).print();
    gradients(&cases, &points, rounds).print();
    batches(&cases, rounds).print();
    engines(&cases, &points, rounds);
    compiling(&cases);
    allocations(&cases, &points);
}

fn values(cases: &[Case], points: &[[f64; SLOTS]], rounds: usize) -> Table {
    let mut rows = Vec::new();
    for case in cases {
        let program = compiled(&case.text);
        let mut work = Work::default();
        for x in points {
            agree(case.name, program.value(x, &mut work), (case.native)(x));
        }
        let mut contestants: Vec<Contestant> = vec![
            Box::new(|k| (case.native)(&points[k])),
            Box::new(|k| program.value(&points[k], &mut work)),
        ];
        let mut times = vec![0, 1];
        for (column, peer) in [
            (2, peers::fasteval(case, points)),
            (3, peers::exmex(case, points)),
        ] {
            if let Some(mut peer) = peer {
                for (k, x) in points.iter().enumerate() {
                    agree(
                        &format!("{} by a peer", case.name),
                        peer(k),
                        (case.native)(x),
                    );
                }
                contestants.push(peer);
                times.push(column);
            }
        }
        let measured = medians(&mut contestants, POINTS, rounds);
        let [mut row, mut ratios] = [vec![f64::NAN; 4], vec![f64::NAN; 4]];
        for (k, column) in times.into_iter().enumerate() {
            (row[column], ratios[column]) = (measured.0[k], measured.1[k]);
        }
        rows.push((case.name, row, ratios));
    }
    Table {
        title: "Value",
        columns: vec!["native", "cognate", "fasteval", "exmex"],
        rows,
        goal: (2.0, 5.0),
    }
}

fn gradients(cases: &[Case], points: &[[f64; SLOTS]], rounds: usize) -> Table {
    let mut rows = Vec::new();
    for case in cases {
        let wanted: Vec<Input> = case.slots.iter().map(|&k| layout()[k]).collect();
        let program = compiled(&case.text).with_gradient(&wanted);
        let (mut work, mut out) = (Work::default(), vec![0.0; wanted.len() + 1]);
        let mut native_out = out.clone();
        for x in points {
            program.run(x, &mut work, &mut out);
            (case.native_dual)(x, &mut native_out);
            for (got, want) in out.iter().zip(&native_out) {
                agree(&format!("gradient of {}", case.name), *got, *want);
            }
        }
        let mut contestants: Vec<Contestant> = vec![
            Box::new(|k| {
                (case.native_dual)(&points[k], &mut native_out);
                native_out[0]
            }),
            Box::new(|k| {
                program.run(&points[k], &mut work, &mut out);
                out[0]
            }),
        ];
        let (times, ratios) = medians(&mut contestants, POINTS, rounds);
        rows.push((case.name, times, ratios));
    }
    Table {
        title: "Value and gradient",
        columns: vec!["native dual", "cognate"],
        rows,
        goal: (1.8, f64::INFINITY),
    }
}

fn batches(cases: &[Case], rounds: usize) -> Table {
    let points = points(BATCH);
    let columns: Vec<Vec<f64>> = (0..SLOTS)
        .map(|k| points.iter().map(|p| p[k]).collect())
        .collect();
    let views: Vec<&[f64]> = columns.iter().map(|c| &c[..]).collect();
    let mut rows = Vec::new();
    for case in cases {
        let program = compiled(&case.text);
        let mut batch = program.batch();
        let (mut out, mut native_out) = (vec![0.0; BATCH], vec![0.0; BATCH]);
        (batch.run(&views, &mut [&mut out])).expect("columns that fit");
        (case.native_loop)(&columns, &mut native_out);
        for (got, want) in out.iter().zip(&native_out) {
            agree(&format!("batch of {}", case.name), *got, *want);
        }
        let mut contestants: Vec<Contestant> = vec![
            Box::new(|_| {
                (case.native_loop)(black_box(&columns), &mut native_out);
                native_out[BATCH - 1]
            }),
            Box::new(|_| {
                (batch.run(black_box(&views), &mut [&mut out])).expect("columns that fit");
                out[BATCH - 1]
            }),
        ];
        let (times, ratios) = medians(&mut contestants, 1, rounds);
        let times = times.into_iter().map(|t| t / BATCH as f64).collect();
        rows.push((case.name, times, ratios));
    }
    Table {
        title: "Batch of 1024 points, per point",
        columns: vec!["native loop", "cognate"],
        rows,
        goal: (1.1, f64::INFINITY),
    }
}

/// How long parsing and compiling takes, per operator, and that it is linear.
/// Value and gradient by each engine; how long a translation takes, and for how many runs the interpreter is the faster.
fn engines(cases: &[Case], points: &[[f64; SLOTS]], rounds: usize) {
    println!("\nEngines: value and gradient, ns; translation, µs");
    println!(
        "{:14}{:>14}{:>14}{:>14}{:>14}{:>14}{:>14}",
        "", "steps", "native", "interpreted", "interpreted ×", "translation", "runs to win"
    );
    let mut ratios = Vec::new();
    for case in cases {
        let program = compiled(&case.text);
        let program = program.with_gradient(program.inputs());
        let of = |engine| program.with_engine(engine);
        let (Some(native), Some(interpreted)) = (of(Engine::Native), of(Engine::Interpreter))
        else {
            println!("no code of the processor here");
            return;
        };
        let mut contestants: Vec<Contestant> = [native, interpreted]
            .into_iter()
            .map(|program| -> Contestant {
                let (mut work, mut out) = (Work::default(), vec![0.0; program.n_outputs()]);
                Box::new(move |k| {
                    program.run(&points[k], &mut work, &mut out);
                    out[0]
                })
            })
            .collect();
        let (times, ratio) = medians(&mut contestants, POINTS, rounds);
        let translation = mean_of_own_time(|| {
            black_box(program.with_engine(Engine::Native));
        });
        println!(
            "{:14}{:14}{:14.2}{:14.2}{:14.2}{:14.2}{:14.0}",
            case.name,
            program.n_steps(),
            times[0],
            times[1],
            ratio[1],
            translation,
            translation * 1e3 / (times[1] - times[0])
        );
        ratios.push(ratio[1]);
    }
    println!("{:56}{:14.2}", "mean", geometric_mean(&ratios));
}

fn compiling(cases: &[Case]) {
    println!("\nParse and compile, µs");
    println!(
        "{:<12}{:>14}{:>14}{:>14}{:>14}",
        "", "parse", "compile", "operators", "per operator"
    );
    let operators = |text: &str| text.matches(['+', '-', '*', '/', '(', ',']).count().max(1);
    let long = |n: usize| {
        (0..n)
            .map(|k| format!("{}*TIME**2+SIN({k}.5*DX(1,2))", k + 1))
            .collect::<Vec<_>>()
            .join("-")
    };
    let mut texts: Vec<(&str, String)> = cases.iter().map(|c| (c.name, c.text.clone())).collect();
    texts.push(("100 terms", long(100)));
    texts.push(("1000 terms", long(1000)));
    texts.push(("10000 terms", long(10_000)));
    for (name, text) in &texts {
        let parse = || parse(text, Dialect::Function, Profile::Adams).expect("parsed before");
        let ast = parse();
        let mut compile = || {
            let bindings = Bindings::default();
            let mut compiler = Compiler::new(&bindings);
            let value = compiler.add(&ast).expect("compiled before");
            black_box(compiler.finish(&[value]));
        };
        let p = mean_of_own_time(|| drop(black_box(parse())));
        let c = mean_of_own_time(&mut compile);
        let n = operators(text);
        println!(
            "{name:<12}{p:>14.2}{c:>14.2}{n:>14}{:>14.2}",
            (p + c) / n as f64
        );
    }
}

fn allocations(cases: &[Case], points: &[[f64; SLOTS]]) {
    let mut most = 0;
    for case in cases {
        let wanted: Vec<Input> = case.slots.iter().map(|&k| layout()[k]).collect();
        let program = compiled(&case.text).with_gradient(&wanted);
        let (mut work, mut out) = (Work::default(), vec![0.0; wanted.len() + 1]);
        // until it has been translated
        for x in points.iter().cycle().take(10_000) {
            program.run(x, &mut work, &mut out);
        }
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        for x in points {
            program.run(x, &mut work, &mut out);
        }
        most = most.max(ALLOCATIONS.load(Ordering::Relaxed) - before);
    }
    println!(
        "\nAllocations while evaluating {} points, at most: {most}",
        points.len()
    );
}
