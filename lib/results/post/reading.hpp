// What devices report, read from columns of the table:
//   value_of    one column where another one reaches a number: the contact radius at a force
//   slope_of    the derivative there: the stiffness at a depth
//   hysteresis_of   the work of the last cycle that does not come back, and its share
//   suction_of  R0 to R9 of a Cutometer from the height of the dome
//
// The last one is mode 1 of the instrument: constant suction, then none. Heights are measured from
// that at the beginning of a cycle, whose times the user gives:
//
//   height |        ____---- Uf          Ue  height 0.1 s after the suction begins
//          |   _---'        |            Uf  height when it ends
//          |  |Ue           | Ur         Uv  Uf - Ue
//          |  |             |___         Ur  what comes back within 0.1 s after that
//          |  |             |   ''---__  Ua  what comes back until the cycle ends
//          |_/______________|__________'______ time
//
//   R0 = Uf, R1 = Uf - Ua, R2 = Ua/Uf, R3 the last maximum, R4 the last minimum,
//   R5 = Ur/Ue, R6 = Uv/Ue, R7 = Ur/Uf, R8 = Ua, R9 = R3 - R0
// R0, R1, R2, R5, R6, R7 and R8 are those of the first cycle, as the instrument has them.
//   [ABG95] A. O. Barel, W. Courage, P. Clarys, Suction method for measurement of skin mechanical
//   properties: the Cutometer, Handbook of Non-Invasive Methods and the Skin, CRC Press 1995.
//   [A80] P. G. Agache, C. Monneur, J. L. Leveque, J. de Rigal, Mechanical properties and Young's
//   modulus of human skin in vivo, Arch. Dermatol. Res. 269 (1980) 221-232 (Ue, Uv, Uf, Ur).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"

namespace langer {

// The listing `reading`. Exactly one of the first four says what is read.
struct ReadingChoice {
  std::optional<std::string> value_of, slope_of, hysteresis_of, suction_of;
  std::optional<std::string> over;
  std::optional<double> at;
  double begins = 0, immediate = 0.1;
  std::optional<double> suction, release;
  static void fields(auto& v) {
    v(&ReadingChoice::value_of, "value_of", unit::none,
      "column that is read where `over` first reaches `at`, such as contact_radius over force");
    v(&ReadingChoice::slope_of, "slope_of", unit::none,
      "column whose derivative by `over` is read there: of force over u_ind the stiffness at a "
      "depth");
    v(&ReadingChoice::hysteresis_of, "hysteresis_of", unit::none,
      "column whose last cycle over `over` is integrated: <name>_loss, the area of the loop, and "
      "<name>_ratio, its share of the area under the loading");
    v(&ReadingChoice::suction_of, "suction_of", unit::none,
      "column with the height of the dome under suction and after it: <name>_R0 ... <name>_R9, "
      "<name>_Ue, Uv, Uf, Ur and Ua as a Cutometer reports them");
    v(&ReadingChoice::over, "over", unit::none,
      "the other column, by name; not of suction_of, which goes by seconds");
    v(&ReadingChoice::at, "at", unit::none,
      "number that `over` reaches, in the unit of its column");
    v(&ReadingChoice::begins, "begins", unit::s, "of suction_of: when the first suction begins",
      at_least(0));
    v(&ReadingChoice::suction, "suction", unit::s, "how long it lasts", positive);
    v(&ReadingChoice::release, "release", unit::s, "how long the skin is then left", positive);
    v(&ReadingChoice::immediate, "immediate", unit::s,
      "after which what has moved counts as elastic", positive);
  }
  std::vector<Complaint> complaints() const;
};

// A number read from two columns; NaN where `over` never reaches `at`.
double value_where(const std::vector<double>& over, const std::vector<double>& of, double at);
// Its derivative, of the parabola through the three states around that place.
double slope_where(const std::vector<double>& over, const std::vector<double>& of, double at);

// The last cycle: from the least `over` before its last maximum, or the first state, to the end.
struct Loop {
  double loading = 0, unloading = 0;  // areas under the two branches
  double loss() const { return loading - unloading; }
  double ratio() const { return loss() / loading; }
};
Loop last_loop(const std::vector<double>& over, const std::vector<double>& of);

// Heights of a suction and release [mm].
struct SuctionCycles {
  double ue = 0, uf = 0, ur = 0, ua = 0;      // of the first cycle
  double last_maximum = 0, last_minimum = 0;  // of the last cycle, from the first beginning
  int cycles = 0;
  double uv() const { return uf - ue; }
};

// A time at which a height is needed and no state of the path lies.
struct MissingTime {
  double seconds = 0;
};

// The heights at the times of the choice. `missing` is set where the path has no state at one of
// them: between states nothing is guessed, since skin moves fastest there.
SuctionCycles suction_cycles(const std::vector<double>& seconds, const std::vector<double>& height,
                             const ReadingChoice& choice, std::optional<MissingTime>& missing);

}  // namespace langer
