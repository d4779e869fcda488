// The page that moves: time, controls, and what follows them.

import css from './style.css';
import uplotCss from 'uplot/dist/uPlot.min.css';
import { Vector3 } from 'three';
import { Compass } from './compass.js';
import { digits, readData, rowAt } from './data.js';
import { Panels } from './panels.js';
import { Plots } from './plots.js';
import { Film, compose, filmKind, save, sheet } from './record.js';
import { Stage } from './stage.js';

const icon = (path) => `<svg viewBox="0 0 12 12" width="12" height="12" fill="currentColor"><path d="${path}"/></svg>`;
const PLAY = icon('M3 1.5 10 6 3 10.5z');
const PAUSE = icon('M3 2h2.2v8H3zM6.8 2H9v8H6.8z');

const PAGE = `
<div id="top"><div id="title"><b></b><span></span></div><div id="tools"></div></div>
<div id="stage">
  <div id="names"></div><div id="dimensions"></div><div id="tip"></div>
  <div id="without" class="hidden"></div>
  <label id="scale"><span id="rate"></span><span></span><input type="range" min="-1" max="1" step="0.05" value="0" title="Length of arrows"></label>
</div>
<div id="plots"></div>
<div id="bar">
  <button id="back" title="One output back (←)">${icon('M9 2 4 6l5 4zM2.5 2h1v8h-1z')}</button>
  <button id="play" title="Play or pause (space)"></button>
  <button id="forth" title="One output on (→)">${icon('M3 2l5 4-5 4zM8.5 2h1v8h-1z')}</button>
  <input id="slider" type="range" min="0" value="0" title="Time"><span id="clock"></span>
  <select id="speed" title="Speed against real time"></select>
  <button id="loop" class="on" title="Begin anew at the end">${icon('M6 2a4 4 0 1 0 3.9 3h-1.1A3 3 0 1 1 6 3v1.5L9 2.5 6 .5z')}</button>
</div>
<div id="side"><div id="tabs"></div><div id="tree"></div><div id="runs" class="hidden"></div><div id="log" class="hidden"></div><div id="values"></div></div>`;

const SPEEDS = [1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 1000, 10000];
/** Pictures in a second below which less is drawn. */
const SLOW = 12;
/** Time that a run takes on the page when real time is much shorter or longer, in s. */
const USUAL_DURATION = 6;

const byId = (id) => document.getElementById(id);

/** Says in the middle of the screen why the page is not what it should be. */
function fail(error) {
  const box = byId('failure');
  box.hidden = false;
  box.textContent = `This page could not be shown: ${error?.message ?? error}`;
  const advice = document.createElement('p');
  advice.textContent = typeof DecompressionStream === 'undefined'
    ? 'This browser cannot unpack the page: Chrome 80, Firefox 113, Safari 16.4 and later ones can.'
    : 'Reload the page. If that does not help, another browser may show it, and cognate draw writes pictures without one.';
  box.append(advice);
  // what can be seen behind it may still be of use
  box.onclick = () => (box.hidden = true);
}
// an event without an error is a remark of the browser
window.addEventListener('error', (event) => event.error && fail(event.error));
window.addEventListener('unhandledrejection', (event) => fail(event.reason));

async function main() {
  const style = document.createElement('style');
  style.textContent = uplotCss + css;
  document.head.append(style);
  const data = await readData(byId('data').textContent);
  const app = document.createElement('div');
  app.id = 'app';
  app.innerHTML = PAGE;
  document.body.append(app);
  const [first] = data.runs;
  data.runs.slice(1).forEach((run, k) => {
    if (run.name === first.name) run.name += ` (${k + 2})`;
  });
  byId('title').querySelector('b').textContent = data.title || first.name;
  byId('title').querySelector('span').textContent = data.runs.map((r) => r.name).join(' and ');

  const stage = new Stage(byId('stage'), data);
  const compass = new Compass(byId('stage'), data);
  const without = (why) => {
    byId('without').textContent = why;
    byId('without').classList.toggle('hidden', !why);
  };
  if (!stage.renderer) without('No picture: this browser has no WebGL 2, or it is switched off. Curves and values are shown all the same.');
  stage.canvas.addEventListener('webglcontextlost', () => without('The graphics card has dropped the picture; it comes back when it can.'));
  stage.canvas.addEventListener('webglcontextrestored', () => {
    without('');
    draw();
  });
  const plots = new Plots(byId('plots'), data, (t) => seek(t));
  const panels = new Panels(data, plots, (id) => {
    stage.highlight(id);
    state.selected = id;
    draw();
  });
  // a run whose time stands still is shown by its rows
  const still = first.times.at(-1) === first.times[0];
  const clock = still ? Float64Array.from(first.times, (_, k) => k) : first.times;
  const [begin, end] = [clock[0], clock.at(-1)];
  const state = { t: begin, row: 0, playing: false, loop: true, speed: 1, names: false, follow: false, selected: null, measuring: null, film: null, rate: 0 };
  const real = still ? 1 : data.second;

  // --- time ---

  /** Shows a time; `row`: a row of that time, where several have it. */
  function at(t, row = rowAt(clock, t)) {
    state.t = t;
    state.row = row;
    const next = Math.min(row + 1, first.rows - 1);
    const gap = clock[next] - clock[row];
    const others = [];
    data.runs.forEach((run, r) => {
      if (r === 0) stage.place(0, row, next, gap > 0 ? Math.min((t - clock[row]) / gap, 1) : 0);
      else {
        const own = rowAt(run.times, t);
        const then = Math.min(own + 1, run.rows - 1);
        const span = run.times[then] - run.times[own];
        stage.place(r, own, then, span > 0 ? Math.min(Math.max((t - run.times[own]) / span, 0), 1) : 0);
        others.push(own);
      }
    });
    panels.at(row, others);
    plots.at(still ? first.times[row] : t);
    byId('slider').value = row;
    const kind = first.kinds.filter(([from]) => from <= row).at(-1)?.[1] ?? '';
    byId('clock').textContent = `${digits(first.times[row])} ${first.timeUnit} · ${row + 1}/${first.rows} ${kind}`;
    draw();
  }
  const seek = (t) => {
    pause();
    const row = rowAt(clock, t);
    const next = Math.min(row + 1, first.rows - 1);
    const nearest = clock[next] - t < t - clock[row] ? next : row;
    at(clock[nearest], nearest);
  };
  const toRow = (row) => {
    pause();
    const inside = Math.min(Math.max(row, 0), first.rows - 1);
    at(clock[inside], inside);
  };

  let before = null;
  // pictures since the frame rate was last told
  let [shown, since] = [0, 0];
  function counted(now) {
    shown += 1;
    if (now - since < 1000) return;
    if (since) state.rate = (1000 * shown) / (now - since);
    if (since && state.rate < SLOW) stage.lighten();
    byId('rate').textContent = since ? `${state.rate.toFixed(state.rate < 10 ? 1 : 0)} pictures/s` : '';
    [shown, since] = [0, now];
  }
  function frame(now) {
    if (!state.playing) return;
    counted(now);
    if (before !== null) {
      let t = state.t + ((now - before) / 1000) * (state.speed / real);
      if (t >= end) {
        if (state.loop && !state.film) t = begin;
        else {
          pause();
          t = end;
        }
      }
      at(t);
    }
    before = now;
    requestAnimationFrame(frame);
  }
  function play() {
    if (first.rows < 2) return;
    if (state.t >= end) at(begin);
    state.playing = true;
    before = null;
    [shown, since] = [0, 0];
    byId('play').innerHTML = PAUSE;
    requestAnimationFrame(frame);
  }
  function pause() {
    state.playing = false;
    byId('play').innerHTML = PLAY;
    byId('rate').textContent = '';
    // a film ends with its last picture
    requestAnimationFrame(() => requestAnimationFrame(endFilm));
  }

  // --- drawing ---

  let asked = false;
  function draw() {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      const body = data.bodies.findIndex((b) => b.id === state.selected);
      if (state.follow && body >= 0) {
        const target = stage.runs[0].bodies[body].position;
        stage.camera.position.add(target.clone().sub(stage.controls.target));
        stage.controls.target.copy(target);
        stage.camera.lookAt(target);
      }
      measured();
      stage.render();
      compass.draw(stage.camera);
      labels();
      if (state.film) compose(state.film.canvas, stage, compass, words());
    });
  }
  stage.onChange = draw;

  // --- pictures and films ---

  const words = () => [byId('title').querySelector('b').textContent, byId('clock').textContent];
  /** Returns what the stage shows as a picture. */
  function picture() {
    const canvas = sheet(stage);
    stage.render();
    compass.draw(stage.camera);
    compose(canvas, stage, compass, words());
    return new Promise((done) => canvas.toBlob(done, 'image/png'));
  }
  /** Plays once from the beginning and saves that as a film. */
  function film(kind, button) {
    at(begin, 0);
    const canvas = sheet(stage);
    compose(canvas, stage, compass, words());
    state.film = new Film(canvas, kind, (blob, ending) => {
      button.textContent = 'Film';
      button.classList.remove('on');
      save(blob, `${first.name}.${ending}`);
    });
    button.textContent = 'Stop film';
    button.classList.add('on');
    if (!state.playing) play();
  }
  function endFilm() {
    state.film?.end();
    state.film = null;
  }

  const names = data.bodies.map((body) => {
    const label = document.createElement('div');
    label.textContent = body.name;
    label.style.color = body.colour;
    if (!body.ground) byId('names').append(label);
    return label;
  });
  const middles = data.bodies.map((_, k) => stage.middleOf(k));
  function labels() {
    byId('names').classList.toggle('hidden', !state.names);
    if (!state.names) return;
    names.forEach((label, k) => {
      const group = stage.runs[0].bodies[k];
      const place = stage.onPage(middles[k].clone().applyQuaternion(group.quaternion).add(group.position));
      label.style.display = place ? '' : 'none';
      if (place) [label.style.left, label.style.top] = place.map((x) => `${x}px`);
    });
  }

  // --- dimensions ---

  function dimension(i, j) {
    const made = stage.addDimension(i, j);
    made.label = document.createElement('div');
    made.label.title = `MARKER/${i} – MARKER/${j}: click to remove`;
    made.label.onclick = () => {
      stage.removeDimension(made);
      made.label.remove();
      draw();
    };
    byId('dimensions').append(made.label);
    draw();
  }
  function measured() {
    for (const made of stage.dimensions) {
      const { middle, length } = stage.measured(made);
      made.label.textContent = `${digits(Number(length.toPrecision(5)))} ${data.unit ?? ''}`;
      const place = stage.onPage(middle);
      made.label.style.display = place ? '' : 'none';
      if (place) [made.label.style.left, made.label.style.top] = place.map((x) => `${x}px`);
    }
  }
  /** Takes the marker that is nearest to a click; with two of them there is a dimension. */
  function measureAt(x, y) {
    const number = stage.nearestMarker(x, y);
    if (number === null || state.measuring[0] === number) return;
    state.measuring.push(number);
    if (state.measuring.length < 2) return;
    dimension(...state.measuring);
    state.measuring = null;
    measure.classList.remove('on');
  }

  // --- controls ---

  const slider = byId('slider');
  slider.max = first.rows - 1;
  slider.oninput = () => toRow(Number(slider.value));
  byId('play').onclick = () => (state.playing ? pause() : play());
  byId('back').onclick = () => toRow(state.row - 1);
  byId('forth').onclick = () => toRow(state.row + 1);
  byId('loop').onclick = () => byId('loop').classList.toggle('on', (state.loop = !state.loop));
  const duration = (end - begin) * real;
  const wanted = duration >= 1.5 && duration <= 30 ? 1 : duration / USUAL_DURATION;
  state.speed = SPEEDS.reduce((best, s) => (Math.abs(Math.log(s / wanted)) < Math.abs(Math.log(best / wanted)) ? s : best), 1);
  byId('speed').append(...SPEEDS.filter((s) => s >= state.speed / 100 && s <= state.speed * 100).map((s) => new Option(`× ${s}`, s, s === 1, s === state.speed)));
  byId('speed').onchange = (event) => (state.speed = Number(event.target.value));

  let measure = null;
  const tool = (text, title, action, on) => {
    const button = document.createElement('button');
    Object.assign(button, { textContent: text, title });
    button.classList.toggle('on', Boolean(on));
    button.onclick = () => {
      const now = action();
      if (typeof now === 'boolean') button.classList.toggle('on', now);
      at(state.t, state.row);
    };
    byId('tools').append(button);
    return button;
  };
  const option = (name) => () => (stage.options[name] = !stage.options[name]);
  const { up } = stage;
  const view = (eye, upward) => () => stage.look(eye.clone(), upward.clone());
  const side = up.clone().cross(stage.eye).normalize();
  const front = side.clone().cross(up).normalize();
  const slanted = front.clone().addScaledVector(side, 0.75).addScaledVector(up, 0.55).normalize();
  tool('3D', 'Look from the side and from above', view(slanted, up));
  for (const [name, x, y, z] of [['X', 1, 0, 0], ['Y', 0, -1, 0], ['Z', 0, 0, 1]]) {
    const eye = new Vector3(x, y, z);
    // upwards as before, unless that is where the eye is
    const upward = Math.abs(eye.dot(up)) < 0.9 ? up.clone().addScaledVector(eye, -eye.dot(up)).normalize() : new Vector3(0, z ? 1 : 0, z ? 0 : 1);
    tool(name, `Look along ${name} of ground`, view(eye, upward));
  }
  tool('Fit', 'See all of it', () => stage.fit());
  let flat = false;
  tool('Parallel', 'Look without perspective', () => {
    flat = !flat;
    stage.flatten(flat);
    return flat;
  });
  const has = (reaction) => data.arrows.some((a) => a.reaction === reaction);
  if (has(false)) tool('Forces', 'Arrows of forces (red) and torques (purple)', option('forces'), true);
  if (has(true)) tool('Reactions', 'Arrows of what joints transmit', option('reactions'), false);
  if (data.trails.length) tool('Paths', 'Paths of the markers that requests ask for', option('trails'), true);
  // markers are seen only while symbols of joints are not
  const choose = (shown, hidden) => () => {
    const { options } = stage;
    options[shown] = !options[shown];
    if (options[shown]) options[hidden] = false;
    for (const [kind, button] of Object.entries(symbols)) button.classList.toggle('on', options[kind]);
  };
  const symbols = { joints: tool('Joints', 'Symbols of joints', choose('joints', 'markers'), true) };
  if (data.actions.length) tool('Axes', 'Directions in which joints turn and slide', option('actions'), false);
  if (data.triads.length) {
    symbols.markers = tool('Markers', 'x (red), y (green) and z (blue) of markers, in the place of joints', choose('markers', 'joints'), false);
    measure = tool('Measure', 'A dimension: click two markers; click its value to remove it', () => {
      state.measuring = state.measuring ? null : [];
      if (state.measuring && !stage.options.markers) symbols.markers.click();
      return Boolean(state.measuring);
    });
  }
  tool('Names', 'Names of bodies', () => (state.names = !state.names));
  tool('Grid', 'Grid and shadows', () => (stage.grid.visible = !stage.grid.visible), true);
  if (data.runs.length > 1) tool('Second run', 'The second run, pale', () => (stage.runs[1].root.visible = !stage.runs[1].root.visible), true);
  tool('Follow', 'Keep the chosen body in the middle', () => (state.follow = !state.follow));
  if (stage.renderer) {
    tool('Picture', 'Save this view as a picture (PNG)', () => void picture().then((blob) => save(blob, `${first.name}.png`)));
    const kind = filmKind();
    if (kind && first.rows > 1) {
      const button = tool('Film', 'Play once and save that as a film', () => void (state.film ? pause() : film(kind, button)));
    }
  }
  tool('◨', 'Panel beside the picture', () => {
    byId('app').classList.toggle('narrow');
    resize();
  });
  byId('scale').querySelector('span:not(#rate)').textContent = data.unit ? `grid ${digits(stage.gridStep)} ${data.unit}` : `grid ${digits(stage.gridStep)}`;
  const scale = byId('scale').querySelector('input');
  scale.classList.toggle('hidden', !data.arrows.length);
  scale.oninput = () => {
    stage.arrowScale = 10 ** Number(scale.value);
    at(state.t, state.row);
  };

  const { canvas } = stage;
  const name = (hit) => {
    const body = data.bodies[hit.body];
    const element = panels.elements.get(hit.element);
    if (hit.element.startsWith('MARKER/')) return `${hit.element} · ${body.name}`;
    return hit.element === body.id || !element ? `${body.name} (${body.id})` : `${element.name} · ${element.kind} (${hit.element})`;
  };
  let pressed = null;
  canvas.addEventListener('pointerdown', (e) => (pressed = [e.clientX, e.clientY]));
  canvas.addEventListener('pointerup', (e) => {
    if (!pressed || Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) > 4) return;
    if (state.measuring) return measureAt(e.clientX, e.clientY);
    const hit = stage.pick(e.clientX, e.clientY);
    const id = hit && (panels.elements.has(hit.element) && !hit.element.startsWith('GRAPHICS') ? hit.element : data.bodies[hit.body].id);
    panels.select(id);
  });
  let pointed = null;
  canvas.addEventListener('pointermove', (e) => {
    // one look a picture is enough
    if (!pointed) requestAnimationFrame(() => point(pointed));
    pointed = e;
  });
  function point(e) {
    pointed = null;
    const hit = e.buttons || e.pointerType === 'touch' ? null : stage.pick(e.clientX, e.clientY);
    const tip = byId('tip');
    tip.style.display = hit ? 'block' : 'none';
    if (!hit) return;
    tip.textContent = name(hit);
    const { left, top } = byId('stage').getBoundingClientRect();
    [tip.style.left, tip.style.top] = [`${e.clientX - left + 14}px`, `${e.clientY - top + 10}px`];
  }
  window.addEventListener('keydown', (e) => {
    if (['INPUT', 'SELECT'].includes(e.target.tagName) && e.target.type !== 'range') return;
    const action = { ' ': () => (state.playing ? pause() : play()), ArrowLeft: () => toRow(state.row - 1), ArrowRight: () => toRow(state.row + 1), Home: () => toRow(0), End: () => toRow(first.rows - 1) }[e.key];
    if (!action) return;
    e.preventDefault();
    action();
  });
  let touched = false;
  stage.controls.addEventListener('start', () => (touched = true));
  function resize() {
    stage.resize();
    plots.resize();
    // until somebody moves the eye, all of it is seen
    if (!touched) stage.fit();
    draw();
  }
  plots.onResize = panels.onPlots = resize;
  window.addEventListener('resize', resize);
  // legends below the plots take room when they are filled
  new ResizeObserver(resize).observe(byId('stage'));

  for (const [i, j] of data.dimensions) dimension(i, j);
  pause();
  stage.resize();
  stage.look(stage.eye, stage.up);
  at(begin, 0);
  // for tests, and for whoever drives the page by a script
  window.cognate = {
    data, state, play, pause, toRow, seek,
    value: (column) => first.value(first.channels.findIndex((c) => c.name === column))[state.row],
    select: (id) => panels.select(id),
    dimension,
    dimensions: () => stage.dimensions.map((made) => stage.measured(made).length),
    draw: () => stage.render(),
    picture,
  };
  byId('failure').hidden = true;
  document.body.dataset.ready = 'yes';
}

main().catch(fail);
