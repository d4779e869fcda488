//! An animated glTF file: bodies as nodes that move, for any viewer of three dimensions.
//!
//! One node a body, with the solids that move with it; what stretches is a node of its own, scaled
//! along z; forces are arrows that are scaled with their size. Times begin at 0. Of rows at one
//! time the last is kept, since keys must increase, and so it is with rows that 32 bits do not tell
//! apart; a key that its neighbours give by a straight line is left out. Numbers of parts, joints
//! and markers stand in `extras`.

use super::solid::{Triangles, along_z};
use super::{Arrow, Form, Pictured, Solid, colours};
use crate::space::{Frame, Mat3, Vec3, rotation};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// `GL_FLOAT`.
const FLOAT: u32 = 5126;
/// `GL_UNSIGNED_INT`.
const UNSIGNED_INT: u32 = 5125;
/// `GL_ARRAY_BUFFER`, `GL_ELEMENT_ARRAY_BUFFER`.
const TARGETS: [u32; 2] = [34962, 34963];
/// Error of a key that is left out, as a part of the size of the mechanism, or in a quaternion.
const KEY_TOLERANCE: f64 = 2e-5;
/// Length of the arrow of the largest force, as a part of the size of the mechanism.
const LARGEST_ARROW: f64 = 0.2;
/// Least scale of a node: a viewer cannot invert a matrix of zeros.
const LEAST_SCALE: f64 = 1e-6;
/// Radius of a line, as a part of the size of the mechanism.
const LINE: f64 = 0.0025;

/// Returns the bytes of an animated `.glb` file.
pub fn glb(pictured: &Pictured) -> Vec<u8> {
    let mut file = File::new(pictured);
    let mut scene = Vec::new();
    // bodies
    for body in 0..pictured.bodies.all.len() {
        scene.push(file.body(body));
    }
    // what stretches
    for s in &pictured.stretched {
        let mesh = file.mesh(&[(s.unit(), s.colour)]);
        let places = file.keys.iter().map(|&row| {
            let (frame, length) = s.place(&pictured.bodies, &pictured.track, row);
            (frame, [1.0, 1.0, length.max(LEAST_SCALE)])
        });
        let places = places.collect::<Vec<_>>();
        let node = json!({ "name": s.element.to_string(), "mesh": mesh, "extras": { "element": s.element.to_string() } });
        scene.push(file.moving(node, &places));
    }
    // forces
    for arrow in pictured.arrows.iter().filter(|a| !a.is_reaction) {
        scene.extend(file.arrow(arrow));
    }
    file.bytes(scene)
}

/// A file that is being made.
struct File<'a> {
    pictured: &'a Pictured,
    /// rows that have keys
    keys: Vec<usize>,
    /// their times, from 0 on
    times: Vec<f32>,
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    material_of: BTreeMap<[u8; 3], usize>,
    nodes: Vec<Value>,
    samplers: Vec<Value>,
    channels: Vec<Value>,
    /// accessors of times, by the keys that they have
    inputs: BTreeMap<Vec<usize>, usize>,
}

impl<'a> File<'a> {
    fn new(pictured: &'a Pictured) -> Self {
        let (keys, times) = keys(&pictured.track.times);
        Self {
            pictured,
            keys,
            times,
            binary: Vec::new(),
            views: Vec::new(),
            accessors: Vec::new(),
            meshes: Vec::new(),
            materials: Vec::new(),
            material_of: BTreeMap::new(),
            nodes: Vec::new(),
            samplers: Vec::new(),
            channels: Vec::new(),
            inputs: BTreeMap::new(),
        }
    }

    /// Adds a body with everything that moves with it; returns its node.
    fn body(&mut self, body: usize) -> usize {
        let pictured = self.pictured;
        let own = pictured.pieces.iter().filter(|p| p.body == body);
        let line = LINE * pictured.sizes.whole;
        let solids: Vec<_> = own.map(|p| (p.form.solid(line), p.colour)).collect();
        let it = &pictured.bodies.all[body];
        let mut node = json!({ "name": it.name, "extras": { "element": it.id.to_string() } });
        if !solids.is_empty() {
            node["mesh"] = json!(self.mesh(&solids));
        }
        if pictured.track.poses[body].is_empty() {
            let q = rotation::to_quaternion(&it.placed.rotation);
            node["translation"] = json!(it.placed.position.0);
            node["rotation"] = json!([q[1], q[2], q[3], q[0]]);
            self.nodes.push(node);
            return self.nodes.len() - 1;
        }
        let frames = &pictured.track.poses[body];
        let places: Vec<_> = self
            .keys
            .iter()
            .map(|&row| (frames[row], [1.0; 3]))
            .collect();
        self.moving(node, &places)
    }

    /// Adds the arrow of a force, which is as long as the force is large; `None` of one that never
    /// acts.
    fn arrow(&mut self, arrow: &Arrow) -> Option<usize> {
        let pictured = self.pictured;
        let values = &pictured.track.loads[arrow.load].values;
        let force = |row: usize| {
            let f = Vec3([0, 1, 2].map(|k| values[row][k]));
            if f.norm().is_finite() {
                f
            } else {
                Vec3::zero()
            }
        };
        let largest = (0..values.len())
            .map(|row| force(row).norm())
            .fold(0.0, f64::max);
        if largest <= 0.0 {
            return None;
        }
        let whole = LARGEST_ARROW * pictured.sizes.whole;
        let shaft = 0.02 * whole;
        let mut solid = Solid::frustum(shaft, shaft, [0.0, 0.8 * whole]);
        let head = [(3.0 * shaft, 0.8 * whole), (0.0, whole)];
        solid.join(Solid::turned(&head, 16, true));
        let mesh = self.mesh(&[(solid, colours::FORCE)]);
        let places = self.keys.iter().map(|&row| {
            let f = force(row);
            let frame = Frame {
                rotation: along_z(f),
                position: arrow.from(&pictured.bodies, &pictured.track, row),
            };
            (frame, [(f.norm() / largest).max(LEAST_SCALE); 3])
        });
        let places = places.collect::<Vec<_>>();
        let name = format!("{} force", arrow.element);
        let node = json!({ "name": name, "mesh": mesh, "extras": { "element": arrow.element.to_string() } });
        Some(self.moving(node, &places))
    }

    /// Adds a node and the channels that move it.
    fn moving(&mut self, mut node: Value, places: &[(Frame<f64>, [f64; 3])]) -> usize {
        let index = self.nodes.len();
        let mut before = [1.0, 0.0, 0.0, 0.0];
        let turned: Vec<[f64; 4]> = places
            .iter()
            .map(|(frame, _)| {
                let q = rotation::to_quaternion(&frame.rotation);
                // the shorter way from one key to the next
                let same = q.iter().zip(before).map(|(a, b)| a * b).sum::<f64>() >= 0.0;
                before = if same { q } else { q.map(|x| -x) };
                [before[1], before[2], before[3], before[0]]
            })
            .collect();
        let moved: Vec<[f64; 3]> = places.iter().map(|(f, _)| f.position.0).collect();
        let scaled: Vec<[f64; 3]> = places.iter().map(|(_, s)| *s).collect();
        if let (Some(m), Some(q), Some(s)) = (moved.first(), turned.first(), scaled.first()) {
            node["translation"] = json!(m.map(|x| x as f32));
            node["rotation"] = json!(q.map(|x| x as f32));
            node["scale"] = json!(s.map(|x| x as f32));
        }
        self.nodes.push(node);
        let whole = self.pictured.sizes.whole;
        self.channel(index, "translation", &moved, KEY_TOLERANCE * whole);
        self.channel(index, "rotation", &turned, KEY_TOLERANCE);
        self.channel(index, "scale", &scaled, KEY_TOLERANCE * whole.max(1.0));
        index
    }

    /// Adds a channel with the keys that it needs; none where nothing changes.
    fn channel<const N: usize>(
        &mut self,
        node: usize,
        path: &str,
        values: &[[f64; N]],
        tolerance: f64,
    ) {
        let kept = needed(&self.times, values, tolerance);
        if kept.len() < 2 {
            return;
        }
        let singles: Vec<[f32; N]> = kept.iter().map(|&k| values[k].map(|x| x as f32)).collect();
        let times: Vec<[f32; 1]> = kept.iter().map(|&k| [self.times[k]]).collect();
        let input = match self.inputs.get(&kept) {
            Some(&input) => input,
            None => {
                let input = self.floats(&times, "SCALAR", None, true);
                self.inputs.insert(kept, input);
                input
            }
        };
        let kind = if N == 4 { "VEC4" } else { "VEC3" };
        let output = self.floats(&singles, kind, None, false);
        let sampler = self.samplers.len();
        (self.samplers)
            .push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
        let target = json!({ "node": node, "path": path });
        self.channels
            .push(json!({ "sampler": sampler, "target": target }));
    }

    /// Adds a mesh of solids, one primitive a colour; returns its index.
    fn mesh(&mut self, solids: &[(Solid, [u8; 3])]) -> usize {
        let mut by_colour: BTreeMap<[u8; 3], Solid> = BTreeMap::new();
        for (solid, colour) in solids {
            by_colour.entry(*colour).or_default().join(solid.clone());
        }
        let mut primitives = Vec::new();
        for (colour, solid) in by_colour {
            let Triangles {
                points,
                normals,
                triangles,
            } = solid.triangles();
            let position = self.floats(&points, "VEC3", Some(TARGETS[0]), true);
            let normal = self.floats(&normals, "VEC3", Some(TARGETS[0]), false);
            let bytes = triangles.iter().flatten().flat_map(|k| k.to_le_bytes());
            let view = self.view(bytes.collect(), Some(TARGETS[1]));
            let count = 3 * triangles.len();
            let indices = self.accessors.len();
            let of = json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR" });
            self.accessors.push(of);
            let material = self.material(colour);
            let attributes = json!({ "POSITION": position, "NORMAL": normal });
            primitives.push(
                json!({ "attributes": attributes, "indices": indices, "material": material }),
            );
        }
        self.meshes.push(json!({ "primitives": primitives }));
        self.meshes.len() - 1
    }

    fn material(&mut self, colour: [u8; 3]) -> usize {
        let materials = &mut self.materials;
        *self.material_of.entry(colour).or_insert_with(|| {
            // glTF has linear colours, ours are sRGB
            let [r, g, b] = colour.map(|c| (f64::from(c) / 255.0).powf(2.2));
            materials.push(json!({
                "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.1, "roughnessFactor": 0.6 },
                "doubleSided": true,
            }));
            materials.len() - 1
        })
    }

    /// Adds numbers; returns their accessor.
    fn floats<const N: usize>(
        &mut self,
        values: &[[f32; N]],
        kind: &str,
        target: Option<u32>,
        bounds: bool,
    ) -> usize {
        let bytes = values
            .iter()
            .flatten()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let view = self.view(bytes, target);
        let mut accessor = json!({ "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": kind });
        if bounds {
            let limit = |f: fn(f32, f32) -> f32, from: f32| {
                let all = values.iter();
                all.fold([from; N], |limit, v| {
                    std::array::from_fn(|k| f(limit[k], v[k]))
                })
                .to_vec()
            };
            accessor["min"] = json!(limit(f32::min, f32::INFINITY));
            accessor["max"] = json!(limit(f32::max, f32::NEG_INFINITY));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn view(&mut self, bytes: Vec<u8>, target: Option<u32>) -> usize {
        let mut view =
            json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.binary.extend(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    /// Returns the file: a header, the description, the numbers.
    fn bytes(mut self, mut scene: Vec<usize>) -> Vec<u8> {
        // glTF looks along z with y upwards: one node turns the mechanism so
        let up = self.pictured.view.up;
        let z = self.pictured.view.eye;
        let x = up.cross(z);
        let z = x.cross(up);
        let unit = |v: Vec3<f64>| v.times(1.0 / v.norm().max(f64::MIN_POSITIVE));
        let to_view = Mat3::from_columns(unit(x), unit(up), unit(z)).transpose();
        let q = rotation::to_quaternion(&to_view);
        let root = self.nodes.len();
        let turned = json!({ "name": self.pictured.title, "children": scene, "rotation": [q[1], q[2], q[3], q[0]] });
        self.nodes.push(turned);
        scene = vec![root];
        let mut all = json!({
            "asset": { "version": "2.0", "generator": concat!("cognate ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": scene }],
            "nodes": self.nodes,
        });
        let lists = [
            ("meshes", self.meshes),
            ("materials", self.materials),
            ("accessors", self.accessors),
            ("bufferViews", self.views),
        ];
        for (name, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
            all[name] = Value::Array(list);
        }
        if !self.binary.is_empty() {
            all["buffers"] = json!([{ "byteLength": self.binary.len() }]);
        }
        if !self.channels.is_empty() {
            all["animations"] =
                json!([{ "name": "run", "channels": self.channels, "samplers": self.samplers }]);
        }
        let mut description = all.to_string().into_bytes();
        description.resize(description.len().next_multiple_of(4), b' ');
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let mut file = b"glTF".to_vec();
        let chunk = |bytes: &[u8]| if bytes.is_empty() { 0 } else { 8 + bytes.len() };
        let length = 12 + chunk(&description) + chunk(&self.binary);
        for word in [2, length as u32] {
            file.extend(word.to_le_bytes());
        }
        for (name, bytes) in [(b"JSON", description), (b"BIN\0", self.binary)] {
            if !bytes.is_empty() {
                file.extend((bytes.len() as u32).to_le_bytes());
                file.extend(name);
                file.extend(bytes);
            }
        }
        file
    }
}

/// Returns the rows that have keys, and their times from 0 on: of rows at one time the last.
fn keys(times: &[f64]) -> (Vec<usize>, Vec<f32>) {
    let first = times.first().copied().unwrap_or(0.0);
    let mut rows: Vec<usize> = Vec::new();
    let mut all: Vec<f32> = Vec::new();
    for (row, t) in times.iter().enumerate() {
        let t = (t - first) as f32;
        while all.last().is_some_and(|last| *last >= t) && all.len() > 1 {
            all.pop();
            rows.pop();
        }
        if all.last().is_some_and(|last| *last >= t) {
            (rows[0], all[0]) = (row, t.max(0.0));
        } else if t >= 0.0 {
            rows.push(row);
            all.push(t);
        }
    }
    (rows, all)
}

/// Returns the keys that straight lines between them need to be within `tolerance` of all others;
/// one where nothing changes.
fn needed<const N: usize>(times: &[f32], values: &[[f64; N]], tolerance: f64) -> Vec<usize> {
    let n = values.len();
    let off = |k: usize, a: usize, b: usize| {
        let part = f64::from(times[k] - times[a]) / f64::from(times[b] - times[a]);
        let lines = values[a].iter().zip(values[b]).zip(values[k]);
        lines
            .map(|((a, b), x)| (a + part * (b - a) - x).abs())
            .fold(0.0, f64::max)
    };
    let is_still = |v: &[f64; N]| {
        v.iter()
            .zip(values[0])
            .all(|(a, b)| (a - b).abs() <= tolerance)
    };
    if n < 2 || values.iter().all(is_still) {
        return (0..n.min(1)).collect();
    }
    /// Keys in a row of which one is kept at least, so that the search stays linear.
    const LONGEST: usize = 64;
    let mut kept = vec![0];
    let mut from = 0;
    for to in 2..n {
        let is_off = (from + 1..to).any(|k| off(k, from, to) > tolerance);
        if is_off || to - from > LONGEST {
            kept.push(to - 1);
            from = to - 1;
        }
    }
    kept.push(n - 1);
    kept
}

impl Form {
    /// Returns its surface; of a line a tube.
    pub fn solid(&self, line: f64) -> Solid {
        match self {
            Form::Rod { from, to, radius } => {
                let (a, b) = (Vec3(*from), Vec3(*to));
                let frame = Frame {
                    rotation: along_z(b - a),
                    position: a,
                };
                Solid::capsule(*radius, (b - a).norm()).placed(&frame)
            }
            Form::Ball { centre, radius } => {
                let frame = Frame {
                    rotation: Mat3::identity(),
                    position: Vec3(*centre),
                };
                Solid::ellipsoid([*radius; 3]).placed(&frame)
            }
            Form::Solid(solid) => solid.clone(),
            Form::Line { points, closed } => Solid::tube(points, *closed, line, 6),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_keys_increase_and_begin_at_zero() {
        let (rows, times) = keys(&[5.0, 5.0, 5.1, 5.1, 5.100_000_000_1, 6.0, 5.5, 7.0]);
        assert_eq!(rows, [1, 4, 6, 7]);
        assert!(times.windows(2).all(|t| t[0] < t[1]), "{times:?}");
        assert_eq!(times[0], 0.0);
    }

    #[test]
    fn keys_that_are_left_out_lie_on_lines_between_the_others() {
        let times: Vec<f32> = (0..200).map(|k| k as f32 / 100.0).collect();
        let values: Vec<[f64; 1]> = times.iter().map(|t| [f64::from(*t).sin()]).collect();
        let kept = needed(&times, &values, 1e-3);
        assert!(kept.len() < 40, "{}", kept.len());
        for pair in kept.windows(2) {
            for k in pair[0]..pair[1] {
                let part = f64::from(times[k] - times[pair[0]])
                    / f64::from(times[pair[1]] - times[pair[0]]);
                let line = values[pair[0]][0] * (1.0 - part) + values[pair[1]][0] * part;
                assert!((line - values[k][0]).abs() < 1.1e-3);
            }
        }
        assert_eq!(needed(&times, &vec![[3.0]; 200], 1e-3), [0]);
    }
}
