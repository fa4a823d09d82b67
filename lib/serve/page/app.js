'use strict';
// The page as a whole: projects, files, check, scene, run, report. It keeps nothing: everything is
// read from the files of the folder and written into them.
const STARTERS = {
  indentation: ['Indentation', 'A sphere is pressed into skin. The law comes from two tensile curves; the force has an error bar.'],
  tension: ['Tension', 'A strip is pulled: stress over strain, force.'],
  suction: ['Suction', 'Skin is sucked into the hole of a plate, as by a Cutometer.'],
  twist: ['Twist', 'A disc glued to the skin is turned, as that of a torque meter.'],
  fit: ['Fit', 'The parameters of a law from tensile curves of your own, and which of them the curves do not determine.'],
  sweep: ['Sweep', 'The same test at several fibre angles and frictions: one table of all runs.'],
};
const KINDS = {
  fit: ['Curves and law', 'Measured curves, and the law that is fitted to them.'], material: ['Material', 'The law of the body.'],
  mesh: ['Body', 'Shape and cells of the body, named points and sets.'], solve: ['Scene', 'What holds and moves the body: supports, loads, indenters.'],
  post: ['Results', 'Columns, figures and pictures of the results.'], sensitivity: ['Sensitivity', 'Which parameters matter.'], gather: ['Table', 'One row for each run of a sweep.'],
  pipeline: ['Steps', 'The steps of the project, in the order of their data; here a sweep has its values.'], tune: ['Study', ''], sample: ['Samples', ''], report: ['Report', ''],
};
const ORDER = ['fit', 'material', 'mesh', 'solve', 'post', 'sensitivity', 'gather', 'tune', 'sample', 'report', 'pipeline'];
const $ = id => document.getElementById(id);

const ask = async (path, query = {}, options = {}) => {
  const text = new URLSearchParams(query).toString();
  let reply;
  try {
    reply = await fetch(path + (text ? '?' + text : ''), options);
  } catch (gone) {
    $('run-says').textContent = 'The server does not answer: langer serve has ended.';
    return { problem: 'The server does not answer: langer serve has ended.' };
  }
  const found = await reply.json().catch(() => ({}));
  if (!reply.ok && !found.problem) found.problem = `The server answers with ${reply.status}.`;
  return found;
};
const tell = (path, order) => ask(path, {}, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(order) });

const app = { project: null, files: [], file: '', kinds: {}, trees: {}, schemas: {}, turn: 0, problems: [] };
const form = new Form($('form'), { send: (path, value) => change(path, value), openFile: name => openFile(name) });
const view = new SceneView($('view'));
const chart = new ProgressChart($('chart'));

// ------------------------------------------------------------------ projects
const showStart = state => {
  const order = Object.keys(STARTERS), starters = state.starters.slice().sort((a, b) => (order.indexOf(a) + 99) % 99 - (order.indexOf(b) + 99) % 99);
  $('start').hidden = false;
  $('work').hidden = $('jump').hidden = true;
  $('footer').hidden = true;
  $('project-name').textContent = '';
  $('where').textContent = `The folder is made in ${state.folder}. Its files are plain text; make runs them without this page.`;
  $('starters').replaceChildren(...starters.map((name, i) => {
    const [title, says] = STARTERS[name] || [inWords(name), ''];
    const radio = h('input', { type: 'radio', name: 'starter', value: name, onchange: () => { if (!app.named) $('new-name').value = free(name, state.projects); } });
    radio.checked = i === 0;
    return h('label', { class: 'starter' }, radio, h('b', {}, title), h('span', {}, says));
  }));
  $('new-name').value = free(starters[0], state.projects);
};
const free = (name, taken) => { let one = name; for (let i = 2; taken.includes(one); ++i) one = `${name}_${i}`; return one; };
$('new-name').addEventListener('input', () => { app.named = true; });
$('new-project').addEventListener('submit', async event => {
  event.preventDefault();
  const name = $('new-name').value, starter = document.querySelector('input[name=starter]:checked').value;
  const made = await tell('api/new', { starter, name });
  $('new-problem').textContent = made.problem || '';
  if (!made.problem) location.hash = new URLSearchParams({ project: name });
});
const choices = (state, now) => {
  $('project-choice').hidden = false;
  const named = name => name || state.folder.split('/').pop();
  $('project').replaceChildren(h('option', { value: '*' }, 'New project'), ...state.projects.map(name => h('option', { value: ':' + name }, named(name))));
  $('project').value = now === null ? '*' : ':' + now;
  if (!state.projects.length) $('project-choice').hidden = true;
};
$('project').addEventListener('change', () => { location.hash = $('project').value === '*' ? 'new' : new URLSearchParams({ project: $('project').value.slice(1) }); });

const start = async () => {
  const asked = new URLSearchParams(location.hash.slice(1));
  let project = asked.has('project') ? asked.get('project') : null;
  let state = await ask('api/state', project ? { project } : {});
  if (project === null && !asked.has('new') && state.here) project = '';
  if (project === null && !asked.has('new') && (state.projects || []).length === 1) { project = state.projects[0]; state = await ask('api/state', { project }); }
  choices(state, project);
  app.project = project;
  app.named = false;
  clearInterval(app.timer);
  if (project === null || !state.here) return showStart(state);
  $('start').hidden = true;
  $('work').hidden = $('jump').hidden = false;
  $('report').hidden = true;
  chart.clear();
  $('log').textContent = '';
  const name = project || state.folder.split('/').pop();
  $('project-name').textContent = name;
  document.title = `${name} \u2013 Langer`;
  $('footer').hidden = false;
  $('footer').textContent = `Files: ${state.folder}${project ? '/' + project : ''}. In a terminal there, make does the same as Run.`;
  app.data = null;
  await readFiles(state);
  const first = app.files.includes(asked.get('file')) ? asked.get('file') : app.files[0];
  await openFile(first);
  refresh();
  watch(true);
  if (state.report) showReport();
};
addEventListener('hashchange', start);
// the address keeps the project; links within the page only scroll
for (const link of document.querySelectorAll('#jump a, .skip'))
  link.addEventListener('click', event => {
    event.preventDefault();
    const part = document.querySelector(link.getAttribute('href'));
    if (part.hidden) return;
    part.setAttribute('tabindex', '-1');
    part.focus({ preventScroll: true });
    part.scrollIntoView();
  });

// ------------------------------------------------------------------ files
const readFiles = async state => {
  const found = await Promise.all(state.files.map(async file => [file, await ask('api/file', { project: app.project, file })]));
  app.kinds = Object.fromEntries(found.map(([file, f]) => [file, f.kind || file.replace(/\.yaml$/, '')]));
  app.trees = Object.fromEntries(found.map(([file, f]) => [file, f.tree]));
  app.files = state.files.slice().sort((a, b) => (ORDER.indexOf(app.kinds[a]) + 99) % 99 - (ORDER.indexOf(app.kinds[b]) + 99) % 99);
  $('known-files').replaceChildren(...[...state.data, ...state.files].filter(n => n !== 'Makefile').map(value => h('option', { value })));
  tabs();
};
const title = file => { const t = (KINDS[app.kinds[file]] || [inWords(file.replace(/\.yaml$/, ''))])[0]; return app.files.filter(f => app.kinds[f] === app.kinds[file]).length > 1 ? `${t} (${file})` : t; };
const tabs = () => {
  const focused = document.activeElement && document.activeElement.getAttribute('role') === 'tab';
  $('tabs').replaceChildren(...app.files.map(file => {
    const n = app.problems.filter(p => p.file === file).length;
    return h('button', { type: 'button', role: 'tab', id: `tab-${file}`, 'aria-selected': String(file === app.file), 'aria-controls': 'panel', tabindex: file === app.file ? 0 : -1, onclick: () => openFile(file) },
      title(file), n ? h('span', { class: 'count', 'aria-label': `${n} messages` }, String(n)) : null);
  }));
  if (focused) $(`tab-${app.file}`).focus();
};
$('tabs').addEventListener('keydown', event => {
  const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key], n = app.files.length, at = app.files.indexOf(app.file);
  const to = step ? (at + step + n) % n : event.key === 'Home' ? 0 : event.key === 'End' ? n - 1 : -1;
  if (to < 0) return;
  event.preventDefault();
  openFile(app.files[to]);
});
const openFile = async name => {
  const file = name.replace(/^\.\//, '');
  if (!app.files.includes(file)) return;
  app.file = file;
  const kind = app.kinds[file];
  if (!app.schemas[kind]) app.schemas[kind] = await ask('api/schema', { kind });
  $('panel').setAttribute('aria-labelledby', `tab-${file}`);
  $('file-says').textContent = `${(KINDS[kind] || ['', ''])[1]} File: ${file}`;
  await showFile();
  tabs();
};
const showFile = async () => {
  const file = app.file, found = await ask('api/file', { project: app.project, file });
  if (file !== app.file) return;
  app.trees[file] = found.tree;
  if (document.activeElement !== $('yaml-text')) $('yaml-text').value = found.text || '';
  const schema = app.schemas[app.kinds[file]];
  form.problems = app.problems.filter(p => p.file === file);
  form.show(found.tree, schema && !schema.problem ? schema : {}, file);
  if (!found.tree) $('form').replaceChildren(h('p', { class: 'problem' }, found.problem || ''), h('p', {}, 'Mend it in the YAML view.'));
};
const change = async (path, value) => {
  const project = app.project, file = app.file;
  const said = await tell('api/edit', { project, file, path, value });
  if (said.problem) return said.problem;
  await showFile();
  refresh();
  return '';
};
const asText = on => {
  $('as-text').setAttribute('aria-pressed', on);
  $('as-form').setAttribute('aria-pressed', !on);
  $('yaml').hidden = !on;
  $('form').hidden = on;
  if (app.file) showFile();
};
$('as-text').addEventListener('click', () => asText(true));
$('as-form').addEventListener('click', () => asText(false));
$('yaml-save').addEventListener('click', async () => {
  const said = await tell('api/write', { project: app.project, file: app.file, text: $('yaml-text').value });
  $('yaml-problem').textContent = said.problem || '';
  if (!said.problem) { await showFile(); refresh(); }
});
$('upload').addEventListener('change', async () => {
  const one = $('upload').files[0];
  if (!one) return;
  const name = one.name.replace(/[^A-Za-z0-9_.+-]/g, '_');
  const said = one.size > 16e6 ? { problem: 'The file is larger than 16 MB: copy it into the folder.' } :
    await ask('api/upload', { project: app.project, name }, { method: 'POST', headers: { 'Content-Type': 'application/octet-stream' }, body: await one.arrayBuffer() });
  $('upload-says').textContent = said.problem || `${name} is in the folder. Choose it by this name.`;
  $('upload').value = '';
  if (!said.problem) await readFiles(await ask('api/state', { project: app.project }));
});

// ------------------------------------------------------------------ check and scene
// "solve.yaml:9:3: contacts.sphere.friction: found ...", and lines below it that belong to it
const parts = said => {
  const out = [];
  for (const line of said.split('\n')) {
    const m = /^(?:\.\/)?([^\s:]+\.(?:yaml|csv)):(\d+):(\d+): (.*)$/.exec(line);
    if (m) {
      const key = /^([A-Za-z_][\w.\[\]+-]*): /.exec(m[4]);
      out.push({ file: m[1].split('/').pop(), line: +m[2], column: +m[3], key: key ? key[1] : '', text: m[4] });
    } else if (/^\s+\S/.test(line) && out.length && !/^\s*warning:/.test(line)) out[out.length - 1].text += '\n' + line.trim();
    else if (/^\s*warning: /.test(line)) out.push({ note: true, text: line.trim() });
    else if (line.trim()) out.push({ note: true, text: line, plain: true });
  }
  return out;
};
const refresh = async () => {
  const turn = ++app.turn, project = app.project;
  $('check').setAttribute('aria-busy', 'true');
  const check = await ask('api/check', { project });
  if (turn !== app.turn) return;
  $('check').removeAttribute('aria-busy');
  const found = parts(check.said || check.problem || '');
  app.right = check.right;
  app.problems = check.right ? [] : found.filter(p => p.file);
  showMessages(found, check.right);
  tabs();
  form.mark(app.problems.filter(p => p.file === app.file));
  if (!check.right) {
    $('cost').textContent = '';
    if (!app.data) view.show(null, 'Drawn when the check finds nothing wrong.'); else view.stale(true);
    return;
  }
  $('cost').textContent = 'Cost estimate: being made \u2026';
  const made = await ask('api/scene', { project });
  if (turn !== app.turn) return;
  const scene = made.scene;
  if (!scene) {
    $('cost').textContent = '';
    showMessages(parts(made.said || made.problem || ''), false);
    view.show(null, app.data ? 'The last scene that could be drawn' : 'There is no scene to draw; see the message below.');
    return;
  }
  if (!scene.node) {
    view.show(null, 'This project solves no scene: there is nothing to draw.');
    $('view').closest('section').hidden = true;
    $('cost').textContent = 'Nothing is solved; the steps take seconds.';
    return;
  }
  $('view').closest('section').hidden = false;
  scene.touching = touching();
  app.data = scene;
  view.show(scene);
  $('known-sets').replaceChildren(...scene.sets.map(s => h('option', { value: s.name })));
  if (scene.problem) showMessages([...parts(scene.problem), ...found], false);
  else showMessages([...found, ...(made.said || '').split('\n').filter(l => /warning: /.test(l)).map(text => ({ note: true, text }))], true);
  $('cost').textContent = cost(scene, made.said || '');
};
// sets that contacts name, from the files: the scene has the nodes, not the names
const touching = () => {
  const out = [], look = tree => {
    const contacts = tree && tree.kind === 'map' && tree.entries.find(e => e.key === 'contacts');
    if (!contacts || contacts.value.kind !== 'map') return;
    for (const e of contacts.value.entries) { const on = e.value.kind === 'map' && e.value.entries.find(x => x.key === 'on'); if (on && on.value.text) out.push(on.value.text); }
  };
  Object.values(app.trees).forEach(look);
  return out;
};
const amount = (v, unit) => `${+v.toPrecision(2)} ${unit}`;
const cost = (scene, said) => {
  const f = scene.forecast;
  if (!f) return '';
  const seconds = f.cpu[0] * scene.members;
  const time = seconds < 90 ? amount(Math.max(seconds, 0.1), 's') : seconds < 5400 ? amount(seconds / 60, 'min') : amount(seconds / 3600, 'h');
  const words = [`Cost estimate: about ${time} of CPU time`, `${amount(f.memory[0], f.memory[1])} of memory`, `${f.cells[0]} cells, ${f.free_dofs[0]} unknowns, ${f.steps[0]} steps`];
  if (scene.members > 1) words.push(`${scene.members} runs; the first is drawn`);
  const estimate = /estimate\s+about ([^\n]*)/.exec(said);
  return words.join('; ') + '.' + (estimate ? ` The estimate of the error: about ${estimate[1]}.` : '');
};
const showMessages = (found, right) => {
  const wrong = found.filter(p => p.file), notes = found.filter(p => p.note && (!p.plain || !right));
  const list = h('ul', { class: 'messages' }, wrong.map(p => h('li', { class: right ? 'note' : null }, `${p.file}, line ${p.line}: ${p.text}\n`, app.files.includes(p.file) ? h('button', { type: 'button', onclick: () => goTo(p) }, 'Show') : null)), notes.map(p => h('li', { class: right ? 'note' : null }, p.text)));
  $('check').replaceChildren(...(right ? [h('p', { class: 'right-words' }, 'Nothing is wrong: the files can be run.')] : []), ...(wrong.length + notes.length ? [list] : []));
};
const goTo = async p => {
  if (p.file !== app.file) await openFile(p.file);
  asText(false);
  await showFile();
  if (!form.focusOn(p)) { asText(true); await showFile(); $('yaml-text').focus(); }
};

// ------------------------------------------------------------------ run
const WORDS = { running: 'Running', done: 'Done', failed: 'Failed', stopped: 'Stopped: finished steps are kept, Run goes on from them' };
$('run').addEventListener('click', async () => {
  chart.clear();
  $('report').hidden = true;
  const said = await tell('api/run', { project: app.project });
  if (said.problem) { $('run-says').textContent = said.problem; return; }
  watch();
});
$('stop').addEventListener('click', () => tell('api/stop', {}));
const watch = async first => {
  clearInterval(app.timer);
  const project = app.project;
  const look = async () => {
    const p = await ask('api/progress', { project });
    if (project !== app.project) return;
    const runs = p.state === 'running';
    $('run').disabled = runs;
    $('stop').disabled = !runs;
    if (p.state === 'none' || p.problem) { if (first) $('run-says').textContent = ''; clearInterval(app.timer); return; }
    const step = (p.log || '').split('\n').reverse().map(l => /^(?:.*\/)?langer-(\w+) /.exec(l)).find(Boolean);
    const words = WORDS[p.state] + (runs && step ? `: ${step[1]}` : '') + (p.state === 'failed' ? `: exit code ${p.code}` : '') + (runs ? '' : ` after ${amount(Math.max(p.seconds, 0.1), 's')}`);
    if ($('run-says').textContent !== words) $('run-says').textContent = words;
    const end = $('log').scrollTop + $('log').clientHeight > $('log').scrollHeight - 30;
    if ($('log').textContent !== p.log) { $('log').textContent = p.log; if (end) $('log').scrollTop = $('log').scrollHeight; }
    chart.show(p.series || {});
    if (p.state === 'failed') {
      $('log-fold').open = true;
      showMessages([...parts(p.log).filter(m => m.file)], false);
    }
    if (!runs) {
      clearInterval(app.timer);
      if (p.state === 'done') {
        showReport();
        if (!first) refresh();  // the law may have been fitted
      }
    }
  };
  await look();
  if (!$('stop').disabled) app.timer = setInterval(look, 500);
};
const showReport = async () => {
  const state = await ask('api/state', { project: app.project });
  if (!state.report) return;
  const at = `files/${app.project ? encodeURIComponent(app.project) + '/' : ''}run/report/report.html`;
  $('report').hidden = false;
  $('report-link').href = at;
  $('report-frame').src = at + '?' + Date.now();
};

start();
