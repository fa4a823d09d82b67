'use strict';
// Force over travel while a solve runs: one curve for each solve of the run.
const svg = (tag, attributes = {}, ...children) => {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
};
const QUANTITIES = { t: ['path parameter t', ''], travel: ['travel', 'mm'], force: ['force', 'N'], angle: ['angle', '\u00b0'], torque: ['torque', 'N mm'], largest: ['largest displacement', 'mm'] };
const CURVES = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9'];

const niceTicks = (a, b, n) => {
  const raw = (b - a) / n, power = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].map(m => m * power).find(s => s >= raw * 0.999), out = [];
  for (let v = Math.ceil(a / step - 1e-9) * step; v <= b + 1e-9 * step; v += step) out.push(Math.abs(v) < 1e-9 * step ? 0 : v);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return out.map(v => ({ v, text: digits > 6 || Math.abs(b) >= 1e6 ? v.toPrecision(3) : v.toFixed(digits).replace('-', '\u2212') }));
};

class ProgressChart {
  constructor(place) {
    this.x = h('select', { id: 'chart-x', onchange: () => { this.chosen = true; this.draw(); } });
    this.y = h('select', { id: 'chart-y', onchange: () => { this.chosen = true; this.draw(); } });
    this.picture = h('div');
    this.tools = h('div', { class: 'chart-tools' }, h('label', {}, 'upwards ', this.y), h('label', {}, 'across ', this.x));
    this.says = h('p', { class: 'soft', 'aria-live': 'off' });
    place.append(this.tools, this.picture, this.says);
    this.clear();
  }
  clear() {
    this.series = {};
    this.chosen = false;
    this.tools.hidden = true;
    this.picture.replaceChildren();
    this.says.textContent = '';
  }
  show(series) {
    if (JSON.stringify(series) === JSON.stringify(this.series)) return;
    this.series = series;
    const all = Object.values(series);
    if (!all.length) return this.clear();
    const moves = key => all.some(s => s[key].some(v => Math.abs(v) > 1e-12));
    const keys = Object.keys(QUANTITIES).filter(k => k === 't' || moves(k));
    const options = (select, value) => { select.replaceChildren(...keys.map(k => h('option', { value: k }, QUANTITIES[k][0]))); select.value = value; };
    let [x, y] = [this.x.value, this.y.value];
    if (!this.chosen || !keys.includes(x) || !keys.includes(y)) {
      const still = all.every(s => s.travel.length < 2 || Math.abs(s.travel[s.travel.length - 1] - s.travel[s.travel.length >> 1]) < 1e-9 * Math.abs(s.travel[0] || 1));
      [x, y] = moves('torque') ? ['angle', 'torque'] : moves('force') && !still ? ['travel', 'force'] : ['t', moves('largest') ? 'largest' : 'force'];
    }
    options(this.x, x);
    options(this.y, y);
    this.tools.hidden = false;
    this.draw();
  }
  draw() {
    const X = this.x.value, Y = this.y.value, curves = Object.entries(this.series).map(([name, s]) => ({ name, points: [[0, 0], ...s[X].map((v, i) => [v, s[Y][i]])] }));
    const W = 620, H = 300, left = 64, right = 14, top = 12, bottom = 44, all = curves.flatMap(c => c.points);
    const span = k => { let a = Math.min(...all.map(p => p[k])), b = Math.max(...all.map(p => p[k])); if (b - a < 1e-300) b = a + 1; return [a, b + 0.04 * (b - a)]; };
    const [[x0, x1], [y0, y1]] = [span(0), span(1)], px = v => left + (v - x0) / (x1 - x0) * (W - left - right), py = v => H - bottom - (v - y0) / (y1 - y0) * (H - top - bottom);
    const named = k => QUANTITIES[k][1] ? `${QUANTITIES[k][0]} (${QUANTITIES[k][1]})` : QUANTITIES[k][0];
    const last = curves[0].points[curves[0].points.length - 1];
    const picture = svg('svg', { viewBox: `0 0 ${W} ${H}`, role: 'img', 'aria-label': `${named(Y)} over ${named(X)}: ${curves[0].points.length - 1} steps, the last at ${+last[0].toPrecision(4)}, ${+last[1].toPrecision(4)}` });
    for (const t of niceTicks(x0, x1, 6)) picture.append(svg('line', { class: 'rule', x1: px(t.v), x2: px(t.v), y1: top, y2: H - bottom }), svg('text', { x: px(t.v), y: H - bottom + 17, 'text-anchor': 'middle' }, t.text));
    for (const t of niceTicks(y0, y1, 5)) picture.append(svg('line', { class: 'rule', x1: left, x2: W - right, y1: py(t.v), y2: py(t.v) }), svg('text', { x: left - 7, y: py(t.v) + 4, 'text-anchor': 'end' }, t.text));
    picture.append(svg('path', { class: 'axis', d: `M${left},${top}V${H - bottom}H${W - right}` }), svg('text', { x: (left + W - right) / 2, y: H - 8, 'text-anchor': 'middle' }, named(X)),
      svg('text', { transform: `translate(15,${(top + H - bottom) / 2}) rotate(-90)`, 'text-anchor': 'middle' }, named(Y)));
    curves.forEach((c, i) => {
      const colour = i === 0 && dark() ? '#58a6ff' : CURVES[i % CURVES.length];
      picture.append(svg('path', { d: 'M' + c.points.map(p => `${px(p[0]).toFixed(1)},${py(p[1]).toFixed(1)}`).join('L'), fill: 'none', stroke: colour, 'stroke-width': 2 }));
      c.points.slice(1).forEach(p => picture.append(svg('circle', { cx: px(p[0]).toFixed(1), cy: py(p[1]).toFixed(1), r: 2.6, fill: colour })));
    });
    this.picture.replaceChildren(picture);
    this.says.textContent = curves.length > 1 ? `${curves.length} solves: ${curves.map(c => c.name).join(', ')}` : '';
  }
}
