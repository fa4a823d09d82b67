# The page of a run: whole, small, asks for nothing from elsewhere; in a browser without errors, and every control changes the
# picture of the body. The part in the browser needs chromium.
include(${ROOT}/tests/support/run.cmake)
copy_project()
run(0 ${BIN}/langer-plan pipelines/smoke.yaml)
run(0 make -j2 -C runs/smoke)
set(page ${WORK}/project/runs/smoke/report/report.html)
file(SIZE ${page} size)
if(size GREATER 10000000)
  message(FATAL_ERROR "the page has ${size} bytes")
endif()
file(READ ${page} text)
foreach(word "Smoke" "alpha = 60" "\"stage\":\"sensitivity\"" "force resisting the indenter" "largest relative residual")
  string(FIND "${text}" "${word}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "the page does not hold: ${word}")
  endif()
endforeach()

# refused: nothing to report on, a file of another kind, a field of no point
run(2 ${BIN}/langer-report runs/smoke/report/report.yaml -o none.html)
expect_said("no file to report on")
run(3 ${BIN}/langer-report runs/smoke/report/report.yaml --curves runs/smoke/mesh/mesh.h5 -o none.html)
expect_said("schema mesh/1")
run(2 ${BIN}/langer-report runs/smoke/report/report.yaml --mesh runs/smoke/mesh/mesh.h5 --set "fields=[u_y]" -o none.html)
expect_said("displacements are always shown")
# a budget: fewer states, then the surface alone, never more than asked for
run(0 ${BIN}/langer-report runs/smoke/report/report.yaml --solution runs/smoke/alpha_060/solve/solution.h5 --set megabytes=1.2 -o little.html)
file(SIZE ${WORK}/project/little.html little)
if(little GREATER 1200000)
  message(FATAL_ERROR "asked for 1.2 MB, got ${little} bytes")
endif()

# bodies that meet: areas of contact are no numbers of nodes
run(0 ${BIN}/langer-solve configs/solve/impact_two.yaml --set path.seconds=5e-4 -o two.h5 --quiet)
run(0 ${BIN}/langer-report runs/smoke/report/report.yaml --solution two.h5 -o two.html)
file(READ ${WORK}/project/two.html text)
string(FIND "${text}" "area of contact" area)
if(area EQUAL -1)
  message(FATAL_ERROR "the page of two bodies has no area of contact")
endif()

# the first row of a table has the momenta of the beginning: 0.105 and -0.05 g m/s along x
run(0 ${BIN}/langer-post configs/post/impact_two.yaml --solution two.h5 -o two_curves.h5 --quiet)
file(READ ${WORK}/project/two_curves.csv rows)
string(REGEX MATCH "\n0,[^\n]*" first "${rows}")
if(NOT first MATCHES ",0[.]000105[0-9]*,-5e-05,|,0[.]00010499[0-9]*,-4[.]99[0-9]*e-05,|,0[.]000105[0-9]*,-4[.]99[0-9]*e-05,")
  message(FATAL_ERROR "the first row has other momenta: ${first}")
endif()

# an impact is described by its results, and no equilibrium of it is judged
run(0 ${BIN}/langer-solve configs/solve/ballistometer.yaml --set path.seconds=0.014 -o bounce.h5 --quiet)
run(0 ${BIN}/langer-report runs/smoke/report/report.yaml --solution bounce.h5 -o bounce.html)
file(READ ${WORK}/project/bounce.html text)
foreach(words
    "A sphere of radius 2.5 mm and 2 g hits a body of revolution, 16 mm in radius and 8 mm high: peak force 0.2"
    "N ± " "in contact for " "ms ± " "restitution 0." "a body in motion has no equilibrium")
  string(FIND "${text}" "${words}" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "the page of a bounce has no words \"${words}\"")
  endif()
endforeach()

# its first row has the velocity of the probe, and its depth has a sign
run(0 ${BIN}/langer-post configs/post/ballistometer.yaml --solution bounce.h5 -o bounce_curves.h5 --quiet)
file(READ ${WORK}/project/bounce_curves.csv rows)
if(NOT rows MATCHES "^time_s,travel_probe_mm,[^\n]*\n0,0,0,300,0[.]09")
  message(FATAL_ERROR "the first row has another velocity: ${rows}")
endif()
if(NOT rows MATCHES "\n0[.]014,-0[.]")
  message(FATAL_ERROR "the probe is not above the skin at the end: ${rows}")
endif()
file(READ ${page} text)

find_program(CHROMIUM NAMES chromium chromium-browser google-chrome)
if(NOT CHROMIUM)
  message("skipped: no chromium to open the page in")
  return()
endif()
string(FIND "${text}" "THREE" three)
if(three EQUAL -1)
  message("skipped: built without three.js")
  return()
endif()
file(COPY_FILE ${page} ${WORK}/tried.html)
file(APPEND ${WORK}/tried.html [=[
<script>
(async () => {
  const root = document.documentElement, pictures = [], frames = () => new Promise(done => setTimeout(done, 60));
  const note = async what => { await frames(); pictures.push(what + '=' + root.dataset.picture); };
  const set = async (id, value) => {
    const control = document.getElementById(id);
    if (control.type === 'checkbox') control.checked = value; else control.value = value;
    control.dispatchEvent(new Event('input'));
    await note(id);
  };
  const press3d = key => document.querySelector('.stage canvas').dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
  await note('start');
  await set('clip', 'none');
  await set('state', 1);
  await set('field', 'u_y');
  await set('scale', 4);
  await set('colours', 'cividis');
  await set('fit', 'state');
  await set('high', 0.5);
  await set('fibres', true);
  await set('edges', false);
  await set('clip', 'x');
  await set('at', 0.4);
  await set('turn', true);
  await set('indenter', false);
  await set('member', 1);
  await set('opacity', 0.4);
  press3d('ArrowLeft');
  await note('key');
  const canvas = document.querySelector('.stage canvas');
  let box = canvas.getBoundingClientRect();
  const spot = (x, y, more) => ({ clientX: box.left + x, clientY: box.top + y, bubbles: true, cancelable: true, button: 0, ...more });
  const mouse = (target, type, x, y, more) => target.dispatchEvent(new MouseEvent(type, spot(x, y, more)));
  canvas.setPointerCapture = canvas.releasePointerCapture = () => {};  // no pointer is there to be captured
  // three.js of 2019 listens to the mouse, a current one to pointers
  const drag3d = (from, to, more) => {
    for (const [type, [x, y]] of [['down', from], ['move', to], ['up', to]]) {
      const told = { buttons: type === 'up' ? 0 : 1, ...more };
      canvas.dispatchEvent(new PointerEvent('pointer' + type, { pointerId: 1, pointerType: 'mouse', isPrimary: true, pageX: 0, ...spot(x, y, told) }));
      mouse(canvas, 'mouse' + type, x, y, told);
    }
  };
  drag3d([300, 300], [360, 270]);
  await note('turned');
  // turned, the body stays within its frame: no paint at the rim of the picture
  let fills = true;
  const painted = () => {
    const sheet = document.createElement('canvas'), pen = sheet.getContext('2d');
    sheet.width = canvas.width;
    sheet.height = canvas.height;
    pen.drawImage(canvas, 0, 0);
    const { data: px, width: w, height: h } = pen.getImageData(0, 0, sheet.width, sheet.height), at = (x, y) => px[4 * (y * w + x)] < 240 || px[4 * (y * w + x) + 1] < 240;
    let rim = 0, all = 0;
    for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) if (at(x, y)) { ++all; rim += x < 3 || y < 3 || x > w - 4 || y > h - 4; }
    return { rim, part: all / (w * h) };
  };
  for (let k = 0; k < 6; ++k) {
    for (let j = 0; j < 5; ++j) press3d(k % 2 ? 'ArrowUp' : 'ArrowLeft');
    await frames();
    const found = painted();
    fills = fills && found.rim === 0 && found.part > 0.02;
  }
  const placed = () => +document.getElementById('at').value;
  await set('clip', 'x');
  const before = placed();
  drag3d([300, 300], [350, 260], { shiftKey: true });
  root.dataset.cutmoved = placed() !== before;
  await note('shift_drag');
  await set('clip', 'none');
  box = canvas.getBoundingClientRect();
  canvas.dispatchEvent(new MouseEvent('dblclick', spot(box.width / 2 - 62, box.height / 2)));
  root.dataset.cutput = document.getElementById('clip').value === 'free';
  await note('double_click');
  canvas.dispatchEvent(new WheelEvent('wheel', { deltaY: -300, bubbles: true, cancelable: true }));
  await note('zoomed');
  await set('clip', 'none');
  [...document.querySelectorAll('.panel button')].find(b => b.textContent === 'from above').click();
  await note('from_above');
  box = canvas.getBoundingClientRect();  // a click scrolls the page to what it is in
  mouse(canvas, 'mousemove', box.width / 2 - 60, box.height / 2);
  root.dataset.picked = document.getElementById('tip').textContent.replace(/\n/g, ' ');
  const chart = document.querySelector('#curves figure > svg'), at = chart.getBoundingClientRect();
  for (const y of [0.1, 0.3, 0.5, 0.7, 0.9])
    if (!/alpha/.test(document.getElementById('tip').textContent))
      chart.dispatchEvent(new MouseEvent('mousemove', { clientX: at.left + at.width / 2, clientY: at.top + at.height * y, bubbles: true }));
  root.dataset.hovered = document.getElementById('tip').textContent.replace(/\n/g, ' ');
  // charts: closer, logarithmic, by keys, saved
  const ticks = svg => [...svg.querySelectorAll('text')].map(t => t.textContent).join('|');
  const press = (target, key) => target.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
  const place = chart.getBoundingClientRect(), drag = (type, fx, fy, target) => (target || chart).dispatchEvent(
    new MouseEvent(type, { clientX: place.left + fx * place.width, clientY: place.top + fy * place.height, bubbles: true, button: 0 }));
  const whole = ticks(chart);
  drag('mousedown', 0.4, 0.3); drag('mousemove', 0.7, 0.6); drag('mouseup', 0.7, 0.6, window);
  root.dataset.zoomed = ticks(chart) !== whole;
  const button = text => [...chart.parentElement.querySelectorAll('button')].find(b => b.textContent === text);
  button('whole').click();
  root.dataset.whole = ticks(chart) === whole;
  button('log y').click();
  root.dataset.logarithmic = button('log y').getAttribute('aria-pressed') === 'true' && ticks(chart) !== whole;
  button('log y').click();
  document.getElementById('tip').hidden = true;
  press(chart, 'ArrowRight');
  root.dataset.walked = document.getElementById('tip').hidden ? '' : document.getElementById('tip').textContent.split('\n')[0];
  root.dataset.saved = new DOMParser().parseFromString(L.savedSvg(chart), 'image/svg+xml').querySelector('parsererror') ? 'broken' : 'svg';
  const first = data.charts.find(c => c.group === 'curves');
  root.dataset.csv = L.csv(first).trim().split('\n').length - 1 === first.series.reduce((n, s) => n + s.x.length, 0);
  root.dataset.unlabelled = [...document.querySelectorAll('button, input, select')].filter(c => !(c.textContent.trim() && c.tagName === 'BUTTON') && !c.closest('label') && !c.getAttribute('aria-label')).length;
  dispatchEvent(new Event('beforeprint'));
  const sheet = document.querySelector('.paper'), ink = sheet.getContext('2d').getImageData(0, 0, sheet.width, sheet.height).data;
  let coloured = 0;
  for (let i = 0; i < ink.length; i += 4) coloured += Math.max(ink[i], ink[i + 1], ink[i + 2]) - Math.min(ink[i], ink[i + 1], ink[i + 2]) > 60;
  root.dataset.paper = coloured > 2000;
  const widths = [...document.querySelectorAll('.split')].map(box => [...box.querySelectorAll('table')].map(t => t.tHead.rows[0].cells.length));
  root.dataset.parts = widths.length > 0 && widths.every(([all, ...parts]) => parts.reduce((n, w) => n + w - 1, 1) === all);
  dispatchEvent(new Event('afterprint'));
  root.dataset.unnamed = document.querySelectorAll('svg[role=img]:not([aria-label]), canvas[role=img]:not([aria-label])').length;
  // a smooth line passes through its points, and between two of them stays between their values
  const points = [[0, 0], [10, 3], [20, 3.5], [40, 30], [50, 12], [60, 11]], drawn = L.smoothPath(points).replace(/[MCL]/g, ' ').trim().split(/\s+/).map(Number);
  const knots = points.map((p, k) => k === 0 ? drawn.slice(0, 2) : drawn.slice(6 * k, 6 * k + 2));
  const between = points.slice(1).every((q, k) => [3, 5].every(j => { const y = drawn[6 * k + j], p = points[k]; return y >= Math.min(p[1], q[1]) - 0.06 && y <= Math.max(p[1], q[1]) + 0.06; }));
  root.dataset.smooth = between && points.every((p, k) => Math.abs(p[0] - knots[k][0]) < 0.06 && Math.abs(p[1] - knots[k][1]) < 0.06);
  root.dataset.rounded = [L.rounded(9.497, 0.152), L.rounded(9.511, 0.83), L.rounded(1234.5, 60), L.rounded(-0.0123456, 0.0004), L.rounded(2, 0)].join('|');
  root.dataset.fills = fills;
  root.dataset.tried = pictures.join(' ');
})();
</script>
]=])
execute_process(COMMAND ${CHROMIUM} --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --window-size=1300,1200
  --virtual-time-budget=20000 --enable-logging=stderr --user-data-dir=${WORK}/browser --dump-dom "file://${WORK}/tried.html#checksum=1"
  RESULT_VARIABLE code OUTPUT_VARIABLE dom ERROR_VARIABLE log TIMEOUT 120)
if(NOT code EQUAL 0)
  message("skipped: chromium does not start here (${code})")
  return()
endif()
string(REGEX MATCH "<html[^>]*>" root "${dom}")
message("${root}")
foreach(expected "data-errors=\"\"" "data-ready=\"yes\"" "data-view=\"ready\"" "data-picked=\"displacement u_y [^\"]* mm" "data-hovered=\"alpha = " "data-zoomed=\"true\"" "data-whole=\"true\""
    "data-logarithmic=\"true\"" "data-walked=\"alpha = " "data-saved=\"svg\"" "data-csv=\"true\"" "data-unnamed=\"0\"" "data-unlabelled=\"0\"" "data-cutmoved=\"true\"" "data-cutput=\"true\"" "data-paper=\"true\"" "data-parts=\"true\""
    "data-smooth=\"true\"" "data-fills=\"true\"" "data-rounded=\"9.50[|]9.5[|]1230[|]−0.0123[|]2\"")
  if(NOT root MATCHES "${expected}")
    message(FATAL_ERROR "the page in the browser lacks ${expected}:\n${root}\n${log}")
  endif()
endforeach()
if(log MATCHES "CONSOLE[^\n]*(rror|WebGL: INVALID)")
  message(FATAL_ERROR "the browser's console:\n${log}")
endif()
if(NOT root MATCHES "data-tried=\"([^\"]*)\"")
  message(FATAL_ERROR "the controls were not tried:\n${root}")
endif()
string(REPLACE " " ";" pictures "${CMAKE_MATCH_1}")
list(LENGTH pictures n)
expect_equal(${n} 25 "pictures taken")
set(before "")
foreach(picture ${pictures})
  string(REGEX MATCH "=(.*)$" _ ${picture})
  if(CMAKE_MATCH_1 STREQUAL before)
    message(FATAL_ERROR "${picture}: this control did not change the picture\n${pictures}")
  endif()
  set(before ${CMAKE_MATCH_1})
endforeach()
message("${n} pictures, all different from the one before")

# narrow, dark and printed: nothing wider than the screen, light text on dark, every part on paper
file(COPY_FILE ${page} ${WORK}/looked.html)
file(APPEND ${WORK}/looked.html [=[
<script>
setTimeout(() => {
  const root = document.documentElement, colour = getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number);
  root.dataset.width = root.clientWidth;
  root.dataset.wider = Math.max(0, root.scrollWidth - root.clientWidth);
  root.dataset.dark = colour[0] + colour[1] + colour[2] < 150;
  root.dataset.sentence = document.querySelector('.big').textContent;
}, 500);
</script>
]=])
macro(look name)
  execute_process(COMMAND ${CHROMIUM} --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --virtual-time-budget=6000
    --user-data-dir=${WORK}/browser_${name} --dump-dom ${ARGN} "file://${WORK}/looked.html" OUTPUT_VARIABLE dom ERROR_VARIABLE log TIMEOUT 120)
  string(REGEX MATCH "<html[^>]*>" root "${dom}")
  foreach(expected "data-errors=\"\"" "data-wider=\"0\"" "data-sentence=\"[^\"]*sphere of radius 20 mm pressed 0.2 mm along −y")
    if(NOT root MATCHES "${expected}")
      message(FATAL_ERROR "${name}: the page lacks ${expected}:\n${root}\n${log}")
    endif()
  endforeach()
endmacro()
look(narrow --window-size=390,844)
if(NOT root MATCHES "data-width=\"390\"")
  message("this chromium has no window as narrow as 390 pixels: seen at the least it has")
endif()
look(dark --window-size=1400,900 --blink-settings=preferredColorScheme=0)
if(NOT root MATCHES "data-dark=\"true\"")
  message(FATAL_ERROR "the page is not dark:\n${root}")
endif()
look(light --window-size=1400,900 --blink-settings=preferredColorScheme=1)
if(NOT root MATCHES "data-dark=\"false\"")
  message(FATAL_ERROR "the page is dark:\n${root}")
endif()
execute_process(COMMAND ${CHROMIUM} --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --virtual-time-budget=6000
  --user-data-dir=${WORK}/browser_print --no-pdf-header-footer --print-to-pdf=${WORK}/page.pdf "file://${page}" OUTPUT_QUIET ERROR_QUIET TIMEOUT 120)
find_program(PDFTOTEXT pdftotext)
if(EXISTS ${WORK}/page.pdf AND PDFTOTEXT)
  run(0 ${PDFTOTEXT} -layout ${WORK}/page.pdf -)
  foreach(word "pressed 0.2 mm" "Deformed body" "Effective configs" "supports:")
    expect_said("${word}")
  endforeach()
  # wide tables: names whole, within the margins of 0.4 inch, and letters of 6.5 points or more, whose boxes are 1.15 to 1.17 times as high
  execute_process(COMMAND ${PDFTOTEXT} -bbox ${WORK}/page.pdf - COMMAND awk -F "\"" [=[
    />(contact_warnings|penetration_between_nodes|von_mises_max)</ { ++n[$9]; if ($8 - $4 < 6.5 * 1.17 || $2 < 28.8 || $6 > width - 28.8) print }
    /<page / { width = $2 }
    END { for (word in n) ++words; print words + 0, "words" }]=] OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
  expect_equal("${said}" "3 words\n" "names of wide tables on paper that are broken, too small or cut off; those found")
else()
  message("skipped: the print, for want of pdftotext (Debian: poppler-utils)")
endif()
