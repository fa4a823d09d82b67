#include "export/cards.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace langer {

namespace {

// the matrix where it is one term of a kind
template <class Term>
const Term* only(const Material& m) {
  return m.matrix.size() == 1 ? std::get_if<Term>(&m.matrix.front()) : nullptr;
}

// coefficients of the powers of (I1_bar - 3) and (I2_bar - 3), where the matrix is such a polynomial
struct Polynomial {
  double I1[3] = {}, I2[3] = {};
};
std::optional<Polynomial> polynomial(const Material& m) {
  Polynomial p;
  for (const MatrixTerm& term : m.matrix) {
    if (const auto* t = std::get_if<NeoHooke>(&term))
      p.I1[0] += t->a1;
    else if (const auto* t = std::get_if<Yeoh>(&term))
      p.I1[0] += t->a1, p.I1[1] += t->a2, p.I1[2] += t->a3;
    else if (const auto* t = std::get_if<YeohI2>(&term))
      p.I2[0] += t->b1, p.I2[1] += t->b2, p.I2[2] += t->b3;
    else if (const auto* t = std::get_if<MooneyRivlin>(&term))
      p.I1[0] += t->c10, p.I2[0] += t->c01;
    else if (const auto* t = std::get_if<Signorini>(&term))
      p.I1[0] += t->c10, p.I1[1] += t->c20, p.I2[0] += t->c01;
    else
      return std::nullopt;
  }
  return p;
}

std::string number(double x) { return fmt::format("{:.10g}", x); }

std::string matrix_words(const Material& m) {
  std::string words;
  for (const MatrixTerm& term : m.matrix)
    words += (words.empty() ? "" : " + ") + std::string(std::visit([](const auto& t) { return t.key; }, term));
  if (!m.fibres.empty()) words += fmt::format(" with {} fibre famil{}", m.fibres.size(), m.fibres.size() == 1 ? "y" : "ies");
  return words;
}

struct Direction {
  double x, z;
};
Direction direction(const Fibre& f) {
  const double alpha = f.alpha_deg * std::numbers::pi / 180;
  return {std::cos(alpha), std::sin(alpha)};
}

int ogden_parts(const Ogden& law) {
  int n = 0;
  for (const auto& part : law.parts()) n += part.mu != 0;
  return n;
}

constexpr const char* other_volume = "volume term here (1/D)((J^2-1)/2 - ln J) instead of (J-1)^2/d; same bulk modulus 2/d";

// the isotropic keywords that Abaqus and CalculiX share; empty where the law does not exist
std::string hyperelastic(const Material& m, const std::string& comment) {
  const double d = m.volume.quadratic.d;
  if (const auto* t = only<ArrudaBoyce>(m))
    return fmt::format("{} {}\n*HYPERELASTIC, ARRUDA-BOYCE\n{}, {}, {}\n", comment, other_volume, number(t->mu),
                       number(t->locking_stretch), number(d));
  if (const auto* t = only<Ogden>(m)) {
    std::string line, zeros;
    for (const auto& [mu, alpha] : t->parts())
      if (mu != 0) line += number(mu * alpha / 2) + ", " + number(alpha) + ", ";
    const int n = ogden_parts(*t);
    if (n == 0) return "";
    for (int i = 1; i < n; ++i) zeros += ", 0.";
    std::string end = number(d) + zeros;
    // eight numbers in a line
    if (n == 3) end = number(d) + ", 0.,\n0.";
    return fmt::format("{} Ogden: mu here is mu alpha/2 of Langer\n*HYPERELASTIC, OGDEN, N={}\n{}{}\n", comment, n, line, end);
  }
  const auto p = polynomial(m);
  if (!p || p->I2[1] != 0 || p->I2[2] != 0) return "";
  if (p->I2[0] == 0 && p->I1[1] == 0 && p->I1[2] == 0)
    return fmt::format("*HYPERELASTIC, NEO HOOKE\n{}, {}\n", number(p->I1[0]), number(d));
  if (p->I2[0] == 0)
    return fmt::format("*HYPERELASTIC, YEOH\n{}, {}, {}, {}, 0., 0.\n", number(p->I1[0]), number(p->I1[1]), number(p->I1[2]),
                       number(d));
  if (p->I1[1] == 0 && p->I1[2] == 0)
    return fmt::format("*HYPERELASTIC, MOONEY-RIVLIN\n{}, {}, {}\n", number(p->I1[0]), number(p->I2[0]), number(d));
  if (p->I1[2] == 0)
    return fmt::format("*HYPERELASTIC, POLYNOMIAL, N=2\n{}, {}, {}, 0., 0., {}, 0.\n", number(p->I1[0]), number(p->I2[0]),
                       number(p->I1[1]), number(d));
  return "";
}

// one c1, c2, kappa for all families, as HGO and GOH implementations ask
bool alike(const std::vector<Fibre>& fibres) {
  for (const Fibre& f : fibres)
    if (f.hgo.c1 != fibres[0].hgo.c1 || f.hgo.c2 != fibres[0].hgo.c2 || f.kappa != fibres[0].kappa) return false;
  return true;
}

Card abaqus(const Material& m) {
  Card card{"Abaqus", "abaqus.inp", "", true};
  std::string law;
  const auto p = polynomial(m);
  if (m.fibres.empty()) {
    law = hyperelastic(m, "**");
  } else if (p && p->I1[1] == 0 && p->I1[2] == 0 && p->I2[0] == 0 && p->I2[1] == 0 && p->I2[2] == 0 && alike(m.fibres)) {
    const Fibre& f = m.fibres[0];
    law = fmt::format(
        "** {}\n** the fibre directions stand in the *ORIENTATION of the section, e.g.\n**  *ORIENTATION, NAME=FIBRES, LOCAL "
        "DIRECTIONS={}\n**  1., 0., 0., 0., 1., 0.\n",
        other_volume, m.fibres.size());
    for (const Fibre& one : m.fibres)
      law += fmt::format("**  {}, 0., {}\n", number(direction(one).x), number(direction(one).z));
    law += fmt::format("*ANISOTROPIC HYPERELASTIC, HOLZAPFEL, LOCAL DIRECTIONS={}\n{}, {}, {}, {}, {}\n", m.fibres.size(),
                       number(p->I1[0]), number(m.volume.quadratic.d), number(f.hgo.c1), number(f.hgo.c2), number(f.kappa));
  }
  card.exists = !law.empty();
  card.text = card.exists ? "** mm, N, MPa\n*MATERIAL, NAME=LANGER\n" + law
                          : "** " + matrix_words(m) +
                                " is no built-in material of Abaqus; it needs UHYPER (isotropic) or UANISOHYPER_INV (fibres)\n";
  return card;
}

Card calculix(const Material& m) {
  Card card{"CalculiX", "calculix.inp", "", true};
  const std::string law = m.fibres.empty() ? hyperelastic(m, "**") : "";
  card.exists = !law.empty();
  card.text = card.exists ? "** mm, N, MPa\n*MATERIAL, NAME=LANGER\n" + law
                          : "** " + matrix_words(m) + " is no built-in material of CalculiX; it needs a user material\n";
  return card;
}

Card ansys(const Material& m) {
  Card card{"ANSYS", "ansys.txt", "! mm, N, MPa\n", true};
  const double d = m.volume.quadratic.d;
  const auto p = polynomial(m);
  const char* other = "! volume term here ((J^2-1)/2 - ln J)/d instead of (J-1)^2/d; same bulk modulus 2/d\n";
  bool dispersed = false;
  for (const Fibre& f : m.fibres) dispersed = dispersed || f.kappa != 0;
  if (p && m.fibres.size() <= 2 && !dispersed) {
    // the law (44): W = sum A_i (I1-3)^i + sum B_i (I2-3)^i + C1/(2 C2)(exp(C2 (I4-1)^2)-1) + E1/(2 E2)(...) + (J-1)^2/d
    card.text += fmt::format("TB,AHYPER,1,1,10,EXPO\nTBDATA,1,{},{},{}\nTBDATA,4,{},{},{}\n", number(p->I1[0]),
                             number(p->I1[1]), number(p->I1[2]), number(p->I2[0]), number(p->I2[1]), number(p->I2[2]));
    for (std::size_t k = 0; k < m.fibres.size(); ++k)
      card.text += fmt::format("TBDATA,{},{},{}\n", 7 + 2 * k, number(m.fibres[k].hgo.c1), number(m.fibres[k].hgo.c2));
    for (std::size_t k = 0; k < m.fibres.size(); ++k)
      card.text += fmt::format("TB,AHYPER,1,1,3,{}\nTBDATA,1,{},0,{}\n", k == 0 ? "AVEC" : "BVEC",
                               number(direction(m.fibres[k]).x), number(direction(m.fibres[k]).z));
    card.text += fmt::format("TB,AHYPER,1,1,1,PVOL\nTBDATA,1,{}\n", number(d));
  } else if (const auto* t = only<Ogden>(m); t && m.fibres.empty() && ogden_parts(*t) > 0) {
    const int n = ogden_parts(*t);
    card.text += fmt::format("TB,HYPER,1,1,{},OGDEN\n", n);
    int at = 1;
    for (const auto& [mu, alpha] : t->parts())
      if (mu != 0) card.text += fmt::format("TBDATA,{},{},{}\n", at, number(mu), number(alpha)), at += 2;
    card.text += fmt::format("TBDATA,{},{}\n", at, number(d));
  } else if (const auto* t = only<ArrudaBoyce>(m); t && m.fibres.empty()) {
    card.text +=
        fmt::format("{}TB,HYPER,1,1,3,BOYCE\nTBDATA,1,{},{},{}\n", other, number(t->mu), number(t->locking_stretch), number(d));
  } else if (const auto* t = only<Gent>(m); t && m.fibres.empty()) {
    card.text += fmt::format("{}TB,HYPER,1,1,3,GENT\nTBDATA,1,{},{},{}\n", other, number(t->mu), number(t->Jm), number(d));
  } else {
    card.exists = false;
    card.text = "! " + matrix_words(m) + (dispersed ? ", dispersed," : "") +
                " is no built-in material of ANSYS; it needs UserHyper or UserMat\n";
  }
  return card;
}

Card febio(const Material& m) {
  Card card{"FEBio", "febio.xml", "", true};
  const double k = m.volume.quadratic.bulk_modulus();
  const auto p = polynomial(m);
  const bool linear = p && p->I1[1] == 0 && p->I1[2] == 0 && p->I2[1] == 0 && p->I2[2] == 0;
  std::string type, body;
  const auto line = [&](const std::string& tag, double value) {
    body += fmt::format("  <{0}>{1}</{0}>\n", tag, number(value));
  };
  if (m.fibres.empty() && linear) {
    type = "Mooney-Rivlin";
    line("c1", p->I1[0]), line("c2", p->I2[0]);
  } else if (m.fibres.empty() && p && p->I2[0] == 0 && p->I2[1] == 0 && p->I2[2] == 0) {
    type = "Yeoh";
    line("c1", p->I1[0]), line("c2", p->I1[1]), line("c3", p->I1[2]);
  } else if (const auto* t = only<Ogden>(m); t && m.fibres.empty() && ogden_parts(*t) > 0) {
    type = "Ogden";
    int i = 1;
    // FEBio: c/m^2 (l_1^m + l_2^m + l_3^m - 3)
    for (const auto& [mu, alpha] : t->parts())
      if (mu != 0) line(fmt::format("c{}", i), mu * alpha), line(fmt::format("m{}", i), alpha), ++i;
  } else if (const auto* t = only<ArrudaBoyce>(m); t && m.fibres.empty()) {
    type = "Arruda-Boyce";
    line("mu", t->mu), line("N", t->locking_stretch * t->locking_stretch);
  } else if (const auto* t = only<Gent>(m); t && m.fibres.empty()) {
    type = "Gent";
    line("G", t->mu), line("Jm", t->Jm);
  } else if (linear && p->I2[0] == 0 && alike(m.fibres) &&
             (m.fibres.size() == 1 || (m.fibres.size() == 2 && m.fibres[0].alpha_deg == -m.fibres[1].alpha_deg))) {
    // matrix c/2 (I1 - 3); two families at +gamma and -gamma from the material's first axis: one family counts half
    type = "Holzapfel-Gasser-Ogden";
    const Fibre& f = m.fibres[0];
    const bool one = m.fibres.size() == 1;
    line("c", 2 * p->I1[0]), line("k1", one ? f.hgo.c1 / 2 : f.hgo.c1), line("k2", f.hgo.c2);
    line("gamma", one ? 0 : std::abs(f.alpha_deg)), line("kappa", f.kappa);
    const Direction a = one ? direction(f) : Direction{1, 0};
    body += fmt::format("  <mat_axis type=\"vector\">\n    <a>{},0,{}</a>\n    <d>{},0,{}</d>\n  </mat_axis>\n", number(a.x),
                        number(a.z), number(-a.z), number(a.x));
  }
  card.exists = !type.empty();
  if (!card.exists) {
    card.text = "<!-- " + matrix_words(m) + " is no built-in material of FEBio; it needs a plugin -->\n";
    return card;
  }
  line("k", k);
  card.text = fmt::format(
      "<!-- mm, N, MPa. Uncoupled material: volume term here k (ln J)^2/2 instead of (J-1)^2/d; same bulk modulus k = 2/d -->\n"
      "<material id=\"1\" name=\"langer\" type=\"{}\">\n{}</material>\n",
      type, body);
  return card;
}

}  // namespace

std::vector<Card> cards(const Material& material) {
  return {abaqus(material), ansys(material), febio(material), calculix(material)};
}

}  // namespace langer
