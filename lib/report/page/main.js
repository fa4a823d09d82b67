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
// Curves at the level of rounding say that something holds, not how anything goes: they stand in one folded place.
const roundingLevel = 1e-8;  // mm, N, MPa or of 1
const rounded = c => ['path', 'curves'].includes(c.group) && c.series.every(s => s.y.every(v => v === null || Math.abs(v) < roundingLevel));
const charts = group => data.charts.filter(c => c.group === group && !rounded(c)).map(L.chart);

// what was done and what came of it: sentence and facts of each member
const answers = data.answers.map(a => L.el('div', { class: 'answers' }, L.el('p', { class: 'big' }, a.sentence),
  L.el('dl', {}, ...a.facts.flatMap(f => [L.el('dt', {}, f.name), L.el('dd', {}, f.text)]))));
{
  const order = ['warning', 'note', 'good'], sorted = data.verdicts.slice().sort((a, b) => order.indexOf(a.level) - order.indexOf(b.level));
  // what is said of several members in the same words stands once
  const alike = new Map(), key = v => v.level + v.text.replace(/[-\d.]+(e[-+]\d+)?/g, '#');
  sorted.forEach(v => alike.set(key(v), (alike.get(key(v)) || []).concat(v)));
  // what holds is folded where there is much of it: it shall not stand before the picture
  const much = 3;
  const line = v => L.el('div', { class: 'verdict ' + v.level, role: 'listitem' }, L.el('b', {}, levels[v.level]), L.el('span', { class: 'of' }, v.of), L.el('span', {}, v.text));
  const rows = [...alike.values()].map(group => {
    if (group.length === 1) return line(group[0]);
    const same = group.every(v => v.text === group[0].text), row = line({ ...group[0], of: `${group.length} members` });
    if (!same) row.lastChild.replaceChildren(L.el('details', { class: 'plain' }, L.el('summary', {}, group[0].text + ' …'),
      ...group.map(v => L.el('div', {}, `${v.of}: ${v.text}`))));
    return row;
  });
  const most = 2, told = answers.length > most ? [...answers.slice(0, 1), L.el('details', {}, L.el('summary', {}, `${answers.length - 1} more members`), ...answers.slice(1))] : answers;
  const held = rows.filter(row => row.classList.contains('good'));
  if (held.length > much) {
    const place = rows.indexOf(held[0]), fold = L.el('details', { class: 'verdict good fold' }, L.el('summary', {}, L.el('b', {}, levels.good), ` ${held.length} checks hold`), ...held);
    rows.splice(place, held.length, fold);
  }
  const verdicts = rows.length ? L.el('div', { class: 'verdicts', role: 'list', 'aria-label': 'verdicts' }, ...rows) : '';
  if (told.length || rows.length)
    section('summary', 'Summary', L.el('div', { class: told.length ? 'first' : 'first wide' }, told.length ? L.el('div', {}, ...told) : '', verdicts));
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
section('identifiability', 'What the tests tell', ...grid([...charts('profiles'), ...data.matrices.map(L.matrix), ...data.maps.map(L.planeMap)]));
section('curves', 'Curves', ...grid(charts('curves')));
section('sweep', 'Sweep', ...grid(data.polars.map(L.polar).concat(charts('sweep'))));
section('sensitivity', 'Sensitivity', ...grid(charts('sensitivity')));
const path = grid(charts('path'));
section('path', 'Path of the solver', ...(path.length ? [L.el('details', {}, L.el('summary', {}, 'what the solver wrote for every step'), ...path)] : []));
{
  const small = data.charts.filter(rounded), most = c => Math.max(0, ...c.series.flatMap(s => s.y.map(v => Math.abs(v || 0))));
  if (small.length)
    section('rounding', 'At the level of rounding', L.el('details', {}, L.el('summary', {}, `${small.length} of the curves stay below 10⁻⁸: ${small.map(c => c.yLabel).join(', ')}`),
      L.table({ columns: [{ name: 'quantity', unit: '' }, { name: 'unit', unit: '' }, { name: 'at most', unit: '' }],
        rows: small.map(c => [c.yLabel, L.unit(c.yUnit) || '-', most(c)]) })));
}
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
