#include "core/config/formula.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>

#include "core/base/traps.hpp"

namespace langer {

std::vector<double> evaluate(const std::string& formula, const std::vector<FormulaPoint>& points,
                             const Place& where, const std::string& key) {
  const auto refuse = [&](const std::string& found) {
    throw Failure(Exit::config,
                  Error{where, key, found, "a formula of x, y and z [mm] with one finite value",
                        "for example \"30 + 2*x\"; sin, cos and tan expect radians"});
  };
  std::vector<double> values;
  FormulaPoint at{0, 0, 0};
  try {
    const NoTraps in_the_formula;  // 1/0 is refused with its place
    mu::Parser parser;
    parser.DefineVar("x", &at.x);
    parser.DefineVar("y", &at.y);
    parser.DefineVar("z", &at.z);
    parser.SetExpr(formula);
    for (const FormulaPoint& point : points) {
      at = point;
      int n = 0;
      const double* value = parser.Eval(n);
      if (n != 1) refuse(fmt::format("\"{}\" has {} values", formula, n));
      if (!std::isfinite(value[0]))
        refuse(fmt::format("\"{}\" is {} at ({:g}, {:g}, {:g})", formula, value[0], point.x,
                           point.y, point.z));
      values.push_back(value[0]);
    }
  } catch (const mu::Parser::exception_type& error) {
    refuse(fmt::format("\"{}\": {} (character {})", formula, error.GetMsg(), error.GetPos() + 1));
  }
  return values;
}

}  // namespace langer
