#include "export/cards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include "export/acting.hpp"
#include "export/calculix_material.hpp"
#include "export/febio_material.hpp"
#include "export/fibre_frame.hpp"
#include "export/foreign_terms.hpp"
#include "export/polynomial.hpp"
#include "mechanics/material/parameters.hpp"

namespace langer {

namespace {

// The matrix, if it is one term of this kind; otherwise nullptr.
template <class Term>
const Term* only(const Material& m) {
  if (m.matrix.size() == 1) return std::get_if<Term>(&m.matrix.front());
  return nullptr;
}

std::string number(double x) { return fmt::format("{:.10g}", x); }

// The number of parts of an Ogden model that have energy.
int ogden_parts(const Ogden& law) {
  int n = 0;
  for (const auto& [mu, alpha] : law.parts()) n += mu != 0 && alpha != 0;
  return n;
}

constexpr const char* other_volume =
    "volume term here (1/D)((J^2-1)/2 - ln J) instead of (J-1)^2/d; same bulk modulus 2/d";
constexpr const char* units = "mm, N, MPa";

// The note of a program that lacks the model.
std::string note(const std::string& program, const std::string& lacks, const std::string& nearest) {
  return fmt::format("{} lacks {}; nearest: {}", program, lacks, nearest);
}

// The isotropic keywords that Abaqus and CalculiX share, with notes.
std::string isotropic(const Material& m) {
  std::string law = hyperelastic(m);
  if (law.empty()) return "";
  if (only<ArrudaBoyce>(m) && of_other_form(m.volume))
    law = fmt::format("** {}\n", other_volume) + law;
  if (only<Ogden>(m)) law = "** Ogden: mu here is mu alpha/2 of Langer\n" + law;
  return law;
}

// Whether all families have the same c1, c2 and kappa, as implementations of HGO and GOH require.
bool same_parameters(const std::vector<Fibre>& fibres) {
  const HgoFibre first = *as_hgo(fibres[0]);
  return std::ranges::all_of(fibres, [&](const Fibre& f) {
    const HgoFibre law = *as_hgo(f);
    return law.c1 == first.c1 && law.c2 == first.c2 && f.kappa == fibres[0].kappa;
  });
}

// The volume term of the isotropic models of Abaqus and CalculiX.
VolumeTerm volume_of_keywords(const Material& m) {
  if (only<ArrudaBoyce>(m)) return VolumeTerm::simo_taylor;
  return VolumeTerm::quadratic;
}

// What the model of Holzapfel, Gasser and Ogden in Abaqus lacks for a material.
Lacking beyond_holzapfel(const Material& m) {
  const auto p = polynomial(m);
  const std::string user = ", or UANISOHYPER_INV";
  if (!p || !p->neo_hookean())
    return {"fibres in a matrix other than neo-Hookean", "a neo-Hookean matrix" + user};
  const Lacking law = beyond_hgo(m);
  if (!law.empty()) return {law.what, law.nearest + user};
  if (m.fibres.size() > 3)
    return {fmt::format("{} families of fibres", m.fibres.size()), "three at most" + user};
  if (!same_parameters(m.fibres))
    return {"families with moduli of their own", "one c1, c2 and kappa for all" + user};
  if (as_hgo(m.fibres[0])->c2 == 0)
    return {"c2 = 0, by which it divides", "c2: 1e-6, which differs in the seventh digit"};
  for (const Fibre& f : m.fibres)
    if (f.tension_switch != FibreSwitch::I4_bar)
      return {"fibres with another switch", "switch: I4_bar, which is its own" + user};
  return beyond_volume(m.volume, VolumeTerm::simo_taylor);
}

// A comment line if the volume term has another form in the program.
std::string volume_note(bool differs) {
  if (differs) return fmt::format("** {}\n", other_volume);
  return "";
}

// Keywords of Abaqus for the model of Holzapfel, Gasser and Ogden.
std::string holzapfel(const Material& m) {
  const HgoFibre law = *as_hgo(m.fibres[0]);
  std::string s = fmt::format(
      "{}** the section names the directions of the fibres: *SOLID SECTION, ..., "
      "ORIENTATION=FIBRES, with\n"
      "**  *ORIENTATION, NAME=FIBRES, LOCAL DIRECTIONS={}\n**  1., 0., 0., 0., 1., 0.\n**  3, 0.\n",
      volume_note(of_other_form(m.volume)), m.fibres.size());
  for (const Vec3& a : fibre_directions(m))
    s += fmt::format("**  {}, 0., {}\n", number(a.x()), number(a.z()));
  return s + fmt::format(
                 "*ANISOTROPIC HYPERELASTIC, HOLZAPFEL, LOCAL DIRECTIONS={}\n{}, {}, {}, {}, {}\n",
                 m.fibres.size(), number(polynomial(m)->I1[0]), number(compressibility(m.volume)),
                 number(law.c1), number(law.c2), number(m.fibres[0].kappa));
}

// Isotropic materials and the model of Holzapfel, Gasser and Ogden.
Card abaqus(const Material& m) {
  Card card{"Abaqus", "abaqus.inp", "", true};
  Lacking lacking;
  std::string law;
  if (m.fibres.empty()) {
    law = isotropic(m);
    if (law.empty()) {
      lacking = {matrix_words(m),
                 "neo-Hooke, Mooney-Rivlin, Yeoh, polynomials, Ogden, Arruda-Boyce, or UHYPER"};
    } else {
      lacking = beyond_volume(m.volume, volume_of_keywords(m));
    }
  } else {
    lacking = beyond_holzapfel(m);
    if (lacking.empty()) law = holzapfel(m);
  }
  card.exists = lacking.empty() && !law.empty();
  if (card.exists) {
    card.text = fmt::format("** {}\n*MATERIAL, NAME=LANGER\n{}", units, law);
  } else {
    card.text = fmt::format("** {}\n** {}\n", units, note("Abaqus", lacking.what, lacking.nearest));
  }
  return card;
}

// The section of CalculiX names the frame in which the directions of the fibres are given.
Card calculix(const Material& m) {
  std::vector<Vec3> in_frame;
  std::string section;
  if (!m.fibres.empty()) {
    const FibreFrame frame = fibre_frame(fibre_directions(m));
    in_frame = frame.in_frame;
    section = fmt::format(
        "** the section names the frame of the fibres: *SOLID SECTION, ..., MATERIAL={}, "
        "ORIENTATION=FIBRES\n"
        "*ORIENTATION, NAME=FIBRES, SYSTEM=RECTANGULAR\n{:.12g}, {:.12g}, {:.12g}, {:.12g}, "
        "{:.12g}, {:.12g}\n",
        calculix_name(m, "LANGER"), frame.e1[0], frame.e1[1], frame.e1[2], frame.e2[0], frame.e2[1],
        frame.e2[2]);
  }
  const ForeignLaw law = calculix_material(m, in_frame, "LANGER");
  Card card{"CalculiX", "calculix.inp", "", !law.text.empty()};
  if (!card.exists) {
    card.text = fmt::format("** {}\n** {}\n", units, note("CalculiX", law.lacks, law.nearest));
    return card;
  }
  const bool other_form = only<ArrudaBoyce>(m) && of_other_form(m.volume);
  card.text = fmt::format("** {}\n{}{}{}", units, volume_note(other_form), law.text, section);
  return card;
}

// The isotropic models of TB,HYPER; empty if it has none for this material.
std::string ansys_isotropic(const Material& m) {
  const double d = compressibility(m.volume);
  const char* other = "";
  if (of_other_form(m.volume))
    other = "! volume term here ((J^2-1)/2 - ln J)/d instead of (J-1)^2/d; same bulk modulus 2/d\n";
  const auto table = [](const char* option, int n, const std::vector<double>& constants) {
    std::string s = fmt::format("TB,HYPER,1,1,{},{}\n", n, option);
    for (std::size_t i = 0; i < constants.size(); i += 6) {
      s += fmt::format("TBDATA,{}", i + 1);
      for (std::size_t k = i; k < std::min(i + 6, constants.size()); ++k)
        s += "," + number(constants[k]);
      s += "\n";
    }
    return s;
  };
  if (const auto p = polynomial(m)) {
    const auto& [a, b] = std::pair(p->I1, p->I2);
    if (p->neo_hookean()) return table("NEO", 1, {2 * a[0], d});  // mu/2 (I1 - 3)
    if (p->of_I1()) return table("YEOH", 3, {a[0], a[1], a[2], d, 0, 0});
    if (p->linear()) return table("MOONEY", 2, {a[0], b[0], d});
    if (a[2] == 0 && b[2] == 0) return table("MOONEY", 5, {a[0], b[0], a[1], 0, b[1], d});
    return table("MOONEY", 9, {a[0], b[0], a[1], 0, b[1], a[2], 0, 0, b[2], d});
  }
  if (const auto* t = only<Ogden>(m); t && ogden_parts(*t) > 0) {
    std::vector<double> constants;
    for (const auto& [mu, alpha] : t->parts())
      if (mu != 0 && alpha != 0) {
        constants.push_back(mu);
        constants.push_back(alpha);
      }
    constants.push_back(d);
    return table("OGDEN", ogden_parts(*t), constants);
  }
  if (const auto* t = only<ArrudaBoyce>(m))
    return other + table("BOYCE", 3, {t->mu, t->locking_stretch, d});
  if (const auto* t = only<Gent>(m)) return other + table("GENT", 3, {t->mu, t->Jm, d});
  return "";
}

// The exponential model of ANSYS (44): W = sum A_i (I1-3)^i + sum B_i (I2-3)^i + C1/(2 C2)(exp(C2
// (I4-1)^2)-1) + E1/(2 E2)(...) + (J-1)^2/d.
std::string ansys_fibres(const Material& m, const Polynomial& p) {
  std::string s = fmt::format(
      "! no switch is documented for its fibres: where they are shortened they may push, which "
      "Langer's do not\n"
      "TB,AHYPER,1,1,10,EXPO\nTBDATA,1,{},{},{}\nTBDATA,4,{},{},{}\n",
      number(p.I1[0]), number(p.I1[1]), number(p.I1[2]), number(p.I2[0]), number(p.I2[1]),
      number(p.I2[2]));
  for (std::size_t k = 0; k < 2; ++k) {
    // A family that does not exist has modulus 0 and an exponent by which ANSYS can divide.
    std::string modulus = "0";
    std::string exponent = "1";
    if (k < m.fibres.size()) {
      modulus = number(as_hgo(m.fibres[k])->c1);
      exponent = number(as_hgo(m.fibres[k])->c2);
    }
    s += fmt::format("TBDATA,{},{},{}\n", 7 + 2 * k, modulus, exponent);
  }
  constexpr std::array names{"AVEC", "BVEC"};
  const std::vector<Vec3> a = fibre_directions(m);
  for (std::size_t k = 0; k < a.size(); ++k)
    s += fmt::format("TB,AHYPER,1,1,3,{}\nTBDATA,1,{},0,{}\n", names.at(k), number(a[k].x()),
                     number(a[k].z()));
  return s + fmt::format("TB,AHYPER,1,1,1,PVOL\nTBDATA,1,{}\n", number(compressibility(m.volume)));
}

// What TB,AHYPER lacks for a material.
Lacking beyond_ansys(const Material& m) {
  if (!polynomial(m))
    return {"fibres in " + matrix_words(m), "a polynomial matrix (yeoh), or UserMat"};
  const Lacking law = beyond_hgo(m);
  if (!law.empty()) return {law.what, law.nearest + ", or UserMat"};
  if (m.fibres.size() > 2)
    return {fmt::format("{} families of fibres", m.fibres.size()), "two, or UserMat"};
  for (const Fibre& f : m.fibres) {
    if (f.kappa != 0) return {"dispersed fibres", "kappa: 0, or UserMat"};
    if (as_hgo(f)->c2 == 0)
      return {"c2 = 0, by which it divides", "c2: 1e-6, which differs in the seventh digit"};
  }
  return beyond_volume(m.volume, VolumeTerm::quadratic);
}

// Its models BOYCE and GENT have the Simo-Taylor volume term, all others the quadratic one.
Card ansys(const Material& m) {
  Card card{"ANSYS", "ansys.txt", "", true};
  std::string law;
  Lacking lacking;
  if (m.fibres.empty()) {
    law = ansys_isotropic(m);
    VolumeTerm term = VolumeTerm::quadratic;
    if (only<ArrudaBoyce>(m) || only<Gent>(m)) term = VolumeTerm::simo_taylor;
    if (law.empty()) {
      lacking = {matrix_words(m), "one of its terms alone, or UserHyper"};
    } else {
      lacking = beyond_volume(m.volume, term);
    }
  } else {
    lacking = beyond_ansys(m);
    if (lacking.empty()) law = ansys_fibres(m, *polynomial(m));
  }
  card.exists = lacking.empty() && !law.empty();
  if (card.exists) {
    card.text = fmt::format("! {}\n{}", units, law);
  } else {
    card.text = fmt::format("! {}\n! {}\n", units, note("ANSYS", lacking.what, lacking.nearest));
  }
  return card;
}

// The text of febio_material(), or its note.
Card febio(const Material& m) {
  const ForeignLaw law = febio_material(m, fibre_directions(m), 1, "langer");
  const std::string first_line = fmt::format("<!-- {}; FEBio 4 -->\n", units);
  if (law.text.empty()) {
    return {"FEBio", "febio.xml",
            first_line + fmt::format("<!-- {} -->\n", note("FEBio", law.lacks, law.nearest)),
            false};
  }
  return {"FEBio", "febio.xml", first_line + law.text, true};
}

// The instantaneous material right after a step, to which the branches of ANSYS refer: all moduli
// of the matrix times the same factor.
Material instantaneous(const Material& m, double amplified) {
  Material stiff = m;
  for (const MaterialParameter& p : parameters(stiff))
    if (p.key.starts_with("matrix") && p.unit == std::string(unit::MPa)) *p.value *= amplified;
  return stiff;
}

// Adds viscous branches. TIME=PRONY and TB,PRONY give their strengths as fractions of the
// instantaneous modulus.
void add_branches(const Material& m, const std::vector<ViscousBranch>& branches, Card& abaqus,
                  Card& ansys) {
  double amplified = 1;
  for (const ViscousBranch& branch : branches) amplified += branch.gamma;
  const char* transport =
      "at large strain it leads the stress of the branches along with the rotation, Langer with "
      "all of the deformation: alike where "
      "strains are small";
  if (abaqus.exists) {
    const std::string word = "*HYPERELASTIC,";
    abaqus.text.insert(abaqus.text.find(word) + word.size(), " MODULI=LONG TERM,");
    abaqus.text += fmt::format("** {}\n*VISCOELASTIC, TIME=PRONY\n", transport);
    for (const ViscousBranch& b : branches)
      abaqus.text += fmt::format("{}, 0, {}\n", number(b.gamma / amplified), number(b.tau));
  }
  // ANSYS starts from the instantaneous modulus, which is that of the relaxed material and of all
  // branches.
  ansys = langer::ansys(instantaneous(m, amplified));
  if (!ansys.exists) return;
  ansys.text +=
      fmt::format("! moduli above are those at once after a step; {}\nTB,PRONY,1,1,{},SHEAR\n",
                  transport, branches.size());
  for (std::size_t i = 0; i < branches.size(); ++i)
    ansys.text += fmt::format("TBDATA,{},{},{}\n", 2 * i + 1, number(branches[i].gamma / amplified),
                              number(branches[i].tau));
}

// Cards of the material without branches, to which Abaqus and ANSYS add Prony series. The others
// get a note.
std::vector<Card> viscous_cards(const Material& m) {
  const std::vector<ViscousBranch> branches = branches_of(m);
  Material law = m;
  law.viscous.reset();
  law.spectrum.reset();
  std::vector<Card> all{abaqus(law), ansys(law), febio(law), calculix(law)};
  // The branches in words, for the note of FEBio.
  std::string pairs;
  for (std::size_t i = 0; i < branches.size(); ++i)
    pairs += fmt::format(" t{} = {} s, g{} = {};", i + 1, number(branches[i].tau), i + 1,
                         number(branches[i].gamma));
  const auto refuse = [&](Card& card, const std::string& begin, const std::string& end,
                          const std::string& nearest) {
    card.exists = false;
    card.text =
        begin + note(card.program, "viscous branches as they are here", nearest) + end + "\n";
  };
  const std::string relaxed = "the law without `viscous`, what is left after all has relaxed";
  if (m.fibres.empty()) {
    add_branches(law, branches, all[0], all[1]);
  } else {
    refuse(all[0], "** ", "", relaxed + "; its viscous laws with fibres were not tried");
    refuse(all[1], "! ", "", relaxed + "; its viscous laws with fibres were not tried");
  }
  refuse(all[2], "<!-- ", " -->",
         "<material type=\"uncoupled viscoelastic\"> around the law without them, with" + pairs +
             " it was not tried");
  refuse(all[3], "** ", "", relaxed);
  return all;
}

}  // namespace

// The cards of all four programs.
std::vector<Card> cards(const Material& material) {
  const Material m = acting(material);
  if (is_viscous(m)) return viscous_cards(m);
  return {abaqus(m), ansys(m), febio(m), calculix(m)};
}

}  // namespace langer
