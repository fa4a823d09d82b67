'use strict';
// The deformed body: its surface coloured by a field, cut open by a plane, with fibres and the indenters; three.js draws it:
// a current release by npm, or Debian's of 2019, between which light and colours differ.
L.decode = (text, Kind) => {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return new Kind(bytes.buffer);
};

// One body with its states decoded when they are first asked for.
L.Body = class {
  constructor(data) {
    const { u, ...rest } = data;
    Object.assign(this, rest);
    this.packedMoves = u;
    this.X = L.decode(data.X, Float32Array);
    this.facets = L.decode(data.facets, Int32Array);
    this.cells = data.cells && L.decode(data.cells, Int32Array);
    this.moves = data.states.map(() => null);
    this.punches = data.indenters.shown.map(p => ({ ...p, points: L.decode(p.points, Float32Array), triangles: L.decode(p.triangles, Int32Array) }));
    this.n = this.X.length / 3;
    this.glyphs = data.glyphs && { facet: L.decode(data.glyphs.facet, Int32Array), nodes: L.decode(data.glyphs.nodes, Int32Array),
      weights: L.decode(data.glyphs.weights, Float32Array) };
    const largest = (k) => data.states.reduce((m, s, i) => { const u = this.u(i); for (let j = 0; j < this.n; ++j) m = Math.max(m, k < 0 ? Math.hypot(u[3 * j], u[3 * j + 1], u[3 * j + 2]) : u[3 * j + k]); return m; }, k < 0 ? 0 : -Infinity);
    const least = k => data.states.reduce((m, s, i) => { const u = this.u(i); for (let j = 0; j < this.n; ++j) m = Math.min(m, u[3 * j + k]); return m; }, Infinity);
    const moved = (name, label, k) => ({ name, label, unit: 'mm', low: k < 0 ? 0 : least(k), high: largest(k), component: k });
    this.choices = data.fields.concat([moved('u', 'length of the displacement', -1), moved('u_x', 'displacement u_x', 0),
      moved('u_y', 'displacement u_y', 1), moved('u_z', 'displacement u_z', 2)]);
    this.spans = {};
  }
  u(state) {  // mm
    if (!this.moves[state]) {
      const steps = L.decode(this.packedMoves[state], Int16Array), u = new Float32Array(steps.length);
      for (let i = 0; i < u.length; ++i) u[i] = steps[i] * this.step;
      this.moves[state] = u;
    }
    return this.moves[state];
  }
  values(choice, state) {
    const out = new Float32Array(this.n);
    if (choice.component !== undefined) {
      const u = this.u(state), k = choice.component;
      for (let i = 0; i < this.n; ++i) out[i] = k < 0 ? Math.hypot(u[3 * i], u[3 * i + 1], u[3 * i + 2]) : u[3 * i + k];
      return out;
    }
    const packed = L.decode(choice.states[state], Uint16Array), per = (choice.high - choice.low) / 65534;
    for (let i = 0; i < this.n; ++i) out[i] = packed[i] === 65535 ? NaN : choice.low + packed[i] * per;
    return out;
  }
};

// The cut of a plane through the cells, each in six tetrahedra: triangles with the field's values.
L.sixTets = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
L.section = (cells, x, values, normal, at) => {
  const positions = [], colours = [], d = new Float32Array(8), far = new Float32Array(x.length / 3);
  for (let i = 0; i < far.length; ++i) far[i] = normal[0] * x[3 * i] + normal[1] * x[3 * i + 1] + normal[2] * x[3 * i + 2] - at;
  const cross = (i, j) => {
    const t = far[i] / (far[i] - far[j]);
    return [0, 1, 2].map(k => x[3 * i + k] + t * (x[3 * j + k] - x[3 * i + k])).concat(values[i] + t * (values[j] - values[i]));
  };
  const add = (...corners) => corners.forEach(c => { positions.push(c[0], c[1], c[2]); colours.push(c[3]); });
  for (let c = 0; c < cells.length; c += 8) {
    let below = 0;
    for (let k = 0; k < 8; ++k) below += (d[k] = far[cells[c + k]]) < 0 ? 1 : 0;
    if (below === 0 || below === 8) continue;
    for (const tet of L.sixTets) {
      const low = tet.filter(k => d[k] < 0).map(k => cells[c + k]), high = tet.filter(k => d[k] >= 0).map(k => cells[c + k]);
      if (low.length === 1) add(...high.map(h => cross(low[0], h)));
      if (high.length === 1) add(...low.map(l => cross(l, high[0])));
      if (low.length === 2 && high.length === 2) {
        const [a, b, e, f] = [cross(low[0], high[0]), cross(low[0], high[1]), cross(low[1], high[1]), cross(low[1], high[0])];
        add(a, b, e, a, e, f);
      }
    }
  }
  return { positions: new Float32Array(positions), values: new Float32Array(colours) };
};

L.bodyView = (place, all) => {
  const bodies = all.map(d => new L.Body(d));
  const stage = L.el('div', { class: 'stage' }), over = L.el('canvas', { class: 'over' }), panel = L.el('div', { class: 'panel' });
  place.append(stage, panel);

  // controls
  const asked = new URLSearchParams(location.hash.slice(1));
  const labelled = (text, control, output) => L.el('label', {}, L.el('span', {}, text, ' ', output || ''), control);
  const select = (id, names, texts) => { const s = L.el('select', { id }); names.forEach((n, i) => s.append(L.el('option', { value: n }, texts[i]))); return s; };
  const range = (id, min, max, step, value) => L.el('input', { id, type: 'range', min, max, step, value });
  const box = (id, text, checked) => { const c = L.el('input', { id, type: 'checkbox' }); c.checked = checked; return { c, label: L.el('label', {}, c, text) }; };
  const member = select('member', bodies.map((b, i) => i), bodies.map(b => b.label));
  const field = select('field', [], []), state = range('state', 0, 1, 1, 0), scale = range('scale', 0, 5, 0.1, 1);
  const low = L.el('input', { id: 'low', type: 'number', step: 'any', 'aria-label': 'least colour' }), high = L.el('input', { id: 'high', type: 'number', step: 'any', 'aria-label': 'greatest colour' });
  const fit = select('fit', ['all', 'state', 'own'], ['least and largest of all states', 'of the state shown', 'as typed']);
  const colours = select('colours', ['viridis', 'cividis'], ['viridis', 'cividis']);
  const clip = select('clip', ['none', 'x', 'y', 'z', 'free'], ['whole', 'cut at x', 'cut at y', 'cut at z', 'cut across the way one looks']), at = range('at', -1, 1, 0.001, 0), turn = box('turn', 'other side', false);
  const edges = box('edges', 'cells', true), fibres = box('fibres', 'fibres', false), indenter = box('indenter', 'indenters', true);
  const stateText = L.el('output'), missing = L.el('p'), scaleText = L.el('output'), atText = L.el('output');
  const views = ['oblique', 'from above', 'along z', 'along x'].map((name, i) => { const b = L.el('button', { type: 'button' }, name); b.onclick = () => look(i); return b; });
  const save = L.el('button', { type: 'button' }, 'save picture'), times = select('times', [1, 2, 4], ['as shown', '2 × as large', '4 × as large']);
  times.setAttribute('aria-label', 'size of the picture that is saved');
  const play = L.el('button', { type: 'button', id: 'play', 'aria-pressed': 'false' }, '▶ play'), opacity = range('opacity', 0.1, 1, 0.05, 1), opacityText = L.el('output');
  const keys = L.el('p', { class: 'keys' }, 'With the picture in focus: arrows turn it, + and − come closer or go away, 0 fits it, space plays, [ and ] go through the states. With Shift held the mouse moves the cut; a double click puts it where it is.');
  // what is wanted first stands below the picture, the rest is folded
  const more = L.el('div', { class: 'more' }, labelled('displacement drawn', scale, scaleText), labelled('opacity', opacity, opacityText),
    labelled('colours', L.el('div', { class: 'row' }, colours)), labelled('colour range', fit), L.el('div', { class: 'row' }, low, '–', high),
    L.el('div', { class: 'row' }, turn.label, edges.label, fibres.label, indenter.label), L.el('div', { class: 'row' }, save, times));
  panel.append(L.el('div', { class: 'bar' }, ...(bodies.length > 1 ? [labelled('member', member)] : []), labelled('field', field), labelled('state', state, stateText),
    labelled('cut', L.el('div', { class: 'row' }, clip), ''), labelled('position of the cut', at, atText)),
    L.el('div', { class: 'row' }, play, ...views), L.el('details', {}, L.el('summary', {}, 'colours, scale, opacity, picture to save, keys'), more, keys), missing);

  // scene
  const bright = +THREE.REVISION >= 155 ? Math.PI : 1;
  if (THREE.ColorManagement) THREE.ColorManagement.enabled = false;
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  if ('outputColorSpace' in renderer) renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1));
  renderer.domElement.setAttribute('role', 'img');
  renderer.domElement.setAttribute('tabindex', '0');
  renderer.localClippingEnabled = true;
  stage.append(renderer.domElement, over);
  const scene = new THREE.Scene(), camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
  const lamp = new THREE.DirectionalLight(0xffffff, 0.42 * bright);
  camera.add(lamp);
  lamp.position.set(-0.5, 0.9, 0.8);
  scene.add(camera, new THREE.AmbientLight(0xffffff, 0.66 * bright));
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.screenSpacePanning = true;
  // turned, the body keeps filling its frame; zoomed or moved by hand, it stays as it was put
  let held = false;
  controls.addEventListener('change', () => {
    if (!size) return;
    if (!held && centre && controls.target.distanceTo(centre) > 1e-6 * size) held = true;
    if (!held) zoomToFit();
    draw();
  });
  renderer.domElement.addEventListener('wheel', () => { held = true; }, true);

  const scales = {};
  for (const name of Object.keys(L.scales)) {
    const texels = new Uint8Array(256 * 4);
    for (let i = 0; i < 256; ++i) texels.set([...L.colour(name, i / 255), 255], 4 * i);
    scales[name] = new THREE.DataTexture(texels, 256, 1);
    scales[name].minFilter = scales[name].magFilter = THREE.LinearFilter;
    scales[name].needsUpdate = true;
  }
  const plane = new THREE.Plane(new THREE.Vector3(1, 0, 0), 0);
  const skin = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
  const cutSkin = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide });
  const line = new THREE.LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.5 });
  const fibreLine = new THREE.LineBasicMaterial({ color: 0xff3d7f });
  const steel = new THREE.MeshPhongMaterial({ color: 0xc2c8ce, shininess: 40, side: THREE.DoubleSide, transparent: true, opacity: 0.72, depthWrite: false });
  const mesh = new THREE.Mesh(new THREE.BufferGeometry(), skin), cut = new THREE.Mesh(new THREE.BufferGeometry(), cutSkin);
  const wires = new THREE.LineSegments(new THREE.BufferGeometry(), line);
  const glyphs = new THREE.LineSegments(new THREE.BufferGeometry(), fibreLine), punches = new THREE.Group();
  scene.add(mesh, cut, wires, glyphs, punches);
  for (const thing of [mesh, cut, wires, glyphs]) thing.frustumCulled = false;

  let body, x, values, choice, middle, size, centre = null;
  const choose = () => {
    const before = field.value;
    body = bodies[+member.value || 0];
    field.replaceChildren(...body.choices.map(c => L.el('option', { value: c.name }, L.withUnit(c.label, c.unit))));
    field.value = body.choices.some(c => c.name === before) ? before : body.choices[0].name;
    state.max = body.states.length - 1;
    const index = new Uint32Array(body.facets.length / 4 * 6), sides = new Map();
    for (let f = 0, i = 0; f < body.facets.length; f += 4) {
      const [a, b, c, d] = body.facets.subarray(f, f + 4);
      index.set([a, b, c, a, c, d], i);
      i += 6;
      for (const [p, q] of [[a, b], [b, c], [c, d], [d, a]]) sides.set(Math.min(p, q) * body.n + Math.max(p, q), [p, q]);
    }
    // each facet has corners of its own, so that the edges of the body stay sharp
    body.corners = index;
    body.sides = new Uint32Array([...sides.values()].flat());
    for (const geometry of [mesh.geometry, wires.geometry]) geometry.dispose();
    mesh.geometry = new THREE.BufferGeometry();
    mesh.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * index.length), 3));
    mesh.geometry.setAttribute('normal', new THREE.BufferAttribute(new Float32Array(3 * index.length), 3));
    mesh.geometry.setAttribute('uv', new THREE.BufferAttribute(new Float32Array(2 * index.length), 2));
    wires.geometry = new THREE.BufferGeometry();
    wires.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * body.n), 3));
    wires.geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * body.n), 3));
    wires.geometry.setIndex(new THREE.BufferAttribute(body.sides, 1));
    punches.children.slice().forEach(p => punches.remove(p));
    body.punches.forEach(p => {
      const shape = new THREE.BufferGeometry();
      shape.setAttribute('position', new THREE.BufferAttribute(p.points, 3));
      shape.setIndex(new THREE.BufferAttribute(new Uint32Array(p.triangles), 1));
      shape.computeVertexNormals();
      shape.computeBoundingBox();
      const punch = new THREE.Mesh(shape, steel);
      punch.userData = p;
      punches.add(punch);
    });
    missing.textContent = body.indenters.missing.length ? `not drawn: ${body.indenters.missing.join(', ')}, of a file that the solution does not hold` : '';
    const lowest = [Infinity, Infinity, Infinity], highest = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < body.X.length; ++i) { lowest[i % 3] = Math.min(lowest[i % 3], body.X[i]); highest[i % 3] = Math.max(highest[i % 3], body.X[i]); }
    middle = new THREE.Vector3(...lowest.map((l, k) => (l + highest[k]) / 2));
    size = Math.hypot(...lowest.map((l, k) => highest[k] - l));
    body.box = [lowest, highest];
  };

  const uvOf = v => (v - +low.value) / (+high.value - +low.value || 1);
  const update = () => {
    const i = +state.value, s = +scale.value, u = body.u(i);
    choice = body.choices.find(c => c.name === field.value);
    values = body.values(choice, i);
    x = new Float32Array(u.length);
    for (let k = 0; k < u.length; ++k) x[k] = body.X[k] + s * u[k];
    if (fit.value !== 'own') {
      let a = choice.low, b = choice.high;
      if (fit.value === 'state') { a = Infinity; b = -Infinity; values.forEach(v => { if (v < a) a = v; if (v > b) b = v; }); }
      if (!(b - a > 1e-12 * Math.max(Math.abs(a), Math.abs(b)))) { a -= 0.5; b += 0.5; }
      low.value = +a.toPrecision(4);
      high.value = +b.toPrecision(4);
    }
    stateText.textContent = `${i + 1} of ${body.states.length}, t = ${L.number(body.states[i].t)}` +
      (body.punches.length ? `, indenter ${L.number(Math.hypot(...body.states[i].u_ind))} mm` : '');
    scaleText.textContent = `× ${(+scale.value).toFixed(1).replace(/\.0$/, '')}`;

    const { position, normal, uv } = mesh.geometry.attributes, corners = body.corners;
    for (let k = 0; k < corners.length; ++k) {
      const n = corners[k];
      position.array[3 * k] = x[3 * n]; position.array[3 * k + 1] = x[3 * n + 1]; position.array[3 * k + 2] = x[3 * n + 2];
      uv.array[2 * k] = Math.min(0.998, Math.max(0.002, uvOf(values[n])));
      uv.array[2 * k + 1] = 0.5;
    }
    smooth(normal.array, position.array);
    for (const a of [position, normal, uv]) a.needsUpdate = true;
    wires.geometry.attributes.position.array.set(x);
    wires.geometry.attributes.position.needsUpdate = true;
    const tint = wires.geometry.attributes.color;  // dark lines on bright colours, bright ones on dark
    for (let k = 0; k < body.n; ++k) {
      const c = L.colour(colours.value, uvOf(values[k])), bright = 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2] > 115, grey = bright ? 0.1 : 0.88;
      tint.array[3 * k] = tint.array[3 * k + 1] = tint.array[3 * k + 2] = grey;
    }
    tint.needsUpdate = true;
    for (const m of [skin, cutSkin]) { m.opacity = +opacity.value; m.transparent = m.opacity < 1; m.depthWrite = !m.transparent; }
    opacityText.textContent = `${Math.round(100 * opacity.value)} %`;
    skin.map = cutSkin.map = scales[colours.value];
    skin.needsUpdate = cutSkin.needsUpdate = true;
    wires.visible = edges.c.checked;
    punches.visible = indenter.c.checked;
    punches.children.forEach(p => p.position.set(...p.userData.u[i].map(u => s * u)));
    drawFibres();
    drawCut();
    mesh.geometry.computeBoundingSphere();
    draw();
  };
  // normals averaged over the facets at a node that look nearly the same way
  const smooth = (normal, position) => {
    const n = body.corners.length / 3, own = new Float32Array(3 * n), sums = new Map();
    for (let t = 0; t < n; ++t) {
      const p = position.subarray(9 * t, 9 * t + 9);
      const a = [p[3] - p[0], p[4] - p[1], p[5] - p[2]], b = [p[6] - p[0], p[7] - p[1], p[8] - p[2]];
      own.set([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], 3 * t);
    }
    const key = (node, t) => {  // six sectors of direction keep edges sharp
      const v = own.subarray(3 * t, 3 * t + 3), w = v.map(Math.abs), k = w[0] > w[1] ? (w[0] > w[2] ? 0 : 2) : (w[1] > w[2] ? 1 : 2);
      return node * 6 + 2 * k + (v[k] > 0 ? 1 : 0);
    };
    const keys = new Float64Array(3 * n);
    for (let t = 0; t < n; ++t) for (let c = 0; c < 3; ++c) {
      const k = keys[3 * t + c] = key(body.corners[3 * t + c], t);
      let sum = sums.get(k);
      if (!sum) sums.set(k, sum = [0, 0, 0]);
      for (let j = 0; j < 3; ++j) sum[j] += own[3 * t + j];
    }
    for (let c = 0; c < 3 * n; ++c) {
      const sum = sums.get(keys[c]), length = Math.hypot(...sum) || 1;
      for (let j = 0; j < 3; ++j) normal[3 * c + j] = sum[j] / length;
    }
  };
  const drawFibres = () => {
    glyphs.visible = fibres.c.checked && !!body.glyphs;
    fibres.label.style.display = body.glyphs ? '' : 'none';
    if (!glyphs.visible) return;
    const g = body.glyphs, ends = new Float32Array(6 * g.facet.length);
    for (let k = 0; k < g.facet.length; ++k) {
      const c = [0, 0, 0], d = [0, 0, 0];
      for (let j = 0; j < 4; ++j) for (let a = 0; a < 3; ++a) c[a] += x[3 * body.facets[4 * g.facet[k] + j] + a] / 4;
      for (let j = 0; j < 8; ++j) for (let a = 0; a < 3; ++a) d[a] += x[3 * g.nodes[8 * k + j] + a] * g.weights[8 * k + j];
      const [p, q] = [body.facets[4 * g.facet[k]], body.facets[4 * g.facet[k] + 2]];
      const [v, w] = [1, 0].map(s => [0, 1, 2].map(a => x[3 * body.facets[4 * g.facet[k] + 2 + s] + a] - x[3 * body.facets[4 * g.facet[k] + s] + a]));
      const n = [v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]], far = 0.002 * size / (Math.hypot(...n) || 1);
      for (let a = 0; a < 3; ++a) c[a] -= far * n[a];  // a little off the surface
      const half = 0.26 * Math.hypot(...[0, 1, 2].map(a => body.X[3 * p + a] - body.X[3 * q + a]));
      for (let a = 0; a < 3; ++a) { ends[6 * k + a] = c[a] - half * d[a]; ends[6 * k + 3 + a] = c[a] + half * d[a]; }
    }
    glyphs.geometry.dispose();
    glyphs.geometry = new THREE.BufferGeometry();
    glyphs.geometry.setAttribute('position', new THREE.BufferAttribute(ends, 3));
  };
  // the plane's direction, and how far the body reaches along it
  const across = new THREE.Vector3(0, 0, 1);
  const direction = () => clip.value === 'free' ? across : new THREE.Vector3(+(clip.value === 'x'), +(clip.value === 'y'), +(clip.value === 'z'));
  const reachOf = n => {
    const ends = [Infinity, -Infinity], [a, b] = body.box;
    for (let k = 0; k < 8; ++k) { const d = n.x * (k & 1 ? b : a)[0] + n.y * (k & 2 ? b : a)[1] + n.z * (k & 4 ? b : a)[2]; ends[0] = Math.min(ends[0], d); ends[1] = Math.max(ends[1], d); }
    return ends;
  };
  const drawCut = () => {
    const on = clip.value !== 'none';
    at.disabled = turn.c.disabled = !on;
    atText.textContent = '';
    cut.visible = on && !!body.cells;
    const planes = on ? [plane] : null;
    for (const m of [skin, line, fibreLine, steel]) { m.clippingPlanes = planes; m.needsUpdate = true; }
    if (!on) return;
    const n = direction(), [from, to] = reachOf(n), here = (from + to) / 2 + +at.value * (to - from) / 2;
    atText.textContent = clip.value === 'free' ? `${L.number(here - (from + to) / 2, 3)} mm from the middle` : `${clip.value} = ${L.number(here, 3)} mm`;
    const side = turn.c.checked ? 1 : -1;
    plane.normal.copy(n).multiplyScalar(side);
    plane.constant = -side * here;
    if (!body.cells) return;
    const s = L.section(body.cells, x, values, [n.x, n.y, n.z], here), uv = new Float32Array(2 * s.values.length);
    for (let k = 0; k < s.values.length; ++k) { uv[2 * k] = Math.min(0.998, Math.max(0.002, uvOf(s.values[k]))); uv[2 * k + 1] = 0.5; }
    cut.geometry.dispose();
    cut.geometry = new THREE.BufferGeometry();
    cut.geometry.setAttribute('position', new THREE.BufferAttribute(s.positions, 3));
    cut.geometry.setAttribute('uv', new THREE.BufferAttribute(uv, 2));
  };

  // from the middle of the body to that of the part that is shown
  const shift = () => {
    if (clip.value === 'none') return new THREE.Vector3();
    const n = direction(), [from, end] = reachOf(n), here = -plane.constant * plane.normal.dot(n);
    return n.clone().multiplyScalar((here + (plane.normal.dot(n) > 0 ? end : from)) / 2 - middle.dot(n));
  };
  const fitted = () => look(-1);  // from where one looks now
  const look = which => {
    const directions = [[0.62, 0.62, 1], [0, 1, 1e-4], [0, 0, 1], [1, 0, 0]];
    const from = which < 0 ? camera.position.clone().sub(controls.target).normalize() : new THREE.Vector3(...directions[which]).normalize();
    camera.position.copy(middle).addScaledVector(from, 2 * size);
    if (clip.value !== 'none') camera.position.addScaledVector(shift(), 1);
    controls.target.copy(middle).add(shift());
    centre = controls.target.clone();
    held = false;
    camera.near = -5 * size;
    camera.far = 10 * size;
    camera.zoom = 1;
    resize();
    controls.update();
    zoomToFit();
    draw();
  };
  // as large as it fits, beside the colour bar
  const zoomToFit = () => {
    camera.updateMatrixWorld();
    const right = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0), up = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1);
    const p = new THREE.Vector3(), whole = clip.value === 'none';
    let w = 1e-9 * size, h = 1e-9 * size;
    const reach = () => { p.sub(controls.target); w = Math.max(w, Math.abs(p.dot(right))); h = Math.max(h, Math.abs(p.dot(up))); };
    for (let i = 0; i < body.n; ++i) {
      p.set(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
      if (whole || plane.distanceToPoint(p) > -1e-3 * size) reach();
    }
    // of an indenter larger than the body what is near it
    punches.visible && punches.children.forEach(punch => {
      const points = punch.geometry.attributes.position;
      for (let i = 0; i < points.count; ++i) {
        p.fromBufferAttribute(points, i).add(punch.position);
        if (p.distanceTo(middle) < 0.8 * size) reach();
      }
    });
    camera.zoom = 0.95 * Math.min((camera.right - camera.left - 170 * perPixel()) / (2 * w), (camera.top - camera.bottom - 80 * perPixel()) / (2 * h));
    camera.updateProjectionMatrix();
  };
  const perPixel = () => (camera.right - camera.left) / stage.clientWidth;
  const resize = () => {
    const w = stage.clientWidth, h = stage.clientHeight, half = size / 2;
    renderer.setSize(w, h);
    renderer.domElement.setAttribute('aria-label', `${body.label}: the deformed body`);
    camera.top = half;
    camera.bottom = -half;
    camera.left = -half * w / h;
    camera.right = half * w / h;
    camera.setViewOffset(w, h, 62, 0, w, h);  // the middle of the body stands left of the colour bar
    const ratio = renderer.getPixelRatio();
    over.width = w * ratio;
    over.height = h * ratio;
    over.style.width = w + 'px';
    over.style.height = h + 'px';
    over.getContext('2d').setTransform(ratio, 0, 0, ratio, 0, 0);
  };

  // colour bar, axes and scale over the picture
  const font = px => `${px}px "Liberation Sans", Arial, Helvetica, sans-serif`;
  const annotate = () => {
    const pen = over.getContext('2d'), w = stage.clientWidth, h = stage.clientHeight;
    pen.clearRect(0, 0, w, h);
    const left = w - 118, top = 74, width = 20, height = Math.min(330, h - 220);
    for (let i = 0; i < height; ++i) {
      pen.fillStyle = L.css(L.colour(colours.value, 1 - i / (height - 1)));
      pen.fillRect(left, top + i, width, 1.5);
    }
    const ink = L.dark() ? '#e6edf3' : '#1f2328', soft = L.dark() ? '#9da7b3' : '#59636e';
    pen.strokeStyle = soft;
    pen.lineWidth = 1;
    pen.strokeRect(left, top, width, height);
    pen.fillStyle = ink;
    pen.font = font(14);
    pen.textAlign = 'right';
    L.withUnit(choice.label, choice.unit).replace(/ (\(|displacement)/g, '\n$1').split('\n').forEach((part, i, parts) => pen.fillText(part, w - 16, top - 16 - 18 * (parts.length - 1 - i)));
    pen.textAlign = 'left';
    pen.font = font(13);
    const a = +low.value, b = +high.value, ticks = b > a ? L.ticks(a, b, 6) : [], texts = L.tickTexts(ticks);
    ticks.forEach((t, i) => {
      const y = top + height * (b - t) / (b - a);
      pen.beginPath(); pen.moveTo(left + width, y); pen.lineTo(left + width + 5, y); pen.stroke();
      pen.fillText(texts[i] + (i === 0 ? L.times(texts) : ""), left + width + 9, y + 4.5);
    });
    // axes as the camera sees them
    const origin = [w - 74, h - 52];
    const inverse = camera.matrixWorldInverse;
    ['x', 'y', 'z'].map((name, k) => ({ name, v: new THREE.Vector3(+(k === 0), +(k === 1), +(k === 2)).transformDirection(inverse) }))
      .sort((p, q) => p.v.z - q.v.z).forEach(({ name, v }) => {
        pen.strokeStyle = ink;
        pen.lineWidth = 1.6;
        pen.beginPath(); pen.moveTo(...origin); pen.lineTo(origin[0] + 34 * v.x, origin[1] - 34 * v.y); pen.stroke();
        pen.textAlign = 'center';
        if (Math.hypot(v.x, v.y) > 0.15) pen.fillText(name, origin[0] + 45 * v.x, origin[1] - 45 * v.y + 4);
      });
    // a length
    const mm = perPixel() / camera.zoom, wished = 110 * mm, nice = [1, 2, 5, 10].map(m => m * 10 ** Math.floor(Math.log10(wished))).filter(m => m <= wished).pop();
    pen.lineWidth = 2;
    pen.beginPath(); pen.moveTo(18, h - 22); pen.lineTo(18 + nice / mm, h - 22); pen.stroke();
    pen.textAlign = 'left';
    pen.fillText(`${L.number(nice)} mm`, 18, h - 30);
    pen.fillStyle = soft;
    pen.fillText(`${body.label}   ${stateText.textContent}` + (+scale.value !== 1 ? `   displacement ${scaleText.textContent}` : ''), 18, 24);
  };
  let waiting = false;
  const later = asked.has('checksum') ? task => setTimeout(task, 0) : requestAnimationFrame;  // tools may have no frames
  const draw = () => {
    if (waiting) return;
    waiting = true;
    later(() => {
      waiting = false;
      renderer.setClearColor(L.dark() ? 0x0d1117 : 0xffffff);
      renderer.render(scene, camera);
      annotate();
      checksum();
    });
  };
  // of the pixels drawn, for whoever wants to know whether a control changes the picture
  const checksum = () => {
    const gl = renderer.getContext(), w = gl.drawingBufferWidth, h = gl.drawingBufferHeight, px = new Uint8Array(4 * w * h);
    if (!asked.has('checksum')) return;
    gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, px);
    let sum = 17, painted = 0;
    for (let i = 0; i < px.length; i += 4) { sum = (Math.imul(sum, 31) + px[i] + 7 * px[i + 1] + 53 * px[i + 2]) | 0; painted += px[i] < 250 || px[i + 1] < 250; }
    document.documentElement.dataset.picture = (sum >>> 0).toString(16);
    document.documentElement.dataset.painted = painted;
  };

  // the value under the pointer
  const ray = new THREE.Raycaster(), pointer = new THREE.Vector2();
  const hitBy = event => {
    const r = renderer.domElement.getBoundingClientRect();
    pointer.set((event.clientX - r.left) / r.width * 2 - 1, 1 - (event.clientY - r.top) / r.height * 2);
    ray.setFromCamera(pointer, camera);
    const kept = p => clip.value === 'none' || plane.distanceToPoint(p) > -1e-6 * size;
    return ray.intersectObjects(cut.visible ? [mesh, cut] : [mesh]).find(h => h.object === cut || kept(h.point));
  };
  renderer.domElement.addEventListener('mousemove', event => {
    const hit = event.buttons ? null : hitBy(event);
    if (!hit) return L.tip('');
    const t = hit.uv.x * (+high.value - +low.value) + +low.value, p = hit.point;
    L.tip(`${choice.label} ${L.number(t)} ${L.unit(choice.unit)}${hit.uv.x <= 0.0021 ? ' or less' : hit.uv.x >= 0.9979 ? ' or more' : ''}\n` +
      `at (${[p.x, p.y, p.z].map(c => L.number(c, 3)).join(', ')}) mm`, event);
  });
  renderer.domElement.addEventListener('mouseleave', () => L.tip(''));
  save.onclick = () => {
    const factor = +times.value, before = renderer.getPixelRatio();
    const drawn = ratio => { renderer.setPixelRatio(ratio); resize(); renderer.render(scene, camera); annotate(); };
    drawn(before * factor);
    const both = L.el('canvas', { width: over.width, height: over.height }), pen = both.getContext('2d');
    pen.drawImage(renderer.domElement, 0, 0);
    pen.drawImage(over, 0, 0);
    drawn(before);
    both.toBlob(blob => L.give(blob, `${body.label}_${choice.name}.png`));
  };

  let timer = null;
  const go = step => { state.value = (+state.value + step + body.states.length) % body.states.length; update(); };
  play.onclick = () => {
    const on = play.getAttribute('aria-pressed') === 'false';
    play.setAttribute('aria-pressed', on);
    play.textContent = on ? '⏸ stop' : '▶ play';
    clearInterval(timer);
    if (on) timer = setInterval(() => go(1), Math.max(60, 2500 / body.states.length));
  };
  const turned = (right, up) => {
    const offset = new THREE.Spherical().setFromVector3(camera.position.clone().sub(controls.target));
    offset.theta -= right;
    offset.phi = Math.min(Math.PI - 0.01, Math.max(0.01, offset.phi - up));
    camera.position.copy(controls.target).add(new THREE.Vector3().setFromSpherical(offset));
    controls.update();
    if (!held) zoomToFit();
    draw();
  };
  const closer = factor => { held = true; camera.zoom *= factor; camera.updateProjectionMatrix(); draw(); };
  const by = { ArrowLeft: () => turned(-0.1, 0), ArrowRight: () => turned(0.1, 0), ArrowUp: () => turned(0, 0.1), ArrowDown: () => turned(0, -0.1), '+': () => closer(1.15), '=': () => closer(1.15),
    '-': () => closer(1 / 1.15), '0': () => fitted(), ' ': () => play.click(), '[': () => go(-1), ']': () => go(1) };
  renderer.domElement.addEventListener('keydown', event => { if (by[event.key] && !event.ctrlKey && !event.metaKey) { event.preventDefault(); event.stopPropagation(); by[event.key](); } }, true);
  L.redraws.push(() => { if (body) { resize(); renderer.setClearColor(L.dark() ? 0x0d1117 : 0xffffff); renderer.render(scene, camera); annotate(); } });

  member.oninput = () => { const keep = state.value; choose(); state.value = keep; update(); fitted(); };
  for (const control of [field, state, scale, fit, colours, at, opacity, edges.c, fibres.c, indenter.c]) control.oninput = update;
  // what is left of the body fills the picture
  clip.oninput = () => { across.copy(camera.position).sub(controls.target).normalize(); update(); fitted(); };
  turn.c.oninput = () => { update(); fitted(); };

  // the cut goes with the mouse: along its normal as that is seen, or up and down where one looks along it
  let grasped = null;
  const move = event => {
    if (!grasped) return;
    const n = direction(), right = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0), up = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1);
    let a = n.dot(right), b = n.dot(up);
    if (a * a + b * b < 0.04) { a = 0; b = 1; }
    const [from, to] = reachOf(n), mm = perPixel() / camera.zoom, way = ((event.clientX - grasped.x) * a - (event.clientY - grasped.y) * b) * mm / (a * a + b * b);
    at.value = Math.max(-1, Math.min(1, grasped.at + 2 * way / (to - from || 1)));
    update();
  };
  const released = () => { grasped = null; controls.enabled = true; removeEventListener('mousemove', move); removeEventListener('mouseup', released); };
  stage.addEventListener('pointerdown', event => { if (event.shiftKey && clip.value !== 'none') controls.enabled = false; }, true);
  stage.addEventListener('mousedown', event => {
    if (!event.shiftKey || clip.value === 'none' || event.button !== 0) return;
    controls.enabled = false;
    grasped = { x: event.clientX, y: event.clientY, at: +at.value };
    addEventListener('mousemove', move);
    addEventListener('mouseup', released);
    event.preventDefault();
  }, true);
  renderer.domElement.addEventListener('dblclick', event => {
    const hit = hitBy(event);
    if (!hit) return;
    if (clip.value === 'none') { clip.value = 'free'; across.copy(camera.position).sub(controls.target).normalize(); }
    const n = direction(), [from, to] = reachOf(n);
    at.value = Math.max(-1, Math.min(1, (2 * hit.point.dot(n) - from - to) / (to - from || 1)));
    update();
  });
  for (const end of [low, high]) end.oninput = () => { fit.value = 'own'; update(); };
  // seen from where it was put, it fits again; zoomed or moved by hand it stays
  const fitAgain = () => { if (body && size && stage.clientWidth) { if (held) { resize(); draw(); } else fitted(); } };
  if (window.ResizeObserver) new ResizeObserver(fitAgain).observe(stage); else addEventListener('resize', fitAgain);

  // on paper: a picture in place of WebGL, which browsers leave out
  const paper = L.el('canvas', { class: 'paper', role: 'img' });
  stage.append(paper);
  L.printed.push(() => {
    paper.setAttribute('aria-label', `${body.label}: the deformed body`);
    const before = renderer.getPixelRatio();
    renderer.setPixelRatio(2);
    resize();
    renderer.setClearColor(0xffffff);
    renderer.render(scene, camera);
    annotate();
    paper.width = over.width;
    paper.height = over.height;
    const pen = paper.getContext('2d');
    pen.drawImage(renderer.domElement, 0, 0);
    pen.drawImage(over, 0, 0);
    renderer.setPixelRatio(before);
  });

  // what the address asks for, through the controls themselves: report.html#field=J&state=3&clip=z
  if (asked.has('member')) member.value = asked.get('member');
  choose();
  state.value = body.states.length - 1;
  scale.value = 1;
  const flat = body.box[1][2] - body.box[0][2] < 0.01 * (body.box[1][0] - body.box[0][0]);  // a section is the cut itself
  if (body.punches.length && body.cells && !flat) {  // what matters lies under the first indenter
    clip.value = 'z';
    const [a, b] = body.box.map(corner => corner[2]), box = punches.children[0].geometry.boundingBox;
    at.value = Math.max(-1, Math.min(1, (box.min.z + box.max.z - a - b) / (b - a)));
  }
  for (const control of panel.querySelectorAll('input, select')) {
    if (!asked.has(control.id) || control === member) continue;
    if (control.type === 'checkbox') control.checked = asked.get(control.id) === '1'; else control.value = asked.get(control.id);
    if (control === low || control === high) fit.value = 'own';
  }
  resize();
  update();
  look(asked.has('view') ? Math.max(0, ['oblique', 'above', 'z', 'x'].indexOf(asked.get('view'))) : flat ? 2 : 0);
  document.documentElement.dataset.view = 'ready';
};
