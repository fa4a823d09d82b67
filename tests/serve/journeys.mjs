// Drives the set-up page in Chromium, as a person would: six tests are set up, run and read without
// touching a file. Each takes a starter, changes values by the labels of the form, waits for the
// check, the scene and the cost estimate, runs, and reads the report.
//   node journeys.mjs LANGER WORK [PICTURES]      LANGER: the program; WORK: an empty folder
// Also checked: no request leaves the server, nothing scrolls sideways at 1400 and 390 pixels, every
// control has a name, a whole journey works by the keyboard alone, messages are shown at their
// fields. Pictures are taken if a folder is given for them.
import { spawn } from 'node:child_process';
import { readFileSync, writeFileSync, mkdirSync, existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

const { chromium } = createRequire(process.env.PLAYWRIGHT_FROM || import.meta.url)('playwright-core');
const [langer, work, pictures] = process.argv.slice(2);
const assert = (right, words) => { if (!right) throw new Error(words); };

mkdirSync(work, { recursive: true });
const server = spawn(langer, ['serve', work], { stdio: ['ignore', 'pipe', 'inherit'] });
const address = await new Promise((resolve, reject) => {
  server.stdout.on('data', data => resolve(String(data).trim()));
  server.on('exit', code => reject(new Error(`langer serve ended with ${code}`)));
});
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM || '/usr/bin/chromium', args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
page.setDefaultTimeout(120000);
const troubles = [];
page.on('request', r => { if (!r.url().startsWith(address) && !/^(data|blob|about):/.test(r.url())) troubles.push(`a request to ${r.url()}`); });
page.on('pageerror', e => troubles.push(`an error on the page: ${e}`));

const field = path => page.locator(`#form [data-path="${path}"]`);
const yaml = (project, file) => readFileSync(join(work, project, file), 'utf8');
const right = () => page.getByText('Nothing is wrong').waitFor();
const tab = name => page.getByRole('tab', { name }).click();
const picture = async (name, wide = true) => {
  if (!pictures) return;
  mkdirSync(pictures, { recursive: true });
  await page.screenshot({ path: join(pictures, name + '.png'), fullPage: wide });
};
const set = async (path, value) => {
  await field(path).fill(value);
  const edited = page.waitForResponse(r => r.url().includes('/api/edit'));
  await field(path).press('Enter');
  const reply = await (await edited).json();
  assert(!reply.problem, `${path}: ${reply.problem}`);
};
// The page at each width and in each colour scheme.
const look = async name => {
  for (const [width, height] of [[1400, 900], [390, 844]])
    for (const colorScheme of ['light', 'dark']) {
      await page.setViewportSize({ width, height });
      await page.emulateMedia({ colorScheme });
      await page.waitForTimeout(400);
      const wider = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      assert(wider <= 0, `${name}: ${wider} pixels too wide at ${width}`);
      await picture(`${name}_${width}_${colorScheme}`);
    }
  await page.setViewportSize({ width: 1400, height: 900 });
  await page.emulateMedia({ colorScheme: 'light' });
};
const named = async where => {
  const without = await page.evaluate(() => [...document.querySelectorAll('button, input, select, textarea, iframe')].filter(e => e.checkVisibility())
    .filter(e => !(e.labels && e.labels.length && [...e.labels].some(l => l.textContent.trim())) && !e.getAttribute('aria-label') && !e.title && !e.textContent.trim())
    .map(e => e.outerHTML.slice(0, 120)));
  assert(!without.length, `${where}: controls without a name: ${without.join('\n')}`);
};

// Tab until the control has the focus.
const tabTo = async selector => {
  for (let i = 0; i < 150; ++i) {
    if (await page.evaluate(s => document.activeElement.matches(s), selector)) return;
    await page.keyboard.press('Tab');
  }
  throw new Error(`${selector} cannot be reached by the Tab key`);
};

const create = async (starter, name, byKeys) => {
  await page.goto('about:blank');
  await page.goto(address + '#new');
  await page.getByRole('radio').first().waitFor();
  if (byKeys) {
    await tabTo('input[name=starter]');
    while (!(await page.evaluate(s => document.activeElement.value === s, starter))) await page.keyboard.press('ArrowDown');
    await tabTo('#new-name');
    await page.keyboard.press('Control+A');
    await page.keyboard.type(name);
    await page.keyboard.press('Enter');
  } else {
    await page.locator(`input[name=starter][value=${starter}]`).check();
    await page.getByLabel('Name of its folder').fill(name);
    await page.getByRole('button', { name: 'Create' }).click();
  }
  await page.getByRole('tab').first().waitFor();
  await right();
};
const run = async (name, report) => {
  await right();
  await page.getByText('Cost estimate: about').or(page.getByText('Nothing is solved')).waitFor();
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.locator('#run-says', { hasText: /Done|Failed|Stopped/ }).waitFor();
  const says = await page.locator('#run-says').textContent();
  assert(/^Done/.test(says), `${name}: ${says}\n${await page.locator('#log').textContent()}`);
  assert(existsSync(join(work, name, 'run/report/report.html')), `${name}: no report`);
  await page.frameLocator('#report-frame').getByText(report).first().waitFor();
};

const journeys = {
  async indentation(name) {
    await create('indentation', name);
    await tab('Scene');
    await set('contacts.sphere.motion[0].to[1]', '-0.4');
    await set('contacts.sphere.friction', '-1');
    await page.locator('#check').getByText(/contacts.sphere.friction: found -1/).waitFor();
    assert(await field('contacts.sphere.friction').getAttribute('aria-invalid') === 'true', 'the field is not marked');
    await picture('message_1400', false);
    await set('contacts.sphere.friction', '0.2');
    await right();
    await page.getByText('Cost estimate: about').waitFor();
    const text = yaml(name, 'solve.yaml');
    assert(/friction: 0\.2 +# Coulomb/.test(text) && /to: \[0, -0\.4, 0\]\} +# mm/.test(text), `comments are lost:\n${text}`);
    await named(name);
    await look('scene');
    await run(name, /N/);
    await look('done');
    await page.locator('#report').scrollIntoViewIfNeeded();
    await page.evaluate(() => document.querySelector('#report').scrollIntoView());
    await page.waitForTimeout(1500);
    await picture('report_1400', false);
    await page.evaluate(() => scrollTo(0, 0));
    await page.waitForTimeout(500);
    await picture('top_1400', false);
  },
  async tension(name) {
    await create('tension', name);
    await tab('Scene');
    await set('loads[0].displacement.x', '3');
    await run(name, /Tension/);
    // A run of a fraction of a second may end before a first step is drawn.
    await page.locator('#chart svg').waitFor({timeout: 5000}).catch(() => {});
    assert(/displacement: \{x: 3\}\} +# mm at the end/.test(yaml(name, 'solve.yaml')), 'the load has not changed');
  },
  async suction(name) {
    await create('suction', name);
    await tab('Scene');
    await set('loads[0].pressure[1].to', '-0.01');
    await run(name, /Suction/);
    await picture('suction_1400');
  },
  // by the keyboard alone
  async twist(name) {
    await create('twist', name, true);
    await tabTo('[role=tab][aria-selected=true]');
    while (!(await page.evaluate(() => /Scene/.test(document.activeElement.textContent)))) { await page.keyboard.press('ArrowRight'); await page.waitForTimeout(150); }
    await field('loads[0].rotation.angle').waitFor();
    await tabTo('[data-path="loads[0].rotation.angle"]');
    await page.keyboard.press('Control+A');
    await page.keyboard.type('10');
    const edited = page.waitForResponse(r => r.url().includes('/api/edit'));
    await page.keyboard.press('Enter');
    await edited;
    await right();
    await tabTo('#run');
    await page.keyboard.press('Enter');
    await page.locator('#run-says', { hasText: /^Done/ }).waitFor();
    assert(/angle: 10\}/.test(yaml(name, 'solve.yaml')), 'the angle has not changed');
    assert((await page.locator('#view canvas[role=img]').getAttribute('aria-label')).includes('rotation on disc'), 'the scene is not described');
    await picture('twist_1400');
  },
  async fit(name) {
    await create('fit', name);
    const own = join(work, 'own.csv');
    writeFileSync(own, readFileSync(join(work, name, 'along.csv')));
    await page.getByLabel('Add a file').setInputFiles(own);
    await page.getByText('own.csv is in the folder').waitFor();
    await tab('Curves and law');
    await set('data[0].file', 'own.csv');
    await run(name, /Fit/);
    await picture('fit_1400');
  },
  async sweep(name) {
    await create('sweep', name);
    await tab('Steps');
    await set('nodes.solve.sweep.alpha.values', '0, 90');
    await run(name, /Sweep/);
    assert(/values: \[0, 90\], unit: deg/.test(yaml(name, 'pipeline.yaml')), 'the sweep has not changed');
    await picture('sweep_1400');
  },
};

let failed = 0;
try {
  await page.goto(address);
  await page.getByRole('radio').first().waitFor();
  await named('start');
  await look('start');
  const wanted = process.env.JOURNEYS ? process.env.JOURNEYS.split(',') : Object.keys(journeys);
  for (const name of wanted) {
    const begun = Date.now();
    try {
      await journeys[name](name);
      const seconds = (Date.now() - begun) / 1000;
      console.log(`${name}: set up, run and read in ${seconds.toFixed(1)} s`);
      assert(seconds < 300, `${name} takes more than five minutes`);
    } catch (problem) {
      ++failed;
      console.log(`${name}: ${problem.stack || problem}`);
      await picture(`failed_${name}`);
    }
  }
  for (const trouble of new Set(troubles)) { ++failed; console.log(trouble); }
} finally {
  await browser.close();
  server.kill('SIGTERM');
}
process.exit(failed ? 1 : 0);
