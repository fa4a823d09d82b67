#include "meshing/inp_material.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <set>

namespace langer {

namespace {

constexpr std::size_t per_line = 8;
constexpr std::size_t most_numbers = 16;  // of one model, with its temperature
constexpr int most_terms = 3;

// A model of *HYPERELASTIC with the coefficients of its polynomial, or its terms.
struct Model {
  std::string matrix;        // key and value
  double shear_modulus = 0;  // at rest [MPa]
};

using Coefficients = std::array<double, most_terms>;

// Of (I1_bar - 3)^i and (I2_bar - 3)^i, under the name that has no unused coefficient.
Model polynomial(const Coefficients& a, const Coefficients& b) {
  Model model;
  model.shear_modulus = 2 * (a[0] + b[0]);
  const bool higher = a[1] != 0 || a[2] != 0 || b[1] != 0 || b[2] != 0;
  const bool of_I2 = b[0] != 0 || b[1] != 0 || b[2] != 0;
  if (!higher && !of_I2) {
    model.matrix = fmt::format("neo_hooke: {{a1: {}}}", a[0]);
  } else if (!higher) {
    model.matrix = fmt::format("mooney_rivlin: {{c10: {}, c01: {}}}", a[0], b[0]);
  } else {
    model.matrix = fmt::format("yeoh: {{a1: {}, a2: {}, a3: {}}}", a[0], a[1], a[2]);
    if (of_I2) {
      model.matrix += fmt::format(", yeoh_I2: {{b1: {}, b2: {}, b3: {}}}", b[0], b[1], b[2]);
    }
  }
  return model;
}

// Their mu is mu alpha/2 of Langer.
Model ogden(const std::vector<double>& numbers, int n_terms) {
  Model model;
  for (int i = 0; i < n_terms; ++i) {
    const double mu = numbers[static_cast<std::size_t>(2 * i)];
    const double alpha = numbers[static_cast<std::size_t>(2 * i + 1)];
    if (!model.matrix.empty()) model.matrix += ", ";
    model.matrix += fmt::format("mu{0}: {1}, alpha{0}: {2}", i + 1, 2 * mu / alpha, alpha);
    model.shear_modulus += mu;
  }
  model.matrix = "ogden: {" + model.matrix + "}";
  return model;
}

// The models and the number of their coefficients before D1, D2, ... for N terms.
struct Layout {
  int n_terms = 1;
  int n_coefficients = 0;
  int n_volume = 1;  // D1, D2, ...
};

std::optional<int> terms_of(const InpCard& card) {
  const std::string text = card.value("N");
  if (text.empty()) return 1;
  if (text.size() != 1 || text[0] < '1' || text[0] > '0' + most_terms) return std::nullopt;
  return text[0] - '0';
}

std::optional<Layout> layout_of(const InpCard& card) {
  if (card.has("NEO HOOKE")) return Layout{1, 1, 1};
  if (card.has("MOONEY-RIVLIN")) return Layout{1, 2, 1};
  if (card.has("YEOH")) return Layout{3, 3, 3};
  if (card.has("ARRUDA-BOYCE")) return Layout{1, 2, 1};
  const std::optional<int> n = terms_of(card);
  if (!n) return std::nullopt;
  if (card.has("REDUCED POLYNOMIAL")) return Layout{*n, *n, *n};
  if (card.has("OGDEN")) return Layout{*n, 2 * *n, *n};
  // Without any parameter the card is a polynomial: terms (i, j) with 1 <= i + j <= N.
  return Layout{*n, (*n + 1) * (*n + 2) / 2 - 1, *n};
}

// A parameter of the card for which no model here stands.
std::string foreign_parameter(const InpCard& card) {
  static const std::set<std::string> known{
      "NEO HOOKE",          "MOONEY-RIVLIN", "YEOH",       "ARRUDA-BOYCE",
      "REDUCED POLYNOMIAL", "OGDEN",         "POLYNOMIAL", "N"};
  for (const auto& [key, value] : card.parameters) {
    if (known.count(key)) continue;
    // Here, too, the numbers of a viscous material are those after all has relaxed.
    if (key == "MODULI" && upper_case(value) == "LONG TERM") continue;
    if (value.empty()) return key;
    return key + "=" + value;
  }
  return "";
}

// The general polynomial lists its coefficients by rising i + j, and by falling i: C10, C01, C20,
// C11, C02, ... Nothing if a mixed one is not 0.
std::optional<Model> general_polynomial(const std::vector<double>& numbers, int n_terms) {
  Coefficients a{}, b{};
  std::size_t at = 0;
  for (int order = 1; order <= n_terms; ++order) {
    for (int j = 0; j <= order; ++j, ++at) {
      if (j == 0) {
        a[static_cast<std::size_t>(order - 1)] = numbers[at];
      } else if (j == order) {
        b[static_cast<std::size_t>(order - 1)] = numbers[at];
      } else if (numbers[at] != 0) {
        return std::nullopt;
      }
    }
  }
  return polynomial(a, b);
}

std::optional<Model> model_of(const InpCard& card, const std::vector<double>& numbers,
                              const Layout& layout) {
  if (card.has("ARRUDA-BOYCE")) {
    return Model{
        fmt::format("arruda_boyce: {{mu: {}, locking_stretch: {}}}", numbers[0], numbers[1]),
        numbers[0]};
  }
  if (card.has("OGDEN")) return ogden(numbers, layout.n_terms);
  if (card.has("NEO HOOKE") || card.has("YEOH") || card.has("REDUCED POLYNOMIAL")) {
    Coefficients a{};
    for (int i = 0; i < layout.n_coefficients; ++i) {
      a[static_cast<std::size_t>(i)] = numbers[static_cast<std::size_t>(i)];
    }
    return polynomial(a, {});
  }
  if (card.has("MOONEY-RIVLIN")) return polynomial({numbers[0]}, {numbers[1]});
  return general_polynomial(numbers, layout.n_terms);
}

// Their D as a volume term. D = 0, or none, is an incompressible material there.
std::string volume_of(const InpCard& card, double D, double shear_modulus, std::string& remark) {
  constexpr double bulk_over_shear = 1000;
  if (D == 0) {
    D = 2 / (bulk_over_shear * shear_modulus);
    remark = fmt::format(
        "D1 is 0, incompressible: d makes the bulk modulus {:g} times the shear modulus",
        bulk_over_shear);
  }
  const char* const name = card.has("ARRUDA-BOYCE") ? "simo_taylor" : "quadratic";
  return fmt::format("{}: {{d: {}}}", name, D);
}

}  // namespace

void read_hyperelastic(InpMaterial& material, const InpLine& line) {
  if (!material.fault.empty()) return;
  // Numbers that a line leaves out at its end are 0, and the next line does not take their places.
  material.numbers.resize(per_line * static_cast<std::size_t>(material.n_lines), 0);
  ++material.n_lines;
  std::vector<std::string> cells = line.cells;
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  for (const std::string& cell : cells) {
    if (material.numbers.size() >= most_numbers) {
      material.fault = fmt::format("more than {} numbers of *HYPERELASTIC", most_numbers);
      return;
    }
    try {
      material.numbers.push_back(real_number(cell, line.place));
    } catch (const Failure&) {
      material.fault = fmt::format("found \"{}\" in line {}", line.text, line.place.line);
      return;
    }
  }
}

MaterialKeys material_keys(const InpMaterial& material) {
  const InpCard& card = material.hyperelastic;
  if (card.word.empty()) return {"", "it has no *HYPERELASTIC"};
  if (!material.fault.empty()) return {"", material.fault};
  if (const std::string other = foreign_parameter(card); !other.empty()) {
    return {"", "*HYPERELASTIC, " + other};
  }
  const std::optional<Layout> layout = layout_of(card);
  if (!layout) return {"", fmt::format("N={}, more than {} terms", card.value("N"), most_terms)};

  std::vector<double> numbers = material.numbers;
  const auto n = static_cast<std::size_t>(layout->n_coefficients);
  const auto n_all = n + static_cast<std::size_t>(layout->n_volume);
  if (numbers.size() < n) {
    return {"", fmt::format("*HYPERELASTIC has {} numbers instead of {}", numbers.size(), n_all)};
  }
  // One number more is the temperature at which the others hold.
  if (numbers.size() > n_all + 1) return {"", "*HYPERELASTIC depends on temperature or a field"};
  numbers.resize(n_all, 0);
  for (std::size_t i = n + 1; i < n_all; ++i) {
    if (numbers[i] != 0) return {"", fmt::format("D{} is not 0", i - n + 1)};
  }
  const double D = numbers[n];
  if (D < 0) return {"", "D1 is negative"};
  if (card.has("OGDEN")) {
    for (std::size_t i = 1; i < n; i += 2) {
      if (numbers[i] == 0) return {"", "alpha is 0"};
    }
  }

  const std::optional<Model> model = model_of(card, numbers, *layout);
  if (!model) return {"", "a product of both invariants is not 0"};
  if (D == 0 && !(model->shear_modulus > 0)) {
    return {"", "D1 is 0 and there is no shear modulus at rest"};
  }
  MaterialKeys found;
  const std::string volume = volume_of(card, D, model->shear_modulus, found.remark);
  found.keys = fmt::format("matrix: {{{}}}, volume: {{{}}}", model->matrix, volume);
  return found;
}

}  // namespace langer
