// solution.h5: one record per accepted step, appended and flushed before the next step begins.
// docs/schema.md Arrays keep the mesh's node and cell order. n nodes, e cells, k contact
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

namespace langer {

struct ContactRecord {
  std::vector<Vec3> r;      // reaction on the body, global frame [N], one per candidate node
  std::vector<int> status;  // 0 open, 1 stick, 2 slip
  std::vector<double> gap;  // [mm]
  // where the indenter adheres, else empty: intensity, -1 where nothing has bonded yet;
  // displacement of the node less that of the indenter where it bonded [mm]; force of the bond on
  // the body, beside r [N]
  std::vector<double> beta = {};
  std::vector<Vec3> bonded_at = {}, adhesive = {};
};

struct StepRecord {
  double t = 0;          // path parameter
  double increment = 0;  // of t
  int iterations = 0;
  double residual = 0;         // relative
  std::vector<Vec3> u;         // (n) [mm]
  std::vector<Vec3> reaction;  // (n) internal minus external force: supports and contact [N]
  std::map<std::string, std::vector<Vec3>>
      point_fields;  // (n) further ones: derivatives of u and reaction
  std::map<std::string, std::vector<double>>
      cell_fields;  // (e): J, I4_bar, von_mises [MPa], pressure [MPa]
  std::map<std::string, double>
      scalars;                // further /history values, e.g. penetration, cone, complementarity
  Vec3 u_ind = Vec3::Zero();  // [mm]; only with contact
  Vec3 force_ind = Vec3::Zero();                  // force on the indenter [N]; only with contact
  std::map<std::string, ContactRecord> contacts;  // by contact name; empty without contact
};

// What does not change from step to step.
struct SolutionHeader {
  Mesh mesh;
  Material material;                // of the first body
  std::vector<Material> materials;  // one for each body where they differ, else empty
  Directions directions{};          // of the fibres in all cells; the file has those of a field
  std::string formulation;          // element/solid.hpp
  std::map<std::string, std::vector<int>>
      contact_nodes;  // candidates by contact name; empty without contact
  std::map<std::string, Triangles>
      indenter_surfaces{};  // of those read from files, where they begin
  Identity identity;

  // one for all cells, or one for each body
  std::vector<Material> laws() const {
    if (materials.empty()) return std::vector{material};
    return materials;
  }
};

// a run that added steps to what a later one goes on with
struct EarlierRun {
  std::string config, command, code_version, created_utc;
  int steps = 0;
};

// Writes <path>.part and renames it to <path> in finish(); beside it <path>.steps, from which the
// next run continues (step_journal.hpp).
class SolutionWriter {
 public:
  // false: this step and those behind it are not good enough to go on from
  using StillGood = std::function<bool(const StepRecord& step, const EarlierRun& run)>;
  // Starts a new file; or continues what a run of the same task left.
  SolutionWriter(const std::string& path, const SolutionHeader& header,
                 const StillGood& still_good = {});
  ~SolutionWriter();
  // last record of a continued file, with everything a step needs to start from
  std::optional<StepRecord> resumed() const;
  std::optional<StepRecord> before_resumed()
      const;  // the record before that, from which extrapolation starts
  int n_steps() const;
  const std::vector<EarlierRun>& earlier()
      const;  // which runs the steps are of that it was continued from
  void append(const StepRecord& record);
  void say_image_of(
      const std::string& which);  // a solution that is the image of another: how, and of which
  using Histories = std::map<std::string, std::vector<double>>;  // by name, a value for each step
  // cost: none where the work was done in several runs; summary: what is said of the result as a
  // whole; found_later: histories that only the whole path tells
  void finish(const std::optional<Cost>& cost = {}, const std::vector<Summary>& summary = {},
              const Histories& found_later = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Reads a whole solution lazily.
class SolutionReader {
 public:
  explicit SolutionReader(
      const std::string& path);  // throws Failure(input): missing, truncated, wrong schema
  ~SolutionReader();
  const SolutionHeader& header() const;
  int n_steps() const;
  StepRecord step(int i) const;
  std::vector<Summary> summary() const;  // said of the result as a whole: its errors
  const std::string& content_id() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace langer
