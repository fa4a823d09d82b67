'use strict';
L.table = table => {
  const head = L.el('tr', {}, ...table.columns.map(c => L.el('th', {}, c.name, L.el('small', {}, L.unit(c.unit) || '\u00a0'))));
  const rows = table.rows.map(row => L.el('tr', {}, ...row.map(v => typeof v === 'string' ? L.el('td', { class: 'word' }, v) : L.el('td', {}, L.number(v, 5)))));
  return L.el('div', { class: 'scroll' }, L.el('table', {}, L.el('thead', {}, head), L.el('tbody', {}, ...rows)));
};
