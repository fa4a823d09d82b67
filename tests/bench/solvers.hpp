// What each nonlinear solver needs for the same answer, on three scenes: a table for
// docs/scenes.md.
#pragma once

namespace langer {
void measure_solvers();
}
