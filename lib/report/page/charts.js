'use strict';
// Curves and polar plots as SVG, with the values under the pointer.
// Colours that stay apart for colour-blind readers: eight for names (Okabe and Ito), viridis where the series have an order.
const L = {};
L.names = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#56b4e9', '#e69f00', '#000000', '#8c8c00'];
L.dashes = ['', '7 4', '2 3', '9 3 2 3'];
// knots of the two scales, sRGB
L.scales = {
  viridis: [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137], [53, 183, 121], [109, 205, 89],
    [180, 222, 44], [253, 231, 37]],
  cividis: [[0, 32, 77], [0, 48, 111], [58, 71, 108], [87, 93, 109], [112, 113, 115], [138, 134, 120], [167, 156, 117], [197, 180, 107],
    [227, 205, 91], [255, 234, 70]]
};
L.colour = (scale, t) => {
  const knots = L.scales[scale], x = Math.min(1, Math.max(0, t)) * (knots.length - 1), i = Math.min(knots.length - 2, Math.floor(x));
  return knots[i].map((c, k) => Math.round(c + (knots[i + 1][k] - c) * (x - i)));
};
L.css = c => `rgb(${c.join(',')})`;

L.number = (x, digits = 4) => {
  if (x === null || x === undefined || !isFinite(x)) return '–';
  if (x === 0) return '0';
  const a = Math.abs(x);
  const s = a >= 1e5 || a < 1e-3 ? x.toExponential(digits - 1) : String(+x.toPrecision(digits));
  return s.replace('e', ' e').replace(/-/g, '−');
};
L.unit = u => (!u || u === '-' ? '' : { deg: '°', percent: '%' }[u] || u.replace('1/', '1/'));
L.withUnit = (label, unit) => label + (L.unit(unit) ? ` (${L.unit(unit)})` : '');
L.ticks = (low, high, wished = 5) => {
  const raw = (high - low) / wished, power = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = [1, 2, 2.5, 5, 10].map(m => m * power).find(s => s >= raw * 0.999);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) ticks.push(+(i * step).toPrecision(12));
  return ticks;
};
// texts with as many digits as the steps need
L.tickTexts = ticks => {
  const most = Math.max(...ticks.map(Math.abs)), step = ticks.length > 1 ? ticks[1] - ticks[0] : most || 1;
  if (most >= 1e5 || (most > 0 && most < 1e-3)) {  // the first tick that is not zero says the power
    const power = Math.floor(Math.log10(most) + 1e-9), texts = L.tickTexts(ticks.map(t => t / 10 ** power));
    texts.power = power;
    return texts;
  }
  let digits = 0;
  while (digits < 8 && Math.abs(step * 10 ** digits - Math.round(step * 10 ** digits)) > 1e-6) ++digits;
  return ticks.map(t => t.toFixed(digits).replace(/-/g, '−'));
};

L.times = texts => texts.power === undefined ? '' : ` × 10${String(texts.power).replace(/./g, c => '⁰¹²³⁴⁵⁶⁷⁸⁹'[c] || '⁻')}`;

L.el = (name, attributes = {}, ...children) => {
  const svg = ['svg', 'g', 'path', 'line', 'text', 'circle', 'rect'].includes(name);
  const e = svg ? document.createElementNS('http://www.w3.org/2000/svg', name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
  for (const child of children) e.append(child);
  return e;
};
L.tip = (text, event) => {
  const tip = document.getElementById('tip');
  tip.hidden = !text;
  if (!text) return;
  tip.textContent = text;
  tip.style.left = Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8) + 'px';
  tip.style.top = Math.min(event.clientY + 14, innerHeight - tip.offsetHeight - 8) + 'px';
};

L.look = (chart, i) => {
  const n = chart.series.length;
  if (chart.ordered && n > 1) return { colour: L.css(L.colour('viridis', 0.92 * i / (n - 1))), dash: L.dashes[0] };
  // a law has the colour of the points it was fitted to
  const pair = chart.group === 'fits' ? Math.floor(i / 2) : i;
  return { colour: L.names[pair % 8], dash: L.dashes[Math.floor(pair / 8) % 4] };
};
L.legend = (chart, shown) => {
  if (chart.series.length < 2) return '';
  return L.el('div', { class: 'legend' }, ...chart.series.map((s, i) => {
    const look = L.look(chart, i), mark = L.el('svg', { viewBox: '0 0 24 10', style: 'width:24px' });
    mark.append(s.points ? L.el('circle', { cx: 12, cy: 5, r: 3.2, fill: 'none', stroke: look.colour, 'stroke-width': 1.6 })
      : L.el('line', { x1: 0, x2: 24, y1: 5, y2: 5, stroke: look.colour, 'stroke-width': 2.4, 'stroke-dasharray': look.dash }));
    const item = L.el('span', {}, mark, s.name);
    item.style.cursor = 'pointer';
    item.onclick = () => { shown[i] = !shown[i]; item.style.opacity = shown[i] ? 1 : 0.35; shown.draw(); };
    return item;
  }));
};

// a line with a band of its error about it
L.banded = s => s.error && s.error.length > 0 && s.error.length === s.x.length;

L.chart = chart => {
  const W = 600, H = 350, box = { l: 74, r: 14, t: 10, b: 50 };
  const figure = L.el('figure', { class: 'chart' }, L.el('figcaption', {}, chart.title));
  const shown = chart.series.map(() => true), svg = L.el('svg', { viewBox: `0 0 ${W} ${H}` });
  let points = [];
  shown.draw = () => {
    svg.replaceChildren();
    points = [];
    const all = chart.series.filter((s, i) => shown[i]);
    const xs = all.flatMap(s => s.x).filter(v => v !== null);
    const ys = all.flatMap(s => L.banded(s) ? s.y.flatMap((y, k) => [y - s.error[k], y + s.error[k]]) : s.y).filter(v => v !== null);
    if (!ys.length) return;
    const reach = values => {
      let low = values.reduce((a, b) => Math.min(a, b)), high = values.reduce((a, b) => Math.max(a, b));
      if (!(high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)))) { const half = Math.abs(low) * 0.1 || 0.5; low -= half; high += half; }
      return [low, high];
    };
    const [x0, x1] = reach(xs);
    let [y0, y1] = reach(ys);
    const room = 0.05 * (y1 - y0);
    if (y0 > 0 && y0 < 0.3 * y1) y0 = 0; else if (y0 !== 0) y0 -= room;
    if (y1 < 0 && y1 > 0.3 * y0) y1 = 0; else if (y1 !== 0) y1 += room;
    const px = x => box.l + (x - x0) / (x1 - x0) * (W - box.l - box.r), py = y => H - box.b - (y - y0) / (y1 - y0) * (H - box.t - box.b);
    const xt = L.ticks(x0, x1, 6), yt = L.ticks(y0, y1), xw = L.tickTexts(xt), yw = L.tickTexts(yt);
    yt.forEach((y, i) => svg.append(L.el('line', { x1: box.l, x2: W - box.r, y1: py(y), y2: py(y), stroke: y === 0 ? '#9aa4ae' : '#e4e8ec' }),
      L.el('text', { x: box.l - 8, y: py(y) + 4, 'text-anchor': 'end' }, yw[i])));
    xt.forEach((x, i) => svg.append(L.el('line', { x1: px(x), x2: px(x), y1: H - box.b, y2: H - box.b + 5, stroke: '#59636e' }),
      L.el('text', { x: px(x), y: H - box.b + 19, 'text-anchor': 'middle' }, xw[i])));
    svg.append(L.el('path', { d: `M${box.l} ${box.t}V${H - box.b}H${W - box.r}`, fill: 'none', stroke: '#59636e' }),
      L.el('text', { x: (box.l + W - box.r) / 2, y: H - 10, 'text-anchor': 'middle' }, L.withUnit(chart.xLabel, chart.xUnit) + L.times(xw)),
      L.el('text', { transform: `translate(16 ${(box.t + H - box.b) / 2}) rotate(-90)`, 'text-anchor': 'middle' },
        (chart.yLabel.length > 38 ? L.unit(chart.yUnit) : L.withUnit(chart.yLabel, chart.yUnit)) + L.times(yw)));  // the title says it
    chart.series.forEach((s, i) => {
      if (!shown[i]) return;
      const look = L.look(chart, i);
      if (L.banded(s)) {
        const ends = sign => s.x.map((x, k) => `${px(x).toFixed(1)} ${py(s.y[k] + sign * s.error[k]).toFixed(1)}`);
        svg.append(L.el('path', { d: 'M' + [...ends(1), ...ends(-1).reverse()].join('L') + 'Z', fill: look.colour, 'fill-opacity': 0.18, class: 'band' }));
      }
      let d = '', pen = false;
      s.x.forEach((x, k) => {
        const y = s.y[k];
        if (x === null || y === null) { pen = false; return; }
        points.push({ px: px(x), py: py(y), x, y, name: s.name, colour: look.colour, error: L.banded(s) ? s.error[k] : null });
        if (s.points) svg.append(L.el('circle', { cx: px(x), cy: py(y), r: 3.2, fill: 'none', stroke: look.colour, 'stroke-width': 1.6 }));
        d += (pen ? 'L' : 'M') + px(x).toFixed(1) + ' ' + py(y).toFixed(1);
        pen = true;
      });
      if (!s.points) svg.append(L.el('path', { d, fill: 'none', stroke: look.colour, 'stroke-width': 2, 'stroke-dasharray': look.dash,
        'stroke-linejoin': 'round' }));
      if (!s.points && s.x.length < 12) s.x.forEach((x, k) => s.y[k] !== null &&
        svg.append(L.el('circle', { cx: px(x), cy: py(s.y[k]), r: 2.6, fill: look.colour })));
    });
    svg.append(L.el('circle', { r: 5, fill: 'none', 'stroke-width': 2, class: 'here', visibility: 'hidden' }));
  };
  L.hover(svg, W, () => points, chart.xLabel, chart.xUnit, chart.yUnit);
  const legend = L.legend(chart, shown);
  shown.draw();
  figure.append(legend, svg);
  return figure;
};

// the nearest point of all series, in its words
L.hover = (svg, W, points, xLabel, xUnit, yUnit) => {
  const hide = () => { const here = svg.querySelector('.here'); here && here.setAttribute('visibility', 'hidden'); L.tip(''); };
  svg.onmouseleave = hide;
  svg.onmousemove = event => {
    const r = svg.getBoundingClientRect(), k = W / r.width, x = (event.clientX - r.left) * k, y = (event.clientY - r.top) * k;
    let best = null, near = 60 * 60;
    for (const p of points()) {
      const d = (p.px - x) ** 2 + (p.py - y) ** 2;
      if (d < near) { near = d; best = p; }
    }
    if (!best) return hide();
    const here = svg.querySelector('.here');
    for (const [key, value] of Object.entries({ cx: best.px, cy: best.py, stroke: best.colour, visibility: 'visible' })) here.setAttribute(key, value);
    L.tip(`${best.name}\n${xLabel} = ${L.number(best.x)} ${L.unit(xUnit)}\n${L.number(best.y)}${best.error ? ` ± ${L.number(best.error, 2)}` : ''} ${L.unit(yUnit)}`, event);
  };
};

// A sweep over an angle. A fibre has no sign, so that what holds at α holds at α + 180°: filled marks are computed, open ones follow.
L.polar = polar => {
  const W = 480, H = 440, cx = W / 2, cy = H / 2 + 4, R = 165;
  const chart = { series: polar.series, group: 'polar', ordered: false };
  const figure = L.el('figure', { class: 'chart' }, L.el('figcaption', {}, `${polar.title} over ${polar.axis}${L.unit(polar.unit) ? `, ${L.unit(polar.unit)}` : ''}`));
  const svg = L.el('svg', { viewBox: `0 0 ${W} ${H}` }), shown = polar.series.map(() => true);
  const half = Math.max(...polar.angle) <= 180 && Math.min(...polar.angle) >= 0;
  let points = [];
  shown.draw = () => {
    svg.replaceChildren();
    points = [];
    const values = polar.series.filter((s, i) => shown[i]).flatMap(s => s.y);
    if (!values.length) return;
    let low = Math.min(0, ...values), high = Math.max(0, ...values);
    if (high === low) high = 1;
    const spread = Math.max(...values) - Math.min(...values);
    if (low === 0 && spread < 0.3 * high && spread > 0) low = Math.min(...values) - spread;  // far from zero: look closer
    else if (high === 0 && spread < 0.3 * -low && spread > 0) high = Math.max(...values) + spread;
    const ticks = L.ticks(low, high, 4), step = ticks[1] - ticks[0];
    low = Math.min(low, ticks[0]) - (ticks[0] > low ? 0 : 0.4 * step);
    const r = v => R * (v - low) / (high - low);
    ticks.forEach(t => svg.append(
      L.el('circle', { cx, cy, r: Math.max(0, r(t)), fill: 'none', stroke: t === 0 ? '#59636e' : '#d8dee4', 'stroke-width': t === 0 ? 1.4 : 1 })));
    for (let a = 0; a < 360; a += 30) {
      const c = Math.cos(a * Math.PI / 180), s = Math.sin(a * Math.PI / 180);
      svg.append(L.el('line', { x1: cx, y1: cy, x2: cx + (R + 8) * c, y2: cy - (R + 8) * s, stroke: '#e4e8ec' }),
        L.el('text', { x: cx + (R + 26) * c, y: cy - (R + 22) * s + 4, 'text-anchor': 'middle' }, a + '°'));
    }
    const words = L.tickTexts(ticks), slant = 15 * Math.PI / 180;
    polar.series.forEach((s, i) => {
      if (!shown[i]) return;
      const look = L.look(chart, i);
      const round = polar.angle.map((a, k) => ({ a, v: s.y[k], computed: true }));
      const opposite = a => (a + 180) % 360;  // the same fibres
      if (half) polar.angle.forEach((a, k) => polar.angle.includes(opposite(a)) || round.push({ a: opposite(a), v: s.y[k], computed: false }));
      round.sort((p, q) => p.a - q.a);
      const at = round.map(p => ({ ...p, px: cx + r(p.v) * Math.cos(p.a * Math.PI / 180), py: cy - r(p.v) * Math.sin(p.a * Math.PI / 180) }));
      svg.append(L.el('path', { d: 'M' + at.map(p => `${p.px.toFixed(1)} ${p.py.toFixed(1)}`).join('L') + (half ? 'Z' : ''), fill: 'none',
        stroke: look.colour, 'stroke-width': 2, 'stroke-dasharray': look.dash || L.dashes[i % 4] }));
      at.forEach(p => {
        svg.append(L.el('circle', { cx: p.px, cy: p.py, r: 3.6, fill: p.computed ? look.colour : '#fff', stroke: look.colour, 'stroke-width': 1.4 }));
        points.push({ px: p.px, py: p.py, x: p.a, y: p.v, name: s.name, colour: look.colour });
      });
    });
    ticks.forEach((t, i) => r(t) > 12 && svg.append(L.el('text', { x: cx + r(t) * Math.cos(slant), y: cy - r(t) * Math.sin(slant) + 4, 'text-anchor': 'middle',
      stroke: '#fff', 'stroke-width': 4, 'paint-order': 'stroke', style: 'fill:#59636e' }, words[i])));
    svg.append(L.el('circle', { r: 6, fill: 'none', 'stroke-width': 2, class: 'here', visibility: 'hidden' }));
  };
  L.hover(svg, W, () => points, polar.axis, 'deg', polar.unit);
  shown.draw();
  figure.append(L.legend(chart, shown), svg);
  for (const x of polar.residuals)
    figure.append(L.el('div', { class: 'residuals' }, `${x.says}: holds to ${L.number(100 * x.value, 2)} % over ${x.pairs} pairs of angles`));
  return figure;
};
