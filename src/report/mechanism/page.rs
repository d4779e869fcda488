//! One HTML page that shows runs in motion: no server, no network, nothing beside it.
//!
//! The page holds the viewer (`assets/viewer.js.gz`, made by `assets/viewer/build.mjs`) and the
//! data of the runs, as text: a description in JSON, then packed columns (`pack.rs`), all
//! compressed. The viewer reads them with what browsers have; it runs from `file:`.

use super::channels::Channels;
use super::pack::Packed;
use super::{Form, Look, Pictured, Role, Track};
use crate::dataset::surface::Surfaces;
use crate::diagnostic::Diagnostic;
use crate::model::{ElementId, Family, Model};
use crate::results::{Kind, Run, msg};
use crate::space::rotation;
use base64::prelude::{BASE64_STANDARD, Engine};
use flate2::Compression;
use flate2::write::{GzDecoder, GzEncoder};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Write;

/// The viewer: three.js, uPlot and our own script, bundled and compressed.
static VIEWER: &[u8] = include_bytes!("../../../assets/viewer.js.gz");
/// Its SHA-256 in base 64: the only script that the page runs.
static VIEWER_SHA256: &str = include_str!("../../../assets/viewer.sha256");

/// Look of what the page says before it is shown, or in its place.
const FAILURE_STYLE: &str = "#failure{position:fixed;inset:0;z-index:99;display:grid;place-content:center;     text-align:center;padding:24px;font:16px/1.5 system-ui,sans-serif;background:#eef1f4f2;color:#22262c}     #failure[hidden]{display:none}";

/// Quantum of positions, as a part of the size of the mechanism.
const POSITION_QUANTUM: f64 = 4e-6;
/// Quantum of components of unit quaternions.
const QUATERNION_QUANTUM: f64 = 1.0 / 40_000.0;
/// Quantum of times, as a part of the duration.
const TIME_QUANTUM: f64 = 1e-9;

/// A run on a page.
pub struct Shown<'a> {
    /// its results
    pub run: &'a Run,
    /// its track over the bodies of the first run
    pub track: &'a Track,
}

/// Returns the page of one run; `surfaces`: the shells that stand in files.
///
/// # Errors
/// A run that does not say where its parts are: it wants
/// [`Options::frames`](crate::Options::frames).
pub fn page_of_run(model: &Model, run: &Run, surfaces: &Surfaces) -> Result<String, Diagnostic> {
    let pictured = Pictured::new(model, run, surfaces)?;
    let track = &pictured.track;
    Ok(page(model, &pictured, &[Shown { run, track }]))
}

/// Returns the text of a page.
///
/// `runs`: the runs that are shown over each other, that of `pictured` first.
pub fn page(model: &Model, pictured: &Pictured, runs: &[Shown<'_>]) -> String {
    let mut packed = Packed::default();
    let mut geometry = Geometry::default();
    let mut data = json!({
        "title": model.title.trim(),
        "second": pictured.second,
        "unit": runs.first().map(|r| r.run.units.length.clone()),
        "bodies": bodies(pictured),
        "pieces": pieces(pictured, &mut geometry),
        "stretched": stretched(pictured, &mut geometry),
        "trails": pictured.trails.iter().map(|t| json!({ "body": t.body, "marker": t.marker, "place": t.place })).collect::<Vec<_>>(),
        "arrows": pictured.arrows.iter().map(|a| json!({
            "element": a.element.to_string(), "body": a.body, "place": a.place, "load": a.load, "reaction": a.is_reaction,
        })).collect::<Vec<_>>(),
        "triads": pictured.triads.iter().map(|t| {
            let q = rotation::to_quaternion(&t.at.frame.rotation);
            json!({
                "element": t.element.to_string(), "body": t.at.body, "place": t.at.frame.position.0,
                "rotation": [q[1], q[2], q[3], q[0]],
            })
        }).collect::<Vec<_>>(),
        "actions": pictured.action_vectors.iter().map(|a| json!({
            "element": a.element.to_string(), "body": a.at.body, "place": a.at.frame.position.0,
            "direction": a.at.frame.rotation.column(2).0,
        })).collect::<Vec<_>>(),
        "dimensions": pictured.dimensions.iter().map(|d| [d.markers.i, d.markers.j]).collect::<Vec<_>>(),
        "view": {
            "centre": pictured.view.centre.0, "size": pictured.view.size, "eye": pictured.view.eye.0,
            "up": pictured.view.up.0, "planar": pictured.view.is_planar, "joint": pictured.sizes.joint,
            "gravity": model.gravity,
        },
        "tree": tree(model, pictured),
    });
    let shown = runs.iter().map(|shown| run(pictured, shown, &mut packed));
    data["runs"] = json!(shown.collect::<Vec<_>>());
    data["overlaps"] = json!(overlaps(pictured, &mut packed));
    let (columns, numbers) = packed.finish();
    data["columns"] = json!(columns);
    data["geometry"] = json!([numbers.len(), geometry.floats.len(), geometry.indices.len()]);
    let mut bytes = numbers;
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes.extend(geometry.floats.iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend(geometry.indices.iter().flat_map(|k| k.to_le_bytes()));
    let text = data.to_string();
    let mut all = (text.len() as u32).to_le_bytes().to_vec();
    all.extend(text.as_bytes());
    all.resize(all.len().next_multiple_of(4), b' ');
    all.extend(bytes);
    document(
        &title(model, runs),
        &BASE64_STANDARD.encode(compressed(&all)),
    )
}

fn title(model: &Model, runs: &[Shown<'_>]) -> String {
    let names: Vec<&str> = runs.iter().map(|r| r.run.name.as_str()).collect();
    let title = model.title.trim();
    let title = if title.is_empty() { "mechanism" } else { title };
    format!("{} · {title}", names.join(", "))
}

/// Returns the document around the data.
fn document(title: &str, data: &str) -> String {
    let title = quick_xml::escape::partial_escape(title);
    let viewer = viewer();
    // the one script, styles, nothing from outside and nothing to outside
    let policy = format!(
        "default-src 'none'; script-src 'sha256-{}'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'",
        VIEWER_SHA256.trim()
    );
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"generator\" content=\"cognate {}\">\n<title>{title}</title>\n<style>{FAILURE_STYLE}</style>\n</head>\n<body>\n\
         <div id=\"failure\" role=\"alert\">This page is not shown yet. It needs JavaScript and loads nothing from outside; \
         where these words stay, the browser runs no scripts here or is too old.</div>\n\
         <script id=\"data\" type=\"application/octet-stream\">{data}</script>\n<script>{viewer}</script>\n</body>\n</html>\n",
        env!("CARGO_PKG_VERSION"),
    )
}

/// Returns the text of the viewer.
fn viewer() -> String {
    let mut decoder = GzDecoder::new(Vec::new());
    let written = decoder.write_all(VIEWER).and_then(|()| decoder.finish());
    // it is part of this program, and a test reads it
    String::from_utf8(written.unwrap_or_default()).unwrap_or_default()
}

fn compressed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    // a vector takes everything
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.unwrap_or_default()
}

/// Corners, normals and triangles of all surfaces, each of equal ones once.
#[derive(Default)]
struct Geometry {
    floats: Vec<f32>,
    indices: Vec<u32>,
    /// by a number that equal surfaces share, where surfaces are
    known: BTreeMap<u64, Vec<[usize; 4]>>,
}

impl Geometry {
    /// Adds a surface; returns where it is: first float and corners, first index and indices. The
    /// normals stand behind the corners.
    fn push(&mut self, solid: &super::Solid) -> Value {
        let triangles = solid.triangles();
        let corners = triangles.points.iter().chain(&triangles.normals);
        let floats: Vec<f32> = corners.flatten().copied().collect();
        let indices: Vec<u32> = triangles.triangles.iter().flatten().copied().collect();
        let bits = floats
            .iter()
            .map(|x| x.to_bits())
            .chain(indices.iter().copied());
        // FNV-1a, by words
        let key = bits.fold(0xcbf2_9ce4_8422_2325_u64, |key, word| {
            (key ^ u64::from(word)).wrapping_mul(0x100_0000_01b3)
        });
        let known = self.known.entry(key).or_default();
        let is_same = |[f, n, k, m]: &&[usize; 4]| {
            self.floats[*f..f + 6 * n] == floats[..] && self.indices[*k..k + m] == indices[..]
        };
        if let Some(place) = known.iter().find(is_same) {
            return json!(place);
        }
        let counts = [triangles.points.len(), indices.len()];
        let place = [self.floats.len(), counts[0], self.indices.len(), counts[1]];
        known.push(place);
        self.floats.extend(floats);
        self.indices.extend(indices);
        json!(place)
    }
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn bodies(pictured: &Pictured) -> Vec<Value> {
    let of = |b: &super::Body| {
        let q = rotation::to_quaternion(&b.placed.rotation);
        json!({
            "id": b.id.to_string(), "name": b.name, "ground": b.is_ground, "colour": hex(b.colour), "mass": b.mass,
            "cm": b.cm.map(|cm| cm.0), "position": b.placed.position.0, "rotation": [q[1], q[2], q[3], q[0]],
        })
    };
    pictured.bodies.all.iter().map(of).collect()
}

fn pieces(pictured: &Pictured, geometry: &mut Geometry) -> Vec<Value> {
    let mut all = Vec::new();
    for piece in &pictured.pieces {
        let mut value = json!({
            "body": piece.body, "element": piece.element.to_string(), "role": piece.role.word(), "colour": hex(piece.colour),
        });
        match &piece.form {
            Form::Line { points, closed } => {
                value["line"] = json!(points);
                value["closed"] = json!(closed);
            }
            Form::Rod { from, to, radius } => value["rod"] = json!([from, to, radius]),
            Form::Ball { centre, radius } => value["ball"] = json!([centre, radius]),
            Form::Solid(solid) => {
                let is_flat = solid.smooth.iter().any(|s| !s);
                value["mesh"] = geometry.push(solid);
                value["edges"] = json!(piece.role == Role::Shape && is_flat);
            }
        }
        all.push(value);
    }
    all
}

fn stretched(pictured: &Pictured, geometry: &mut Geometry) -> Vec<Value> {
    let mut all = Vec::new();
    for s in &pictured.stretched {
        let look = match s.look {
            Look::Coil => "coil",
            Look::Rod => "rod",
        };
        all.push(json!({
            "element": s.element.to_string(), "look": look, "from": s.from.0, "fromPlace": s.from.1,
            "to": s.to.0, "toPlace": s.to.1, "colour": hex(s.colour), "mesh": geometry.push(&s.unit()),
        }));
    }
    all
}

/// Returns a run: times, poses, channels, facts.
fn run(pictured: &Pictured, shown: &Shown<'_>, packed: &mut Packed) -> Value {
    let Shown { run, track } = shown;
    let span = |x: &[f64]| x.last().copied().unwrap_or(0.0) - x.first().copied().unwrap_or(0.0);
    let times = packed.push(
        track.times.iter().copied(),
        TIME_QUANTUM * span(&track.times),
    );
    let mut poses = Vec::new();
    for frames in &track.poses {
        if frames.is_empty() {
            poses.push(Value::Null);
            continue;
        }
        let quantum = POSITION_QUANTUM * pictured.sizes.whole;
        let mut columns = [0; 7];
        for (k, column) in columns.iter_mut().take(3).enumerate() {
            *column = packed.push(frames.iter().map(|f| f.position.0[k]), quantum);
        }
        let mut before = [1.0, 0.0, 0.0, 0.0];
        let turned: Vec<[f64; 4]> = (frames.iter())
            .map(|frame| {
                let q = rotation::to_quaternion(&frame.rotation);
                let same = q.iter().zip(before).map(|(a, b)| a * b).sum::<f64>() >= 0.0;
                before = if same { q } else { q.map(|x| -x) };
                before
            })
            .collect();
        for (column, k) in columns.iter_mut().skip(3).zip([1, 2, 3, 0]) {
            *column = packed.push(turned.iter().map(|q| q[k]), QUATERNION_QUANTUM);
        }
        poses.push(json!(columns));
    }
    let mut channels = Channels::new(run, track);
    channels.pack(packed);
    json!({
        "name": run.name,
        "rows": track.times.len(),
        "time": times,
        "timeUnit": run.units.time,
        "kinds": kinds(track),
        "poses": poses,
        "loads": track.loads.iter().map(|load| channels.of(&load.columns)).collect::<Vec<_>>(),
        "places": track.loads.iter().map(|load| load.place_columns.map(|c| channels.of(&c))).collect::<Vec<_>>(),
        "channels": channels.list,
        "leftOut": channels.left_out,
        "sets": channels.sets(run),
        "facts": facts(run),
        "warnings": run.record.warnings.iter().map(crate::results::Warning::sentence).collect::<Vec<_>>(),
        "log": if run.log.is_empty() { String::new() } else { msg::write(run) },
    })
}

/// Returns where solids overlap: their names, the deepest place, and the columns of all places.
fn overlaps(pictured: &Pictured, packed: &mut Packed) -> Vec<Value> {
    let quantum = POSITION_QUANTUM * pictured.sizes.whole;
    let mut all = Vec::new();
    for overlap in &pictured.overlaps {
        let places = &overlap.places;
        let column = |k: usize| places.iter().map(move |p| p.map_or(f64::NAN, |p| p[k]));
        let columns = [0, 1, 2].map(|k| packed.push(column(k), quantum));
        all.push(json!({
            "elements": overlap.elements.map(|id| id.to_string()), "depth": overlap.depth,
            "row": overlap.deepest, "place": columns,
        }));
    }
    all
}

/// Returns the kinds of rows: words, each with the first of its rows.
fn kinds(track: &Track) -> Vec<Value> {
    let word = |kind: Kind| match kind {
        Kind::Input => "as read",
        Kind::InitialConditions => "initial conditions",
        Kind::Static => "static",
        Kind::QuasiStatic => "quasi-static",
        Kind::Kinematic => "kinematic",
        Kind::Dynamic => "dynamic",
    };
    let mut all = Vec::new();
    let mut last = None;
    for (row, &kind) in track.kinds.iter().enumerate() {
        if last.replace(kind) != Some(kind) {
            all.push(json!([row, word(kind)]));
        }
    }
    all
}

/// Returns what is worth knowing of a run: names and values.
fn facts(run: &Run) -> Vec<[String; 2]> {
    let r = &run.record;
    let mut all = Vec::new();
    let mut fact = |name: &str, value: String| all.push([name.to_owned(), value]);
    fact("rows", run.table_rows().count().to_string());
    if r.simulations.is_empty() {
        return all;
    }
    let status = if r.stop_reason.is_empty() {
        r.status.word()
    } else {
        &r.stop_reason
    };
    fact("status", status.to_owned());
    fact("freedoms", r.freedom.to_string());
    if !r.redundant.is_empty() {
        fact("redundant rows", r.redundant.join(", "));
    }
    if !r.method.is_empty() {
        fact("method", r.method.clone());
    }
    fact("steps", r.counts.steps.to_string());
    if let Some(error) = r.error {
        fact("error asked for", crate::results::digits_of_six(error));
    }
    if let Some(drift) = r.constraint_drift {
        fact("constraint drift", format!("{drift:.1e}"));
    }
    fact("energy account", format!("{:.1e}", r.energy.error()));
    all
}

/// Returns the elements by family, each with what it is and its statement.
fn tree(model: &Model, pictured: &Pictured) -> Vec<Value> {
    /// Statements of more elements than these would be most of the page.
    const MOST_STATEMENTS: usize = 5000;
    let statements: BTreeMap<ElementId, String> = if model.elements().len() > MOST_STATEMENTS {
        BTreeMap::new()
    } else {
        model.statements().into_iter().collect()
    };
    let body_of = |marker: u32| {
        let body = pictured
            .bodies
            .marker(marker)
            .map(|a| &pictured.bodies.all[a.body]);
        body.map_or_else(|| format!("marker {marker}"), |b| b.name.clone())
    };
    let families = [
        (Family::Body, "bodies"),
        (Family::Constraint, "constraints"),
        (Family::Force, "forces"),
        (Family::System, "systems"),
        (Family::Output, "outputs"),
        (Family::Data, "data"),
    ];
    let labels = model.labels();
    let name = |id: ElementId| match pictured.bodies.find(id) {
        Some(body) => pictured.bodies.all[body].name.clone(),
        None => labels.name(model, id),
    };
    let mut all = Vec::new();
    for (family, title) in families {
        let of_family = |id: &ElementId| {
            id.kind.family() == family && id.kind != crate::model::ElementKind::Marker
        };
        let mut list = Vec::new();
        for (id, element) in model.elements().into_iter().filter(|(id, _)| of_family(id)) {
            let ends = element.ends().map(|[i, j]| [body_of(i), body_of(j)]);
            list.push(json!({
                "id": id.to_string(),
                "name": name(id),
                "kind": kind(model, id),
                "between": ends,
                "off": pictured.track.off.get(&id),
                "statement": statements.get(&id).map(|s| s.trim_end()),
            }));
        }
        if !list.is_empty() {
            all.push(json!({ "title": title, "elements": list }));
        }
    }
    all
}

/// Returns what an element is, in a word.
fn kind(model: &Model, id: ElementId) -> String {
    use crate::model::ElementKind;
    let joint = (model.joints.get(&id.number)).filter(|_| id.kind == ElementKind::Joint);
    let primitive = (model.primitives.get(&id.number)).filter(|_| id.kind == ElementKind::Jprim);
    let word = joint
        .map(|j| j.kind.keyword())
        .or(primitive.map(|p| p.kind.row().keyword));
    word.unwrap_or(id.kind.keyword()).to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Component, Entity, Units};

    /// A run of bodies that swing and turn about oblique axes, without solving.
    fn swinging(bodies: u32, rows: u32) -> (Model, Run) {
        let mut text = "Many bodies\nPART/1, GROUND\n".to_owned();
        let mut run = Run::new("many", "", Units::default());
        for n in 2..2 + bodies {
            text += &format!("PART/{n}, MASS=1, CM={n}, IP=1,1,1\nMARKER/{n}, PART={n}\n");
            let name = format!("PART_{n}");
            let components = ["X", "Y", "Z", "PSI", "THETA", "PHI"].map(|c| Component {
                name: c.into(),
                column: run.add_column(format!("{name}_XFORM.{c}"), ""),
            });
            run.entities.push(Entity {
                name: format!("{name}_XFORM"),
                entity: name,
                kind: "Part".into(),
                id: u64::from(n),
                components: components.to_vec(),
            });
        }
        run.begin(Kind::Dynamic);
        for k in 0..rows {
            let t = f64::from(k) * 1e-3;
            let mut row = vec![t];
            for n in 0..bodies {
                let w = 3.0 + f64::from(n);
                let swing = |f: f64| (f * w * t + f).sin();
                row.extend([
                    swing(1.0),
                    swing(0.7),
                    0.3 * swing(2.1),
                    w * t,
                    1.0 + 0.5 * swing(1.3),
                    swing(0.4),
                ]);
            }
            run.push(&row);
        }
        run.end();
        let model = Model::from_text(&format!("{text}END\n")).expect("a model");
        (model, run)
    }

    #[test]
    fn ten_thousand_rows_of_twenty_bodies_take_less_than_a_megabyte() {
        let (model, run) = swinging(20, 10_000);
        let pictured = Pictured::new(&model, &run, &Default::default()).expect("positions");
        let track = &pictured.track;
        let text = page(&model, &pictured, &[Shown { run: &run, track }]);
        let data = text.len() - viewer().len();
        assert!(data < 1_000_000, "{data}");
    }

    #[test]
    fn nothing_in_a_title_or_a_name_ends_the_script() {
        let (mut model, run) = swinging(1, 3);
        model.title = "</script><b>&".into();
        let pictured = Pictured::new(&model, &run, &Default::default()).expect("positions");
        let track = &pictured.track;
        let text = page(&model, &pictured, &[Shown { run: &run, track }]);
        assert_eq!(text.matches("</script").count(), 2);
        assert!(text.contains("&lt;/script&gt;&lt;b&gt;&amp;"));
    }
}
