#include "identification/statistics/candidate_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace langer {

namespace {

TestKind kind_of(const CandidateChoice& choice) {
  return static_cast<TestKind>(choice.kind);
}  // of one that is no scene

// The test that a candidate would be, to an amount (stretch less 1, or shear): as many points as
// the largest test, whose weight it has as well, for it is measured by the same device.
Test test_like(const CandidateChoice& choice, const std::vector<Test>& tests, double reach) {
  const Test& largest =
      *std::max_element(tests.begin(), tests.end(),
                        [](const Test& a, const Test& b) { return a.points() < b.points(); });
  Test t;
  t.kind = kind_of(choice);
  t.fibre_angle_deg = choice.fibre_angle;
  t.weight = largest.weight;
  for (std::size_t i = 1; i <= largest.points(); ++i) {
    const double x = reach * static_cast<double>(i) / static_cast<double>(largest.points());
    t.first.push_back(deformation_at(t.kind, x));
    if (kind_of(choice) == TestKind::biaxial) t.second.push_back(1 + x);
    t.stress_x.push_back(0);
    if (kind_of(choice) == TestKind::equibiaxial || kind_of(choice) == TestKind::biaxial)
      t.stress_z.push_back(0);
  }
  return t;
}

// the largest component of the Cauchy stress in a test, up to the first state that does not exist
// [MPa]
double largest_cauchy(const Material& material, Test test) {
  const std::vector<Vec3> a = specimen_fibres(material, test.fibre_angle_deg);
  double largest = 0;
  for (std::size_t i = 0; i < test.points(); ++i) {
    const PlaneState s =
        plane_state(material, a, test.kind, test.first[i], test.second_at(i), test.shear);
    if (!s.converged) break;
    largest = std::max(largest, s.sigma.cwiseAbs().maxCoeff());
  }
  return largest;
}

// How far a candidate goes: to the largest amount measured so far, but not beyond the stress that
// the material has borne.
double reach_of(const CandidateChoice& choice, const Material& material,
                const std::vector<Test>& tests) {
  double reach = 0, borne = 0;
  for (const Test& one : tests) {
    for (double x : one.first) reach = std::max(reach, strain_of(one.kind, x));
    borne = std::max(borne, largest_cauchy(material, one));
  }
  const auto stress_at = [&](double amount) {
    const std::vector<Vec3> a = specimen_fibres(material, choice.fibre_angle);
    const double first = deformation_at(kind_of(choice), amount);
    const PlaneState s = plane_state(material, a, kind_of(choice), first, first);
    if (!s.converged) return std::numeric_limits<double>::infinity();
    return s.sigma.cwiseAbs().maxCoeff();
  };
  // the first crossing: stress need not rise throughout
  constexpr int steps = 60;
  for (int i = 1; i <= steps; ++i) {
    double high = reach * i / steps;
    double low = reach * (i - 1) / steps;
    if (!std::isgreater(stress_at(high), borne * (1 + 1e-9))) continue;
    for (int k = 0; k < 30; ++k) {
      const double middle = 0.5 * (low + high);
      if (std::isgreater(stress_at(middle), borne)) {
        high = middle;
      } else {
        low = middle;
      }
    }
    return low;
  }
  return reach;
}

}  // namespace

bool set_stress(Test& test, const Material& material, Dilatation dilatation) {
  VecX stress(static_cast<Eigen::Index>(test.values()));
  if (!model_stress(material, test, dilatation, stress.data())) return false;
  if (!stress.allFinite()) return false;
  const auto points = static_cast<Eigen::Index>(test.points());
  for (std::size_t i = 0; i < test.stress_x.size(); ++i)
    test.stress_x[i] = stress[static_cast<Eigen::Index>(i)];
  for (std::size_t i = 0; i < test.stress_z.size(); ++i)
    test.stress_z[i] = stress[points + static_cast<Eigen::Index>(i)];
  return true;
}

std::optional<Test> candidate_test(const CandidateChoice& choice, const Material& material,
                                   const std::vector<Test>& tests, Dilatation dilatation) {
  // without tests it is not known how far one would go
  if (choice.kind == DataKind::scene || tests.empty()) return std::nullopt;
  const double reach = reach_of(choice, material, tests);
  if (!(reach > 0)) return std::nullopt;
  Test test = test_like(choice, tests, reach);
  if (!set_stress(test, material, dilatation)) return std::nullopt;
  const TestKind kind = kind_of(choice);
  std::string quantity = "stretch";
  if (kind == TestKind::simple_shear) quantity = "shear";
  test.name = fmt::format("{}, fibres at {:g} degrees, to {} {:.2f}",
                          names(kind)[static_cast<std::size_t>(kind)], choice.fibre_angle, quantity,
                          deformation_at(kind, reach));
  return test;
}

}  // namespace langer
