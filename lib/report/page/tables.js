'use strict';
// Wider tables are printed in parts, each with the first column, so that letters stay as large as style.css has them on paper and no name or
// number is broken: between the margins of A4, in px.
const onPaper = 680, letters = 9.5, between = 9;
L.table = table => {
  const columns = table.columns.map((_, i) => i), title = table.title || 'table';
  const errorOf = table.columns.map(c => table.columns.findIndex(e => e.name === c.name + '_error' && e.unit === c.unit));
  const text = (v, i, row) => typeof v === 'string' ? v : errorOf[i] >= 0 ? L.rounded(v, row[errorOf[i]]) : /_error$/.test(table.columns[i].name) ? L.number(v, 2) : L.number(v, 5), units = table.columns.map(c => L.unit(c.unit));
  const part = some => L.el('table', { 'aria-label': title },
    L.el('thead', {}, L.el('tr', {}, ...some.map(i => L.el('th', { scope: 'col' }, table.columns[i].name, L.el('small', {}, units[i] || '\u00a0'))))),
    L.el('tbody', {}, ...table.rows.map(row => L.el('tr', {}, ...some.map(i => L.el('td', typeof row[i] === 'string' ? { class: 'word' } : {}, text(row[i], i, row)))))));
  const box = L.el('div', { class: 'scroll' }, part(columns));
  L.printed.push(() => {
    if (box.childElementCount > 1) return;
    const ruler = L.el('canvas', {}).getContext('2d');
    ruler.font = `600 ${letters}px ${getComputedStyle(document.body).fontFamily}`;
    const widths = columns.map(i => between + Math.max(...[table.columns[i].name, units[i], ...table.rows.map(row => text(row[i], i, row))].map(t => Math.min(ruler.measureText(t).width, onPaper / 3))));  // words may be broken
    const parts = [];
    let room = 0;
    for (const i of columns.slice(1)) {
      if (room < widths[i]) { parts.push([0]); room = onPaper - widths[0]; }
      parts[parts.length - 1].push(i);
      room -= widths[i];
    }
    if (parts.length < 2) return;
    box.classList.add('split');
    box.append(...parts.map(part));
  });
  return box;
};

// what is nearly 1 shows how nearly
L.correlation = v => (Math.abs(v) > 0.99 && Math.abs(v) < 1 - 1e-9 ? v.toFixed(3) : v.toFixed(2)).replace('-', '−');

// A matrix of correlations: blue for -1, red for 1, the number in each cell.
L.matrix = m => {
  const n = m.names.length, side = Math.min(58, 380 / n), left = 8 + 7.2 * Math.max(...m.names.map(w => w.length)), W = Math.max(440, left + n * side + 10), H = n * side + 16 + left;
  const svg = L.el('svg', { viewBox: `0 0 ${W} ${H}`, role: 'img' }), figure = L.el('figure', { class: 'chart matrix' });
  svg.setAttribute('aria-label', m.title);
  const colour = v => { const t = Math.min(1, Math.abs(v)), to = v < 0 ? [5, 48, 97] : [128, 0, 38]; return L.css([0, 1, 2].map(k => Math.round(247 + (to[k] - 247) * t))); };
  m.names.forEach((name, i) => {
    svg.append(L.el('text', { x: left - 6, y: 6 + (i + 0.5) * side + 4, 'text-anchor': 'end' }, name),
      L.el('text', { transform: `translate(${left + (i + 0.5) * side + 4} ${n * side + 14}) rotate(-60)`, 'text-anchor': 'end' }, name));
    m.values[i].forEach((v, j) => {
      const x = left + j * side, y = 6 + i * side, known = v !== null;
      svg.append(L.el('rect', { x, y, width: side, height: side, fill: known ? colour(v) : '#cccccc', class: 'cell' }));
      if (side > 24) svg.append(L.el('text', { x: x + side / 2, y: y + side / 2 + 4, 'text-anchor': 'middle', style: `fill:${known && Math.abs(v) > 0.55 ? '#fff' : '#1f2328'}` }, known ? L.correlation(v) : '–'));
    });
  });
  const csv = () => ['', ...m.names].join(',') + '\n' + m.names.map((name, i) => [name, ...m.values[i]].join(',')).join('\n') + '\n';
  figure.append(L.el('figcaption', {}, L.el('span', {}, m.title), L.el('span', { class: 'tools' }, ...L.savers(m.title, svg, csv))), svg);
  return figure;
};

// Values over a plane: blue above zero, red below, paler towards it; the logarithm keeps the ends from being all of one colour.
L.planeMap = m => {
  const n = m.at.length, S = 340, left = 62, top = 8, svg = L.el('svg', { viewBox: `0 0 ${S + left + 96} ${S + 58}`, role: 'img' });
  svg.setAttribute('aria-label', m.title);
  const flat = m.values.flat().filter(v => v !== null), most = Math.max(...flat.map(Math.abs)), size = S / n;
  const strength = v => Math.log1p(3 * Math.abs(v) / m.middle) / Math.log1p(3 * most / m.middle), part = (k, a) => L.css([0, 1, 2].map(i => Math.round(247 + (k[i] - 247) * a)));
  const colour = v => v === null ? '#999999' : part(v < 0 ? [150, 0, 30] : [5, 60, 120], 0.08 + 0.92 * strength(v));
  m.values.forEach((row, i) => row.forEach((v, j) => svg.append(L.el('rect', { x: left + j * size, y: top + (n - 1 - i) * size, width: size + 0.4, height: size + 0.4, fill: colour(v) }))));
  const ticks = L.ticks(m.at[0], m.at[n - 1], 5), words = L.tickTexts(ticks), place = t => (t - m.at[0]) / (m.at[n - 1] - m.at[0]) * (S - size) + size / 2;
  ticks.forEach((t, i) => svg.append(L.el('text', { x: left + place(t), y: top + S + 17, 'text-anchor': 'middle' }, words[i]), L.el('text', { x: left - 8, y: top + S - place(t) + 4, 'text-anchor': 'end' }, words[i])));
  svg.append(L.el('text', { x: left + S / 2, y: top + S + 40, 'text-anchor': 'middle' }, m.xLabel), L.el('text', { transform: `translate(14 ${top + S / 2}) rotate(-90)`, 'text-anchor': 'middle' }, m.yLabel));
  const low = Math.min(...flat), key = [most, m.middle, m.middle / 10, 0, ...(low < 0 ? [-m.middle / 10, low] : [])].filter((v, i, all) => all.indexOf(v) === i && v <= most);
  svg.append(L.el('text', { x: left + S + 12, y: top + 12 }, L.unit(m.unit)));
  key.forEach((v, i) => svg.append(L.el('rect', { x: left + S + 12, y: top + 22 + 24 * i, width: 18, height: 18, fill: colour(v) }), L.el('text', { x: left + S + 36, y: top + 36 + 24 * i }, L.number(v, 2))));
  svg.addEventListener('mousemove', event => {
    const r = svg.getBoundingClientRect(), k = (S + left + 96) / r.width, j = Math.floor(((event.clientX - r.left) * k - left) / size), i = n - 1 - Math.floor(((event.clientY - r.top) * k - top) / size);
    if (!m.values[i] || m.values[i][j] === undefined) return L.tip('');
    L.tip(`${m.xLabel} ${L.number(m.at[j], 3)}, ${m.yLabel} ${L.number(m.at[i], 3)}\n${m.label} ${L.number(m.values[i][j])} ${L.unit(m.unit)}`, event);
  });
  svg.addEventListener('mouseleave', () => L.tip(''));
  const csv = () => [m.xLabel, m.yLabel, `${m.label} ${m.unit}`].join(',') + '\n' + m.values.map((row, i) => row.map((v, j) => [m.at[j], m.at[i], v === null ? '' : v].join(',')).join('\n')).join('\n') + '\n';
  return L.el('figure', { class: 'chart' }, L.el('figcaption', {}, L.el('span', {}, `${m.title}; red: strong ellipticity lost`), L.el('span', { class: 'tools' }, ...L.savers(m.title, svg, csv))), svg);
};
