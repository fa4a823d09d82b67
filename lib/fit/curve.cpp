#include "fit/curve.hpp"

namespace langer {

namespace {

Curve curve_of(const Test& test) {
  Curve curve{{}, test.stress_x, test.measure};
  for (double stretch : test.first) curve.strain.push_back(engineering_strain(stretch));
  return curve;
}

}  // namespace

Test test_of(const Curve& curve, const std::string& name) {
  Test test;
  test.name = name, test.measure = curve.measure, test.stress_x = curve.stress;
  for (double e : curve.strain) test.first.push_back(1 + e);
  return test;
}

Curve read_curve(const std::string& path) { return curve_of(read_tests(path, {}).front()); }

Curve parse_curve(const std::string& text, const std::string& shown_name) {
  return curve_of(parse_tests(text, shown_name, {}).front());
}

}  // namespace langer
