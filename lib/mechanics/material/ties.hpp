// Parameters of a material that follow others: fibres[1].alpha = -fibres[0].alpha, fibres[1].hgo.c1
// = fibres[0].hgo.c1.
//   key = factor * of + offset;   written  [-][factor *] of [+ offset | - offset]
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/material/material.hpp"

namespace langer {

struct Tie {
  std::string key, of;  // as in material/parameters.hpp
  double factor = 1, offset = 0;
};

std::optional<Tie> parse_tie(const std::string& key,
                             const std::string& text);  // nothing if the text has another form
std::string tie_text(const Tie& tie);                   // the right side of the equation

// Chains followed to their ends, so that no tie follows a tied number. `circle`: a key that follows
// itself, if there is one.
struct ResolvedTies {
  std::vector<Tie> ties;
  std::string circle;
};
ResolvedTies resolved(const std::vector<Tie>& ties);

// Pointers into a material: what to set after the numbers that are followed. Ties must be resolved,
// keys known to the law.
class TiedNumbers {
 public:
  TiedNumbers(Material& material, const std::vector<Tie>& ties);
  void follow() const;

 private:
  struct One {
    double* number;
    const double* of;
    double factor, offset;
  };
  std::vector<One> all_;
};

}  // namespace langer
