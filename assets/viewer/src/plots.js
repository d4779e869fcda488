// Curves of channels over time, with a line at the cursor.

import uPlot from 'uplot';

const COLOURS = ['#005ea2', '#d55e00', '#008a62', '#aa3377', '#c98a00', '#56aade', '#5a3c96', '#787878'];
/** Most plots and most curves of one that are shown when nobody chooses. */
const PLOTS = 3;
const CURVES = 5;
/** Height of a plot as a part of that of the page, with its bounds in px. */
const [SHARE, LOWEST, HIGHEST] = [0.21, 96, 168];

const height = () => Math.round(Math.min(Math.max(SHARE * window.innerHeight, LOWEST), HIGHEST));

export class Plots {
  constructor(container, data, seek) {
    this.container = container;
    this.data = data;
    this.seek = seek;
    this.groups = [];
    this.charts = [];
    for (const channel of data.runs[0].channels.filter((c) => c.table)) this.offer(channel);
    this.draw();
  }

  /** Takes a channel into the plot of its unit, while there is room. */
  offer(channel) {
    const group = this.groups.find((g) => g.unit === channel.unit);
    if (group) {
      if (group.names.length < CURVES) group.names.push(channel.name);
    } else if (this.groups.length < PLOTS) {
      this.groups.push({ unit: channel.unit, names: [channel.name] });
    }
  }

  shows(name) {
    return this.groups.some((g) => g.names.includes(name));
  }

  /** Shows a channel, or no longer. */
  toggle(name, unit) {
    const group = this.groups.find((g) => g.names.includes(name));
    if (group) {
      group.names = group.names.filter((n) => n !== name);
      this.groups = this.groups.filter((g) => g.names.length);
    } else {
      const own = this.groups.find((g) => g.unit === unit);
      if (own) own.names.push(name);
      else this.groups.push({ unit, names: [name] });
    }
    this.draw();
  }

  draw() {
    for (const chart of this.charts) chart.destroy();
    this.container.replaceChildren();
    this.container.style.setProperty('--plots', Math.max(this.groups.length, 1));
    this.charts = this.groups.map((group) => this.chart(group));
  }

  chart(group) {
    const box = document.createElement('div');
    box.className = 'plot';
    const close = document.createElement('button');
    close.textContent = '×';
    close.title = 'Close this plot';
    close.onclick = () => {
      this.groups = this.groups.filter((g) => g !== group);
      this.draw();
      this.onResize?.();
    };
    box.append(close);
    this.container.append(box);
    const tables = [];
    const series = [{ label: this.data.runs[0].timeUnit ? `time [${this.data.runs[0].timeUnit}]` : 'time' }];
    this.data.runs.forEach((run, r) => {
      const known = group.names.map((name) => run.channels.findIndex((c) => c.name === name)).filter((k) => k >= 0);
      if (!known.length) return;
      tables.push([increasing(run.times), ...known.map((k) => Array.from(run.value(k), (x) => (Number.isNaN(x) ? null : x)))]);
      for (const k of known) {
        const { name } = run.channels[k];
        const colour = COLOURS[group.names.indexOf(name) % COLOURS.length];
        series.push({
          label: this.data.runs.length > 1 ? `${name} (${run.name})` : name,
          stroke: colour, width: r ? 1.2 : 1.6, dash: r ? [6, 4] : undefined, spanGaps: tables.length > 1, points: { show: run.rows < 3 },
          // a curve is where its values are, not at the nearest pixel
          pxAlign: 0,
        });
      }
    });
    const chart = new uPlot({
      width: Math.max(box.clientWidth, 120),
      height: height(),
      scales: { x: { time: false } },
      axes: [
        { size: 24, font: '11px sans-serif', grid: { stroke: '#e6e9ed' }, ticks: { size: 4 } },
        { size: 58, space: 22, font: '11px sans-serif', grid: { stroke: '#e6e9ed' }, ticks: { size: 4 }, label: group.unit || undefined, labelSize: 16, labelFont: '11px sans-serif' },
      ],
      cursor: { sync: { key: 'cognate' }, drag: { x: true, y: false } },
      legend: { show: true, live: false },
      series,
      hooks: { draw: [(u) => this.line(u)] },
    }, tables.length > 1 ? uPlot.join(tables) : tables[0] ?? [[]], box);
    chart.over.addEventListener('click', (event) => {
      const { left } = chart.over.getBoundingClientRect();
      this.seek(chart.posToVal(event.clientX - left, 'x'));
    });
    return chart;
  }

  /** Draws the line at the cursor. */
  line(u) {
    if (this.time === undefined) return;
    const x = Math.round(u.valToPos(this.time, 'x', true));
    const { left, top, width, height } = u.bbox;
    if (!(x >= left && x <= left + width)) return;
    u.ctx.save();
    u.ctx.setLineDash([]);
    u.ctx.strokeStyle = '#d0342c';
    u.ctx.lineWidth = Math.max(1, window.devicePixelRatio || 1);
    u.ctx.beginPath();
    u.ctx.moveTo(x, top);
    u.ctx.lineTo(x, top + height);
    u.ctx.stroke();
    u.ctx.restore();
  }

  at(time) {
    this.time = time;
    for (const chart of this.charts) chart.redraw(false, false);
  }

  resize() {
    for (const chart of this.charts) chart.setSize({ width: Math.max(chart.root.parentElement.clientWidth, 120), height: height() });
  }
}

/** Returns times that never go back: rows are counted where they do. */
function increasing(times) {
  const ordered = times.every((t, k) => k === 0 || t >= times[k - 1]);
  return Array.from(times, (t, k) => (ordered ? t : k));
}
