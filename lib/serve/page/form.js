'use strict';
// A form for a YAML file, made from its JSON Schema (`langer schema KIND`): one control for each
// key that is in the file, and a list of the keys that may be added. A change is sent as the path
// of the key and its new value in YAML; the server edits that place of the text.
const h = (tag, attributes = {}, ...children) => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat().filter(c => c !== null && c !== undefined));
  return element;
};

const Schema = {
  // The schema itself: references are followed; of "if there is an include" the other branch.
  plain(schema, root) {
    let s = schema;
    for (let i = 0; i < 20; ++i) {
      if (s.$ref) {
        const { $ref, ...own } = s;
        s = { ...$ref.slice(2).split('/').reduce((at, key) => at[key], root), ...own };
      } else if (s.if && s.else) {
        const { if: _, then: __, else: other, ...own } = s;
        s = { ...other, ...own };
      } else if (s.allOf && s.allOf.length === 1) {
        const { allOf, ...own } = s;
        s = { ...allOf[0], ...own };
      } else break;
    }
    return s;
  },
  // All forms that a value may have, without "nothing".
  forms(schema, root) {
    const s = Schema.plain(schema, root);
    if (!s.anyOf) return [s];
    const { anyOf, ...own } = s;
    return anyOf.flatMap(one => Schema.forms(one, root)).filter(f => f.type !== 'null').map(f => ({ ...f, ...own }));
  },
  type(s) {
    if (s.enum) return 'enum';
    const t = Array.isArray(s.type) ? s.type.filter(x => x !== 'null')[0] : s.type;
    return t || (s.properties || s.patternProperties ? 'object' : 'string');
  },
  isChoice: s => Schema.type(s) === 'object' && s.minProperties === 1 && s.maxProperties === 1,
  isNamed: s => Schema.type(s) === 'object' && !!s.patternProperties,
  isNumber: s => ['number', 'integer'].includes(Schema.type(s)),
  keys: s => Object.keys(s.properties || {}).filter(k => k !== 'include'),
  fits(s, tree) {
    const t = Schema.type(s);
    if (tree.kind === 'map') return t === 'object';
    if (tree.kind === 'list') return t === 'array';
    if (tree.kind === 'scalar') return t !== 'object' && t !== 'array';
    return true;
  },
  // The form that a value of the file has; of several maps the one that knows most of its keys.
  best(forms, tree) {
    const rate = f => (tree.entries || []).reduce((n, e) => n + ((f.properties || {})[e.key] ? 1 : -2), 0);
    const fitting = forms.filter(f => Schema.fits(f, tree));
    return fitting.sort((a, b) => rate(b) - rate(a))[0] || (tree.kind === 'map' || tree.kind === 'list' ? {} : forms[0]);
  },
  // With the part that another key chooses: "if stage is solve, then ...".
  chosen(s, root, tree) {
    for (const rule of s.allOf || []) {
      const [[key, is]] = Object.entries((rule.if || {}).properties || { '': {} });
      const entry = (tree.entries || []).find(e => e.key === key);
      if (!entry || is.const === undefined || entry.value.text !== String(is.const)) continue;
      const then = Schema.plain(rule.then, root);
      return { ...s, ...then, properties: { ...then.properties, [key]: s.properties[key] } };
    }
    return s;
  },
  // What a new part begins with, as YAML in one line.
  begin(schema, root, key = '', depth = 0) {
    const s = Schema.forms(schema, root)[0];
    if (s.default !== undefined && !(s.default === '' && s.type !== 'object')) return Yaml.of(s.default);
    const t = Schema.type(s);
    const known = { on: 'top', of: 'top', within: '1%', file: 'file.csv', key: 'key', law: 'law' };
    if (t === 'enum') return String(s.enum[0]);
    if (t === 'boolean') return 'true';
    if (Schema.isNumber(s)) {
      if (s.minimum !== undefined && s.minimum > 0) return String(Math.max(s.minimum, t === 'integer' ? s.minimum : 1));
      return s.exclusiveMinimum !== undefined ? '1' : '0';
    }
    if (t === 'array') {
      const n = s.minItems || 1, items = s.items || {};
      return '[' + Array(n).fill(Schema.begin(items, root, key, depth + 1)).join(', ') + ']';
    }
    if (t === 'object') {
      if (depth > 6) return '{}';
      let keys = s.required || [];
      if (Schema.isNamed(s)) return '{name: ' + Schema.begin(Object.values(s.patternProperties)[0], root, '', depth + 1) + '}';
      if (Schema.isChoice(s) || !keys.length) keys = Schema.keys(s).slice(0, 1);
      return '{' + keys.map(k => `${k}: ${Schema.begin(s.properties[k], root, k, depth + 1)}`).join(', ') + '}';
    }
    return known[key] || 'name';
  },
};

const Yaml = {
  number: /^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$/,
  // A text that a person typed, as YAML that means just that.
  text(s) {
    if (Yaml.number.test(s)) return s;
    const plain = /^[A-Za-z0-9_./+%-][A-Za-z0-9_ ./+%()-]*$/.test(s) && !/ $/.test(s) && !/^(true|false|yes|no|on|off|null|~|-)$/i.test(s) && !/^- /.test(s);
    return plain ? s : JSON.stringify(s);
  },
  of(value) {
    if (Array.isArray(value)) return '[' + value.map(Yaml.of).join(', ') + ']';
    if (value && typeof value === 'object') return '{' + Object.entries(value).map(([k, v]) => `${k}: ${Yaml.of(v)}`).join(', ') + '}';
    return typeof value === 'string' ? Yaml.text(value) : String(value);
  },
  // A part of a file in one line.
  line(tree) {
    if (tree.kind === 'list') return '[' + tree.items.map(Yaml.line).join(', ') + ']';
    if (tree.kind === 'map') return '{' + tree.entries.map(e => `${e.key}: ${Yaml.line(e.value)}`).join(', ') + '}';
    if (tree.kind === 'null') return 'null';
    return tree.quoted ? JSON.stringify(tree.text) : Yaml.text(tree.text);
  },
};

const inWords = key => { if (key.length === 1) return key; const w = key.replace(/_/g, ' '); return w.charAt(0).toUpperCase() + w.slice(1); };
const atPath = (path, key) => path ? `${path}.${key}` : key;

class Form {
  // send(path, value or null) resolves when the file has changed; openFile(name) shows another one
  constructor(place, { send, openFile }) {
    this.place = place;
    this.send = send;
    this.openFile = openFile;
    this.closed = new Set();
    this.problems = [];
    this.n = 0;
  }

  show(tree, schema, file) {
    this.root = schema;
    this.file = file;
    this.controls = [];
    const focus = document.activeElement && this.place.contains(document.activeElement) && document.activeElement.dataset.path;
    const parts = [];
    const top = Schema.plain(schema, schema);
    if (tree) this.object(tree, top, '', parts);
    this.place.replaceChildren(...parts);
    this.mark(this.problems);
    if (focus) {
      const again = [...this.place.querySelectorAll('[data-path]')].find(c => c.dataset.path === focus);
      if (again) again.focus({ preventScroll: true });
    }
  }

  // The keys of a map: those that are there, then those that may be added.
  object(tree, schema, path, out) {
    const s = Schema.chosen(schema, this.root, tree);
    if (Schema.isNamed(s)) return this.named(tree, s, path, out);
    const entries = tree.kind === 'map' ? tree.entries : [];
    if (Schema.isChoice(s) && path) this.choice(entries, s, path, out);
    for (const { key, value } of entries) {
      if (key === 'include') {
        const files = value.kind === 'list' ? value.items.map(i => i.text) : [value.text];
        for (const name of files) out.push(h('p', { class: 'soft' }, 'Taken from ', h('button', { type: 'button', onclick: () => this.openFile(name) }, name)));
        continue;
      }
      const own = (s.properties || {})[key];
      this.value(value, own || {}, atPath(path, key), key, out, { removable: !(s.required || []).includes(key) && !Schema.isChoice(s), unknown: !own });
    }
    if (!Schema.isChoice(s)) this.adder(entries, s, path, out);
  }

  choice(entries, s, path, out) {
    const keys = Schema.keys(s), now = entries.map(e => e.key).find(k => keys.includes(k)), id = this.id();
    const select = h('select', { id, 'data-path': path, onchange: () => this.change(select, path, `{${select.value}: ${Schema.begin(s.properties[select.value], this.root, select.value)}}`) },
      now ? null : h('option', { value: '' }, 'choose'), keys.map(k => h('option', { value: k, selected: k === now }, inWords(k))));
    out.push(this.row('Kind', id, [select], '', path, null));
  }

  named(tree, s, path, out) {
    const item = Object.values(s.patternProperties)[0];
    for (const { key, value } of tree.kind === 'map' ? tree.entries : [])
      this.value(value, item, atPath(path, key), key, out, { removable: true, asWritten: true });
    const id = this.id(), name = h('input', { id, type: 'text', class: 'short', pattern: '[A-Za-z0-9_+\\-]+' });
    const add = () => { if (name.value && name.checkValidity()) this.change(name, atPath(path, name.value), Schema.begin(item, this.root)); else name.focus(); };
    out.push(h('div', { class: 'add' }, h('label', { for: id }, 'New name'), name, h('button', { type: 'button', onclick: add }, 'Add')));
  }

  adder(entries, s, path, out) {
    const there = new Set(entries.map(e => e.key)), rest = Schema.keys(s).filter(k => !there.has(k));
    if (!rest.length) return;
    const id = this.id(), help = h('p', { class: 'help' });
    const add = h('button', { type: 'button', disabled: true, onclick: () => this.change(select, atPath(path, select.value), Schema.begin(s.properties[select.value], this.root, select.value)) }, 'Add');
    const select = h('select', { id, 'aria-label': `Setting to add${path ? ' to ' + path : ''}`, onchange: () => {
      add.disabled = !select.value;
      help.textContent = select.value ? Schema.plain(s.properties[select.value], this.root).description || '' : '';
    } }, h('option', { value: '' }, `Add a setting (${rest.length})`), rest.map(k => h('option', { value: k }, inWords(k))));
    out.push(h('div', { class: 'add' }, select, add, help));
  }

  // One value: a line with a control, or a part that folds.
  value(tree, schema, path, key, out, { removable = false, asWritten = false, unknown = false, title = '' } = {}) {
    const forms = Schema.forms(schema, this.root);
    const s = Schema.best(forms, tree);
    const label = title || (asWritten ? key : inWords(key));
    const [says, unit] = this.says(schema, s);
    const remove = removable ? h('button', { type: 'button', class: 'quiet take', 'aria-label': `Remove ${label}`, onclick: event => this.change(event.target, path, null) }, 'Remove') : null;
    const t = Schema.type(s);
    const other = forms.filter(f => Schema.type(f) !== t && !(Schema.isNumber(f) && Schema.isNumber(s)) && ['object', 'array'].includes(Schema.type(f)) !== ['object', 'array'].includes(t))[0];
    const turn = other && !unknown ? h('button', { type: 'button', class: 'quiet', onclick: event => this.change(event.target, path, this.turned(tree, other)) },
      Schema.type(other) === 'array' ? 'As a list' : Schema.type(other) === 'object' ? 'More detail' : 'As one value') : null;
    const control = this.control(tree, s, path, key);
    if (control) {
      const id = control.id || this.id();
      if (!control.group) control.elements[0].id = id;
      out.push(this.row(label, control.group ? null : id, [...control.elements, unit ? h('span', { class: 'unit' }, unit) : null], says, path, [turn, remove], tree, control.group));
      return;
    }
    const inside = [], where = tree.kind === 'null' ? { ...tree, kind: t === 'array' ? 'list' : 'map', items: [], entries: [] } : tree;
    if (t === 'array' || where.kind === 'list') this.list(where, s, path, label, inside);
    else this.object(where, s, path, inside);
    if (turn) inside.push(turn);
    const fold = h('details', { class: 'part', 'data-place': `${tree.line}:${tree.column}`, open: !this.closed.has(this.file + path), ontoggle: () => this.closed[fold.open ? 'delete' : 'add'](this.file + path) },
      h('summary', {}, label, ' ', says ? h('small', {}, this.short(says)) : null),
      h('div', { class: 'inside' }, h('p', { class: 'problem' }), inside, removable ? remove : null));
    this.controls.push({ path, line: tree.line, column: tree.column, problem: fold.querySelector('.problem'), focus: fold.querySelector('summary'), fold });
    out.push(fold);
  }

  list(tree, s, path, label, out) {
    const item = s.items || {}, one = label.replace(/ies$/, 'y').replace(/s$/, '');
    tree.items.forEach((value, i) => this.value(value, item, `${path}[${i}]`, '', out, { removable: true, title: `${one} ${i + 1}` }));
    const fresh = tree.items.length && tree.items[tree.items.length - 1];
    out.push(h('div', { class: 'add' }, h('button', { type: 'button', onclick: event => this.change(event.target, `${path}[${tree.items.length}]`,
      fresh ? Yaml.line(fresh) : Schema.begin(item, this.root)) }, `Add ${/^[aeiou]/i.test(one) ? 'an' : 'a'} ${one.toLowerCase()}`)));
  }

  // A part in another of its forms: a number becomes a history that ends there, "1%" a map.
  turned(tree, other) {
    const t = Schema.type(other);
    if (t === 'array' && tree.kind === 'scalar') {
      const item = Schema.plain(other.items || {}, this.root);
      if (item.properties && item.properties.to) return `[{t: 1, to: ${Yaml.text(tree.text)}}]`;
      return `[${Yaml.text(tree.text)}]`;
    }
    if (t === 'object' && tree.kind === 'scalar' && other.required) return `{${other.required[0]}: ${Yaml.text(tree.text)}}`;
    if (t !== 'array' && t !== 'object') {
      const last = tree.kind === 'list' && tree.items[tree.items.length - 1];
      const to = last && last.kind === 'map' && last.entries.find(e => e.key === 'to');
      if (to) return Yaml.line(to.value);
    }
    return Schema.begin(other, this.root);
  }

  // {elements, group} of what fits in a line; null for what needs a part of its own.
  control(tree, s, path, key) {
    const t = Schema.type(s), text = tree.kind === 'scalar' ? tree.text : '';
    if (tree.kind === 'map' || t === 'object') return null;
    if (tree.kind === 'list' && t !== 'array') return tree.items.every(i => i.kind === 'scalar') ? this.words(tree.items, path) : null;
    if (t === 'array') {
      const item = Schema.forms(s.items || {}, this.root)[0], it = Schema.type(item);
      const items = tree.kind === 'list' ? tree.items : [];
      if (items.some(i => i.kind !== 'scalar')) return null;
      if (it === 'enum') return this.ticks(items, item, path);
      if (Schema.isNumber(item) && s.minItems && s.minItems === s.maxItems && s.minItems <= 4) return this.axes(items, s.minItems, path);
      if (it === 'object' || it === 'array') return null;
      return this.words(items, path);
    }
    if (t === 'enum') {
      const all = s.enum.map(String), known = all.includes(text);
      const select = h('select', { 'data-path': path, onchange: () => this.change(select, path, Yaml.text(select.value)) },
        known ? null : h('option', { value: text, selected: true }, text || 'choose'), all.map(w => h('option', { value: w, selected: w === text }, w)));
      return { elements: [select] };
    }
    if (t === 'boolean') {
      const box = h('input', { type: 'checkbox', 'data-path': path, onchange: () => this.change(box, path, String(box.checked)) });
      box.checked = /^(true|yes|on)$/i.test(text);
      return { elements: [box] };
    }
    const numeric = Schema.isNumber(s);
    const lists = { config: 'known-files', on: 'known-sets', of: 'known-sets', at: 'known-sets', file: 'known-files' };
    const input = h('input', { type: 'text', 'data-path': path, value: text, inputmode: numeric ? 'decimal' : undefined, class: numeric ? undefined : 'wide', list: numeric ? undefined : lists[key], autocomplete: 'off', spellcheck: 'false',
      onchange: () => this.change(input, path, this.typed(input.value, numeric, tree)) });
    return { elements: [input] };
  }
  typed(value, numeric, tree) {
    const v = value.trim().replace(/^([-+]?\d+),(\d+)$/, '$1.$2').replace(/^\u2212/, '-');
    if (!numeric && tree.quoted) return JSON.stringify(v);
    return v === '' ? '""' : Yaml.text(v);
  }
  axes(items, n, path) {
    const names = n === 3 ? ['x', 'y', 'z'] : Array.from({ length: n }, (_, i) => String(i + 1));
    const inputs = names.map((name, i) => h('input', { type: 'text', class: 'short', inputmode: 'decimal', 'data-path': `${path}[${i}]`, 'aria-label': `${path} ${name}`, value: items[i] ? items[i].text : '', autocomplete: 'off',
      onchange: event => items.length === n ? this.change(event.target, `${path}[${i}]`, this.typed(event.target.value, true, {})) :
        this.change(event.target, path, '[' + inputs.map(c => c.value || '0').join(', ') + ']') }));
    return { group: true, elements: inputs.map((input, i) => h('span', { class: 'axes' }, h('span', { 'aria-hidden': 'true' }, names[i]), input)) };
  }
  ticks(items, item, path) {
    const boxes = item.enum.map(word => { const c = h('input', { type: 'checkbox', 'data-path': `${path}#${word}`, value: word, onchange: () => this.change(c, path, '[' + boxes.filter(b => b.checked).map(b => b.value).join(', ') + ']') }); c.checked = items.some(i => i.text === String(word)); return c; });
    return { group: true, elements: boxes.map(c => h('label', { class: 'ticks' }, c, c.value)) };
  }
  words(items, path) {
    const input = h('input', { type: 'text', class: 'wide', 'data-path': path, value: items.map(i => i.text).join(', '), autocomplete: 'off', spellcheck: 'false',
      onchange: () => this.change(input, path, '[' + input.value.split(',').map(w => w.trim()).filter(Boolean).map(Yaml.text).join(', ') + ']') });
    return { elements: [input], note: 'separated by commas' };
  }

  row(label, id, elements, says, path, buttons, tree = {}, group = false) {
    const problem = h('p', { class: 'problem', id: this.id() }), help = this.help(says);
    if (help) help.id = this.id();
    const row = h('div', { class: 'field', role: group ? 'group' : undefined, 'aria-label': group ? label : undefined },
      id ? h('label', { for: id }, label) : h('span', { class: 'label', 'aria-hidden': 'true' }, label),
      h('div', { class: 'control' }, elements), h('div', {}, buttons || []), help, problem);
    const first = row.querySelector('.control input, .control select');
    if (first) first.setAttribute('aria-describedby', [help && help.id, problem.id].filter(Boolean).join(' '));
    this.controls.push({ path, line: tree.line, column: tree.column, problem, focus: first, row });
    return row;
  }
  help(says) {
    if (!says) return null;
    if (says.length <= 150) return h('p', { class: 'help' }, says);
    return h('details', { class: 'help long' }, h('summary', {}, this.short(says)), says);
  }
  short(says) {
    if (says.length <= 110) return says;
    return says.slice(0, 110).replace(/\s+\S*$/, '') + ' \u2026';
  }
  // Explanation and unit; the schema has the unit at the end, in brackets.
  says(schema, s) {
    const words = Schema.plain(schema, this.root).description || s.description || '', m = /^(.*?)\s\[(?!\d+\])([^\[\]]{1,12})\]$/.exec(words);
    return m ? [m[1], m[2]] : [words, ''];
  }
  id() { return `f${++this.n}`; }

  async change(control, path, value) {
    const said = await this.send(path, value);
    if (!said) return;
    const at = this.controls.find(c => c.path === path) || this.controls.find(c => path.startsWith(c.path));
    if (at) at.problem.textContent = said;
  }

  // Messages of the programs at the lines that they name: {line, column, text}. Returns those shown.
  mark(problems) {
    this.problems = problems;
    for (const c of this.controls || []) { c.problem.textContent = ''; if (c.focus) c.focus.removeAttribute('aria-invalid'); }
    for (const p of problems) {
      const c = this.find(p);
      if (!c) continue;
      c.problem.textContent += (c.problem.textContent ? '\n' : '') + (p.key ? p.text.slice(p.key.length + 2) : p.text);
      if (c.focus && c.focus.tagName !== 'SUMMARY') c.focus.setAttribute('aria-invalid', 'true');
    }
  }
  find(p) {
    const named = p.key && (this.controls || []).find(c => c.path === p.key);
    const here = (this.controls || []).filter(c => c.line === p.line && c.column === p.column);
    return named || here[here.length - 1] || (this.controls || []).find(c => c.line === p.line);
  }
  focusOn(p) {
    const c = this.find(p);
    if (!c || !c.focus) return false;
    for (let at = c.focus.closest('details.part'); at; at = at.parentElement.closest('details.part')) at.open = true;
    c.focus.focus();
    c.focus.scrollIntoView({ block: 'center' });
    return true;
  }
}
