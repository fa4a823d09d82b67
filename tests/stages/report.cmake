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
expect_said("displacements are always there")
# a budget: fewer states, then the surface alone, never more than asked for
run(0 ${BIN}/langer-report runs/smoke/report/report.yaml --solution runs/smoke/alpha_060/solve/solution.h5 --set megabytes=1.2 -o little.html)
file(SIZE ${WORK}/project/little.html little)
if(little GREATER 1200000)
  message(FATAL_ERROR "asked for 1.2 MB, got ${little} bytes")
endif()

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
  const canvas = document.querySelector('.stage canvas');
  let box = canvas.getBoundingClientRect();
  const mouse = (target, type, x, y, more) => target.dispatchEvent(new MouseEvent(type, { clientX: box.left + x, clientY: box.top + y, bubbles: true, button: 0, ...more }));
  mouse(canvas, 'mousedown', 300, 300, { buttons: 1 });
  mouse(document, 'mousemove', 360, 270, { buttons: 1 });
  mouse(document, 'mouseup', 360, 270);
  await note('turned');
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
foreach(expected "data-errors=\"\"" "data-ready=\"yes\"" "data-view=\"ready\"" "data-picked=\"displacement u_y [^\"]* mm" "data-hovered=\"alpha = ")
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
expect_equal(${n} 19 "pictures taken")
set(before "")
foreach(picture ${pictures})
  string(REGEX MATCH "=(.*)$" _ ${picture})
  if(CMAKE_MATCH_1 STREQUAL before)
    message(FATAL_ERROR "${picture}: this control did not change the picture\n${pictures}")
  endif()
  set(before ${CMAKE_MATCH_1})
endforeach()
message("${n} pictures, all different from the one before")
