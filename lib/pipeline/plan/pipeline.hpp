// A pipeline file as written: nodes, the stage each runs, where its inputs come from, and what is
// varied.
//
//   pipeline: tensile_angles
//   nodes:
//     mesh:  {stage: mesh,  config: configs/mesh/cube_1_8.yaml}
//     solve: {stage: solve, config: configs/solve/tensile.yaml, mesh: mesh, material: configs/material/abdomen_hgo_yeoh.yaml,
//             set: {solver.newton.iterations: 30},
//             sweep: {code:  {variants: {FER: {formulation: displacement}, ANSYS: {formulation: mean_dilatation}}},
//                     alpha: {key: "fibre_angles[0]", values: [0, 30, 45, 60], unit: deg}}}
//     post:  {stage: post,  config: configs/post/tensile.yaml, solution: solve}
//     table: {stage: gather, curves: post, over: [code, alpha]}
//
// An axis may also be a grid: {grid: {<key>: [values], <key>: [values]}}, all combinations of them,
// labelled 0.25-10; or a design of experiments: {design: {parameters: [{key, lower, upper}],
// morris: {trajectories: 6}}}; its points are numbered, and the node that gathers over it tells
// effects (sweep/design.hpp). {samples: 100} are sets of parameters that the fit behind `material`
// leaves open (the stage sample), and the node that gathers over it tells the spread. A variant is
// a map of settings, or the path of a config in place of the node's. A port takes a node's name,
// one member of it
// ({node: fit, law: HGO-Yeoh}) or a file; one that takes several files also a list of those.
// `config` is a file, or a map written in place, or absent (all defaults). Paths are relative to
// the working directory. An axis that two nodes declare is one axis: its points must agree.
// Refused: unknown keys, stages, ports and nodes; names that are not safe in file names and in
// make.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/config/tree.hpp"
#include "pipeline/plan/ports.hpp"

namespace langer::pipeline {

using Settings = std::vector<std::pair<std::string, Tree>>;  // key path -> value

struct AxisPoint {
  std::string label;  // "30", "FER"
  Tree config;        // scalar: a file in place of the node's config
  Settings settings;
};

struct Axis {
  std::string name, unit;
  bool numbers = false;  // all labels are numbers
  std::vector<AxisPoint> points;
  Tree design;      // canonical, where the axis is one
  int samples = 0;  // of what a fit leaves open
  Place place;
};

struct Source {
  std::string port;
  std::string node, file;  // one of them
  std::vector<std::pair<std::string, std::string>>
      at;  // axis -> label: the member of the node that is meant
  Place place;
};

struct Node {
  std::string name;
  const StageSpec* stage = nullptr;
  Tree config;  // scalar: a file; map: the config itself; null: all defaults
  Settings settings;
  std::vector<Source> sources;
  std::vector<Axis> sweep;
  std::vector<std::string> over;
  Place place, over_place;
};

struct Pipeline {
  std::string name, file;
  std::vector<Node> nodes;
  const Node* node(const std::string& name) const;
};

Pipeline read_pipeline(const Tree& tree);  // throws Failure(config) with all that is wrong

// letters, digits, _ . + - /; anything else means something to make or to a shell
bool is_safe_path(const std::string& path);

}  // namespace langer::pipeline
