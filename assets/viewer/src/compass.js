// The directions of ground and of gravity, in the lower left corner of the picture.

import { Quaternion, Vector3 } from 'three';

const AXES = [['X', new Vector3(1, 0, 0), '#cc3e34'], ['Y', new Vector3(0, 1, 0), '#2e8a40'], ['Z', new Vector3(0, 0, 1), '#3662c4']];
const GRAVITY = '#30363d';
/** Length of an arrow and place of its foot from the corner, in px. */
const [LENGTH, FOOT] = [30, 50];

/** Draws them on a canvas of its own above the picture. */
export class Compass {
  constructor(container, data) {
    this.container = container;
    const { gravity } = data.view;
    this.arrows = AXES.map(([name, along, colour]) => ({ name, along, colour }));
    const strength = Math.hypot(...gravity);
    if (strength > 0) this.arrows.push({ name: 'g', along: new Vector3(...gravity).divideScalar(strength), colour: GRAVITY, dashed: true });
    this.canvas = document.createElement('canvas');
    this.canvas.id = 'compass';
    container.append(this.canvas);
  }

  /** Draws the arrows as a camera sees them. */
  draw(camera) {
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const side = 2 * FOOT;
    const { canvas } = this;
    if (canvas.width !== side * scale) {
      [canvas.width, canvas.height] = [side * scale, side * scale];
      [canvas.style.width, canvas.style.height] = [`${side}px`, `${side}px`];
    }
    const ctx = canvas.getContext('2d');
    ctx.setTransform(scale, 0, 0, scale, 0, 0);
    ctx.clearRect(0, 0, side, side);
    const seen = new Quaternion().copy(camera.quaternion).invert();
    const all = this.arrows.map((arrow) => ({ ...arrow, at: arrow.along.clone().applyQuaternion(seen) }));
    // what points at the eye is drawn last
    all.sort((a, b) => a.at.z - b.at.z);
    for (const arrow of all) this.arrow(ctx, arrow);
  }

  arrow(ctx, { name, at, colour, dashed }) {
    const length = dashed ? 0.8 * LENGTH : LENGTH;
    const [x, y] = [FOOT + length * at.x, FOOT - length * at.y];
    const flat = Math.hypot(at.x, at.y);
    Object.assign(ctx, { strokeStyle: colour, fillStyle: colour, lineWidth: dashed ? 1.6 : 2.2, lineCap: 'round' });
    ctx.setLineDash(dashed ? [3, 3] : []);
    ctx.beginPath();
    ctx.moveTo(FOOT, FOOT);
    ctx.lineTo(x, y);
    ctx.stroke();
    ctx.setLineDash([]);
    ctx.beginPath();
    if (flat < 0.2) {
      // along the line of sight: a point towards the eye, a ring away from it
      ctx.arc(x, y, 3.2, 0, 7);
      if (at.z > 0) ctx.fill();
      else ctx.stroke();
    } else {
      const [u, v] = [at.x / flat, -at.y / flat];
      ctx.moveTo(x + 5 * u, y + 5 * v);
      ctx.lineTo(x - 3 * u - 3.6 * v, y - 3 * v + 3.6 * u);
      ctx.lineTo(x - 3 * u + 3.6 * v, y - 3 * v - 3.6 * u);
      ctx.fill();
    }
    Object.assign(ctx, { font: '600 11px sans-serif', textAlign: 'center', textBaseline: 'middle' });
    // gravity often lies along an axis: its letter stands beside it
    const [u, v] = flat < 0.2 ? [0.7, 0.7] : [at.x / flat, -at.y / flat];
    const [side, away] = dashed ? [10, 4] : [0, 13];
    ctx.fillText(name, x + away * u - side * v, y + away * v + side * u);
  }
}
