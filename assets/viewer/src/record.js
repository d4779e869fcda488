// Pictures and films of what the stage shows: the mechanism, the directions, dimensions, names and the time.

/** Pictures of a film in a second, and its bits in a second. */
const [RATE, BITS] = [30, 8e6];
const KINDS = ['video/mp4;codecs=avc1.42E01F', 'video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'];

/** Offers bytes to be saved under a name. */
export function save(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

/** Returns the kind of film that this browser makes; `undefined`: it makes none. */
export function filmKind() {
  const can = window.MediaRecorder && HTMLCanvasElement.prototype.captureStream;
  return can ? KINDS.find((kind) => MediaRecorder.isTypeSupported(kind)) : undefined;
}

/** Makes a canvas for pictures of the stage; films want even sizes. */
export function sheet(stage) {
  const { width, height } = stage.canvas;
  const made = document.createElement('canvas');
  [made.width, made.height] = [width, height].map((x) => Math.max(2 * Math.floor(x / 2), 2));
  return made;
}

/** Draws the stage on a canvas: words stand where those of the page do. */
export function compose(canvas, stage, compass, words) {
  const ctx = canvas.getContext('2d');
  const scale = canvas.width / stage.container.clientWidth;
  ctx.setTransform(1, 0, 0, 1, 0, 0);
  const behind = ctx.createLinearGradient(0, 0, 0, canvas.height);
  behind.addColorStop(0, '#fbfcfd');
  behind.addColorStop(1, '#dde4eb');
  ctx.fillStyle = behind;
  ctx.fillRect(0, 0, canvas.width, canvas.height);
  ctx.drawImage(stage.canvas, 0, 0);
  ctx.setTransform(scale, 0, 0, scale, 0, 0);
  const size = compass.canvas.clientWidth;
  ctx.drawImage(compass.canvas, 0, stage.container.clientHeight - size, size, size);
  ctx.font = '12px system-ui, sans-serif';
  ctx.textBaseline = 'middle';
  const edge = stage.container.getBoundingClientRect();
  for (const label of stage.container.querySelectorAll('#names:not(.hidden) div, #dimensions div')) {
    if (label.style.display === 'none') continue;
    const { left, top, width, height } = label.getBoundingClientRect();
    const [x, y] = [left - edge.left, top - edge.top];
    ctx.fillStyle = '#ffffffd8';
    ctx.fillRect(x, y, width, height);
    ctx.fillStyle = getComputedStyle(label).color;
    ctx.textAlign = 'center';
    ctx.fillText(label.textContent, x + width / 2, y + height / 2);
  }
  ctx.fillStyle = '#22262c';
  ctx.textAlign = 'left';
  words.forEach((word, k) => ctx.fillText(word, 12, 16 + 17 * k));
}

/** A film of the stage while it plays. */
export class Film {
  constructor(canvas, kind, done) {
    this.canvas = canvas;
    const recorder = new MediaRecorder(canvas.captureStream(RATE), { mimeType: kind, videoBitsPerSecond: BITS });
    const parts = [];
    recorder.ondataavailable = (event) => event.data.size && parts.push(event.data);
    recorder.onstop = () => done(new Blob(parts, { type: kind.split(';')[0] }), kind.startsWith('video/mp4') ? 'mp4' : 'webm');
    recorder.start(1000);
    this.recorder = recorder;
  }

  /** Ends it, after the last picture was taken. */
  end() {
    setTimeout(() => this.recorder.state !== 'inactive' && this.recorder.stop(), 2000 / RATE);
  }
}
