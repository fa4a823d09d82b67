'use strict';
// Curves and polar plots as SVG, with the values under the pointer.
// Colours that stay apart for colour-blind readers: eight for names (Okabe and Ito), viridis where the series have an order.
const L = {};
L.names = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#56b4e9', '#e69f00', '#000000', '#8c8c00'];
L.namesOnDark = ['#4aa3e0', '#ff8a3d', '#2fc79a', '#e39ac6', '#8fd3ff', '#f5b83d', '#ffffff', '#c9c94a'];
L.printing = false;
L.dark = () => !L.printing && matchMedia('(prefers-color-scheme: dark)').matches;
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
// A number to the digits that its error leaves known, as the sentence above has it.
L.rounded = (x, error) => {
  if (!(error > 0) || !isFinite(x) || x === 0) return L.number(x, 5);
  const power = Math.floor(Math.log10(error)), last = error < 2 * 10 ** power ? power - 1 : power;
  const first = Math.floor(Math.log10(Math.abs(x))), digits = Math.min(6, Math.max(1, first - last + 1)), s = L.number(x, digits);
  return /e/.test(s) ? s : (+x.toPrecision(digits)).toFixed(Math.max(0, digits - 1 - first)).replace(/-/g, '−');
};
L.unit = u => (!u || u === '-' ? '' : { deg: '°', percent: '%' }[u] || u.replace('^2', '²').replace('^3', '³'));
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
  const svg = ['svg', 'g', 'path', 'line', 'text', 'circle', 'rect', 'title', 'style'].includes(name);
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
  const n = chart.series.length, dark = L.dark(), names = dark ? L.namesOnDark : L.names, twin = chart.twins && chart.twins[i] >= 0;
  if (chart.ordered && n > 1)
    return { colour: L.css(L.colour('viridis', (dark ? 0.25 : 0) + (dark ? 0.75 : 0.92) * i / (n - 1))), dash: twin ? L.dashes[1 + i % 3] : L.dashes[0] };
  // a law has the colour of the points it was fitted to
  const pair = chart.group === 'fits' ? Math.floor(i / 2) : i;
  return { colour: names[pair % 8], dash: L.dashes[twin ? 1 + i % 3 : Math.floor(pair / 8) % 4] };
};
// For each series the first one before it that it coincides with, to a line's width; -1: none.
L.twinsOf = series => {
  const lines = series.map(s => s.points ? [] : s.y.filter(v => v !== null)), all = lines.flat();
  const width = 0.004 * (Math.max(...all) - Math.min(...all) || Math.abs(all[0]) || 1);
  return series.map((s, i) => s.points ? -1 : series.findIndex((t, j) => j < i && !t.points && t.x.length === s.x.length && s.x.length > 1 &&
    s.x.every((x, k) => x === t.x[k] && (s.y[k] === t.y[k] || Math.abs(s.y[k] - t.y[k]) < width))));
};
L.legend = (chart, shown) => {
  if (chart.series.length < 2) return '';
  return L.el('div', { class: 'legend' }, ...chart.series.map((s, i) => {
    const look = L.look(chart, i), mark = L.el('svg', { viewBox: '0 0 24 10', style: 'width:24px' });
    mark.append(s.points ? L.el('circle', { cx: 12, cy: 5, r: 3.2, fill: 'none', stroke: look.colour, 'stroke-width': 1.6 })
      : L.el('line', { x1: 0, x2: 24, y1: 5, y2: 5, stroke: look.colour, 'stroke-width': 2.4, 'stroke-dasharray': look.dash }));
    const twin = chart.twins && chart.twins[i] >= 0 ? ` (on ${chart.series[chart.twins[i]].name})` : '';
    const item = L.el('button', { type: 'button', title: 'show or hide' }, mark, s.name + twin);
    item.onclick = () => { shown[i] = !shown[i]; item.style.opacity = shown[i] ? 1 : 0.35; item.setAttribute('aria-pressed', shown[i]); shown.draw(); };
    return item;
  }));
};

// A line through points as a path. Where x goes one way it is Fritsch and Carlson's monotone cubic: it passes through every point, and between
// two points it never leaves their values, so that it shows no extreme that the values do not have.
L.smoothPath = points => {
  const n = points.length, at = p => `${p[0].toFixed(1)} ${p[1].toFixed(1)}`;
  if (n === 0) return '';
  const straight = 'M' + points.map(at).join('L'), few = 400;
  const dx = points.slice(1).map((p, k) => p[0] - points[k][0]);
  if (n < 3 || n > few || !(dx.every(d => d > 0) || dx.every(d => d < 0))) return straight;
  const slope = dx.map((d, k) => (points[k + 1][1] - points[k][1]) / d);
  // a corner, where the load turns, stays one: the curves on both sides end there
  const sharp = 5, corner = slope.findIndex((b, k) => k > 0 && slope[k - 1] * b < 0 && Math.max(Math.abs(b / slope[k - 1]), Math.abs(slope[k - 1] / b)) > sharp);
  if (corner > 0) return L.smoothPath(points.slice(0, corner + 1)) + L.smoothPath(points.slice(corner)).replace(/^M[^CL]*/, '');
  const m = points.map((p, k) => {  // harmonic mean, weighted by the lengths: 0 at an extreme
    if (k === 0 || k === n - 1) return slope[k === 0 ? 0 : n - 2];
    const a = slope[k - 1], b = slope[k];
    if (a * b <= 0) return 0;
    const wa = 2 * dx[k] + dx[k - 1], wb = dx[k] + 2 * dx[k - 1];
    return (wa + wb) / (wa / a + wb / b);
  });
  // at the ends the slope of the parabola through three points, within three times the first secant
  const end = (s0, s1, d0, d1) => { const t = ((2 * d0 + d1) * s0 - d0 * s1) / (d0 + d1); return t * s0 <= 0 ? 0 : s0 * s1 <= 0 && Math.abs(t) > 3 * Math.abs(s0) ? 3 * s0 : t; };
  m[0] = end(slope[0], slope[1], dx[0], dx[1]);
  m[n - 1] = end(slope[n - 2], slope[n - 3], dx[n - 2], dx[n - 3]);
  return 'M' + at(points[0]) + dx.map((d, k) => {
    const [p, q] = [points[k], points[k + 1]];
    return `C${at([p[0] + d / 3, p[1] + m[k] * d / 3])} ${at([q[0] - d / 3, q[1] - m[k + 1] * d / 3])} ${at(q)}`;
  }).join('');
};

// a line with a band of its error about it
L.banded = s => s.error && s.error.length > 0 && s.error.length === s.x.length;

// An axis of a chart: ends, ticks and their words; `log` where all values that are shown are positive.
L.axis = (values, log, zoom, isY) => {
  let low = Infinity, high = -Infinity;
  for (const v of values) if (!log || v > 0) { low = Math.min(low, v); high = Math.max(high, v); }
  if (zoom) [low, high] = zoom;
  else if (log) { low = 10 ** Math.floor(Math.log10(low) + 1e-9); high = 10 ** Math.ceil(Math.log10(high) - 1e-9); if (low === high) high *= 10; }
  else {
    if (!(high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)))) { const half = Math.abs(low) * 0.1 || 0.5; low -= half; high += half; }
    if (isY) {
      const room = 0.05 * (high - low);
      if (low > 0 && low < 0.3 * high) low = 0; else if (low !== 0) low -= room;
      if (high < 0 && high > 0.3 * low) high = 0; else if (high !== 0) high += room;
    }
  }
  const part = log ? v => Math.log(v / low) / Math.log(high / low) : v => (v - low) / (high - low);
  const back = log ? f => low * (high / low) ** f : f => low + f * (high - low);
  const decades = log ? Math.log10(high / low) : 0;
  if (decades < 1.5) { const ticks = L.ticks(low, high, 5); return { low, high, part, back, ticks, texts: L.tickTexts(ticks) }; }
  const ticks = [], every = Math.ceil(decades / 6);
  for (let k = Math.ceil(Math.log10(low) - 1e-9); k <= Math.log10(high) + 1e-9; k += every) ticks.push(10 ** k);
  return { low, high, part, back, ticks, texts: ticks.map(t => `10${L.raised(Math.round(Math.log10(t)))}`) };
};
L.raised = n => String(n).replace(/./g, c => '⁰¹²³⁴⁵⁶⁷⁸⁹'[c] || '⁻');

// what a screen reader says of a chart: what it shows, where each curve begins and ends
L.told = chart => {
  const known = s => s.x.map((v, k) => [v, s.y[k]]).filter(p => p[0] !== null && p[1] !== null), most = 6;
  const ends = s => { const all = known(s); return all.length ? `${s.name} from ${L.number(all[0][1], 3)} to ${L.number(all[all.length - 1][1], 3)}` : `${s.name}: nothing`; };
  return `${chart.title}: ${L.withUnit(chart.yLabel, chart.yUnit)} over ${L.withUnit(chart.xLabel, chart.xUnit)}; ` + chart.series.slice(0, most).map(ends).join(', ') +
    (chart.series.length > most ? `, and ${chart.series.length - most} more` : '');
};

// A chart: drag a part to look closer, double click or `whole` to see all; arrows lead along the points.
L.chart = chart => {
  const W = 480, H = 300, box = { l: 70, r: 20, t: 10, b: 48 };
  chart.twins = L.twinsOf(chart.series);
  const figure = L.el('figure', { class: 'chart' });
  const shown = chart.series.map(() => true), svg = L.el('svg', { viewBox: `0 0 ${W} ${H}`, role: 'img', tabindex: 0 });
  svg.setAttribute('aria-label', L.told(chart));
  const state = { points: [], zoom: null, logX: false, logY: false, x: null, y: null };
  const positive = values => values.some(v => v > 0) && !values.some(v => v !== null && v < 0);
  const frame = () => {
    const { x, y } = state;
    box.l = Math.max(70, 36 + 7.2 * Math.max(0, ...y.texts.map(text => String(text).length)));  // numbers stand clear of the axis' name
    const px = v => box.l + x.part(v) * (W - box.l - box.r), py = v => H - box.b - y.part(v) * (H - box.t - box.b);
    y.ticks.forEach((v, i) => svg.append(L.el('line', { x1: box.l, x2: W - box.r, y1: py(v), y2: py(v), class: v === 0 ? 'zero' : 'rule' }),
      L.el('text', { x: box.l - 8, y: py(v) + 4, 'text-anchor': 'end' }, y.texts[i])));
    x.ticks.forEach((v, i) => svg.append(L.el('line', { x1: px(v), x2: px(v), y1: H - box.b, y2: H - box.b + 5, class: 'axis' }),
      L.el('text', { x: px(v), y: H - box.b + 19, 'text-anchor': 'middle' }, x.texts[i])));
    svg.append(L.el('path', { d: `M${box.l} ${box.t}V${H - box.b}H${W - box.r}`, class: 'axis' }),
      L.el('text', { x: (box.l + W - box.r) / 2, y: H - 10, 'text-anchor': 'middle' }, L.withUnit(chart.xLabel, chart.xUnit) + L.times(x.texts)),
      L.el('text', { transform: `translate(16 ${(box.t + H - box.b) / 2}) rotate(-90)`, 'text-anchor': 'middle' },
        (chart.yLabel.length > 30 ? L.unit(chart.yUnit) : L.withUnit(chart.yLabel, chart.yUnit)) + L.times(y.texts)));  // the title says it
    return { px, py };
  };
  const line = (s, look, { px, py }, within) => {
    const usable = k => s.x[k] !== null && s.y[k] !== null && (!state.logX || s.x[k] > 0) && (!state.logY || s.y[k] > 0);
    if (L.banded(s) && !state.logX && !state.logY) {
      const ends = sign => s.x.map((x, k) => [px(x), py(s.y[k] + sign * s.error[k])]);
      const d = L.smoothPath(ends(1)) + 'L' + L.smoothPath(ends(-1).reverse()).slice(1) + 'Z';
      within.append(L.el('path', { d, fill: look.colour, 'fill-opacity': 0.18, class: 'band' }));
    }
    const pieces = [];
    let pen = false;
    s.x.forEach((x, k) => {
      if (!usable(k)) { pen = false; return; }
      const at = { px: px(x), py: py(s.y[k]) };
      state.points.push({ ...at, x, y: s.y[k], name: s.name, colour: look.colour, error: L.banded(s) ? s.error[k] : null });
      if (s.points) within.append(L.el('circle', { cx: at.px, cy: at.py, r: 3.2, fill: 'none', stroke: look.colour, 'stroke-width': 1.6 }));
      if (!pen) pieces.push([]);
      pieces[pieces.length - 1].push([at.px, at.py]);
      pen = true;
    });
    if (s.points) return;
    const d = pieces.map(L.smoothPath).join('');
    within.append(L.el('path', { d, fill: 'none', stroke: look.colour, 'stroke-width': 2, 'stroke-dasharray': look.dash, 'stroke-linejoin': 'round' }));
    if (s.x.length < 12) s.x.forEach((x, k) => usable(k) && within.append(L.el('circle', { cx: px(x), cy: py(s.y[k]), r: 2.6, fill: look.colour })));
  };
  shown.draw = () => {
    svg.replaceChildren(L.el('title', {}, chart.title));
    state.points = [];
    const all = chart.series.filter((s, i) => shown[i]), number = v => v !== null;
    const xs = all.flatMap(s => s.x).filter(number);
    const ys = all.flatMap(s => L.banded(s) && !state.logY ? s.y.flatMap((y, k) => [y - s.error[k], y + s.error[k]]) : s.y).filter(number);
    if (!ys.length) return;
    state.x = L.axis(xs, state.logX, state.zoom && state.zoom.x, false);
    state.y = L.axis(ys, state.logY, state.zoom && state.zoom.y, true);
    // a drawing in the drawing ends at its own edges
    const to = frame(), room = 5, left = box.l - room, top = box.t - room, width = W - box.l - box.r + 2 * room, height = H - box.t - box.b + 2 * room;
    const within = L.el('svg', { x: left, y: top, width, height, viewBox: `${left} ${top} ${width} ${height}`, style: `width:${width}px;height:${height}px` });
    svg.append(within);
    chart.series.forEach((s, i) => shown[i] && line(s, L.look(chart, i), to, within));
    for (const at of chart.marks || []) {  // lines that the curves are compared with
      const y = to.py(at.y);
      if (y < box.t || y > H - box.b) continue;
      svg.append(L.el('line', { x1: box.l, x2: W - box.r, y1: y, y2: y, class: 'mark' }), L.el('text', { x: W - box.r - 4, y: y - 5, 'text-anchor': 'end' }, at.name));
    }
    state.points = state.points.filter(p => p.px >= box.l - 1 && p.px <= W - box.r + 1 && p.py >= box.t - 1 && p.py <= H - box.b + 1);
    svg.append(L.el('rect', { class: 'zoom', visibility: 'hidden' }), L.el('circle', { r: 5, fill: 'none', 'stroke-width': 2, class: 'here', visibility: 'hidden' }));
  };
  const legendPlace = L.el('div');
  const redraw = () => { shown.draw(); const legend = L.legend(chart, shown); legendPlace.replaceChildren(legend); };
  const xs = chart.series.flatMap(s => s.x), ys = chart.series.flatMap(s => s.y);
  const toggle = (text, key, possible) => {
    if (!possible) return '';
    const b = L.el('button', { type: 'button', 'aria-pressed': 'false', title: `logarithmic ${key === 'logX' ? 'x' : 'y'}` }, text);
    b.onclick = () => { state[key] = !state[key]; state.zoom = null; b.setAttribute('aria-pressed', state[key]); shown.draw(); };
    return b;
  };
  const whole = L.el('button', { type: 'button', title: 'all of it again' }, 'whole');
  whole.onclick = () => { state.zoom = null; shown.draw(); };
  figure.append(L.el('figcaption', {}, L.el('span', {}, chart.title), L.el('span', { class: 'tools' }, toggle('log x', 'logX', positive(xs)), toggle('log y', 'logY', positive(ys)), whole,
    ...L.savers(chart.title, svg, () => L.csv(chart)))), legendPlace, svg);
  L.zoomed(svg, W, H, box, state, () => shown.draw());
  L.hover(svg, W, () => state.points, chart.xLabel, chart.xUnit, chart.yUnit);
  L.redraws.push(redraw);
  redraw();
  return figure;
};

// drag a rectangle
L.zoomed = (svg, W, H, box, state, draw) => {
  let from = null;
  const at = event => {
    const r = svg.getBoundingClientRect(), k = W / r.width;
    return [Math.min(W - box.r, Math.max(box.l, (event.clientX - r.left) * k)), Math.min(H - box.b, Math.max(box.t, (event.clientY - r.top) * k))];
  };
  svg.addEventListener('mousedown', event => { if (event.button === 0) { from = at(event); event.preventDefault(); svg.focus({ preventScroll: true }); } });
  svg.addEventListener('mousemove', event => {
    const rect = svg.querySelector('.zoom');
    if (!from || !rect) return;
    const to = at(event), values = { x: Math.min(from[0], to[0]), y: Math.min(from[1], to[1]), width: Math.abs(to[0] - from[0]), height: Math.abs(to[1] - from[1]), visibility: 'visible' };
    for (const [key, value] of Object.entries(values)) rect.setAttribute(key, value);
  });
  addEventListener('mouseup', event => {
    if (!from) return;
    const to = at(event), far = Math.abs(to[0] - from[0]) > 8 && Math.abs(to[1] - from[1]) > 8, share = (p, a, b) => (p - a) / (b - a);
    if (far && state.x) {
      const x = [from[0], to[0]].sort((a, b) => a - b).map(p => state.x.back(share(p, box.l, W - box.r)));
      const y = [from[1], to[1]].sort((a, b) => b - a).map(p => state.y.back(share(p, H - box.b, box.t)));
      state.zoom = { x, y };
    }
    from = null;
    draw();
  });
  svg.addEventListener('dblclick', () => { state.zoom = null; draw(); });
};

// What a chart shows, saved: the numbers, the drawing, a picture of twice its size.
L.csv = chart => {
  const cell = text => /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
  const head = [`${chart.xLabel}${chart.xUnit && chart.xUnit !== '-' ? ` ${chart.xUnit}` : ''}`, 'series', `${chart.yLabel}${chart.yUnit && chart.yUnit !== '-' ? ` ${chart.yUnit}` : ''}`];
  return [head.map(cell).join(','), ...chart.series.flatMap(s => s.x.map((x, k) => [x, cell(s.name), s.y[k]].map(v => v === null ? '' : v).join(',')))].join('\n') + '\n';
};
L.savedSvg = svg => {
  L.printing = true;  // light, whatever the screen is
  L.redraws.forEach(draw => draw());
  const copy = svg.cloneNode(true), [, , w, h] = svg.getAttribute('viewBox').split(' ');
  L.printing = false;
  L.redraws.forEach(draw => draw());
  copy.querySelectorAll('.zoom, .here').forEach(e => e.remove());
  for (const [key, value] of Object.entries({ width: w, height: h })) copy.setAttribute(key, value);
  copy.prepend(L.el('style', {}, 'text{font:12.5px "Liberation Sans",Arial,Helvetica,sans-serif;fill:#1f2328}.axis{stroke:#59636e;fill:none}.rule{stroke:#e4e8ec}.zero{stroke:#9aa4ae}.mark{stroke:#59636e;stroke-dasharray:5 4}.halo{stroke:#fff;stroke-width:4;paint-order:stroke}'));
  return new XMLSerializer().serializeToString(copy);
};
L.give = (blob, name) => { const link = L.el('a', { download: name.replace(/[^\w.+-]+/g, '_'), href: URL.createObjectURL(blob) }); link.click(); };
L.savers = (title, svg, csv) => {
  const button = (text, save) => { const b = L.el('button', { type: 'button', title: `save as ${text}` }, text); b.onclick = save; return b; };
  const png = () => {
    const image = new Image(), [, , w, h] = svg.getAttribute('viewBox').split(' ').map(Number);
    image.onload = () => {
      const canvas = L.el('canvas', { width: 3 * w, height: 3 * h }), pen = canvas.getContext('2d');
      pen.fillStyle = '#fff';
      pen.fillRect(0, 0, canvas.width, canvas.height);
      pen.drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob(blob => L.give(blob, `${title}.png`));
    };
    image.src = 'data:image/svg+xml;charset=utf-8,' + encodeURIComponent(L.savedSvg(svg));
  };
  return [button('CSV', () => L.give(new Blob([csv()], { type: 'text/csv' }), `${title}.csv`)),
    button('SVG', () => L.give(new Blob([L.savedSvg(svg)], { type: 'image/svg+xml' }), `${title}.svg`)), button('PNG', png)];
};
// drawings whose colours follow the screen and the printer
L.redraws = [];
L.printed = [];  // what is made anew for paper
L.redrawAll = () => L.redraws.forEach(draw => draw());
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', L.redrawAll);
addEventListener('beforeprint', () => { L.printing = true; L.redrawAll(); L.printed.forEach(make => make()); document.querySelectorAll('details').forEach(d => { d.dataset.open = d.open; d.open = true; }); });
addEventListener('afterprint', () => { L.printing = false; L.redrawAll(); document.querySelectorAll('details').forEach(d => { d.open = d.dataset.open === 'true'; }); });

// the nearest point of all series, in its words
L.hover = (svg, W, points, xLabel, xUnit, yUnit) => {
  const hide = () => { const here = svg.querySelector('.here'); here && here.setAttribute('visibility', 'hidden'); L.tip(''); };
  const words = p => `${p.name}\n${xLabel} = ${L.number(p.x)} ${L.unit(xUnit)}\n${L.number(p.y)}${p.error ? ` ± ${L.number(p.error, 2)}` : ''} ${L.unit(yUnit)}`;
  const show = (p, event) => {
    const here = svg.querySelector('.here');
    for (const [key, value] of Object.entries({ cx: p.px, cy: p.py, stroke: p.colour, visibility: 'visible' })) here.setAttribute(key, value);
    L.tip(words(p), event);
  };
  let walked = -1;
  svg.onblur = hide;
  svg.addEventListener('keydown', event => {
    const all = points(), step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step || !all.length) return;
    event.preventDefault();
    walked = Math.max(0, Math.min(all.length - 1, walked + step));
    const p = all[walked], r = svg.getBoundingClientRect(), k = r.width / W;
    show(p, { clientX: r.left + p.px * k, clientY: r.top + p.py * k });
  });
  svg.onmouseleave = hide;
  svg.onmousemove = event => {
    const r = svg.getBoundingClientRect(), k = W / r.width, x = (event.clientX - r.left) * k, y = (event.clientY - r.top) * k;
    let best = null, near = 60 * 60;
    for (const p of points()) {
      const d = (p.px - x) ** 2 + (p.py - y) ** 2;
      if (d < near) { near = d; best = p; }
    }
    if (!best) return hide();
    show(best, event);
  };
};

// A sweep over an angle. A fibre has no sign, so that what holds at α holds at α + 180°: filled marks are computed, open ones follow.
L.polar = polar => {
  const W = 480, H = 440, cx = W / 2, cy = H / 2 + 4, R = 165;
  const chart = { series: polar.series, group: 'polar', ordered: false };
  const title = `${polar.title} over ${polar.axis}${L.unit(polar.unit) ? `, ${L.unit(polar.unit)}` : ''}`, figure = L.el('figure', { class: 'chart' });
  const svg = L.el('svg', { viewBox: `0 0 ${W} ${H}`, role: 'img', tabindex: 0 }), shown = polar.series.map(() => true);
  svg.setAttribute('aria-label', title);
  const middle = L.el('div', { class: 'residuals' }), fromZero = L.el('button', { type: 'button', 'aria-pressed': 'false' }, 'from zero');
  const half = Math.max(...polar.angle) <= 180 && Math.min(...polar.angle) >= 0;
  let points = [];
  shown.draw = () => {
    svg.replaceChildren(L.el('title', {}, title));
    points = [];
    const values = polar.series.filter((s, i) => shown[i]).flatMap(s => s.y);
    if (!values.length) return;
    let low = Math.min(0, ...values), high = Math.max(0, ...values);
    if (high === low) high = 1;
    const spread = Math.max(...values) - Math.min(...values);
    if (fromZero.getAttribute('aria-pressed') === 'true') { /* as asked */ } else if (low === 0 && spread < 0.3 * high && spread > 0) low = Math.min(...values) - spread;  // far from zero: look closer
    else if (high === 0 && spread < 0.3 * -low && spread > 0) high = Math.max(...values) + spread;
    const ticks = L.ticks(low, high, 4), step = ticks[1] - ticks[0];
    low = Math.min(low, ticks[0]) - (ticks[0] > low ? 0 : 0.4 * step);
    const r = v => R * (v - low) / (high - low);
    middle.textContent = low === 0 ? '' : `the middle is ${L.number(low, 3)} ${L.unit(polar.unit)}, not zero`;
    ticks.forEach(t => svg.append(L.el('circle', { cx, cy, r: Math.max(0, r(t)), fill: 'none', class: t === 0 ? 'zero' : 'rule' })));
    for (let a = 0; a < 360; a += 30) {
      const c = Math.cos(a * Math.PI / 180), s = Math.sin(a * Math.PI / 180);
      svg.append(L.el('line', { x1: cx, y1: cy, x2: cx + (R + 8) * c, y2: cy - (R + 8) * s, class: 'rule' }),
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
        svg.append(L.el('circle', { cx: p.px, cy: p.py, r: 3.6, fill: p.computed ? look.colour : L.dark() ? '#0d1117' : '#fff', stroke: look.colour, 'stroke-width': 1.4 }));
        points.push({ px: p.px, py: p.py, x: p.a, y: p.v, name: s.name, colour: look.colour });
      });
    });
    ticks.forEach((t, i) => r(t) > 12 && svg.append(L.el('text', { x: cx + r(t) * Math.cos(slant), y: cy - r(t) * Math.sin(slant) + 4, 'text-anchor': 'middle',
      class: 'halo' }, words[i])));
    svg.append(L.el('circle', { r: 6, fill: 'none', 'stroke-width': 2, class: 'here', visibility: 'hidden' }));
  };
  L.hover(svg, W, () => points, polar.axis, 'deg', polar.unit);
  fromZero.onclick = () => { fromZero.setAttribute('aria-pressed', fromZero.getAttribute('aria-pressed') === 'false'); shown.draw(); };
  const csv = () => L.csv({ ...chart, xLabel: polar.axis, xUnit: 'deg', yLabel: polar.title, yUnit: polar.unit, series: polar.series.map(s => ({ ...s, x: polar.angle })) });
  const legend = L.el('div'), redraw = () => { shown.draw(); legend.replaceChildren(L.legend(chart, shown)); };
  L.redraws.push(redraw);
  redraw();
  figure.append(L.el('figcaption', {}, L.el('span', {}, title), L.el('span', { class: 'tools' }, fromZero, ...L.savers(title, svg, csv))), legend, svg, middle);
  for (const x of polar.residuals)
    figure.append(L.el('div', { class: 'residuals' }, `${x.says}: holds to ${L.number(100 * x.value, 2)} % over ${x.pairs} pairs of angles`));
  return figure;
};
