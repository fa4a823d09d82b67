// What other programs make of a material card, by the formulas that they publish: text in, energy
// or stress at a state out.
//   FEBio     its source, github.com/febiosoftware/FEBio at 65622b5, FEBioMech/: FEMooneyRivlin, FEYeoh, FEOgdenMaterial,
//             FEGentMaterial, FEArrudaBoyce, FEFiberExpPowUncoupled, FEFiberPowLinearUncoupled, FEHolzapfelGasserOgden, FEUncoupledElasticMixture,
//             FEUncoupledMaterial (U of the pressure models), FECore/FEMaterial (axes of parent and child)
//   Abaqus    Materials Guide, "Hyperelastic behavior of rubberlike materials", "Anisotropic hyperelastic behavior"; Keywords
//             Guide, *ORIENTATION: axes, additional rotation, then the local directions
//   CalculiX  ccx 2.20 manual, *HYPERELASTIC and "Fiber-reinforced material model" (ELASTIC_FIBER)
//   ANSYS     Material Reference, "Hyperelasticity" and "Anisotropic hyperelasticity" (EXPO)
#pragma once

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer::foreign {

inline std::vector<double> numbers(std::string text) {
  for (char& c : text)
    if (c == ',') c = ' ';
  std::istringstream in(text);
  std::vector<double> list;
  for (double x; in >> x;) list.push_back(x);
  return list;
}

// ---- FEBio ----

struct Solid {
  std::string type, body;
  double value(const std::string& tag, double missing = 0) const {
    std::smatch found;
    return std::regex_search(body, found, std::regex("<" + tag + ">([^<]*)</" + tag + ">"))
               ? std::stod(found[1])
               : missing;
  }
  Vec3 vector(const std::string& tag) const {
    std::smatch found;
    REQUIRE(std::regex_search(body, found, std::regex("<" + tag + ">([^<]*)</")));
    const std::vector<double> x = numbers(found[1]);
    REQUIRE(x.size() == 3);
    return {x[0], x[1], x[2]};
  }
  Mat3 axes() const {
    if (body.find("<mat_axis") == std::string::npos) return Mat3::Identity();
    Mat3 Q;
    const Vec3 a = vector("a"), d = vector("d"), c = a.cross(d);
    Q << a.normalized(), c.cross(a).normalized(), c.normalized();
    return Q;
  }
};

inline Mat3 dev(const Mat3& s) { return s - s.trace() / 3 * Mat3::Identity(); }

// Cauchy stress of a solid without pressure
inline Mat3 febio_deviator(const Solid& s, const Mat3& F, const Mat3& parent) {
  const double J = F.determinant();
  const Mat3 f = std::cbrt(1 / J) * F, b = f * f.transpose(), c = f.transpose() * f,
             Q = parent * s.axes();
  const double I1 = b.trace();
  if (s.type == "Mooney-Rivlin")
    return 2 / J * dev(b * (s.value("c1") + s.value("c2") * I1) - b * b * s.value("c2"));
  if (s.type == "Yeoh") {
    double sum = 0;
    for (int i = 0; i < 6; ++i) sum += s.value("c" + std::to_string(i + 1)) * std::pow(I1 - 3, i);
    return 2 / J * dev(b * sum);
  }
  if (s.type == "Gent")
    return dev(b * (s.value("G") * s.value("Jm") / (s.value("Jm") - I1 + 3))) / J;
  if (s.type == "Arruda-Boyce") {
    const double a[] = {0.5, 0.1, 11. / 350, 19. / 1750, 519. / 134750}, g = I1 / s.value("N");
    double sum = 0;
    for (int i = 4; i >= 0; --i) sum = sum * g + (i + 1) * a[i];
    return 2 / J * dev(b * (s.value("mu") * sum));
  }
  if (s.type == "Ogden") {
    const Eigen::SelfAdjointEigenSolver<Mat3> e(b);
    Mat3 sum = Mat3::Zero();
    for (int k = 0; k < 3; ++k)
      for (int j = 1; j <= 6; ++j) {
        const double m = s.value("m" + std::to_string(j), 1);
        sum += s.value("c" + std::to_string(j)) / m * (std::pow(e.eigenvalues()[k], m / 2) - 1) *
               e.eigenvectors().col(k) * e.eigenvectors().col(k).transpose();
      }
    return dev(sum) / J;
  }
  if (s.type == "fiber-exp-pow-uncoupled") {
    std::smatch found;
    REQUIRE(std::regex_search(s.body, found, std::regex("<fiber type=\"vector\">([^<]*)</fiber>")));
    const std::vector<double> n = numbers(found[1]);
    const Vec3 n0 = Q * Vec3(n.at(0), n.at(1), n.at(2)).normalized(), nt = f * n0;
    const double x = n0.dot(c * n0) - 1, alpha = s.value("alpha"), beta = s.value("beta");
    CHECK(s.value("ksi") >= 0);
    if (x < 0) return Mat3::Zero();
    return 2 / J * s.value("ksi") * std::pow(x, beta - 1) * std::exp(alpha * std::pow(x, beta)) *
           dev(nt * nt.transpose());
  }
  if (s.type == "fiber-pow-linear-uncoupled") {
    std::smatch found;
    REQUIRE(std::regex_search(s.body, found, std::regex("<fiber type=\"vector\">([^<]*)</fiber>")));
    const std::vector<double> n = numbers(found[1]);
    const Vec3 n0 = Q * Vec3(n.at(0), n.at(1), n.at(2)).normalized(), nt = f * n0;
    const double E = s.value("E"), lam0 = s.value("lam0"), beta = s.value("beta"), I0 = lam0 * lam0,
                 In = n0.dot(c * n0);
    const double ksi = E / 4 / (beta - 1) * std::pow(I0, -1.5) * std::pow(I0 - 1, 2 - beta);
    const double slope = ksi * std::pow(I0 - 1, beta - 1) + E / 2 / std::sqrt(I0);
    CHECK(E > 0);
    if (In < 1) return Mat3::Zero();
    const double sn =
        In < I0 ? 2 * In * ksi * std::pow(In - 1, beta - 1) : 2 * slope * In - E * std::sqrt(In);
    return dev(nt * nt.transpose()) * (sn / In / J);
  }
  REQUIRE(s.type == "Holzapfel-Gasser-Ogden");
  const double k1 = s.value("k1"), k2 = s.value("k2"), kappa = s.value("kappa"),
               g = s.value("gamma") * M_PI / 180;
  CHECK(s.value("c") >= 0);
  CHECK(k1 >= 0);
  Mat3 sum = s.value("c") * b;
  for (double side : {1., -1.}) {
    const Vec3 ar = Q.col(0) * std::cos(g) + side * Q.col(1) * std::sin(g), a = f * ar;
    const double E = kappa * (I1 - 3) + (1 - 3 * kappa) * (ar.dot(c * ar) - 1);
    if (E >= 0)
      sum += 2 * k1 * E * std::exp(k2 * E * E) * (kappa * b + (1 - 3 * kappa) * a * a.transpose());
  }
  return dev(sum) / J;
}

// Cauchy stress of the first <material> of a text
inline Mat3 febio_stress(const std::string& text, const Mat3& F) {
  const std::size_t at = text.find("<material "), end = text.find("</material>");
  REQUIRE(at != std::string::npos);
  std::string all = text.substr(at, end - at);
  std::smatch head;
  REQUIRE(std::regex_search(all, head, std::regex("^<material [^>]*type=\"([^\"]*)\">")));
  std::vector<Solid> solids;
  const std::regex part("[ ]*<solid type=\"([^\"]*)\">([^\n]*)</solid>\n");
  for (std::sregex_iterator i(all.begin(), all.end(), part), none; i != none; ++i)
    solids.push_back({(*i)[1], (*i)[2]});
  const Solid whole{head[1], std::regex_replace(all, part, "")};
  const double J = F.determinant(), model = whole.value("pressure_model", -1);
  REQUIRE((model == 0 || model == 1 || model == 2));
  const double slope = model == 0 ? std::log(J) / J : model == 1 ? 0.5 * (J - 1 / J) : J - 1;
  Mat3 sigma = whole.value("k") * slope * Mat3::Identity();
  if (whole.type != "uncoupled solid mixture")
    return sigma + febio_deviator(whole, F, Mat3::Identity());
  REQUIRE(!solids.empty());
  for (const Solid& s : solids) sigma += febio_deviator(s, F, whole.axes());
  return sigma;
}

// ---- programs that are compared by their energy ----

struct Energies {
  double isochoric = 0, volumetric = 0;
};

struct State {
  explicit State(const Mat3& F)
      : J(F.determinant()), c(std::cbrt(1 / (J * J)) * F.transpose() * F) {
    I1 = c.trace(), I2 = 0.5 * (I1 * I1 - (c * c).trace());
    l2 = Eigen::SelfAdjointEigenSolver<Mat3>(c).eigenvalues();
  }
  double J, I1 = 0, I2 = 0;
  Mat3 c;  // isochoric
  Vec3 l2;
  double square(double d) const { return (J - 1) * (J - 1) / d; }
  double logarithmic(double d) const { return ((J * J - 1) / 2 - std::log(J)) / d; }
  double polynomial(const std::vector<double>& n,
                    int terms) const {  // c10 c01 c20 c11 c02 c30 c21 c12 c03
    const double x = I1 - 3, y = I2 - 3,
                 of[] = {x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y};
    double W = 0;
    for (int i = 0; i < terms; ++i) W += n.at(static_cast<std::size_t>(i)) * of[i];
    return W;
  }
  double chains(double mu, double locking) const {
    const double C[] = {1. / 2, 1. / 20, 11. / 1050, 19. / 7000, 519. / 673750};
    double W = 0;
    for (int i = 1; i <= 5; ++i)
      W += mu * C[i - 1] / std::pow(locking, 2 * i - 2) * (std::pow(I1, i) - std::pow(3, i));
    return W;
  }
  double powers(double alpha) const {
    return std::pow(l2[0], alpha / 2) + std::pow(l2[1], alpha / 2) + std::pow(l2[2], alpha / 2) - 3;
  }
  double fibre(const Vec3& a, double k1, double k2, double kappa, bool switched = true) const {
    const double E = kappa * (I1 - 3) + (1 - 3 * kappa) * (a.dot(c * a) - 1);
    return switched && E < 0 ? 0 : k1 / (2 * k2) * (std::exp(k2 * E * E) - 1);
  }
};

// keyword lines of Abaqus and CalculiX with the numbers below them; comments count where `comments`
// says so
struct Keyword {
  std::string line;
  std::vector<std::vector<double>> rows;
  std::vector<double> all() const {
    std::vector<double> list;
    for (const auto& row : rows) list.insert(list.end(), row.begin(), row.end());
    return list;
  }
  bool is(const std::string& word) const { return line.find(word) != std::string::npos; }
};
inline std::vector<Keyword> keywords(const std::string& text) {
  std::vector<Keyword> list;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("**  ", 0) == 0)
      line = line.substr(4);  // the section's *ORIENTATION stands in comments
    if (line.rfind("**", 0) == 0) continue;
    if (line.rfind("*", 0) == 0)
      list.push_back({line, {}});
    else if (!list.empty())
      list.back().rows.push_back(numbers(line));
  }
  return list;
}
inline Mat3 orientation(const std::vector<double>& axes) {
  const Vec3 a(axes.at(0), axes.at(1), axes.at(2)), b(axes.at(3), axes.at(4), axes.at(5)),
      n = a.cross(b);
  Mat3 Q;
  Q << a.normalized(), n.cross(a).normalized(), n.normalized();
  return Q;
}

inline Energies by_keywords(const std::string& text, const Mat3& F) {
  const State s(F);
  const std::vector<Keyword> words = keywords(text);
  const auto find = [&](const std::string& word) -> const Keyword* {
    for (const Keyword& k : words)
      if (k.line.rfind(word, 0) == 0) return &k;
    return nullptr;
  };
  const Keyword* frame = find("*ORIENTATION");
  if (const Keyword* k = find("*ANISOTROPIC HYPERELASTIC, HOLZAPFEL")) {
    const std::vector<double> n = k->all();  // C10, D, k1, k2, kappa
    REQUIRE(frame);
    REQUIRE(frame->rows.size() >= 3);
    REQUIRE(frame->rows[1] == std::vector<double>{3, 0});
    const Mat3 Q = orientation(frame->rows[0]);
    Energies e{n.at(0) * (s.I1 - 3), s.logarithmic(n.at(1))};
    for (std::size_t i = 2; i < frame->rows.size(); ++i)
      e.isochoric +=
          s.fibre((Q * Vec3(frame->rows[i].data())).normalized(), n.at(2), n.at(3), n.at(4));
    CHECK(k->is("LOCAL DIRECTIONS=" + std::to_string(frame->rows.size() - 2)));
    CHECK(frame->is("LOCAL DIRECTIONS=" + std::to_string(frame->rows.size() - 2)));
    return e;
  }
  if (const Keyword* k = find("*USER MATERIAL")) {
    const std::vector<double> n =
        k->all();  // C10, D1, then a1, a2, k1, k2 for each family; a3 > 0 from the length
    REQUIRE(frame);
    CHECK(find("*MATERIAL")->is("NAME=ELASTIC_FIBER"));
    CHECK(k->is("CONSTANTS=" + std::to_string(n.size())));
    const Mat3 Q = orientation(frame->rows.at(0));
    Energies e{n.at(0) * (s.I1 - 3), s.square(n.at(1))};
    for (std::size_t i = 2; i + 3 < n.size(); i += 4) {
      const double rest = 1 - n[i] * n[i] - n[i + 1] * n[i + 1];
      REQUIRE(rest >= 0);
      e.isochoric += s.fibre(Q * Vec3(n[i], n[i + 1], std::sqrt(rest)), n[i + 2], n[i + 3], 0);
    }
    return e;
  }
  const Keyword* k = find("*HYPERELASTIC");
  REQUIRE(k);
  for (const auto& row : k->rows) CHECK(row.size() <= 8);
  const std::vector<double> n = k->all();
  std::smatch found;
  const int N =
      std::regex_search(k->line, found, std::regex("N=([0-9])")) ? std::stoi(found[1]) : 0;
  if (k->is("NEO HOOKE")) return {n.at(0) * (s.I1 - 3), s.square(n.at(1))};
  if (k->is("MOONEY-RIVLIN")) return {s.polynomial(n, 2), s.square(n.at(2))};
  if (k->is("YEOH"))
    return {s.polynomial({n.at(0), 0, n.at(1), 0, 0, n.at(2), 0, 0, 0}, 9), s.square(n.at(3))};
  if (k->is("ARRUDA-BOYCE")) return {s.chains(n.at(0), n.at(1)), s.logarithmic(n.at(2))};
  if (k->is("POLYNOMIAL")) {
    const int terms = N == 2 ? 5 : 9;
    REQUIRE(n.size() == static_cast<std::size_t>(terms + N));
    return {s.polynomial(n, terms), s.square(n.at(static_cast<std::size_t>(terms)))};
  }
  REQUIRE(k->is("OGDEN"));
  REQUIRE(n.size() == static_cast<std::size_t>(3 * N));
  double W = 0;
  for (int i = 0; i < N; ++i)
    W += 2 * n[2 * i] / (n[2 * i + 1] * n[2 * i + 1]) * s.powers(n[2 * i + 1]);
  return {W, s.square(n.at(static_cast<std::size_t>(2 * N)))};
}

inline Energies by_ansys(const std::string& text, const Mat3& F) {
  const State s(F);
  std::map<std::string, std::vector<double>> table;
  std::string option;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("TB,", 0) == 0) option = line.substr(line.rfind(',') + 1);
    if (line.rfind("TB,HYPER", 0) == 0)
      option += numbers(line.substr(line.find(",1,1,") + 5)).empty()
                    ? ""
                    : line.substr(line.find(",1,1,") + 5, 1);
    if (line.rfind("TBDATA,", 0) != 0) continue;
    const std::vector<double> n = numbers(line.substr(7));
    REQUIRE(n.size() >= 2);
    REQUIRE(n.size() <= 7);  // six constants to a line
    std::vector<double>& of = table[option];
    of.resize(std::max(of.size(), static_cast<std::size_t>(n[0]) + n.size() - 2));
    for (std::size_t i = 1; i < n.size(); ++i) of[static_cast<std::size_t>(n[0]) + i - 2] = n[i];
  }
  REQUIRE(!table.empty());
  const auto& [kind, n] = *table.begin();
  if (kind == "NEO1") return {n.at(0) / 2 * (s.I1 - 3), s.square(n.at(1))};
  if (kind == "YEOH3")
    return {s.polynomial({n.at(0), 0, n.at(1), 0, 0, n.at(2), 0, 0, 0}, 9), s.square(n.at(3))};
  if (kind == "MOONEY2" || kind == "MOONEY5" || kind == "MOONEY9") {
    const int terms = kind.back() - '0';
    REQUIRE(n.size() == static_cast<std::size_t>(terms + 1));
    return {s.polynomial(n, terms), s.square(n.back())};
  }
  if (kind == "BOYCE3") return {s.chains(n.at(0), n.at(1)), s.logarithmic(n.at(2))};
  if (kind == "GENT3")
    return {-n.at(0) * n.at(1) / 2 * std::log(1 - (s.I1 - 3) / n.at(1)), s.logarithmic(n.at(2))};
  if (kind.rfind("OGDEN", 0) == 0) {
    const std::size_t N = static_cast<std::size_t>(kind.back() - '0');
    REQUIRE(n.size() == 2 * N + 1);
    double W = 0;
    for (std::size_t i = 0; i < N; ++i) W += n[2 * i] / n[2 * i + 1] * s.powers(n[2 * i + 1]);
    return {W, s.square(n.back())};
  }
  const std::vector<double>& x = table.at("EXPO");
  REQUIRE(x.size() == 10);
  Energies e{s.polynomial({x[0], x[3], x[1], 0, x[4], x[2], 0, 0, x[5]}, 9),
             s.square(table.at("PVOL").at(0))};
  for (const auto& [name, at] : {std::pair("AVEC", 6), std::pair("BVEC", 8)})
    if (table.count(name))
      e.isochoric += s.fibre(Vec3(table.at(name).data()), x[at], x[at + 1], 0, false);
  return e;
}

}  // namespace langer::foreign
