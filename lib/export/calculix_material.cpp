#include "export/calculix_material.hpp"

#include <fmt/format.h>

#include "export/acting.hpp"
#include "export/foreign_terms.hpp"
#include "export/polynomial.hpp"

namespace langer {

namespace {

// The numbers, eight to a line.
std::string lines(const std::vector<double>& numbers) {
  std::string s;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    s += fmt::format("{:.12g}", numbers[i]);
    if (i + 1 == numbers.size()) {
      s += "\n";
    } else if (i % 8 == 7) {
      s += ",\n";
    } else {
      s += ", ";
    }
  }
  return s;
}

// The number with the digits that lines() writes.
double rounded(double x) { return std::stod(fmt::format("{:.12g}", x)); }

// The smallest model that has all coefficients of the polynomial. Mixed terms are 0.
std::string polynomial_keywords(const Polynomial& p, double d) {
  const auto& [a, b] = std::pair(p.I1, p.I2);
  if (p.neo_hookean()) return "*HYPERELASTIC, NEO HOOKE\n" + lines({a[0], d});
  if (p.of_I1()) return "*HYPERELASTIC, YEOH\n" + lines({a[0], a[1], a[2], d, 0, 0});
  if (p.linear()) return "*HYPERELASTIC, MOONEY-RIVLIN\n" + lines({a[0], b[0], d});
  if (a[2] == 0 && b[2] == 0)
    return "*HYPERELASTIC, POLYNOMIAL, N=2\n" + lines({a[0], b[0], a[1], 0, b[1], d, 0});
  return "*HYPERELASTIC, POLYNOMIAL, N=3\n" +
         lines({a[0], b[0], a[1], 0, b[1], a[2], 0, 0, b[2], d, 0, 0});
}

// The material as user material ELASTIC_FIBER.
ForeignLaw with_fibres(const Material& m, const std::vector<Vec3>& fibres,
                       const std::string& name) {
  const auto p = polynomial(m);
  if (!p || !p->neo_hookean())
    return {"", "fibres in a matrix other than neo-Hookean",
            "a neo-Hookean matrix, or no fibres: its ELASTIC_FIBER knows no other"};
  if (fibres.size() > 4)
    return {"", fmt::format("{} families of fibres", fibres.size()), "four at most"};
  const Lacking fibre_model = beyond_hgo(m);
  if (!fibre_model.empty()) return {"", fibre_model.what, fibre_model.nearest};
  const Lacking volume = beyond_volume(m.volume, VolumeTerm::quadratic);
  if (!volume.empty()) return {"", volume.what, volume.nearest};
  std::vector<double> constants{p->I1[0], compressibility(m.volume)};
  for (std::size_t k = 0; k < fibres.size(); ++k) {
    const Fibre& f = m.fibres[k];
    if (f.kappa != 0) return {"", "dispersed fibres", "kappa: 0"};
    if (f.tension_switch != FibreSwitch::I4_bar)
      return {"", "fibres with another switch", "switch: I4_bar, which is its own"};
    const HgoFibre law = *as_hgo(f);
    if (law.c2 == 0)
      return {"", "fibres with c2 = 0, by which it divides",
              "c2: 1e-6, which differs in the seventh digit"};
    // CalculiX computes the third component as the positive root of 1 - x^2 - y^2. It fails if
    // rounding makes (x, y) longer than 1.
    Vec3 a = fibres[k];
    if (a[2] < 0) a = -a;
    const double x = rounded(a[0]);
    const double y = rounded(a[1]);
    if (1 - x * x - y * y < 0) a *= 1 - 2e-12;
    for (double c : {a[0], a[1], law.c1, law.c2}) constants.push_back(c);
  }
  return {fmt::format("*MATERIAL, NAME={}\n*USER MATERIAL, CONSTANTS={}\n", calculix_name(m, name),
                      constants.size()) +
              lines(constants),
          "", ""};
}

}  // namespace

// Polynomials, Arruda-Boyce and Ogden; every other matrix has no keyword.
std::string hyperelastic(const Material& m) {
  if (!m.fibres.empty()) return "";
  const double d = compressibility(m.volume);
  if (const auto p = polynomial(m)) return polynomial_keywords(*p, d);
  if (m.matrix.size() != 1) return "";
  if (const auto* t = std::get_if<ArrudaBoyce>(&m.matrix[0]))
    return "*HYPERELASTIC, ARRUDA-BOYCE\n" + lines({t->mu, t->locking_stretch, d});
  const auto* t = std::get_if<Ogden>(&m.matrix[0]);
  if (!t) return "";
  // Their mu is mu alpha/2. A part with alpha = 0 has no energy, because l_1 l_2 l_3 = 1.
  std::vector<double> numbers;
  for (const auto& [mu, alpha] : t->parts())
    if (mu != 0 && alpha != 0) {
      numbers.push_back(mu * alpha / 2);
      numbers.push_back(alpha);
    }
  const std::size_t n = numbers.size() / 2;
  if (n == 0) return "";
  numbers.push_back(d);
  for (std::size_t i = 1; i < n; ++i) numbers.push_back(0);
  return fmt::format("*HYPERELASTIC, OGDEN, N={}\n", n) + lines(numbers);
}

// Isotropic materials use a keyword, those with fibres the user material.
ForeignLaw calculix_material(const Material& material, const std::vector<Vec3>& directions,
                             const std::string& name) {
  const Material m = acting(material);
  if (!m.fibres.empty()) return with_fibres(m, acting(material, directions), name);
  const std::string law = hyperelastic(m);
  if (law.empty())
    return {"", matrix_words(m),
            "one of its laws: neo-Hooke, Mooney-Rivlin, Yeoh, polynomials up to the third power, "
            "Ogden, Arruda-Boyce"};
  VolumeTerm term = VolumeTerm::quadratic;
  if (std::holds_alternative<ArrudaBoyce>(m.matrix.front())) term = VolumeTerm::simo_taylor;
  const Lacking volume = beyond_volume(m.volume, term);
  if (!volume.empty()) return {"", volume.what, volume.nearest};
  return {fmt::format("*MATERIAL, NAME={}\n", name) + law, "", ""};
}

}  // namespace langer
