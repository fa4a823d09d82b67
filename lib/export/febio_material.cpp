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

// A material, or a part of a mixture.
struct Solid {
  std::string type, parameters;
};
// An XML element with a number.
std::string tag(const std::string& name, double value) {
  return fmt::format("<{0}>{1}</{0}>", name, value);
}
// The frame of a material: its first axis, and a direction in the plane of the first two.
std::string axes(const Vec3& a, const Vec3& d) {
  return fmt::format("<mat_axis type=\"vector\"><a>{}</a><d>{}</d></mat_axis>", triple(a),
                     triple(d));
}

// The Yeoh model with the same slopes at rest: a1, a2, a3 of W(I1_bar) = sum a_i (I1_bar - 3)^i.
std::string as_yeoh(const ArrudaBoyce& law) {
  const double step = 1e-2;
  const Energy<double> at = law(3.0);
  const Energy<double> above = law(3 + step);
  const Energy<double> below = law(3 - step);
  return fmt::format("yeoh: {{a1: {:.6g}, a2: {:.6g}, a3: {:.6g}}}", at.dW, at.ddW / 2,
                     (above.ddW - below.ddW) / (12 * step));
}

// The terms of the matrix as solids of a mixture. Polynomials are added up to one Mooney-Rivlin
// or Yeoh solid or one of each; an Ogden or Gent term is a solid of its own.
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
    // Yeoh has no I2, and a mixture needs at least one solid.
    const bool mooney = !yeoh || sum.I2[0] != 0;
    if (mooney && (sum.I1[0] != 0 || sum.I2[0] != 0 || solids.empty()))
      solids.push_back({"Mooney-Rivlin", tag("c1", sum.I1[0]) + tag("c2", sum.I2[0])});
    if (!yeoh) return;
    double c1 = sum.I1[0];
    if (mooney) c1 = 0;  // the Mooney-Rivlin solid has it
    solids.push_back({"Yeoh", tag("c1", c1) + tag("c2", 2 * sum.I1[1]) + tag("c3", 3 * sum.I1[2])});
  }

 private:
  // A term that is not a polynomial.
  void other(const MatrixTerm& term) {
    if (const auto* ogden = std::get_if<Ogden>(&term)) {
      std::string s;
      int i = 1;
      // FEBio: c/m^2 (l_1^m + l_2^m + l_3^m - 3). A part with alpha = 0 has no energy, because
      // l_1 l_2 l_3 = 1.
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
          {"arruda_boyce (its own has the factor i of the series twice: 1.6 times the force at a "
           "stretch of 1.6)",
           "gent, or near rest " + as_yeoh(std::get<ArrudaBoyce>(term))});
    }
  }
};

// What FEBio lacks for a fibre family.
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

// One family of a mixture. A dispersed family is a Holzapfel-Gasser-Ogden solid with matrix c = 0
// and two families at +gamma and -gamma from the first axis, which coincide here.
Solid family(const Fibre& f, const Vec3& a) {
  if (f.kappa == 0) {
    Solid solid{"fiber-exp-pow-uncoupled", ""};
    if (std::holds_alternative<PowLinearFibre>(f.law)) solid.type = "fiber-pow-linear-uncoupled";
    const auto parameters = [](const auto& law) {
      return parameters_of(law);
    };
    solid.parameters =
        std::visit(parameters, f.law) + fmt::format("<fiber type=\"vector\">{}</fiber>", triple(a));
    return solid;
  }
  const HgoFibre law = *as_hgo(f);
  return {"Holzapfel-Gasser-Ogden", "<c>0</c>" + tag("k1", law.c1 / 2) + tag("k2", law.c2) +
                                        "<gamma>0</gamma>" + tag("kappa", f.kappa) +
                                        axes(a, fibre_frame({a}).e2)};
}

// FEBio's number of a volume term.
int pressure_model(const Volume& volume) {
  if (std::holds_alternative<QuadraticVolume>(volume)) return 2;
  if (std::holds_alternative<SimoTaylorVolume>(volume)) return 1;
  return 0;
}

// The model of Gasser, Ogden and Holzapfel as one material, for a neo-Hookean matrix with one
// dispersed family or two with the same parameters; otherwise empty. Its two families are at the
// angles +gamma and -gamma from their bisector.
std::string dispersed(const Material& m, const std::vector<Vec3>& fibres) {
  const auto p = polynomial(m);
  if (!p || !p->neo_hookean() || p->I1[0] < 0 || m.fibres.empty()) return "";
  if (!beyond_hgo(m).empty()) return "";
  const Fibre& f = m.fibres[0];
  const HgoFibre law = *as_hgo(f);
  const HgoFibre last = *as_hgo(m.fibres.back());
  const bool two = m.fibres.size() == 2;
  const bool same = two && law.c1 == last.c1 && law.c2 == last.c2 && f.kappa == m.fibres[1].kappa;
  if (f.kappa == 0 || (m.fibres.size() > 1 && !same)) return "";
  // A single family is written as two that coincide, with half of the modulus each.
  const Vec3 a = fibres[0];
  Vec3 b = a;
  double k1 = law.c1 / 2;
  if (two) {
    b = fibres[1];
    if (a.dot(b) < 0) b = -b;
    k1 = law.c1;
  }
  const double gamma = std::atan2((a - b).norm(), (a + b).norm());
  const Vec3 bisector = (a + b).normalized();
  Vec3 across = fibre_frame({a}).e2;
  if (gamma > 1e-9) across = (a - b).normalized();
  return tag("c", 2 * p->I1[0]) + tag("k1", k1) + tag("k2", law.c2) +
         tag("gamma", gamma * 180 / std::numbers::pi) + tag("kappa", f.kappa) +
         axes(bisector, across);
}

}  // namespace

// One solid is a material by itself, also the dispersed model of two families. Everything else is
// a mixture, whose fibres are given in the frame of its `mat_axis`.
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
      fmt::format("<pressure_model>{}</pressure_model>", pressure_model(m.volume));
  std::string remark;
  for (const Solid& s : matrix.solids)
    if (s.type == "Yeoh")
      remark =
          "<!-- Yeoh: its stress lacks the factor i of c_i (I1 - 3)^i, so c2 and c3 are multiplied "
          "by 2 and 3 -->\n";
  const auto whole = [&](const std::string& type, const std::string& body) {
    return fmt::format("{}<material id=\"{}\" name=\"{}\" type=\"{}\">\n  {}\n{}</material>\n",
                       remark, id, name, type, volume, body);
  };
  if (m.fibres.empty() && matrix.solids.size() == 1)
    return {whole(matrix.solids[0].type, "  " + matrix.solids[0].parameters + "\n"), "", ""};
  if (const std::string goh = dispersed(m, fibres); !goh.empty())
    return {whole("Holzapfel-Gasser-Ogden", "  " + goh + "\n"), "", ""};

  // A mixture of the solids of the matrix and of the fibres.
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
