#include "identification/setup/law_catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/config/reader.hpp"
#include "core/config/writer.hpp"

namespace langer {

namespace {

// One law as text, so that it reads like a config.
struct Entry {
  const char* name;
  const char* matrix;
  const char* fibre;     // of one family without its angle; empty: none
  const char* numbers;   // keys to find, of the matrix
  const char* of_fibre;  // and of the fibre
};

constexpr const char* yeoh_text = "{yeoh: {a1: 0.02, a2: 0.02, a3: 0.02}}";
constexpr const char* yeoh_keys = "matrix.yeoh.a1 matrix.yeoh.a2 matrix.yeoh.a3";
constexpr const char* neo_text = "{neo_hooke: {a1: 0.02}}";
constexpr const char* neo_key = "matrix.neo_hooke.a1";

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all{
      {"neo_hooke", neo_text, "", neo_key, ""},
      {"mooney_rivlin", "{mooney_rivlin: {c10: 0.01, c01: 0.01}}", "",
       "matrix.mooney_rivlin.c10 matrix.mooney_rivlin.c01", ""},
      {"yeoh", yeoh_text, "", yeoh_keys, ""},
      {"signorini", "{signorini: {c10: 0.01, c01: 0.01, c20: 0.02}}", "",
       "matrix.signorini.c10 matrix.signorini.c01 matrix.signorini.c20", ""},
      {"gent", "{gent: {mu: 0.04, Jm: 2}}", "", "matrix.gent.mu matrix.gent.Jm", ""},
      {"arruda_boyce", "{arruda_boyce: {mu: 0.04, locking_stretch: 1.5}}", "",
       "matrix.arruda_boyce.mu matrix.arruda_boyce.locking_stretch", ""},
      {"ogden", "{ogden: {mu1: 0.02, alpha1: 8, mu2: -0.01, alpha2: -4}}", "",
       "matrix.ogden.mu1 matrix.ogden.alpha1 matrix.ogden.mu2 matrix.ogden.alpha2", ""},
      {"hgo", neo_text, "hgo: {c1: 0.1, c2: 1}", neo_key, "hgo.c1 hgo.c2"},
      {"goh", neo_text, "hgo: {c1: 0.1, c2: 1}, kappa: 0.1", neo_key, "hgo.c1 hgo.c2 kappa"},
      {"hgo_yeoh", yeoh_text, "hgo: {c1: 0.1, c2: 1}", yeoh_keys, "hgo.c1 hgo.c2"},
      {"goh_yeoh", yeoh_text, "hgo: {c1: 0.1, c2: 1}, kappa: 0.1", yeoh_keys,
       "hgo.c1 hgo.c2 kappa"},
      {"exp_pow", neo_text, "exp_pow: {ksi: 0.1, alpha: 1, beta: 2.5}", neo_key,
       "exp_pow.ksi exp_pow.alpha exp_pow.beta"},
      {"pow_linear", neo_text, "pow_linear: {E: 0.5, lam0: 1.1, beta: 2.5}", neo_key,
       "pow_linear.E pow_linear.lam0 pow_linear.beta"},
  };
  return all;
}

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> all;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (end > at) all.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return all;
}

Material material_of(const std::string& yaml) {
  return read_config<Material>(parse_yaml(yaml, "catalogue of laws")).config;
}

constexpr const char* volume_text = "volume: {quadratic: {d: 1.0e-6}}";

CatalogueLaw made(const Entry& entry, bool two) {
  CatalogueLaw one;
  one.name = entry.name;
  std::string fibres = "[]";
  const std::string fibre = entry.fibre;
  if (!fibre.empty()) {
    const std::string family = fibre + ", alpha: 40";
    fibres = "[{" + family + "}]";
    if (two) {
      one.name += "_two";
      fibres = "[{" + family + "}, {" + fibre + ", alpha: -40}]";
    }
  }
  one.law =
      material_of(fmt::format("matrix: {}\nfibres: {}\n{}\n", entry.matrix, fibres, volume_text));
  for (const std::string& key : words(entry.numbers))
    one.parameters.push_back({key, {}, {}, {}, {}});
  if (fibre.empty()) return one;
  for (const std::string& key : words(entry.of_fibre)) {
    one.parameters.push_back({"fibres[0]." + key, {}, {}, {}, {}});
    if (two) one.ties.push_back({"fibres[1]." + key, "fibres[0]." + key});
  }
  FitParameter angle{"fibres[0].alpha", {}, {}, {}, {}};
  if (two) {
    angle.lower = 0;
    angle.upper = 90;
    one.ties.push_back({"fibres[1].alpha", "-fibres[0].alpha"});
  }
  one.parameters.push_back(angle);
  return one;
}

// A term of a library: its modulus is the number that decides whether it is there.
struct Term {
  const char* name;
  const char* group;    // terms of one group are numbers of one energy
  const char* text;     // start values of the group's energy if it is there
  const char* number;   // modulus
  const char* further;  // numbers of its own beside the modulus
};

const std::vector<Term>& terms() {
  static const std::vector<Term> all{
      {"I1", "yeoh", "", "a1", ""},
      {"I1^2", "yeoh", "", "a2", ""},
      {"I1^3", "yeoh", "", "a3", ""},
      {"I2", "yeoh_I2", "", "b1", ""},
      {"I2^2", "yeoh_I2", "", "b2", ""},
      {"I2^3", "yeoh_I2", "", "b3", ""},
      {"fibre", "fibre", "hgo: {c1: 0.1, c2: 0}", "hgo.c1", "alpha"},
      {"exp_fibre", "fibre", "hgo: {c1: 0.1, c2: 1}", "hgo.c1", "hgo.c2 alpha"},
      {"dispersed_fibre", "fibre", "hgo: {c1: 0.1, c2: 1}, kappa: 0.1", "hgo.c1",
       "hgo.c2 kappa alpha"},
      {"power_fibre", "fibre", "exp_pow: {ksi: 0.1, alpha: 0, beta: 3}", "exp_pow.ksi",
       "exp_pow.beta alpha"},
  };
  return all;
}

bool has(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

// the numbers of a polynomial with start values where its terms are there, 0 elsewhere
std::string polynomial(const std::vector<std::string>& chosen, const std::string& group,
                       std::vector<FitParameter>& found) {
  std::string numbers;
  bool any = false;
  for (const Term& term : terms()) {
    if (term.group != group) continue;
    const bool there = has(chosen, term.name);
    any = any || there;
    if (!numbers.empty()) numbers += ", ";
    numbers += fmt::format("{}: {}", term.number, there ? 0.02 : 0.0);
    if (there) found.push_back({fmt::format("matrix.{}.{}", group, term.number), {}, {}, {}, {}});
  }
  if (!any) return "";
  return fmt::format("{}: {{{}}}", group, numbers);
}

// a part of a config that was not written there: its place is that of the key that stands for it
void set_place(Tree& tree, const Place& place) {
  tree.place = place;
  for (Tree::Entry& entry : tree.map) set_place(entry.value, place);
  for (Tree& one : tree.list) set_place(one, place);
}

template <class T>
void add(Tree& config, const char* key, const T& value, const Place& place) {
  if (config.find(key)) return;
  Tree tree = to_tree(value);
  set_place(tree, place);
  config.map.push_back({key, tree});
}

std::vector<std::string> texts_of(const Tree& list) {
  std::vector<std::string> all;
  for (const Tree& one : list.list) all.push_back(one.scalar);
  return all;
}

}  // namespace

std::vector<std::string> catalogue_names() {
  std::vector<std::string> names;
  for (const Entry& entry : entries()) names.push_back(entry.name);
  for (const Entry& entry : entries())
    if (*entry.fibre) names.push_back(std::string(entry.name) + "_two");
  return names;
}

std::optional<CatalogueLaw> catalogue_law(const std::string& name) {
  for (const Entry& entry : entries()) {
    if (name == entry.name) return made(entry, false);
    if (*entry.fibre && name == std::string(entry.name) + "_two") return made(entry, true);
  }
  return std::nullopt;
}

std::vector<std::string> term_names() {
  std::vector<std::string> names;
  for (const Term& term : terms()) names.push_back(term.name);
  return names;
}

std::string mistake_in_terms(const std::vector<std::string>& chosen) {
  const std::vector<std::string> known = term_names();
  for (const std::string& name : chosen)
    if (!has(known, name)) return fmt::format("no term is called \"{}\"", name);
  return "";
}

std::optional<CatalogueLaw> law_of_terms(const std::vector<std::string>& chosen) {
  if (!mistake_in_terms(chosen).empty()) return std::nullopt;
  CatalogueLaw one;
  std::string matrix = polynomial(chosen, "yeoh", one.parameters);
  const std::string second = polynomial(chosen, "yeoh_I2", one.parameters);
  if (!matrix.empty() && !second.empty()) matrix += ", ";
  matrix += second;
  // a law of fibres alone has a matrix that does nothing
  if (matrix.empty()) matrix = "neo_hooke: {a1: 0}";
  std::string fibres;
  int family = 0;
  for (const Term& term : terms()) {
    if (std::string(term.group) != "fibre" || !has(chosen, term.name)) continue;
    if (family > 0) fibres += ", ";
    fibres += fmt::format("{{{}, alpha: {}}}", term.text, family % 2 == 0 ? 40 : -40);
    const std::string at = fmt::format("fibres[{}].", family);
    one.parameters.push_back({at + term.number, {}, {}, {}, {}});
    for (const std::string& key : words(term.further))
      one.parameters.push_back({at + key, {}, {}, {}, {}});
    ++family;
  }
  one.law =
      material_of(fmt::format("matrix: {{{}}}\nfibres: [{}]\n{}\n", matrix, fibres, volume_text));
  for (const std::string& name : term_names()) {
    if (!has(chosen, name)) continue;
    if (!one.name.empty()) one.name += " + ";
    one.name += name;
  }
  return one;
}

void complete_laws(Tree& config) {
  std::optional<CatalogueLaw> one;
  Place place;
  if (const Tree* laws = config.find("laws"); laws && !laws->list.empty()) {
    place = laws->place;
    one = catalogue_law(laws->list.front().scalar);
  } else if (const Tree* discover = config.find("discover")) {
    place = discover->place;
    const Tree* chosen = discover->find("terms");
    one = law_of_terms(chosen ? texts_of(*chosen) : term_names());
  }
  if (!one || config.find("law")) return;
  add(config, "law", one->law, place);
  add(config, "parameters", one->parameters, place);
  if (!one->ties.empty()) add(config, "ties", one->ties, place);
  if (!config.find("bounds")) add(config, "bounds", Bounds::admissible, place);
}

}  // namespace langer
