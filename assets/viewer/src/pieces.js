// Solids that move with bodies: however many they are, a few batches draw them.

import {
  BatchedMesh, BufferAttribute, BufferGeometry, Color, CylinderGeometry, DynamicDrawUsage, InstancedMesh, Matrix4, Quaternion, Sphere, SphereGeometry, Vector3,
} from 'three';

const Z = new Vector3(0, 0, 1);
const ONE = new Vector3(1, 1, 1);
/** Colour that what is chosen is mixed with. */
export const CHOSEN = new Color('#ffb41f');
/** Part of that colour. */
const SHARE = 0.85;
/** Pieces above which a mechanism is large: it is drawn with less care. */
export const MANY = 600;

const vector = (list) => new Vector3(...list);

/** The forms of all pieces of a page: surfaces of the data, balls and rods of unit size. */
export class Forms {
  constructor(data) {
    this.data = data;
    this.known = new Map();
    const [sides, rings] = data.pieces.length > MANY ? [10, 6] : [32, 20];
    this.ball = new SphereGeometry(1, sides, rings);
    this.rod = new CylinderGeometry(1, 1, 1, data.pieces.length > MANY ? 8 : 20, 1, true).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    // batches want the same attributes everywhere
    for (const form of [this.ball, this.rod]) form.deleteAttribute('uv');
  }

  /** Returns a surface of the data; equal ones are one. */
  surface([first, corners, firstIndex, indices]) {
    if (!this.known.has(first)) {
      const { floats } = this.data;
      const made = new BufferGeometry();
      made.setAttribute('position', new BufferAttribute(floats.subarray(first, first + 3 * corners), 3));
      made.setAttribute('normal', new BufferAttribute(floats.subarray(first + 3 * corners, first + 6 * corners), 3));
      made.setIndex(new BufferAttribute(this.data.indices.subarray(firstIndex, firstIndex + indices), 1));
      made.computeBoundingBox();
      this.known.set(first, made);
    }
    return this.known.get(first);
  }

  /** Returns the parts of a piece: forms, and where they stand in the frame of its body. */
  parts(piece) {
    const ball = (centre, radius) => ({ form: this.ball, local: new Matrix4().compose(vector(centre), new Quaternion(), new Vector3(radius, radius, radius)) });
    if (piece.ball) return [ball(...piece.ball)];
    if (piece.rod) {
      const [from, to, radius] = piece.rod;
      const along = vector(to).sub(vector(from));
      const length = along.length();
      const ends = [ball(from, radius), ball(to, radius)];
      if (!(length > 0)) return ends;
      const turned = new Quaternion().setFromUnitVectors(Z, along.divideScalar(length));
      return [{ form: this.rod, local: new Matrix4().compose(vector(from), turned, new Vector3(radius, radius, length)) }, ...ends];
    }
    return [{ form: this.surface(piece.mesh), local: null }];
  }
}

/** Forms that occur more often than this are drawn at once; the others share a batch. */
const FEW = 3;
const NOWHERE = new Matrix4().makeScale(0, 0, 0);
const EVERYWHERE = new Sphere(new Vector3(), Infinity);

/** Forms of one material, each with a colour and an owner. */
export class Batch {
  constructor(material, root, look = {}) {
    Object.assign(this, { material, root, look });
    this.all = [];
    this.meshes = [];
  }

  /** Adds a form; `local`: its place in the frame of what moves it, `null` where that is the same. */
  add(form, local, colour, owner) {
    const entry = { form, local, colour: new Color(colour), owner, visible: true, matrix: new Matrix4() };
    this.all.push(entry);
    return entry;
  }

  /** Makes what is drawn, once all forms are there; returns it. */
  build() {
    const byForm = new Map();
    for (const entry of this.all) {
      if (!byForm.has(entry.form)) byForm.set(entry.form, []);
      byForm.get(entry.form).push(entry);
    }
    const seldom = [];
    for (const [form, entries] of byForm) {
      if (entries.length > FEW) this.instanced(form, entries);
      else seldom.push(...entries);
    }
    if (seldom.length) this.batched(seldom);
    for (const mesh of this.meshes) {
      // they move: what is in sight now is not then
      Object.assign(mesh, { frustumCulled: false }, this.look);
      this.root.add(mesh);
    }
    for (const entry of this.all) entry.mesh.setColorAt(entry.id, entry.colour);
    this.triangles = this.all.reduce((sum, { form }) => sum + form.index.count / 3, 0);
    return this.meshes;
  }

  /** Makes many of one form. */
  instanced(form, entries) {
    const mesh = new InstancedMesh(form, this.material, entries.length);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.boundingSphere = EVERYWHERE;
    entries.forEach((entry, k) => Object.assign(entry, { mesh, id: k }));
    mesh.userData.owners = entries.map((entry) => entry.owner);
    this.meshes.push(mesh);
  }

  /** Makes a few each of many forms. */
  batched(entries) {
    const forms = new Set(entries.map((entry) => entry.form));
    let [corners, indices] = [0, 0];
    for (const form of forms) {
      corners += form.attributes.position.count;
      indices += form.index.count;
    }
    const mesh = new BatchedMesh(entries.length, corners, indices, this.material);
    const ids = new Map();
    for (const form of forms) ids.set(form, mesh.addGeometry(form));
    mesh.userData.owners = [];
    for (const entry of entries) {
      Object.assign(entry, { mesh, id: mesh.addInstance(ids.get(entry.form)) });
      mesh.userData.owners[entry.id] = entry.owner;
    }
    Object.assign(mesh, { perObjectFrustumCulled: false, sortObjects: false });
    this.meshes.push(mesh);
  }

  /** Places an entry by the matrix of what moves it. */
  place(entry, matrix) {
    if (entry.local) entry.matrix.multiplyMatrices(matrix, entry.local);
    else entry.matrix.copy(matrix);
    this.draw(entry);
  }

  draw(entry) {
    entry.mesh.setMatrixAt(entry.id, entry.visible ? entry.matrix : NOWHERE);
    if (entry.mesh.isInstancedMesh) entry.mesh.instanceMatrix.needsUpdate = true;
  }

  show(entry, visible) {
    if (entry.visible === visible) return;
    entry.visible = visible;
    this.draw(entry);
  }

  /** Colours what belongs to an element; `owns`: whether an owner does. */
  highlight(owns) {
    for (const entry of this.all) {
      const chosen = owns(entry.owner);
      if (Boolean(entry.chosen) === chosen) continue;
      entry.chosen = chosen;
      entry.mesh.setColorAt(entry.id, chosen ? entry.colour.clone().lerp(CHOSEN, SHARE) : entry.colour);
      if (entry.mesh.isInstancedMesh) entry.mesh.instanceColor.needsUpdate = true;
    }
  }
}

/** Returns the owner of what a ray has hit. */
export function ownerOf({ object, batchId, instanceId }) {
  const { owners } = object.userData;
  return owners ? owners[batchId ?? instanceId] : object.userData;
}

/** Returns points of a form in the frame of its body, a few of many. */
export function points({ form, local }, most) {
  const { position } = form.attributes;
  const step = Math.max(1, Math.ceil(position.count / most));
  const all = [];
  for (let k = 0; k < position.count; k += step) {
    const p = new Vector3().fromBufferAttribute(position, k);
    all.push(local ? p.applyMatrix4(local) : p);
  }
  return all;
}

/** Returns the middle of a form in the frame of its body. */
export function middle({ form, local }) {
  if (!form.boundingBox) form.computeBoundingBox();
  const centre = form.boundingBox.getCenter(new Vector3());
  return local ? centre.applyMatrix4(local) : centre;
}

/** Returns the matrix of a place and a turn. */
export const rigid = (position, turn) => new Matrix4().compose(position, turn, ONE);
