// What scenes drawn at random are put together from: numbers, materials, blocks and indenters.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace langer::test {

// Numbers of one scene, one after the other.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : rng_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(rng_);
  }
  double logarithmic(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  bool coin(double chance = 0.5) { return uniform(0, 1) < chance; }
  std::size_t below(std::size_t n) {
    return static_cast<std::size_t>(uniform(0, static_cast<double>(n)));
  }

 private:
  std::mt19937_64 rng_;
};

// to three digits, as a user writes numbers
double rounded(double x);

// A material as stiff as skin times `scale`, with at most `families` families of fibres.
std::string material(Draw& draw, double scale = 1, int families = 2);
// A material without fibres whose shear modulus at rest is 2 mu [MPa]; `more` are further keys.
std::string soft_matrix(Draw& draw, double mu, const std::string& more = "");

// a block under indenters of about this radius and depth
struct Pressed {
  double R, H, depth, a;  // radius of a sphere and of its contact, thickness [mm]
  double half;            // of the sides
  double friction;
};

// thickness between `H_in_a_low` and `H_in_a_high` radii of the contact
Pressed pressed(Draw& draw, double H_in_a_low, double H_in_a_high);
// its `mesh`, to whose map `more` is added
std::string mesh_of(const Pressed& p, const std::string& more = "");
// its `mesh`, and `supports` that hold the bottom
std::string block_of(const Pressed& p, const std::string& more = "");
std::string contact_of(const std::string& name, const std::string& shape, const Pressed& p,
                       const std::string& to);
std::string sphere_at(const Pressed& p, double x, double z);
std::string down(const Pressed& p);
std::string of(const Pressed& p, const std::string& law, const std::string& contacts,
               const std::string& more = "");

using Maker = std::function<std::string(Draw&)>;
using Makers = std::vector<std::pair<std::string, Maker>>;  // kinds by name

// Kinds whose supports, loads, histories or indenters are unlike those of the refinement study.
const Makers& further_kinds();

}  // namespace langer::test
