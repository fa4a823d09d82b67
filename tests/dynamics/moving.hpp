// Bodies in motion, stepped in memory.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "mechanics/dynamics/inertia.hpp"
#include "mechanics/solve/increment.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"

namespace langer::test {

// A body with inertia, and steps of equal length.
class Moving {
 public:
  Moving(const Mesh& mesh, const Material& material, const Dofs& dofs, InertiaOptions options,
         std::vector<RigidContact> contacts, double step, int n_steps, Loads loads = {},
         Formulation formulation = Formulation::mean_dilatation)
      : n_(n_steps),
        materials_(mesh.bodies.size(), material),
        body_(mesh, materials_, directions(mesh, materials_), formulation, dofs, 1, Kernel::packets,
              {}, {}, std::move(loads)) {
    options.seconds = step * n_steps;
    if (options.density.empty()) options.density = {1e-9};
    if (!options.massless.empty()) {
      options.massless.assign(static_cast<std::size_t>(mesh.n_nodes()), 0);
      for (const RigidContact& contact : contacts) {
        for (int node : contact.nodes) options.massless[static_cast<std::size_t>(node)] = 1;
      }
    }
    inertia_ = std::make_unique<Inertia>(body_, options);
    body_.set_added_term(inertia_.get());
    IncrementOptions increment;
    increment.seconds = options.seconds;
    increment.inertia = inertia_.get();
    increment_ = std::make_unique<Increment>(body_, std::move(contacts), increment);
  }

  void step(double relative = 1e-10) {
    ++done_;
    increment_->begin(static_cast<double>(done_) / n_);
    NewtonOptions options;
    options.relative = relative;
    const SolveReport report = newton(increment_->problem(), increment_->trial(), options);
    if (!report.converged()) {
      throw std::runtime_error("step " + std::to_string(done_) + ": " + report.why);
    }
    increment_->accept();
  }
  // Continues from another state, at the beginning of the path.
  void restart_from(const BodyState& state) {
    done_ = 0;
    increment_->restore(state);
  }
  double force() const {  // of all contacts [N]
    Vec3 sum = Vec3::Zero();
    for (const auto& r : increment_->accepted().r) {
      for (const Vec3& one : r) sum += one;
    }
    return sum.norm();
  }
  const MotionState& motion() const { return increment_->accepted().motion; }
  double energy() const { return motion().kinetic + motion().stored; }
  Assembler& body() { return body_; }
  Increment& increment() { return *increment_; }
  Inertia& inertia() { return *inertia_; }

 private:
  int n_;
  int done_ = 0;
  std::vector<Material> materials_;
  Assembler body_;
  std::unique_ptr<Inertia> inertia_;
  std::unique_ptr<Increment> increment_;
};

}  // namespace langer::test
