// The mechanism in three dimensions: bodies, springs, forces, trails, light and ground.

import {
  BufferAttribute, BufferGeometry, Color, ConeGeometry, CylinderGeometry, DirectionalLight, DoubleSide, EdgesGeometry,
  Group, HemisphereLight, Line, LineBasicMaterial, LineLoop, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, MeshStandardMaterial, PCFShadowMap,
  PerspectiveCamera, PlaneGeometry, Quaternion, Raycaster, Scene, ShadowMaterial, SphereGeometry, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { isOff } from './data.js';
import { Batch, CHOSEN, Forms, MANY, middle, ownerOf, points, rigid } from './pieces.js';

const Z = new Vector3(0, 0, 1);
/** Length of the arrow of a large force, as a part of the size of the mechanism. */
const ARROW = 0.22;
/** Part of all values of forces that are not larger than the one that an arrow's length is measured by. */
const LARGE = 0.97;
/** Fields of view in degrees: in perspective, and nearly parallel. */
const FIELDS = [30, 2];
/** Most points of a trail. */
const TRAIL_POINTS = 6000;

/** Most points by which the size of what is seen is found. */
const MOST_POINTS = 1e5;
/** Pieces above which edges are left out. */
const MOST_EDGED = 500;
/** Triangles above which nothing casts a shadow. */
const MOST_SHADED = 4e5;
/** Colour that a further run is mixed with. */
const PALE = new Color('#7aa0c8');

const turned = new Quaternion();

const vector = (list) => new Vector3(...list);

/** Returns the least and the largest of the values of a function over a list of any length. */
function range(list, value) {
  let [low, high] = [Infinity, -Infinity];
  for (const one of list) {
    const x = value(one);
    if (x < low) low = x;
    if (x > high) high = x;
  }
  return [low, high];
}

/** Makes what draws with the graphics card, with less care a large mechanism; `null`: the browser has none of it. */
function renderer(isLarge) {
  try {
    const made = new WebGLRenderer({ antialias: !isLarge, alpha: true, preserveDrawingBuffer: true });
    made.setPixelRatio(Math.min(window.devicePixelRatio || 1, isLarge ? 1 : 2));
    made.shadowMap.enabled = true;
    made.shadowMap.type = PCFShadowMap;
    return made;
  } catch {
    return null;
  }
}

export class Stage {
  constructor(container, data) {
    this.container = container;
    this.data = data;
    this.size = data.view.size;
    this.renderer = renderer(data.pieces.length > MANY);
    this.canvas = this.renderer?.domElement ?? document.createElement('div');
    container.prepend(this.canvas);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(FIELDS[0], 1, this.size / 100, this.size * 100);
    this.up = vector(data.view.up);
    this.eye = vector(data.view.eye);
    this.camera.up.copy(this.up);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener('change', () => this.onChange?.());
    this.forms = new Forms(data);
    // what can be picked with the mouse
    this.meshes = [];
    this.dimensions = [];
    // elements that are switched off at some rows
    this.off = new Map(data.tree.flatMap(({ elements }) => elements.filter((e) => e.off).map((e) => [e.id, e])));
    this.runs = data.runs.map((run, k) => this.makeRun(run, k));
    this.box = this.extent();
    this.lights();
    this.ground();
    this.options = { forces: true, reactions: false, trails: true, joints: true, actions: false, markers: false };
    this.pointers = {};
    this.arrowScale = 1;
    this.ray = new Raycaster();
    this.look(this.eye, this.up);
  }

  // --- what there is ---

  material(ghost) {
    const isLarge = this.data.pieces.length > MANY;
    const made = isLarge ? new MeshLambertMaterial({ side: DoubleSide }) : new MeshStandardMaterial({ roughness: 0.52, metalness: 0.12, side: DoubleSide });
    if (ghost) Object.assign(made, { transparent: true, opacity: 0.32, depthWrite: false });
    return made;
  }

  /** Makes the axes of markers, or the action vectors of joints: seen through everything. */
  directions(kind) {
    const { joint } = this.data.view;
    const ink = new MeshBasicMaterial({ depthTest: false, transparent: true });
    const batch = new Batch(ink, this.scene, { renderOrder: 9 });
    const shaft = new CylinderGeometry(0.03, 0.03, 0.76, 8).rotateX(Math.PI / 2).translate(0, 0, 0.38);
    const head = new ConeGeometry(0.078, 0.24, 12).rotateX(Math.PI / 2).translate(0, 0, 0.88);
    const add = (owner, place, turn, direction, length, colour) => {
      const along = new Quaternion().setFromUnitVectors(Z, vector(direction));
      const local = new Matrix4().compose(vector(place), turn.clone().multiply(along), new Vector3(length, length, length));
      for (const form of [shaft, head]) batch.add(form, local, colour, owner);
    };
    if (kind === 'markers') {
      for (const triad of this.data.triads) {
        const turn = new Quaternion(...triad.rotation);
        ['#cc3e34', '#349448', '#3662c4'].forEach((colour, axis) => {
          add(triad, triad.place, turn, [0, 1, 2].map((k) => Number(k === axis)), 2.5 * joint, colour);
        });
      }
    } else {
      for (const action of this.data.actions) add(action, action.place, new Quaternion(), action.direction, 5 * joint, '#186080');
    }
    this.meshes.push(...batch.build());
    return batch;
  }

  /** Returns where a marker is now, in ground; `null`: it has no place. */
  marker(number) {
    const triad = this.data.triads.find((t) => t.element === `MARKER/${number}`);
    return triad ? this.onBody(triad) : null;
  }

  /** Returns where a place of a body of the first run is now, in ground. */
  onBody({ body, place }) {
    const group = this.runs[0].bodies[body];
    return vector(place).applyQuaternion(group.quaternion).add(group.position);
  }

  /** Returns the number of the marker nearest to a place of the page; `null`: none is near. */
  nearestMarker(x, y) {
    /** Distance within which a marker is meant, in px. */
    const NEAR = 24;
    const { left, top } = this.canvas.getBoundingClientRect();
    let [best, least] = [null, NEAR];
    for (const triad of this.data.triads) {
      const number = Number(triad.element.split('/')[1]);
      const place = this.onPage(this.onBody(triad));
      const off = place ? Math.hypot(place[0] - (x - left), place[1] - (y - top)) : Infinity;
      if (off < least) [best, least] = [number, off];
    }
    return best;
  }

  /** Adds the line of the distance of two markers. */
  addDimension(i, j) {
    const made = new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(6), 3));
    const line = new Line(made, new LineBasicMaterial({ color: '#186080', depthTest: false, transparent: true }));
    line.renderOrder = 12;
    line.frustumCulled = false;
    line.raycast = () => {};
    this.scene.add(line);
    const dimension = { i, j, line };
    this.dimensions.push(dimension);
    return dimension;
  }

  /** Moves the line of a dimension; returns its middle and its length. */
  measured({ i, j, line }) {
    const [a, b] = [this.marker(i), this.marker(j)];
    const { position } = line.geometry.attributes;
    position.setXYZ(0, a.x, a.y, a.z);
    position.setXYZ(1, b.x, b.y, b.z);
    position.needsUpdate = true;
    return { middle: a.clone().add(b).multiplyScalar(0.5), length: a.distanceTo(b) };
  }

  removeDimension(dimension) {
    this.dimensions.splice(this.dimensions.indexOf(dimension), 1);
    this.scene.remove(dimension.line);
    dimension.line.geometry.dispose();
  }

  makeRun(run, index) {
    const ghost = index > 0;
    const { data } = this;
    const root = new Group();
    this.scene.add(root);
    const bodies = data.bodies.map((body) => {
      const group = new Group();
      group.position.set(...body.position);
      group.quaternion.set(...body.rotation);
      root.add(group);
      return group;
    });
    const batches = [true, false].map((castShadow) => new Batch(this.material(ghost), root, { castShadow: castShadow && !ghost, receiveShadow: !ghost }));
    const colour = (piece) => (ghost ? new Color(piece.colour).lerp(PALE, 0.5) : piece.colour);
    // the entries of each body, and those that can be hidden
    const moving = data.bodies.map(() => []);
    const hideable = [];
    const edged = data.pieces.filter((piece) => piece.edges).length <= MOST_EDGED && !ghost;
    for (const piece of data.pieces) {
      const isStill = data.bodies[piece.body].ground;
      if (ghost && isStill) continue;
      if (piece.line) {
        const made = this.line(piece, ghost);
        bodies[piece.body].add(made);
        if (!ghost) this.meshes.push(made);
        continue;
      }
      const batch = batches[isStill && piece.role === 'shape' ? 1 : 0];
      for (const { form, local } of this.forms.parts(piece)) {
        const entry = batch.add(form, local, colour(piece), { element: piece.element, body: piece.body });
        moving[piece.body].push({ batch, entry });
        if (piece.role === 'joint' || piece.role === 'ground') hideable.push({ batch, entry, isSymbol: true });
      }
      if (piece.edges && edged) bodies[piece.body].add(this.edges(piece));
    }
    const stretched = data.stretched.map((piece) => {
      const batch = batches[0];
      const entry = batch.add(this.forms.surface(piece.mesh), null, colour(piece), { element: piece.element, body: piece.from });
      hideable.push({ batch, entry });
      return { batch, entry };
    });
    for (const mesh of batches.flatMap((batch) => batch.build())) if (!ghost) this.meshes.push(mesh);
    const arrows = ghost ? [] : data.arrows.map((arrow) => this.arrow(arrow, run, root));
    const trails = data.trails.map((trail) => this.trail(trail, run, root, ghost));
    const overlaps = ghost ? [] : data.overlaps.map((overlap) => this.overlap(overlap, root));
    return { run, root, bodies, batches, moving, hideable, stretched, arrows, trails, overlaps };
  }

  /** Makes the mark of two solids that overlap: seen through everything. */
  overlap(overlap, root) {
    const ink = new MeshStandardMaterial({ color: '#ff1744', emissive: '#ff1744', emissiveIntensity: 0.6, depthTest: false, transparent: true, opacity: 0.85 });
    const mark = new Mesh(new SphereGeometry(0.013 * this.size, 24, 16), ink);
    mark.renderOrder = 11;
    mark.visible = false;
    root.add(mark);
    return { mark, at: (row) => overlap.place.map((column) => column[row]) };
  }

  /** Makes a piece without thickness. */
  line(piece, ghost) {
    const flat = new Float32Array(piece.line.flat());
    const made = new BufferGeometry().setAttribute('position', new BufferAttribute(flat, 3));
    const ink = new LineBasicMaterial({ color: piece.colour, transparent: ghost, opacity: ghost ? 0.4 : 1 });
    const line = piece.closed ? new LineLoop(made, ink) : new Line(made, ink);
    line.userData = { element: piece.element, body: piece.body };
    return line;
  }

  /** Makes the edges of a piece of flat faces. */
  edges(piece) {
    const dark = new Color(piece.colour).multiplyScalar(0.45);
    const form = this.forms.surface(piece.mesh);
    const edges = new LineSegments(new EdgesGeometry(form, 25), new LineBasicMaterial({ color: dark, transparent: true, opacity: 0.55 }));
    edges.raycast = () => {};
    return edges;
  }

  /** Prepares the arrows of the force and of the torque of an element; they are made when they are first seen. */
  arrow(arrow, run, root) {
    const channels = run.loads[arrow.load];
    const value = (k, row) => (channels[k] === null || channels[k] === undefined ? NaN : run.value(channels[k])[row]);
    const kinds = [
      { from: 0, colour: arrow.reaction ? '#2f8f6b' : '#d0342c', heads: 1 },
      { from: 3, colour: arrow.reaction ? '#5a7f2a' : '#8034a8', heads: 2 },
    ];
    const thick = 0.0042 * this.size;
    const parts = kinds.map(({ from, colour, heads }) => {
      const at = (row) => [value(from, row), value(from + 1, row), value(from + 2, row)];
      const make = () => {
        const group = new Group();
        // in front of the bodies: forces act inside of them
        const ink = new MeshStandardMaterial({ color: colour, roughness: 0.5, emissive: colour, emissiveIntensity: 0.25, depthTest: false, transparent: true });
        const shaft = new Mesh(new CylinderGeometry(thick, thick, 1, 12).rotateX(Math.PI / 2).translate(0, 0, 0.5), ink);
        const tips = Array.from({ length: heads }, () => new Mesh(new ConeGeometry(3 * thick, 8 * thick, 16).rotateX(Math.PI / 2), ink));
        group.add(shaft, ...tips);
        for (const mesh of group.children) {
          mesh.renderOrder = 10;
          mesh.userData = { element: arrow.element, body: arrow.body };
          this.meshes.push(mesh);
        }
        root.add(group);
        return { group, shaft, tips };
      };
      return { make, head: 8 * thick, at };
    });
    const places = run.places[arrow.load];
    const acts = (row) => {
      const place = places?.map((c) => (c === null ? NaN : run.value(c)[row]));
      return place?.every(Number.isFinite) && place;
    };
    return { ...arrow, parts, acts, rows: run.rows };
  }

  trail(trail, run, root, ghost) {
    const track = run.tracks[trail.body];
    if (!track) return null;
    const step = Math.max(1, Math.ceil(run.rows / TRAIL_POINTS));
    const rows = [];
    for (let row = 0; row < run.rows; row += step) rows.push(row);
    const flat = new Float32Array(3 * rows.length);
    const place = vector(trail.place);
    const turned = new Quaternion();
    rows.forEach((row, k) => {
      turned.set(track[3][row], track[4][row], track[5][row], track[6][row]).normalize();
      const p = place.clone().applyQuaternion(turned);
      flat.set([p.x + track[0][row], p.y + track[1][row], p.z + track[2][row]], 3 * k);
    });
    const made = new BufferGeometry().setAttribute('position', new BufferAttribute(flat, 3));
    const { colour } = this.data.bodies[trail.body];
    const whole = new Line(made, new LineBasicMaterial({ color: colour, transparent: true, opacity: ghost ? 0.15 : 0.25 }));
    const passed = new Line(made.clone(), new LineBasicMaterial({ color: colour, transparent: ghost, opacity: ghost ? 0.4 : 1 }));
    whole.raycast = passed.raycast = () => {};
    root.add(whole, passed);
    return { whole, passed, step };
  }

  /** Returns points of the surfaces at some rows; of a mechanism that goes far away at the first. */
  extent() {
    const { moving } = this.runs[0];
    const each = Math.max(1, Math.min(50, Math.ceil(MOST_POINTS / this.data.pieces.length / 8)));
    const boxes = moving.map((all) => all.flatMap(({ entry }) => points(entry, each)));
    for (const line of this.meshes.filter((mesh) => mesh.isLine)) {
      const { position } = line.geometry.attributes;
      const step = Math.max(1, Math.floor(position.count / 50));
      for (let k = 0; k < position.count; k += step) boxes[line.userData.body].push(new Vector3().fromBufferAttribute(position, k));
    }
    const instants = Math.max(2, Math.min(40, Math.floor(MOST_POINTS / boxes.reduce((n, all) => n + all.length, 1))));
    const rows = this.data.runs[0].rows;
    const found = [];
    for (let k = 0; k < instants; k++) {
      const row = Math.round((k * (rows - 1)) / (instants - 1));
      this.pose(0, row, row, 0);
      boxes.forEach((points, body) => {
        const group = this.runs[0].bodies[body];
        for (const p of points) found.push(p.clone().applyQuaternion(group.quaternion).add(group.position));
      });
      const far = found.some((p) => p.distanceTo(vector(this.data.view.centre)) > 0.6 * this.size);
      if (k > 0 && far) break;
    }
    const near = found.filter((p) => p.distanceTo(vector(this.data.view.centre)) <= 0.6 * this.size);
    return near.length ? near : [vector(this.data.view.centre)];
  }

  /** Returns the number of triangles of all runs. */
  triangles() {
    return this.runs.flatMap((run) => run.batches).reduce((sum, batch) => sum + (batch.triangles ?? 0), 0);
  }

  /** Returns the middle of a body, in its frame. */
  middleOf(body) {
    const all = this.runs[0].moving[body];
    const sum = new Vector3();
    for (const { entry } of all) sum.add(middle(entry));
    return all.length ? sum.divideScalar(all.length) : vector(this.data.bodies[body].cm ?? [0, 0, 0]);
  }

  lights() {
    const { up, eye, size } = this;
    const right = up.clone().cross(eye).normalize();
    this.scene.add(new HemisphereLight(0xffffff, 0xb4bcc6, 1.55));
    const key = new DirectionalLight(0xffffff, 2.1);
    const centre = vector(this.data.view.centre);
    // of a mechanism in a plane the shadow stays beside it
    const [high, beside, before] = this.data.view.planar ? [0.55, -0.35, 1.7] : [1.4, 0.5, 0.7];
    key.position.copy(centre).addScaledVector(up, high * size).addScaledVector(right, beside * size).addScaledVector(eye, before * size);
    key.target.position.copy(centre);
    key.castShadow = this.triangles() <= MOST_SHADED;
    key.shadow.mapSize.set(2048, 2048);
    Object.assign(key.shadow.camera, { left: -size, right: size, top: size, bottom: -size, near: size / 10, far: 5 * size });
    key.shadow.bias = -4e-4;
    key.shadow.normalBias = 0.002 * size;
    key.shadow.radius = 3;
    this.scene.add(key, key.target);
    this.key = key;
  }

  /** Draws with less care, where the graphics card is slow. */
  lighten() {
    if (!this.renderer || !this.key.castShadow && this.renderer.getPixelRatio() <= 1) return;
    this.key.castShadow = false;
    this.renderer.setPixelRatio(1);
    this.resize();
  }

  /** Adds a grid: below the mechanism, or behind one that moves in a plane. */
  ground() {
    const { size } = this;
    const normal = this.data.view.planar ? this.eye.clone() : this.up.clone();
    const [lowest] = range(this.box, (p) => p.dot(normal));
    const level = lowest - (this.data.view.planar ? 0.03 : 0.002) * size;
    const step = niceStep(size / 12);
    const half = Math.ceil((1.25 * size) / step);
    const across = this.up.clone().cross(this.eye).normalize();
    const along = normal.clone().cross(across);
    const centre = vector(this.data.view.centre);
    // lines of the grid have round coordinates
    const base = across.clone().multiplyScalar(Math.round(centre.dot(across) / step) * step)
      .addScaledVector(along, Math.round(centre.dot(along) / step) * step).addScaledVector(normal, level);
    const lines = (every) => {
      const points = [];
      for (let k = -half; k <= half; k++) {
        if ((k % 5 === 0) !== every) continue;
        for (const [a, b] of [[across, along], [along, across]]) {
          for (const side of [-half, half]) {
            const p = base.clone().addScaledVector(a, k * step).addScaledVector(b, side * step);
            points.push(p.x, p.y, p.z);
          }
        }
      }
      return new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
    };
    const grid = new Group();
    grid.add(new LineSegments(lines(false), new LineBasicMaterial({ color: '#9aa7b5', transparent: true, opacity: 0.22 })));
    grid.add(new LineSegments(lines(true), new LineBasicMaterial({ color: '#8595a6', transparent: true, opacity: 0.4 })));
    const floor = new Mesh(new PlaneGeometry(2 * half * step, 2 * half * step), new ShadowMaterial({ opacity: 0.2 }));
    floor.quaternion.setFromUnitVectors(Z, normal);
    floor.position.copy(base).addScaledVector(normal, -1e-4 * size);
    floor.receiveShadow = true;
    grid.add(floor);
    this.grid = grid;
    this.gridStep = step;
    this.scene.add(grid);
  }

  // --- where it is ---

  /** Places the bodies of a run between two of its rows. */
  pose(index, row, next, part) {
    const { run, bodies } = this.runs[index];
    run.tracks.forEach((track, body) => {
      if (!track) return;
      const group = bodies[body];
      const mix = (k) => track[k][row] + part * (track[k][next] - track[k][row]);
      group.position.set(mix(0), mix(1), mix(2));
      group.quaternion.set(track[3][row], track[4][row], track[5][row], track[6][row]).normalize();
      if (part > 0) {
        turned.set(track[3][next], track[4][next], track[5][next], track[6][next]).normalize();
        group.quaternion.slerp(turned, part);
      }
    });
  }

  /** Places a run between two of its rows; arrows are those of the first. */
  place(index, row, next, part) {
    this.pose(index, row, next, part);
    const { bodies, moving, stretched, hideable, arrows = [], trails = [], overlaps = [] } = this.runs[index];
    const matrices = bodies.map((group) => rigid(group.position, group.quaternion));
    moving.forEach((all, body) => {
      for (const { batch, entry } of all) batch.place(entry, matrices[body]);
    });
    const isActive = (id) => !this.off.has(id) || !isOff(this.off.get(id), row);
    for (const { batch, entry, isSymbol } of hideable) {
      batch.show(entry, isActive(entry.owner.element) && (!isSymbol || (this.options?.joints ?? true)));
    }
    if (index === 0) this.placePointers(matrices);
    const point = (body, place) => vector(place).applyQuaternion(bodies[body].quaternion).add(bodies[body].position);
    this.data.stretched.forEach((piece, k) => {
      const from = point(piece.from, piece.fromPlace);
      const along = point(piece.to, piece.toPlace).sub(from);
      const length = Math.max(along.length(), 1e-9 * this.size);
      const { batch, entry } = stretched[k];
      turned.setFromUnitVectors(Z, along.divideScalar(length));
      batch.place(entry, new Matrix4().compose(from, turned, new Vector3(1, 1, length)));
    });
    for (const arrow of arrows) {
      const shown = (arrow.reaction ? this.options?.reactions : this.options?.forces) && isActive(arrow.element);
      if (!shown) {
        for (const { made } of arrow.parts) if (made) made.group.visible = false;
        continue;
      }
      if (!arrow.scale) measure(arrows.filter((a) => a.reaction === arrow.reaction));
      const known = arrow.acts(row);
      const from = known ? vector(known) : point(arrow.body, arrow.place);
      arrow.parts.forEach((part, kind) => this.point(part, from, part.at(row), arrow.scale[kind]));
    }
    for (const { mark, at } of overlaps) {
      const place = at(row);
      mark.visible = place.every(Number.isFinite);
      if (mark.visible) mark.position.set(...place);
    }
    for (const trail of trails) {
      if (!trail) continue;
      trail.whole.visible = trail.passed.visible = this.options?.trails ?? true;
      trail.passed.geometry.setDrawRange(0, Math.floor(row / trail.step) + 1);
    }
  }

  /** Points an arrow from a place along a force. */
  point(part, from, force, largest) {
    const along = vector(force);
    const size = along.length();
    const length = Math.min((size / largest) * ARROW, 1.6 * ARROW) * this.size * (this.arrowScale ?? 1);
    const visible = largest > 0 && length > 0.25 * part.head;
    if (visible) part.made ??= part.make();
    if (!part.made) return;
    const { group, shaft, tips } = part.made;
    group.visible = visible;
    if (!visible) return;
    group.position.copy(from);
    group.quaternion.setFromUnitVectors(Z, along.divideScalar(size));
    const head = Math.min(part.head, 0.6 * length);
    shaft.scale.set(1, 1, Math.max(length - head, 1e-6));
    tips.forEach((tip, k) => {
      tip.scale.setScalar(head / part.head);
      tip.position.set(0, 0, length - (0.5 + k) * head);
    });
  }

  /** Places the axes of markers and the action vectors that are shown. */
  placePointers(matrices) {
    for (const kind of ['markers', 'actions']) {
      const shown = Boolean(this.options?.[kind]);
      if (shown) this.pointers[kind] ??= this.directions(kind);
      const batch = this.pointers[kind];
      if (!batch) continue;
      for (const mesh of batch.meshes) mesh.visible = shown;
      if (shown) for (const entry of batch.all) batch.place(entry, matrices[entry.owner.body]);
    }
  }

  // --- seeing it ---

  /** Looks from a direction so that all of it is seen. */
  look(eye, up) {
    const { camera } = this;
    camera.up.copy(up);
    const right = up.clone().cross(eye).normalize();
    const upward = eye.clone().cross(right);
    const [x, y, z] = [right, upward, eye].map((axis) => range(this.box, (p) => p.dot(axis)));
    const middle = ([low, high]) => (low + high) / 2;
    const centre = right.clone().multiplyScalar(middle(x)).addScaledVector(upward, middle(y)).addScaledVector(eye, middle(z));
    const slope = Math.tan((camera.fov * Math.PI) / 360);
    const high = Math.max(y[1] - y[0], (x[1] - x[0]) / camera.aspect, 1e-3 * this.size);
    const distance = (0.5 * 1.22 * high) / slope + 0.5 * (z[1] - z[0]);
    this.controls.target.copy(centre);
    camera.position.copy(centre).addScaledVector(eye, distance);
    camera.near = distance / 200;
    camera.far = distance * 50;
    camera.updateProjectionMatrix();
    // the controls remember the direction upwards
    this.controls._quat?.setFromUnitVectors(camera.up, new Vector3(0, 1, 0));
    if (this.controls._quat) this.controls._quatInverse = this.controls._quat.clone().invert();
    this.controls.update();
  }

  fit() {
    const eye = this.camera.position.clone().sub(this.controls.target).normalize();
    this.look(eye, this.camera.up.clone());
  }

  /** Looks in perspective, or nearly in parallel. */
  flatten(flat) {
    this.camera.fov = FIELDS[flat ? 1 : 0];
    this.fit();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.container;
    if (!width || !height) return;
    this.renderer?.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  render() {
    this.renderer?.render(this.scene, this.camera);
  }

  /** Returns the place of a point of ground on the page. */
  onPage(point) {
    const p = point.clone().project(this.camera);
    const { clientWidth: width, clientHeight: height } = this.container;
    return p.z < 1 ? [((p.x + 1) / 2) * width, ((1 - p.y) / 2) * height] : null;
  }

  /** Returns the element and body below a place of the page. */
  pick(x, y) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    this.ray.setFromCamera(new Vector2((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height), this.camera);
    this.ray.params.Line.threshold = 0.006 * this.size;
    const seen = (mesh) => mesh.visible && mesh.parent.visible && (mesh.parent.parent?.visible ?? true);
    const [hit] = this.ray.intersectObjects(this.meshes.filter(seen), false);
    if (!hit) return null;
    return ownerOf(hit);
  }

  /** Lights up what belongs to an element: all of a body. */
  highlight(element) {
    const owns = (owner) => owner.element === element || this.data.bodies[owner.body]?.id === element;
    for (const batch of this.runs[0].batches) batch.highlight(owns);
    for (const { material, userData } of this.meshes) {
      if (!userData.owners && material.emissive) material.emissive.set(owns(userData) ? CHOSEN : material.color);
    }
  }
}

/** Finds the force, and the torque, that arrows are measured by: nearly the largest of all. */
function measure(arrows) {
  /** Most values that are looked at. */
  const MOST = 2e5;
  const step = Math.max(1, Math.ceil(arrows.reduce((n, { rows }) => n + rows, 0) / MOST));
  const scale = [0, 1].map((kind) => {
    const sizes = [];
    for (const arrow of arrows) {
      for (let row = 0; row < arrow.rows; row += step) {
        const size = Math.hypot(...arrow.parts[kind].at(row));
        if (size > 0) sizes.push(size);
      }
    }
    sizes.sort((a, b) => a - b);
    return sizes.length ? sizes[Math.floor(LARGE * (sizes.length - 1))] : 0;
  });
  for (const arrow of arrows) arrow.scale = scale;
}

/** Returns the largest of 1, 2, 5, 10 … that is not above a length. */
function niceStep(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].find((k) => k * power <= length) * power;
}
