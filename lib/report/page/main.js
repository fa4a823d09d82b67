'use strict';
// Puts the page together from its data. What goes wrong is counted where tools can read it.
const errors = [];
const report = e => { errors.push(String(e.message || e.reason || e)); document.documentElement.dataset.errors = errors.join(' | '); };
addEventListener('error', report);
addEventListener('unhandledrejection', report);
document.documentElement.dataset.errors = '';

const data = JSON.parse(document.getElementById('data').textContent), main = document.getElementById('main');
const section = (id, title, ...children) => {
  if (!children.length) return;
  document.getElementById('nav').append(L.el('a', { href: '#' + id, onclick: `document.getElementById('${id}').scrollIntoView(); return false` }, title));
  main.append(L.el('section', { id }, L.el('h2', {}, title), ...children));
};
const grid = children => children.length ? [L.el('div', { class: 'grid' }, ...children)] : [];
const levels = { warning: '⚠ warning', note: 'note', good: '✓ good' };
const charts = group => data.charts.filter(c => c.group === group).map(L.chart);

{
  const order = ['warning', 'note', 'good'], sorted = data.verdicts.slice().sort((a, b) => order.indexOf(a.level) - order.indexOf(b.level));
  // what is said of several members in the same words stands once
  const alike = new Map(), key = v => v.level + v.text.replace(/[-\d.]+(e[-+]\d+)?/g, '#');
  sorted.forEach(v => alike.set(key(v), (alike.get(key(v)) || []).concat(v)));
  const line = v => L.el('div', { class: 'verdict ' + v.level }, L.el('b', {}, levels[v.level]), L.el('span', { class: 'of' }, v.of), L.el('span', {}, v.text));
  const rows = [...alike.values()].map(group => {
    if (group.length === 1) return line(group[0]);
    const same = group.every(v => v.text === group[0].text), row = line({ ...group[0], of: `${group.length} members` });
    if (!same) row.lastChild.replaceChildren(L.el('details', { class: 'plain' }, L.el('summary', {}, group[0].text + ' …'),
      ...group.map(v => L.el('div', {}, `${v.of}: ${v.text}`))));
    return row;
  });
  section('summary', 'Summary', ...(rows.length ? [L.el('div', { class: 'verdicts' }, ...rows)] : []));
}
if (data.bodies.length) {
  const place = L.el('div', { class: 'body' });
  section('body', 'Deformed body', place);
  try { L.bodyView(place, data.bodies); } catch (e) {
    place.replaceChildren(L.el('p', {}, 'The view of the body needs WebGL, which this browser does not offer: ' + e.message));
    document.documentElement.dataset.view = 'none: ' + e.message;
  }
}
section('fits', 'Fits', ...grid(charts('fits')));
section('curves', 'Curves', ...grid(charts('curves')));
section('sweep', 'Sweep', ...grid(data.polars.map(L.polar).concat(charts('sweep'))));
section('sensitivity', 'Sensitivity', ...grid(charts('sensitivity')));
const path = grid(charts('path'));
section('path', 'Path of the solver', ...(path.length ? [L.el('details', {}, L.el('summary', {}, 'what the solver wrote for every step'), ...path)] : []));
section('tables', 'Tables', ...data.tables.flatMap(t => [L.el('h3', {}, t.title), L.table(t)]));

const unknown = v => v === null ? '–' : v;
section('provenance', 'Timings and provenance', ...(data.origins.length ? [L.table({
  columns: ['file', 'stage', 'wall time', 'CPU time', 'made', 'host', 'version', 'content'].map((name, i) => ({ name, unit: i === 2 || i === 3 ? 's' : '' })),
  rows: data.origins.map(o => [o.label, o.stage, o.wall, o.cpu, o.made, o.host, o.version, o.content])
})] : []));
section('configs', 'Effective configs', ...data.origins.map(o => L.el('details', {},
  L.el('summary', {}, `${o.label}: ${o.stage}`), L.el('pre', {}, `# ${o.command}\n# ${o.libraries}\n${o.config}`))));
document.getElementById('footer').textContent = `Langer ${data.version}. Lengths in mm, forces in N, stresses in MPa, angles in degrees.`;
if (/^#\w+$/.test(location.hash) && document.getElementById(location.hash.slice(1))) document.getElementById(location.hash.slice(1)).scrollIntoView();
document.documentElement.dataset.ready = 'yes';
