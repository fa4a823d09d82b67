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
  linked(id, title);
  main.append(L.el('section', { id }, L.el('h2', {}, title), ...children));
};
const linked = (id, title) => document.getElementById('nav').append(L.el('a', { href: '#' + id, onclick: `document.getElementById('${id}').scrollIntoView(); return false` }, title));
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
  // error bars of further quantities of one file: one note
  const bar = ' by mesh and increments', isBar = v => v.level === 'note' && v.text.endsWith(bar);
  for (const of of new Set(sorted.filter(isBar).map(v => v.of))) {
    const bars = sorted.filter(v => isBar(v) && v.of === of);
    bars.slice(1).forEach(v => sorted.splice(sorted.indexOf(v), 1));
    bars[0] = sorted[sorted.indexOf(bars[0])] = { ...bars[0], text: bars.map(v => v.text.slice(0, -bar.length)).join(', ') + bar };
  }
  // what is said of several members in the same words stands once
  const alike = new Map(), key = v => v.level + v.text.replace(/[-\d.]+(e[-+]\d+)?/g, '#');
  sorted.forEach(v => alike.set(key(v), (alike.get(key(v)) || []).concat(v)));
  // what holds is folded where there is much of it: it shall not stand before the picture
  const much = 3;
  const line = v => L.el('div', { class: 'verdict ' + v.level, role: 'listitem' }, L.el('b', {}, levels[v.level], ' ', L.el('span', { class: 'of' }, v.of)), L.el('span', {}, ...v.text.split('`').map((part, i) => i % 2 ? L.el('code', {}, part) : part)));
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
  // what the tests tell, at a glance: a small picture and a sentence, both lead to the large ones
  const glance = (svg, text) => {
    const copy = svg.cloneNode(true);
    copy.querySelectorAll('text, .here, .zoom').forEach(e => e.remove());
    copy.removeAttribute('tabindex');
    copy.setAttribute('aria-label', text);
    return L.el('a', { class: 'glance', href: '#identifiability', onclick: "document.getElementById('identifiability').scrollIntoView(); return false" }, copy, L.el('span', {}, text));
  };
  const svgOf = figure => figure.querySelector(':scope > svg');
  const glances = [], profiles = data.charts.filter(c => c.group === 'profiles');
  if (profiles.length) {
    const ends = c => { const s = c.series[0], most = (c.marks && c.marks[0] || { y: 3.84 }).y, within = s.x.filter((x, k) => x !== null && s.y[k] !== null && s.y[k] <= most); return [Math.min(...within), Math.max(...within)]; };
    const wide = c => { const [a, b] = ends(c); return (b - a) / (Math.abs(a + b) || 1); };
    const worst = profiles.slice().sort((a, b) => wide(b) - wide(a))[0], [a, b] = ends(worst);
    glances.push(glance(svgOf(L.chart(worst)), `least identifiable: ${worst.xLabel}, ${L.number(a, 3)} to ${L.number(b, 3)} ${L.unit(worst.xUnit)} at 95 %`));
  }
  for (const m of data.matrices.slice(0, 1)) {
    let best = null;
    m.values.forEach((row, i) => row.forEach((v, j) => { if (i < j && v !== null && (!best || Math.abs(v) > Math.abs(best.v))) best = { v, i, j }; }));
    if (best) glances.push(glance(svgOf(L.matrix(m)), `largest correlation: ${m.names[best.i]}, ${m.names[best.j]}: ${L.correlation(best.v)}`));
  }
  for (const m of data.maps.slice(0, 1)) {
    const all = m.values.flat().filter(v => v !== null), lost = all.filter(v => v < 0).length;
    glances.push(glance(svgOf(L.planeMap(m)), lost ? `not strongly elliptic in ${L.number(100 * lost / all.length, 2)} % of these stretches (red)` : 'strongly elliptic at all of these stretches'));
  }
  const looks = glances.length ? L.el('div', { class: 'glances' }, ...glances) : '';
  const verdicts = rows.length ? L.el('div', { class: 'verdicts', role: 'list', 'aria-label': 'verdicts' }, ...rows) : '';
  // the sentence with the body beside it, then what is to be known of it
  const place = L.el('div', { class: 'body' }), picture = data.bodies.length ? L.el('div', { class: 'picture', id: 'body' }, L.el('h2', {}, 'Deformed body'), place) : '';
  // where there is little to say beside the picture, the first curve that was asked for
  const asked = data.charts.find(c => c.group === 'curves' && !rounded(c)), few = 3;
  const curve = picture && asked && rows.length <= few ? [L.chart(asked)] : [];
  const beside = picture ? 'first' : 'first wide';
  if (told.length || rows.length || glances.length || picture)
    section('summary', 'Summary', L.el('div', { class: beside }, L.el('div', { class: 'told' }, ...told), picture, L.el('div', { class: 'known' }, verdicts, ...curve)), looks);
  if (picture) linked('body', 'Deformed body');
  if (picture) try { L.bodyView(place, data.bodies); } catch (e) {
    place.replaceChildren(L.el('p', {}, 'The view of the body needs WebGL, which this browser does not offer: ' + e.message));
    document.documentElement.dataset.view = 'none: ' + e.message;
  }
}
section('fits', 'Fits', ...grid(charts('fits')));
section('identifiability', 'Identifiability', ...grid([...charts('profiles'), ...data.matrices.map(L.matrix), ...data.maps.map(L.planeMap)]));
section('curves', 'Curves', ...grid(charts('curves')));
section('sweep', 'Sweep', ...grid(data.polars.map(L.polar).concat(charts('sweep'))));
section('sensitivity', 'Sensitivity', ...grid(charts('sensitivity')));
const path = grid(charts('path'));
section('path', 'Solver history', ...(path.length ? [L.el('details', {}, L.el('summary', {}, 'what the solver recorded at every step'), ...path)] : []));
{
  const small = data.charts.filter(rounded), most = c => Math.max(0, ...c.series.flatMap(s => s.y.map(v => Math.abs(v || 0))));
  if (small.length)
    section('rounding', 'Rounding errors', L.el('details', {}, L.el('summary', {}, `${small.length} of the curves stay below 10⁻⁸: ${small.map(c => c.yLabel).join(', ')}`),
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
