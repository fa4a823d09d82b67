#include "identification/inverse/load_neighbours.hpp"

#include <fmt/format.h>

namespace langer {

LoadNeighbours::Neighbour::Neighbour(const Run& run, std::shared_ptr<const Scene> other,
                                     const SolveConfig& config, const Run::Where& where)
    : scene(std::move(other)),
      reduction(Reduction::find(run.mesh, *scene, config, where, run.reduction.point() != nullptr)),
      body(reduction.assembler()) {}

ParameterChange LoadNeighbours::Neighbour::at(double t, const VecX& u) {
  ParameterChange all;
  body.load_to(t);
  body.assemble(u, false);
  all.f = body.f_int();
  if (body.f_ext().size() > 0) all.f -= body.f_ext();
  all.prescribed = VecX::Zero(u.size());
  for (const Prescribed& p : body.dofs().prescribed) all.prescribed[p.dof] = p.at(t);
  for (const RigidContact& contact : reduction.scene().contacts)
    if (contact.control) all.control = contact.control->force.at(t);
  return all;
}

LoadNeighbours::LoadNeighbours(const Run& run, const SceneParameters& parameters,
                               const SolveConfig& config, const Run::Where& where) {
  for (std::size_t i = 0; i < parameters.list().size(); ++i) {
    Pair& pair = pairs_.emplace_back();
    const auto& load = parameters.load(i);
    if (!load) continue;
    pair.width = load->width;
    pair.less = std::make_unique<Neighbour>(run, load->less, config, where);
    pair.more = std::make_unique<Neighbour>(run, load->more, config, where);
    for (const Neighbour* one : {pair.less.get(), pair.more.get()}) {
      const bool same = one->reduction.kind() == run.reduction.kind() &&
                        one->body.dofs().n == run.body.dofs().n &&
                        one->body.dofs().free == run.body.dofs().free;
      if (same) continue;
      const std::string key = fmt::format("sensitivity[{}]", i);
      throw Failure(Exit::config,
                    Error{where(key), key,
                          "found \"" + parameters.list()[i].key +
                              "\", with which another part of the body is solved",
                          "symmetry: none and homogeneous: off, or another number", ""});
    }
  }
}

void LoadNeighbours::add_change(std::size_t i, double t, const VecX& u, ParameterChange& change) {
  Pair& pair = pairs_[i];
  if (!pair.less) return;
  const ParameterChange less = pair.less->at(t, u);
  const ParameterChange more = pair.more->at(t, u);
  const VecX f = (more.f - less.f) / pair.width;
  if (change.f.size() > 0) {
    change.f += f;
  } else {
    change.f = f;
  }
  const VecX moved = (more.prescribed - less.prescribed) / pair.width;
  if (!moved.isZero(0)) change.prescribed = moved;
  change.control = (more.control - less.control) / pair.width;
}

}  // namespace langer
