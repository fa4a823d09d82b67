#include "export/febio_material.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "export/acting.hpp"
#include "export/fibre_frame.hpp"
#include "export/foreign_terms.hpp"
#include "export/polynomial.hpp"

namespace langer {

namespace {

struct Solid {
  std::string type, parameters;
};

struct Lacking {
  std::string what, nearest;
};

std::string tag(const std::string& name, double value) {
  return fmt::format("<{0}>{1}</{0}>", name, value);
}
std::string axes(const Vec3& a, const Vec3& d) {
  return fmt::format("<mat_axis type=\"vector\"><a>{}</a><d>{}</d></mat_axis>", triple(a),
                     triple(d));
}

// The law with the same slopes at rest: a1, a2, a3 of W(I1_bar) = sum a_i (I1_bar - 3)^i.
std::string as_yeoh(const ArrudaBoyce& law) {
  const double step = 1e-2;
  const Energy<double> at = law(3.0);
  const Energy<double> above = law(3 + step);
  const Energy<double> below = law(3 - step);
  return fmt::format("yeoh: {{a1: {:.6g}, a2: {:.6g}, a3: {:.6g}}}", at.dW, at.ddW / 2,
                     (above.ddW - below.ddW) / (12 * step));
}

// Terms of the matrix as solids of a mixture: polynomials are added up, Ogden's and Gent's stand
// for themselves.
struct Matrix {
  std::vector<Solid> solids;
  std::vector<Lacking> lacking;

  explicit Matrix(const Material& m) {
    Polynomial sum;
    for (const MatrixTerm& term : m.matrix)
      if (!sum.add(term)) other(term);
    if (sum.I2[1] != 0 || sum.I2[2] != 0)
      lacking.push_back({"squares and cubes of (I2_bar - 3)", "yeoh_I2 with b1 alone"});
    const bool yeoh = sum.I1[1] != 0 || sum.I1[2] != 0;
    const bool mooney = !yeoh || sum.I2[0] != 0;
    if (mooney && (sum.I1[0] != 0 || sum.I2[0] != 0 || solids.empty()))
      solids.push_back({"Mooney-Rivlin", tag("c1", sum.I1[0]) + tag("c2", sum.I2[0])});
    if (yeoh)
      solids.push_back({"Yeoh", tag("c1", mooney ? 0 : sum.I1[0]) + tag("c2", 2 * sum.I1[1]) +
                                    tag("c3", 3 * sum.I1[2])});
  }

 private:
  void other(const MatrixTerm& term) {
    if (const auto* ogden = std::get_if<Ogden>(&term)) {
      std::string s;
      int i = 1;
      // c/m^2 (l_1^m + l_2^m + l_3^m - 3); alpha = 0 is no energy, since l_1 l_2 l_3 = 1
      for (const auto& [mu, alpha] : ogden->parts())
        if (mu != 0 && alpha != 0) {
          s += tag(fmt::format("c{}", i), mu * alpha) + tag(fmt::format("m{}", i), alpha);
          ++i;
        }
      if (!s.empty()) solids.push_back({"Ogden", s});
    } else if (const auto* gent = std::get_if<Gent>(&term)) {
      solids.push_back({"Gent", tag("G", gent->mu) + tag("Jm", gent->Jm)});
    } else {
      lacking.push_back(
          {"arruda_boyce (its own has the factor i of the series twice: 1.6 times the force at a stretch of 1.6)",
           "gent, or near rest " + as_yeoh(std::get<ArrudaBoyce>(term))});
    }
  }
};

std::vector<Lacking> lacking_of(const Fibre& f) {
  std::vector<Lacking> list;
  if (const auto law = as_hgo(f); law && law->c1 < 0)
    list.push_back({fmt::format("fibres with c1 = {:g} (it refuses ksi, k1 < 0)", law->c1),
                    "c1 of 0 or more"});
  if (f.kappa != 0 && !as_hgo(f))
    list.push_back({"dispersed " + fibre_words(f), "kappa: 0, or hgo"});
  if (f.tension_switch != FibreSwitch::I4_bar)
    list.push_back(
        {fmt::format("fibres with switch: {}",
                     names(f.tension_switch)[static_cast<std::size_t>(f.tension_switch)]),
         "switch: I4_bar, which is its own"});
  return list;
}

std::string parameters_of(const HgoFibre& law) {
  return tag("alpha", law.c2) + "<beta>2</beta>" + tag("ksi", law.c1);
}
std::string parameters_of(const ExpPowFibre& law) {
  return tag("alpha", law.alpha) + tag("beta", law.beta) + tag("ksi", law.ksi);
}
std::string parameters_of(const PowLinearFibre& law) {
  return tag("E", law.E) + tag("lam0", law.lam0) + tag("beta", law.beta);
}

// one family; dispersed: matrix c/2 (I1 - 3), two families at +gamma and -gamma from the first
// axis, which here fall together
Solid family(const Fibre& f, const Vec3& a) {
  if (f.kappa == 0)
    return {std::holds_alternative<PowLinearFibre>(f.law) ? "fiber-pow-linear-uncoupled"
                                                          : "fiber-exp-pow-uncoupled",
            std::visit([](const auto& law) { return parameters_of(law); }, f.law) +
                fmt::format("<fiber type=\"vector\">{}</fiber>", triple(a))};
  const HgoFibre law = *as_hgo(f);
  return {"Holzapfel-Gasser-Ogden", "<c>0</c>" + tag("k1", law.c1 / 2) + tag("k2", law.c2) +
                                        "<gamma>0</gamma>" + tag("kappa", f.kappa) +
                                        axes(a, fibre_frame({a}).e2)};
}

int pressure_model(const QuadraticVolume&) { return 2; }
int pressure_model(const SimoTaylorVolume&) { return 1; }
int pressure_model(const LogarithmicVolume&) { return 0; }

// Gasser, Ogden and Holzapfel's law as one material: a neo-Hookean matrix, one dispersed family or
// two alike; else empty.
std::string dispersed(const Material& m, const std::vector<Vec3>& fibres) {
  const auto p = polynomial(m);
  if (!p || !p->neo_hookean() || p->I1[0] < 0 || m.fibres.empty()) return "";
  if (!beyond_hgo(m).first.empty()) return "";
  const Fibre& f = m.fibres[0];
  const HgoFibre law = *as_hgo(f);
  const HgoFibre last = *as_hgo(m.fibres.back());
  const bool two = m.fibres.size() == 2;
  const bool alike = two && law.c1 == last.c1 && law.c2 == last.c2 && f.kappa == m.fibres[1].kappa;
  if (f.kappa == 0 || (m.fibres.size() > 1 && !alike)) return "";
  const Vec3 a = fibres[0], b = two ? (a.dot(fibres[1]) < 0 ? Vec3(-fibres[1]) : fibres[1]) : a;
  const double gamma = std::atan2((a - b).norm(), (a + b).norm());
  const Vec3 middle = (a + b).normalized(),
             across = gamma > 1e-9 ? Vec3((a - b).normalized()) : fibre_frame({a}).e2;
  return tag("c", 2 * p->I1[0]) + tag("k1", two ? law.c1 : law.c1 / 2) + tag("k2", law.c2) +
         tag("gamma", gamma * 180 / std::numbers::pi) + tag("kappa", f.kappa) +
         axes(middle, across);
}

}  // namespace

ForeignLaw febio_material(const Material& material, const std::vector<Vec3>& directions, int id,
                          const std::string& name) {
  const Material m = acting(material);
  const std::vector<Vec3> fibres = acting(material, directions);
  const Matrix matrix(m);
  std::vector<Lacking> lacking = matrix.lacking;
  for (const Fibre& f : m.fibres)
    for (const Lacking& l : lacking_of(f)) lacking.push_back(l);
  if (!lacking.empty()) return {"", lacking[0].what, lacking[0].nearest};

  const std::string volume =
      tag("k", bulk_modulus(m)) +
      fmt::format("<pressure_model>{}</pressure_model>",
                  std::visit([](const auto& law) { return pressure_model(law); }, m.volume));
  std::string remark;
  for (const Solid& s : matrix.solids)
    if (s.type == "Yeoh")
      remark =
          "<!-- Yeoh: its stress lacks the factor i of c_i (I1 - 3)^i, so c2 and c3 are written twice and three times -->\n";
  const auto whole = [&](const std::string& type, const std::string& body) {
    return fmt::format("{}<material id=\"{}\" name=\"{}\" type=\"{}\">\n  {}\n{}</material>\n",
                       remark, id, name, type, volume, body);
  };
  if (m.fibres.empty() && matrix.solids.size() == 1)
    return {whole(matrix.solids[0].type, "  " + matrix.solids[0].parameters + "\n"), "", ""};
  if (const std::string goh = dispersed(m, fibres); !goh.empty())
    return {whole("Holzapfel-Gasser-Ogden", "  " + goh + "\n"), "", ""};

  std::string body;
  std::vector<Solid> solids = matrix.solids;
  if (!m.fibres.empty()) {
    const FibreFrame frame = fibre_frame(fibres);
    body = "  " + axes(frame.e1, frame.e2) + "\n";
    for (std::size_t k = 0; k < fibres.size(); ++k)
      solids.push_back(family(m.fibres[k], frame.in_frame[k]));
  }
  for (const Solid& s : solids)
    body += fmt::format("  <solid type=\"{}\">{}</solid>\n", s.type, s.parameters);
  return {whole("uncoupled solid mixture", body), "", ""};
}

std::string triple(const Vec3& x) {
  return fmt::format("{:.16g},{:.16g},{:.16g}", x[0], x[1], x[2]);
}

}  // namespace langer
