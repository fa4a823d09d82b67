// A solved scene as the input of another program, so that the result can be checked there: CalculiX
// (.inp) and FEBio 4 (.feb).
//   written       the body that was solved (its symmetric part, if mirror planes cut it between
//                 elements), elements with the directions of their fibres, materials, supports,
//                 imposed displacements, increments, spheres as rigid facets with penalty contact
//   not written   half turns (the whole body is written); indenters other than spheres and
//                 materials that the program lacks are refused, as Failure(config)
// Differences between the programs are noted at the head of the file. Positions are in mm, forces
// in N, stress in MPa.
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

// Elements of one body with the same fibre directions; none if the material is isotropic.
struct FibreGroup {
  int body = 0;
  std::vector<Vec3> fibres;
  std::vector<int> cells;
};

// A component of the displacement of a set that is imposed; 0 is a support.
struct HeldSet {
  std::string set;  // of nodes
  int axis = 0;
  History to;  // [mm]
};

// A sphere and the surface of the body that it may touch.
struct DeckContact {
  RigidContact law;
  std::string set;            // of nodes
  std::vector<Facet> facets;  // all their corners are contact candidates
  RigidCap cap;
};

// Two surfaces of deformable bodies that may touch.
struct DeckPair {
  std::string name;
  double mu = 0;
  std::vector<Facet> own, other;  // own: where Langer's contact law holds
};

// A scene in the terms that all decks share.
struct Deck {
  Mesh mesh;                        // its node sets: those with supports, movements or contact
  std::vector<Material> materials;  // by body
  std::vector<FibreGroup> groups;
  std::vector<HeldSet> held;
  std::vector<DeckContact> contacts;
  std::vector<DeckPair> pairs;
  bool touches() const { return !contacts.empty() || !pairs.empty(); }
  double first = 0.1, largest = 0.1, smallest = 1e-4;  // increments of the path
  std::vector<double> stops;                           // ascending, the last is 1
  double share = 1;                // the whole body is this many times the part that is written
  std::vector<std::string> words;  // comment lines: the origin of the scene and its results
};

inline constexpr const char* written_by = "written by langer ";  // at the head of every deck

// Throws Failure(config) for what no deck holds.
Deck deck_of(const SolutionReader& solution, const std::string& path);

// `warnings` say where the result of the other program will differ or may not be reached. They
// are also at the head of the text.
struct DeckText {
  std::string text;
  std::vector<std::string> warnings;
};
DeckText calculix_deck(const Deck& deck);
DeckText febio_deck(const Deck& deck);

// Contact by penalty converges only up to some ratio of the bulk modulus to the shear modulus.
// The function returns nothing if the deck is below it. Otherwise it returns the largest ratio
// 2/d over the shear modulus, and the smallest d that converges [1/MPa].
struct TooStiff {
  double ratio = 0, d = 0;
};
std::optional<TooStiff> too_stiff_for_contact(const Deck& deck);

}  // namespace langer
