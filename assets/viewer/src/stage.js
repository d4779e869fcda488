// The mechanism in three dimensions: bodies, springs, forces, trails, light and ground.

import {
  BufferAttribute, BufferGeometry, Color, ConeGeometry, CylinderGeometry, DirectionalLight, DoubleSide, EdgesGeometry,
  Group, HemisphereLight, Line, LineBasicMaterial, LineLoop, LineSegments, Mesh, MeshStandardMaterial, PCFShadowMap,
  PerspectiveCamera, PlaneGeometry, Quaternion, Raycaster, Scene, ShadowMaterial, SphereGeometry, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const Z = new Vector3(0, 0, 1);
/** Length of the arrow of a large force, as a part of the size of the mechanism. */
const ARROW = 0.22;
/** Part of all values of forces that are not larger than the one that an arrow's length is measured by. */
const LARGE = 0.97;
/** Fields of view in degrees: in perspective, and nearly parallel. */
const FIELDS = [30, 2];
/** Most points of a trail. */
const TRAIL_POINTS = 6000;

const vector = (list) => new Vector3(...list);

export class Stage {
  constructor(container, data) {
    this.container = container;
    this.data = data;
    this.size = data.view.size;
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    container.prepend(this.renderer.domElement);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(FIELDS[0], 1, this.size / 100, this.size * 100);
    this.up = vector(data.view.up);
    this.eye = vector(data.view.eye);
    this.camera.up.copy(this.up);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.onChange?.());
    this.materials = new Map();
    this.meshes = [];
    this.dimensions = [];
    this.runs = data.runs.map((run, k) => this.makeRun(run, k));
    this.box = this.extent();
    this.lights();
    this.ground();
    this.options = { forces: true, reactions: false, trails: true, joints: true, actions: false, markers: false };
    this.pointers = this.directions(this.runs[0].bodies);
    this.arrowScale = 1;
    this.ray = new Raycaster();
    this.look(this.eye, this.up);
  }

  // --- what there is ---

  material(colour, ghost) {
    const key = colour + ghost;
    if (!this.materials.has(key)) {
      const made = new MeshStandardMaterial({ color: new Color(colour), roughness: 0.52, metalness: 0.12, side: DoubleSide });
      if (ghost) {
        made.color.lerp(new Color('#7aa0c8'), 0.5);
        Object.assign(made, { transparent: true, opacity: 0.32, depthWrite: false });
      }
      this.materials.set(key, made);
    }
    return this.materials.get(key);
  }

  /** Makes an arrow from a place along a direction. */
  pointer(place, direction, length, colour) {
    const ink = new MeshStandardMaterial({ color: colour, roughness: 0.5, emissive: colour, emissiveIntensity: 0.35, depthTest: false, transparent: true });
    const thick = 0.03 * length;
    const head = 8 * thick;
    const group = new Group();
    group.add(
      new Mesh(new CylinderGeometry(thick, thick, length - head, 8).rotateX(Math.PI / 2).translate(0, 0, (length - head) / 2), ink),
      new Mesh(new ConeGeometry(2.6 * thick, head, 12).rotateX(Math.PI / 2).translate(0, 0, length - head / 2), ink),
    );
    group.position.set(...place);
    group.quaternion.setFromUnitVectors(Z, vector(direction));
    for (const mesh of group.children) mesh.renderOrder = 9;
    return group;
  }

  /** Makes the axes of markers and the action vectors of joints: seen through everything. */
  directions(bodies) {
    const { joint } = this.data.view;
    const colours = ['#cc3e34', '#349448', '#3662c4'];
    const add = (made, { element, body }) => {
      made.traverse((mesh) => {
        if (!mesh.isMesh) return;
        mesh.userData = { element, body };
        this.meshes.push(mesh);
      });
      bodies[body].add(made);
      made.visible = false;
      return made;
    };
    const markers = this.data.triads.map((triad) => {
      const made = new Group();
      [[1, 0, 0], [0, 1, 0], [0, 0, 1]].forEach((axis, k) => made.add(this.pointer([0, 0, 0], axis, 2.5 * joint, colours[k])));
      made.position.set(...triad.place);
      made.quaternion.set(...triad.rotation);
      return add(made, triad);
    });
    const actions = this.data.actions.map((action) => add(this.pointer(action.place, action.direction, 5 * joint, '#186080'), action));
    return { markers, actions };
  }

  /** Returns where a marker is now, in ground; `null`: it has no place. */
  marker(number) {
    const triad = this.data.triads.find((t) => t.element === `MARKER/${number}`);
    if (!triad) return null;
    const body = this.runs[0].bodies[triad.body];
    return vector(triad.place).applyQuaternion(body.quaternion).add(body.position);
  }

  /** Returns the number of the marker nearest to a place of the page; `null`: none is near. */
  nearestMarker(x, y) {
    /** Distance within which a marker is meant, in px. */
    const NEAR = 24;
    const { left, top } = this.renderer.domElement.getBoundingClientRect();
    let [best, least] = [null, NEAR];
    for (const { element } of this.data.triads) {
      const number = Number(element.split('/')[1]);
      const place = this.onPage(this.marker(number));
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

  surface([first, corners, firstIndex, indices]) {
    const { floats } = this.data;
    const made = new BufferGeometry();
    made.setAttribute('position', new BufferAttribute(floats.subarray(first, first + 3 * corners), 3));
    made.setAttribute('normal', new BufferAttribute(floats.subarray(first + 3 * corners, first + 6 * corners), 3));
    made.setIndex(new BufferAttribute(this.data.indices.subarray(firstIndex, firstIndex + indices), 1));
    return made;
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
    const joints = [];
    for (const piece of data.pieces) {
      if (ghost && data.bodies[piece.body].ground) continue;
      const made = this.piece(piece, ghost);
      made.userData = { element: piece.element, body: piece.body };
      bodies[piece.body].add(made);
      if (piece.role === 'joint' || piece.role === 'ground') joints.push(made);
      if (!ghost) this.meshes.push(made);
    }
    const stretched = data.stretched.map((piece) => {
      const made = new Mesh(this.surface(piece.mesh), this.material(piece.colour, ghost));
      made.castShadow = !ghost;
      made.userData = { element: piece.element, body: piece.from };
      root.add(made);
      if (!ghost) this.meshes.push(made);
      return made;
    });
    const arrows = ghost ? [] : data.arrows.map((arrow) => this.arrow(arrow, run, root));
    measure(arrows);
    const trails = data.trails.map((trail) => this.trail(trail, run, root, ghost));
    const overlaps = ghost ? [] : data.overlaps.map((overlap) => this.overlap(overlap, root));
    return { run, root, bodies, stretched, arrows, trails, joints, overlaps };
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

  piece(piece, ghost) {
    const { data } = this;
    if (piece.line) {
      const flat = new Float32Array(piece.line.flat());
      const made = new BufferGeometry().setAttribute('position', new BufferAttribute(flat, 3));
      const ink = new LineBasicMaterial({ color: piece.colour, transparent: ghost, opacity: ghost ? 0.4 : 1 });
      return piece.closed ? new LineLoop(made, ink) : new Line(made, ink);
    }
    const mesh = new Mesh(this.surface(piece.mesh), this.material(piece.colour, ghost));
    mesh.castShadow = !ghost && !(data.bodies[piece.body].ground && piece.role === 'shape');
    mesh.receiveShadow = !ghost;
    if (piece.edges && !ghost) {
      const dark = new Color(piece.colour).multiplyScalar(0.45);
      const edges = new LineSegments(new EdgesGeometry(mesh.geometry, 25), new LineBasicMaterial({ color: dark, transparent: true, opacity: 0.55 }));
      edges.raycast = () => {};
      mesh.add(edges);
    }
    return mesh;
  }

  /** Makes the arrows of the force and of the torque of an element. */
  arrow(arrow, run, root) {
    const channels = run.loads[arrow.load];
    const values = channels.map((c) => (c === null ? null : run.value(c)));
    const kinds = [
      { from: 0, colour: arrow.reaction ? '#2f8f6b' : '#d0342c', heads: 1 },
      { from: 3, colour: arrow.reaction ? '#5a7f2a' : '#8034a8', heads: 2 },
    ];
    const parts = kinds.map(({ from, colour, heads }) => {
      const group = new Group();
      // in front of the bodies: forces act inside of them
      const ink = new MeshStandardMaterial({ color: colour, roughness: 0.5, emissive: colour, emissiveIntensity: 0.25, depthTest: false, transparent: true });
      const thick = 0.0042 * this.size;
      const shaft = new Mesh(new CylinderGeometry(thick, thick, 1, 12).rotateX(Math.PI / 2).translate(0, 0, 0.5), ink);
      const tips = Array.from({ length: heads }, () => new Mesh(new ConeGeometry(3 * thick, 8 * thick, 16).rotateX(Math.PI / 2), ink));
      group.add(shaft, ...tips);
      for (const mesh of group.children) {
        mesh.renderOrder = 10;
        mesh.userData = { element: arrow.element, body: arrow.body };
        this.meshes.push(mesh);
      }
      group.visible = false;
      root.add(group);
      return { group, shaft, tips, head: 8 * thick, at: (row) => [0, 1, 2].map((k) => values[from + k]?.[row] ?? NaN) };
    });
    const place = run.places[arrow.load]?.map((c) => (c === null ? null : run.value(c)));
    const acts = (row) => place && place.every((column) => column && Number.isFinite(column[row])) && place.map((column) => column[row]);
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
    const boxes = this.data.bodies.map(() => []);
    for (const mesh of this.meshes) {
      const { body } = mesh.userData;
      if (mesh.parent !== this.runs[0].bodies[body]) continue;
      const { position } = mesh.geometry.attributes;
      const step = Math.max(1, Math.floor(position.count / 50));
      for (let k = 0; k < position.count; k += step) boxes[body].push(new Vector3().fromBufferAttribute(position, k));
    }
    const rows = this.data.runs[0].rows;
    const found = [];
    for (let k = 0; k < 40; k++) {
      const row = Math.round((k * (rows - 1)) / 39);
      this.place(0, row, row, 0);
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
    key.castShadow = true;
    key.shadow.mapSize.set(2048, 2048);
    Object.assign(key.shadow.camera, { left: -size, right: size, top: size, bottom: -size, near: size / 10, far: 5 * size });
    key.shadow.bias = -4e-4;
    key.shadow.normalBias = 0.002 * size;
    key.shadow.radius = 3;
    this.scene.add(key, key.target);
  }

  /** Adds a grid: below the mechanism, or behind one that moves in a plane. */
  ground() {
    const { size } = this;
    const normal = this.data.view.planar ? this.eye.clone() : this.up.clone();
    const heights = this.box.map((p) => p.dot(normal));
    const level = Math.min(...heights) - (this.data.view.planar ? 0.03 : 0.002) * size;
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

  /** Places a run between two of its rows; arrows are those of the first. */
  place(index, row, next, part) {
    const { run, bodies, stretched, arrows = [], trails = [], overlaps = [] } = this.runs[index];
    const turned = new Quaternion();
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
    const point = (body, place) => vector(place).applyQuaternion(bodies[body].quaternion).add(bodies[body].position);
    this.data.stretched.forEach((piece, k) => {
      const from = point(piece.from, piece.fromPlace);
      const along = point(piece.to, piece.toPlace).sub(from);
      const length = Math.max(along.length(), 1e-9 * this.size);
      stretched[k].position.copy(from);
      stretched[k].quaternion.setFromUnitVectors(Z, along.divideScalar(length));
      stretched[k].scale.set(1, 1, length);
    });
    for (const arrow of arrows) {
      const known = arrow.acts(row);
      const from = known ? vector(known) : point(arrow.body, arrow.place);
      const shown = arrow.reaction ? this.options?.reactions : this.options?.forces;
      arrow.parts.forEach((part, kind) => this.point(part, from, part.at(row), arrow.scale[kind], shown));
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
  point(part, from, force, largest, shown) {
    const along = vector(force);
    const size = along.length();
    const length = Math.min((size / largest) * ARROW, 1.6 * ARROW) * this.size * (this.arrowScale ?? 1);
    part.group.visible = Boolean(shown) && largest > 0 && length > 0.25 * part.head;
    if (!part.group.visible) return;
    part.group.position.copy(from);
    part.group.quaternion.setFromUnitVectors(Z, along.divideScalar(size));
    const head = Math.min(part.head, 0.6 * length);
    part.shaft.scale.set(1, 1, Math.max(length - head, 1e-6));
    part.tips.forEach((tip, k) => {
      tip.scale.setScalar(head / part.head);
      tip.position.set(0, 0, length - (0.5 + k) * head);
    });
  }

  // --- seeing it ---

  /** Looks from a direction so that all of it is seen. */
  look(eye, up) {
    const { camera } = this;
    camera.up.copy(up);
    const right = up.clone().cross(eye).normalize();
    const upward = eye.clone().cross(right);
    const range = (axis) => {
      const all = this.box.map((p) => p.dot(axis));
      return [Math.min(...all), Math.max(...all)];
    };
    const [x, y, z] = [right, upward, eye].map(range);
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
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  render() {
    for (const { joints } of this.runs) for (const mesh of joints) mesh.visible = this.options.joints;
    for (const kind of ['markers', 'actions']) for (const made of this.pointers[kind]) made.visible = this.options[kind];
    this.renderer.render(this.scene, this.camera);
  }

  /** Returns the place of a point of ground on the page. */
  onPage(point) {
    const p = point.clone().project(this.camera);
    const { clientWidth: width, clientHeight: height } = this.container;
    return p.z < 1 ? [((p.x + 1) / 2) * width, ((1 - p.y) / 2) * height] : null;
  }

  /** Returns the element and body below a place of the page. */
  pick(x, y) {
    const { left, top, width, height } = this.renderer.domElement.getBoundingClientRect();
    this.ray.setFromCamera(new Vector2((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height), this.camera);
    this.ray.params.Line.threshold = 0.006 * this.size;
    const seen = (mesh) => mesh.visible && mesh.parent.visible && mesh.parent.parent.visible;
    const [hit] = this.ray.intersectObjects(this.meshes.filter(seen), false);
    return hit ? hit.object.userData : null;
  }

  /** Lights up what belongs to an element: all of a body. */
  highlight(element) {
    for (const mesh of this.meshes) {
      if (!mesh.material.isMeshStandardMaterial) continue;
      const own = mesh.userData.element === element || this.data.bodies[mesh.userData.body]?.id === element;
      mesh.userData.plain ??= mesh.material;
      if (own && mesh.material === mesh.userData.plain) {
        mesh.material = mesh.userData.plain.clone();
        mesh.material.emissive.set('#ffb020');
        mesh.material.emissiveIntensity = 0.45;
      } else if (!own && mesh.material !== mesh.userData.plain) {
        mesh.material.dispose();
        mesh.material = mesh.userData.plain;
      }
    }
  }
}

/** Finds the force, and the torque, that arrows are measured by: nearly the largest of all. */
function measure(arrows) {
  for (const group of [arrows.filter((a) => !a.reaction), arrows.filter((a) => a.reaction)]) {
    const scale = [0, 1].map((kind) => {
      const sizes = [];
      for (const arrow of group) {
        const step = Math.max(1, Math.floor(arrow.rows / 400));
        for (let row = 0; row < arrow.rows; row += step) {
          const size = Math.hypot(...arrow.parts[kind].at(row));
          if (size > 0) sizes.push(size);
        }
      }
      sizes.sort((a, b) => a - b);
      return sizes.length ? sizes[Math.floor(LARGE * (sizes.length - 1))] : 0;
    });
    for (const arrow of group) arrow.scale = scale;
  }
}

/** Returns the largest of 1, 2, 5, 10 … that is not above a length. */
function niceStep(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].find((k) => k * power <= length) * power;
}
