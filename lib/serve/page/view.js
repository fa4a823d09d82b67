'use strict';
// The scene before the solve: the surface of the body, its sets, fibres, and the indenters, which a
// slider moves along their path. three.js draws it (a current release by npm, or Debian's of 2019).
const decode = (text, Kind) => {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return new Kind(bytes.buffer);
};
const dark = () => matchMedia('(prefers-color-scheme: dark)').matches;
const KEY = { held: '#7b61b8', moved: '#d9822b', contact: '#2a8c6a', chosen: '#d03a6c' };

class SceneView {
  constructor(place) {
    this.stage = h('div', { class: 'stage' });
    this.note = h('p', { class: 'note' });
    this.over = h('canvas', { class: 'over' });
    const box = (id, text, on) => { const c = h('input', { type: 'checkbox', id, onchange: () => this.draw() }); c.checked = on; return { c, label: h('label', {}, c, text) }; };
    this.cells = box('show-cells', 'cells', true);
    this.fibres = box('show-fibres', 'fibres', true);
    this.punches = box('show-indenters', 'indenters', true);
    this.chosen = h('select', { id: 'show-set', onchange: () => this.paint() });
    this.at = h('input', { type: 'range', id: 'show-t', min: 0, max: 1, step: 0.01, value: 0, oninput: () => this.move() });
    const views = [['Oblique', [0.62, 0.62, 1]], ['Above', [0, 1, 1e-4]], ['Along z', [0, 0, 1]], ['Along x', [1, 0, 0]]].map(([name, from]) => h('button', { type: 'button', onclick: () => this.look(from) }, name));
    this.legend = h('p', { class: 'legend' });
    this.moves = h('label', {}, 'indenter at t', this.at);
    this.tools = h('div', { class: 'view-tools' }, this.cells.label, this.fibres.label, this.punches.label, h('label', { for: 'show-set' }, 'set'), this.chosen, this.moves, h('span', {}, ...views.flatMap(b => [b, ' '])));
    place.append(this.stage, this.legend, this.tools);
    this.stage.append(this.note);
    try {
      this.begin();
    } catch (problem) {
      this.gone = true;
      this.stage.style.height = 'auto';
      this.note.style.position = 'static';
      this.note.textContent = 'This browser draws no 3D pictures (WebGL). Everything else works without them.';
    }
  }

  begin() {
    if (!window.THREE) throw new Error('no three.js');
    if (THREE.ColorManagement) THREE.ColorManagement.enabled = false;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    if ('outputColorSpace' in this.renderer) this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1));
    const canvas = this.renderer.domElement;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('tabindex', '0');
    canvas.setAttribute('aria-label', 'No scene yet');
    this.stage.prepend(canvas);
    this.stage.append(this.over);
    this.scene = new THREE.Scene();
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
    const bright = +THREE.REVISION >= 155 ? Math.PI : 1, lamp = new THREE.DirectionalLight(0xffffff, 0.42 * bright);
    lamp.position.set(-0.5, 0.9, 0.8);
    this.camera.add(lamp);
    this.scene.add(this.camera, new THREE.AmbientLight(0xffffff, 0.66 * bright));
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.parts = new THREE.Group();
    this.scene.add(this.parts);
    canvas.addEventListener('keydown', event => this.key(event));
    if (window.ResizeObserver) new ResizeObserver(() => { this.resize(); this.draw(); }).observe(this.stage);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { if (this.data) this.build(); });
  }

  key(event) {
    const turn = (right, up) => {
      const o = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target));
      o.theta -= right;
      o.phi = Math.min(Math.PI - 0.01, Math.max(0.01, o.phi - up));
      this.camera.position.copy(this.controls.target).add(new THREE.Vector3().setFromSpherical(o));
      this.controls.update();
    };
    const zoom = f => { this.camera.zoom *= f; this.camera.updateProjectionMatrix(); };
    const by = { ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1), '+': () => zoom(1.15), '=': () => zoom(1.15), '-': () => zoom(1 / 1.15), 0: () => this.look() };
    if (!by[event.key] || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    by[event.key]();
    this.draw();
  }

  stale(is) { this.stage.classList.toggle('old', is); }

  // data: what langer serve --scene prints; null: there is none, and `why`
  show(data, why = '') {
    if (this.gone) return;
    if (!data || !data.node) {
      this.stale(!!this.data);
      this.note.textContent = why;
      this.tools.hidden = !this.data;
      return;
    }
    this.stale(false);
    this.tools.hidden = false;
    this.note.textContent = '';
    const before = this.data && this.box;
    this.data = data;
    this.X = decode(data.X, Float32Array);
    this.facets = decode(data.facets, Int32Array);
    this.sets = data.sets.map(s => ({ ...s, facets: decode(s.facets, Int32Array), points: decode(s.points, Float32Array) }));
    this.indenters = data.indenters.map(p => ({ ...p, points: decode(p.points, Float32Array), triangles: decode(p.triangles, Int32Array) }));
    const keep = this.chosen.value;
    this.chosen.replaceChildren(h('option', { value: '' }, 'held, moved, contact'), ...this.sets.map(s => h('option', { value: s.name }, `${s.name} (${s.nodes})`)));
    if (this.sets.some(s => s.name === keep)) this.chosen.value = keep;
    this.moves.hidden = !this.indenters.length;
    this.punches.label.hidden = !this.indenters.length;
    this.fibres.label.hidden = !data.fibres.some(f => f.at);
    this.build();
    const box = [0, 1, 2].map(k => [this.box.min, this.box.max].map(v => v.getComponent(k).toPrecision(6)).join());
    const was = before && [0, 1, 2].map(k => [before.min, before.max].map(v => v.getComponent(k).toPrecision(6)).join());
    if (!was || box.join() !== was.join()) this.look(data.section ? [0, 0, 1] : [0.62, 0.62, 1]);
    const n = v => +v.toPrecision(4);
    const size = [0, 1, 2].map(k => n(this.box.max.getComponent(k) - this.box.min.getComponent(k))).join(' by ');
    const words = [`Body of ${data.cells} cells, ${size} mm`];
    if (this.indenters.length) words.push(`indenters: ${this.indenters.map(p => p.name).join(', ')}`);
    if (data.supports.length) words.push('held: ' + data.supports.map(s => `${s.on} (${s.hold})`).join(', '));
    if (data.loads.length) words.push('loads: ' + data.loads.map(l => `${l.kind} on ${l.on}`).join(', '));
    words.push(`law: ${data.law}`);
    this.renderer.domElement.setAttribute('aria-label', words.join('; '));
    this.legend.replaceChildren(h('span', {}, words[0]), ...[['held', 'held', data.supports.length], ['moved', 'moved or loaded', data.loads.length], ['contact', 'may touch', data.indenters.length]].filter(k => k[2]).map(([k, text]) => {
      const key = h('span', { class: 'key' }); key.style.background = KEY[k]; return h('span', {}, key, text); }), h('span', {}, `law: ${data.law}`));
  }

  build() {
    const { X, facets, parts } = this;
    parts.children.slice().forEach(c => { parts.remove(c); if (c.geometry) c.geometry.dispose(); });
    const n = facets.length / 4, at = new Float32Array(18 * n), lines = new Float32Array(24 * n);
    this.box = { min: new THREE.Vector3(Infinity, Infinity, Infinity), max: new THREE.Vector3(-Infinity, -Infinity, -Infinity) };
    const corner = i => [X[3 * i], X[3 * i + 1], X[3 * i + 2]];
    for (let f = 0; f < n; ++f) {
      const c = [0, 1, 2, 3].map(k => corner(facets[4 * f + k]));
      [0, 1, 2, 0, 2, 3].forEach((k, j) => at.set(c[k], 18 * f + 3 * j));
      [0, 1, 1, 2, 2, 3, 3, 0].forEach((k, j) => lines.set(c[k], 24 * f + 3 * j));
      c.forEach(p => { const v = new THREE.Vector3(...p); this.box.min.set(Math.min(v.x, this.box.min.x), Math.min(v.y, this.box.min.y), Math.min(v.z, this.box.min.z)); this.box.max.set(Math.max(v.x, this.box.max.x), Math.max(v.y, this.box.max.y), Math.max(v.z, this.box.max.z)); });
    }
    this.middle = this.box.min.clone().add(this.box.max).multiplyScalar(0.5);
    this.size = this.box.max.clone().sub(this.box.min).length() || 1;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(at, 3));
    this.colours = new THREE.BufferAttribute(new Float32Array(18 * n), 3);
    geometry.setAttribute('color', this.colours);
    geometry.computeVertexNormals();
    const vertex = +THREE.REVISION >= 114 ? true : 2;  // of 2019: THREE.VertexColors
    const body = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: vertex, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
    const edges = new THREE.BufferGeometry();
    edges.setAttribute('position', new THREE.BufferAttribute(lines, 3));
    this.edges = new THREE.LineSegments(edges, new THREE.LineBasicMaterial({ color: dark() ? 0x0d1117 : 0x5b4636, transparent: true, opacity: n > 2500 ? 0.15 : 0.35 }));
    this.fibreLines = new THREE.Group();
    const length = 0.016 * this.size;
    this.data.fibres.forEach((family, k) => {
      const p = decode(family.at, Float32Array), a = decode(family.along, Float32Array), ends = new Float32Array(2 * p.length);
      for (let i = 0; i < p.length; i += 3) for (let j = 0; j < 3; ++j) { ends[2 * i + j] = p[i + j] - length * a[i + j]; ends[2 * i + 3 + j] = p[i + j] + length * a[i + j]; }
      const g = new THREE.BufferGeometry();
      g.setAttribute('position', new THREE.BufferAttribute(ends, 3));
      this.fibreLines.add(new THREE.LineSegments(g, new THREE.LineBasicMaterial({ color: [0x8c1d18, 0x1d4f8c, 0x3f6b1d][k % 3] })));
    });
    this.indenterMeshes = new THREE.Group();
    for (const p of this.indenters) {
      const g = new THREE.BufferGeometry(), points = new Float32Array(3 * p.triangles.length);
      p.triangles.forEach((i, j) => points.set(p.points.subarray(3 * i, 3 * i + 3), 3 * j));
      g.setAttribute('position', new THREE.BufferAttribute(points, 3));
      g.computeVertexNormals();
      this.indenterMeshes.add(new THREE.Mesh(g, new THREE.MeshPhongMaterial({ color: 0x7d8894, transparent: true, opacity: 0.5, side: THREE.DoubleSide, depthWrite: false, shininess: 20 })));
    }
    this.marks = new THREE.Group();
    parts.add(body, this.edges, this.fibreLines, this.marks, this.indenterMeshes);
    this.resize();
    this.paint();
    this.move();
  }

  // Colours of the facets: what is held, moved and in reach of an indenter, or the chosen set.
  paint() {
    if (!this.data) return;
    const n = this.facets.length / 4, colour = Array(n).fill('#e3b999');
    const give = (name, key) => { const s = this.sets.find(x => x.name === name); if (s) for (const f of s.facets) colour[f] = KEY[key]; return s; };
    while (this.marks.children.length) this.marks.remove(this.marks.children[0]);
    if (this.chosen.value) {
      this.cross(give(this.chosen.value, 'chosen'), KEY.chosen);
    } else {
      for (const s of this.data.supports) this.cross(give(s.on, 'held'), KEY.held);
      for (const name of (this.data.touching || [])) this.cross(give(name, 'contact'), KEY.contact);
      for (const l of this.data.loads) this.cross(give(l.on, 'moved'), KEY.moved);
    }
    const rgb = {};
    for (let f = 0; f < n; ++f) {
      const c = rgb[colour[f]] = rgb[colour[f]] || [1, 3, 5].map(k => parseInt(colour[f].slice(k, k + 2), 16) / 255);
      for (let j = 0; j < 6; ++j) this.colours.array.set(c, 18 * f + 3 * j);
    }
    this.colours.needsUpdate = true;
    this.draw();
  }
  // A set without facets is drawn as crosses at its nodes.
  cross(set, colour) {
    if (!set || !set.points.length) return;
    const p = set.points, r = 0.012 * this.size, ends = [];
    for (let i = 0; i < p.length; i += 3) for (let k = 0; k < 3; ++k) for (const sign of [-1, 1]) { const q = [p[i], p[i + 1], p[i + 2]]; q[k] += sign * r; ends.push(...q); }
    const g = new THREE.BufferGeometry();
    g.setAttribute('position', new THREE.BufferAttribute(new Float32Array(ends), 3));
    this.marks.add(new THREE.LineSegments(g, new THREE.LineBasicMaterial({ color: colour, depthTest: false })));
  }

  move() {
    if (!this.data) return;
    const t = +this.at.value;
    this.indenters.forEach((p, i) => {
      let before = [0, 0, 0, 0], u = [0, 0, 0];
      for (const way of p.motion) {
        const share = way[0] > before[0] ? Math.min(1, Math.max(0, (t - before[0]) / (way[0] - before[0]))) : 1;
        u = [1, 2, 3].map(k => before[k] + share * (way[k] - before[k]));
        if (t <= way[0]) break;
        before = way;
      }
      this.indenterMeshes.children[i].position.set(...u);
    });
    this.draw();
  }

  look(from) {
    if (!this.data) return;
    const direction = from ? new THREE.Vector3(...from).normalize() : this.camera.position.clone().sub(this.controls.target).normalize();
    if (!from && direction.length() < 0.5) direction.set(0.5, 0.5, 0.7).normalize();
    this.controls.target.copy(this.middle);
    this.camera.position.copy(this.middle).addScaledVector(direction, 2 * this.size);
    this.camera.near = -10 * this.size;
    this.camera.far = 20 * this.size;
    this.camera.zoom = 1;
    this.resize();
    this.controls.update();
    this.camera.updateMatrixWorld();
    const right = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 0), up = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 1);
    let w = 0, high = 0;
    const reach = p => { p.sub(this.middle); w = Math.max(w, Math.abs(p.dot(right))); high = Math.max(high, Math.abs(p.dot(up))); };
    for (const i of this.facets) reach(new THREE.Vector3(this.X[3 * i], this.X[3 * i + 1], this.X[3 * i + 2]));
    for (const p of this.indenters) for (let i = 0; i < p.points.length; i += 3) {
      const v = new THREE.Vector3(p.points[i], p.points[i + 1], p.points[i + 2]);
      if (v.distanceTo(this.middle) < 0.6 * this.size) reach(v);
    }
    this.camera.zoom = 0.9 * Math.min((this.camera.right - this.camera.left) / (2 * w || 1), (this.camera.top - this.camera.bottom - 50 * this.perPixel()) / (2 * high || 1));
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  perPixel() { return (this.camera.right - this.camera.left) / (this.stage.clientWidth || 1); }
  resize() {
    if (!this.size || !this.stage.clientWidth) return;
    const w = this.stage.clientWidth, high = this.stage.clientHeight, half = this.size / 2;
    this.renderer.setSize(w, high);
    Object.assign(this.camera, { top: half, bottom: -half, left: -half * w / high, right: half * w / high });
    this.camera.updateProjectionMatrix();
    const ratio = this.renderer.getPixelRatio();
    Object.assign(this.over, { width: w * ratio, height: high * ratio });
    Object.assign(this.over.style, { width: w + 'px', height: high + 'px' });
    this.over.getContext('2d').setTransform(ratio, 0, 0, ratio, 0, 0);
  }
  draw() {
    if (!this.data || this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.edges.visible = this.cells.c.checked;
      this.fibreLines.visible = this.fibres.c.checked;
      this.indenterMeshes.visible = this.punches.c.checked;
      this.renderer.setClearColor(dark() ? 0x0d1117 : 0xffffff);
      this.renderer.render(this.scene, this.camera);
      this.annotate();
    });
  }
  // axes and a length
  annotate() {
    const pen = this.over.getContext('2d'), w = this.stage.clientWidth, high = this.stage.clientHeight, ink = dark() ? '#e6edf3' : '#1f2328';
    pen.clearRect(0, 0, w, high);
    pen.font = '13px "Liberation Sans", Arial, sans-serif';
    pen.fillStyle = pen.strokeStyle = ink;
    const origin = [w - 56, high - 46], inverse = this.camera.matrixWorldInverse;
    ['x', 'y', 'z'].forEach((name, k) => {
      const v = new THREE.Vector3(+(k === 0), +(k === 1), +(k === 2)).transformDirection(inverse);
      pen.lineWidth = 1.6;
      pen.beginPath(); pen.moveTo(...origin); pen.lineTo(origin[0] + 28 * v.x, origin[1] - 28 * v.y); pen.stroke();
      pen.textAlign = 'center';
      if (Math.hypot(v.x, v.y) > 0.15) pen.fillText(name, origin[0] + 38 * v.x, origin[1] - 38 * v.y + 4);
    });
    const mm = this.perPixel() / this.camera.zoom, wished = 90 * mm, nice = [1, 2, 5, 10].map(m => m * 10 ** Math.floor(Math.log10(wished))).filter(m => m <= wished).pop();
    if (!nice) return;
    pen.lineWidth = 2;
    pen.beginPath(); pen.moveTo(14, high - 16); pen.lineTo(14 + nice / mm, high - 16); pen.stroke();
    pen.textAlign = 'left';
    pen.fillText(`${+nice.toPrecision(3)} mm`, 14, high - 24);
  }
}
