// Laws that a fit may compare by their names alone: `laws: [yeoh, hgo_yeoh, goh]`.
//
// An entry is what the config of a fit would say: law, numbers to find, ties. Start values are for
// a tissue with a secant modulus of 0.3 MPa; those in MPa are scaled to the tests before a search.
// An entry that ends with _two has two families of fibres, mirrored at the axis x.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "identification/setup/fit_config.hpp"

namespace langer {

struct CatalogueLaw {
  std::string name;
  Material law;
  std::vector<FitParameter> parameters;
  std::vector<FitTie> ties;
};

// the secant modulus that the start values are made for [MPa]
inline constexpr double catalogue_modulus = 0.3;

std::vector<std::string> catalogue_names();
std::optional<CatalogueLaw> catalogue_law(const std::string& name);

// The terms of `discover`: each is a part of an energy with a modulus >= 0.
std::vector<std::string> term_names();
// the law of these terms, in the order of term_names(); nothing where a name is not known
std::optional<CatalogueLaw> law_of_terms(const std::vector<std::string>& terms);
// what is wrong with a list of terms; empty: nothing
std::string mistake_in_terms(const std::vector<std::string>& terms);

// Puts `law`, `parameters` and `ties` of the first law of `laws` into a config that has none: it is
// then a whole config. Of `discover` all terms.
void complete_laws(Tree& config);

}  // namespace langer
