// A pipeline file as written: its nodes, the stage that each one runs, the inputs of each, and the
// axes of sweeps.
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
// A node has an input file for each port of its stage. A port takes a node's name, one member of a
// node ({node: fit, law: HGO-Yeoh}) or a file; a port for several files also takes a list of those.
// `config` is a file, or a map in the pipeline itself, or absent (all defaults). Paths are relative
// to the working directory.
//
// The kinds of axes:
//   {key, values}       one key, or several keys with the same value
//   {variants: {..}}    named settings; a variant is a map, or the path of another config
//   {grid: {..}}        all combinations of the values of several keys; labels are like 0.25-10
//   {design: {..}}      a design of experiments (Morris, Sobol'); the node that gathers over it
//                       computes effects (sweep/design.hpp)
//   {samples: 100}      sets of parameters drawn from the covariance of the fit behind `material`
//                       (stage sample); the node that gathers over them computes the spread
// If two nodes declare an axis of the same name, it is one axis, and its points must agree.
//
// Refused: unknown keys, stages, ports and nodes, and names that are not safe in file names and in
// make.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/config/tree.hpp"
#include "pipeline/plan/ports.hpp"

namespace langer::pipeline {

using Settings = std::vector<std::pair<std::string, Tree>>;  // key path -> value

// One value of an axis: its label, and what it changes in a node's config.
struct AxisPoint {
  std::string label;  // "30", "FER"
  Tree config;        // scalar: a file that is used instead of the node's config
  Settings settings;
};

// One axis of a sweep. The label of a point is part of the name of its folder.
struct Axis {
  std::string name, unit;
  bool numbers = false;  // all labels are numbers
  std::vector<AxisPoint> points;
  Tree design;      // canonical; empty unless the axis is a design
  int samples = 0;  // number of samples of the fitted parameters; 0 for another axis
  Place place;
};

// An input of a node: another node, or a file.
struct Source {
  std::string port;
  std::string node, file;                               // one of them
  std::vector<std::pair<std::string, std::string>> at;  // axis -> label: one member of the node
  Place place;
};

// A stage with its config, inputs and sweep.
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

// A whole pipeline; nodes are in the order of the file.
struct Pipeline {
  std::string name, file;
  std::vector<Node> nodes;
  const Node* node(const std::string& name) const;
};

Pipeline read_pipeline(const Tree& tree);  // throws Failure(config) with all errors

// Only letters, digits, _ . + - and /: other characters have a meaning in make or in a shell.
bool is_safe_path(const std::string& path);

}  // namespace langer::pipeline
