// solution.h5: one record per accepted step, written and flushed before the next step begins.
// docs/schema.md
// Arrays keep the order of nodes and elements of the mesh: n nodes, e elements, k contact
// candidates.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/material/material.hpp"
#include "mechanics/mesh/directions.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "mechanics/mesh/triangles.hpp"
#include "results/store/identity.hpp"
#include "results/store/provenance.hpp"
#include "results/store/vibration_record.hpp"

namespace langer {

// The contact of one indenter in one step, by candidate node.
struct ContactRecord {
  std::vector<Vec3> r;      // reaction on the body, global frame [N], one per candidate node
  std::vector<int> status;  // 0 open, 1 stick, 2 slip
  std::vector<double> gap;  // [mm]
  // Of an indenter that adheres, otherwise empty: intensity of the bond, -1 before the first
  // contact; displacement of the node relative to the indenter when it bonded [mm]; force of the
  // bond on the body, which r does not include [N].
  std::vector<double> beta = {};
  std::vector<Vec3> bonded_at = {}, adhesive = {};
};

// One accepted step: displacements, reactions, fields, contacts and numbers.
struct StepRecord {
  double t = 0;          // path parameter
  double increment = 0;  // of t
  int iterations = 0;
  double residual = 0;         // relative
  std::vector<Vec3> u;         // (n) [mm]
  std::vector<Vec3> reaction;  // (n) internal minus external force: supports and contact [N]
  // (n) further fields of nodes: derivatives of u and reaction.
  std::map<std::string, std::vector<Vec3>> point_fields;
  // (e): J, I4_bar, von_mises [MPa], pressure [MPa].
  std::map<std::string, std::vector<double>> cell_fields;
  // Further values of /history, such as penetration, cone and complementarity.
  std::map<std::string, double> scalars;
  Vec3 u_ind = Vec3::Zero();                      // [mm]; only with contact
  Vec3 force_ind = Vec3::Zero();                  // force on the indenter [N]; only with contact
  std::map<std::string, ContactRecord> contacts;  // by contact name; empty without contact
};

// By which loads are multiplied: t itself but on paths with arc lengths.
inline double load_factor_of(const StepRecord& step) {
  const auto found = step.scalars.find("load_factor");
  if (found == step.scalars.end()) return step.t;
  return found->second;
}

// The parts of a solution that all steps share.
struct SolutionHeader {
  Mesh mesh;
  Material material;                // of the first body
  std::vector<Material> materials;  // one for each body if they differ, otherwise empty
  Directions directions{};          // of the fibres in all elements; the file has those of a field
  std::string formulation;          // element/solid.hpp
  // Candidates by contact name; empty without contact.
  std::map<std::string, std::vector<int>> contact_nodes;
  // Surfaces of indenters that were read from files, at their start.
  std::map<std::string, Triangles> indenter_surfaces{};
  Identity identity;

  // One material for all elements, or one for each body.
  std::vector<Material> laws() const {
    if (materials.empty()) return std::vector{material};
    return materials;
  }
};

// An earlier run of the same task that computed steps of this solution.
struct EarlierRun {
  std::string config, command, code_version, created_utc;
  int steps = 0;
};

// Writes <path>.part and renames it to <path> in finish(). Next to it is <path>.steps, from which
// a later run continues (step_journal.hpp).
class SolutionWriter {
 public:
  // Decides whether a kept step is accurate enough to continue from; false discards it and all
  // steps after it.
  using StillGood = std::function<bool(const StepRecord& step, const EarlierRun& run)>;
  // Begins a new file, or continues the file that an earlier run of the same task left.
  SolutionWriter(const std::string& path, const SolutionHeader& header,
                 const StillGood& still_good = {});
  ~SolutionWriter();
  // The last record of a continued file, from which the next step starts.
  std::optional<StepRecord> resumed() const;
  // The record before that, from which the first guess is extrapolated.
  std::optional<StepRecord> before_resumed() const;
  int n_steps() const;
  // The runs that computed the steps of a continued file.
  const std::vector<EarlierRun>& earlier() const;
  void append(const StepRecord& record);
  // Notes that this solution is the mirror image of another: by which symmetry, and of which.
  void write_image_of(const std::string& which);
  void write_vibration(const VibrationRecord& record);           // about the last step
  using Histories = std::map<std::string, std::vector<double>>;  // by name, a value for each step
  // Completes the file. cost: none if several runs computed it. summary: numbers of the whole
  // result. found_later: histories that follow from the whole path.
  void finish(const std::optional<Cost>& cost = {}, const std::vector<Summary>& summary = {},
              const Histories& found_later = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Reads a solution, one step at a time.
class SolutionReader {
 public:
  // Throws Failure(input) if the file is missing, truncated or of another schema.
  explicit SolutionReader(const std::string& path);
  ~SolutionReader();
  const SolutionHeader& header() const;
  int n_steps() const;
  StepRecord step(int i) const;
  std::vector<Summary> summary() const;  // numbers of the whole result: its errors
  const std::string& content_id() const;
  VibrationRecord vibration() const;  // about the last step; empty where none was asked for

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace langer
