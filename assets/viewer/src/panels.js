// The panels beside the picture: elements with their values at the cursor, facts of the runs, the log.

import { digits, isOff } from './data.js';

const make = (tag, properties = {}, ...children) => {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children.filter((c) => c !== null && c !== undefined));
  return made;
};

export class Panels {
  constructor(data, plots, onSelect) {
    this.data = data;
    this.plots = plots;
    this.onSelect = onSelect;
    this.rows = new Map();
    this.elements = new Map();
    this.cells = [];
    this.row = 0;
    this.tree();
    // elements that do not act at all times
    this.switched = [...this.elements.values()].filter((element) => element.off);
    this.runs();
    this.log();
    this.tabs();
    this.show(null);
  }

  tabs() {
    const all = [['tree', 'Elements'], ['runs', 'Run'], ['log', 'Log']];
    const tabs = document.getElementById('tabs');
    const open = (name) => {
      for (const [other] of all) document.getElementById(other).classList.toggle('hidden', other !== name);
      document.getElementById('values').classList.toggle('hidden', name !== 'tree');
      [...tabs.children].forEach((button, k) => button.classList.toggle('on', all[k][0] === name));
    };
    const warnings = this.data.runs.reduce((n, run) => n + run.warnings.length, 0);
    for (const [name, title] of all) {
      if (name === 'log' && !this.data.runs.some((run) => run.log)) continue;
      const text = name === 'runs' && warnings ? `${title} (${warnings} ⚠)` : title;
      tabs.append(make('button', { textContent: text, onclick: () => open(name) }));
    }
    open('tree');
  }

  tree() {
    const box = document.getElementById('tree');
    const colour = new Map(this.data.bodies.map((b) => [b.id, b.colour]));
    const between = (e) => (e.between ? `${e.between[0]} – ${e.between[1]}` : '');
    box.append(make('div', { className: 'row', onclick: () => this.select(null) }, make('b', { textContent: 'Requests and other columns' })));
    for (const { title, elements } of this.data.tree) {
      const family = make('details', { open: elements.length <= 40 && title !== 'data' });
      family.append(make('summary', { textContent: title[0].toUpperCase() + title.slice(1) + ' ' }, make('small', { textContent: elements.length })));
      for (const element of elements) {
        const row = make('div', { className: 'row', title: element.id, onclick: () => this.select(element.id) });
        if (colour.has(element.id)) row.append(make('i', { style: `background:${colour.get(element.id)}` }));
        row.append(make('b', { textContent: element.name }), make('small', { textContent: [element.kind, between(element)].filter(Boolean).join(' · ') }));
        family.append(row);
        this.rows.set(element.id, row);
        this.elements.set(element.id, element);
      }
      box.append(family);
    }
  }

  select(id) {
    this.onSelect(id);
    this.show(id);
  }

  /** Shows an element and its values; `null`: the columns of the tables. */
  show(id) {
    for (const [other, row] of this.rows) row.classList.toggle('on', other === id);
    this.rows.get(id)?.scrollIntoView({ block: 'nearest' });
    const box = document.getElementById('values');
    box.replaceChildren();
    this.cells = [];
    this.state = null;
    this.shown = id;
    const element = this.elements.get(id);
    if (!element) {
      box.append(make('h3', { textContent: 'Values at the cursor' }));
      this.data.runs.forEach((run, r) => {
        const all = run.channels.map((c, k) => [c.name, k]).filter(([, k]) => run.channels[k].table);
        this.table(box, run, r, all, '');
      });
      if (!this.cells.length) box.append(make('div', { textContent: 'Choose an element above, or click it in the picture: its values are shown here.' }));
      return;
    }
    box.append(make('h3', { textContent: `${element.name} ` }));
    const what = [element.id, element.kind].filter(Boolean).join(' · ');
    box.append(make('div', { textContent: element.between ? `${what}: ${element.between[0]} – ${element.between[1]}` : what }));
    if (element.off) this.state = box.appendChild(make('div'));
    const number = Number(element.id.split('/')[1]);
    this.data.runs.forEach((run, r) => {
      const own = run.sets.filter((s) => s.number === number && (s.element === element.name || s.name === element.name || s.name.startsWith(`${element.name}_`)));
      for (const set of own) this.table(box, run, r, set.components, set.name);
    });
    if (element.statement) box.append(make('pre', { textContent: element.statement }));
    this.at(this.row, this.others ?? []);
  }

  table(box, run, r, components, name) {
    if (!components.length) return;
    const title = [name, this.data.runs.length > 1 ? run.name : ''].filter(Boolean).join(' · ');
    if (title) box.append(make('h4', { textContent: title }));
    const table = make('table');
    for (const [label, channel] of components) {
      const { name: full, unit } = run.channels[channel];
      const cell = make('td', { className: 'number' });
      const row = make('tr', { className: 'pick', title: 'Click to plot' }, make('td', { textContent: label }), cell, make('td', { className: 'unit', textContent: unit }));
      row.onclick = () => {
        this.plots.toggle(full, unit);
        this.mark();
        this.onPlots?.();
      };
      table.append(row);
      this.cells.push({ run, r, channel, cell, row, name: full });
    }
    box.append(table);
    this.mark();
    this.at(this.row, this.others ?? []);
  }

  mark() {
    for (const { row, name } of this.cells) row.classList.toggle('drawn', this.plots.shows(name));
  }

  /** Shows the values at a row of the first run, and at rows of the others. */
  at(row, others) {
    this.row = row;
    this.others = others;
    for (const element of this.switched) this.rows.get(element.id).classList.toggle('off', isOff(element, row));
    if (this.state) this.state.textContent = isOff(this.elements.get(this.shown), row) ? 'switched off now' : 'acts now; it is switched off at other times';
    for (const { run, r, channel, cell } of this.cells) {
      cell.textContent = digits(run.value(channel)[r ? others[r - 1] ?? 0 : row]);
    }
  }

  runs() {
    const box = document.getElementById('runs');
    for (const run of this.data.runs) {
      box.append(make('h3', { textContent: run.name }));
      const table = make('table');
      for (const [name, value] of run.facts) table.append(make('tr', {}, make('td', { textContent: name }), make('td', { textContent: value })));
      box.append(table);
      for (const warning of run.warnings) box.append(make('div', { className: 'warning', textContent: warning }));
      for (const { elements, depth, row } of run === this.data.runs[0] ? this.data.overlaps : []) {
        const text = `${elements.join(' and ')} overlap, deepest by ${digits(depth)} ${this.data.unit ?? ''} at ${digits(run.times[row])} ${run.timeUnit}`;
        box.append(make('div', { className: 'warning', textContent: text }));
      }
      if (run.leftOut) box.append(make('div', { className: 'warning', textContent: `${run.leftOut} further columns of this run are not on this page; they are in its tables.` }));
    }
  }

  log() {
    const box = document.getElementById('log');
    for (const run of this.data.runs.filter((r) => r.log)) box.append(make('h3', { textContent: run.name }), make('pre', { textContent: run.log }));
  }
}
