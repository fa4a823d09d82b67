// A solved scene as the input of another program, so that its answer can be checked there: CalculiX
// (.inp) and FEBio 4 (.feb).
//   what is written  the body that was solved (its symmetric part, where mirror planes cut it between cells), cells with the
//                    directions of their fibres, law, supports, imposed displacements, the increments, spheres as rigid facets
//                    with penalty contact
//   what is not      half turns (the whole body is written), indenters other than spheres, laws that the program lacks: the
//   last
//                    two are refused, as Failure(config). What differs there is said at the head of the file.
// Positions in mm, forces in N, stress in MPa.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "export/rigid_cap.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// cells of one body with the same fibre directions; none: isotropic
struct FibreGroup {
  int body = 0;
  std::vector<Vec3> fibres;
  std::vector<int> cells;
};

struct HeldSet {
  std::string set;  // of nodes
  int axis = 0;
  History to;  // [mm]
};

struct DeckContact {
  RigidContact law;
  std::string set;            // of nodes
  std::vector<Facet> facets;  // whose corners all may touch
  RigidCap cap;
};

struct Deck {
  Mesh mesh;                        // node sets: those that are held, moved or may touch
  std::vector<Material> materials;  // by body
  std::vector<FibreGroup> groups;
  std::vector<HeldSet> held;
  std::vector<DeckContact> contacts;
  double first = 0.1, largest = 0.1, smallest = 1e-4;  // increments of the path
  std::vector<double> stops;                           // ascending, the last is 1
  double share = 1;                // the body is this many times what is written
  std::vector<std::string> words;  // where the scene comes from, what was found, line by line
};

inline constexpr const char* written_by = "written by langer ";  // stands at the head of every deck

// Throws Failure(config) for what no deck holds.
Deck deck_of(const SolutionReader& solution, const std::string& path);

// warnings: where the other program's answer will differ, or may not be reached; they stand at the
// head of the text too
struct DeckText {
  std::string text;
  std::vector<std::string> warnings;
};
DeckText calculix_deck(const Deck& deck);
DeckText febio_deck(const Deck& deck);

// Contact in programs that take penalties converges up to some bulk modulus beside the shear
// modulus; nothing where that is met. Else the largest ratio 2/d over the shear modulus, and the d
// that would be borne [1/MPa].
struct TooStiff {
  double ratio = 0, d = 0;
};
std::optional<TooStiff> too_stiff_for_contact(const Deck& deck);

}  // namespace langer
