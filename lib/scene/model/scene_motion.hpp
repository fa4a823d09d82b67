// The motion of a scene: what its config says of inertia, whether a symmetry keeps it, and the
// state of motion as a solution records it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "mechanics/dynamics/inertia.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/scene.hpp"

namespace langer {

// Density of each body of the mesh [t/mm3]. Errors name the key that is no body.
std::vector<double> densities(const DynamicsConfig& dynamics, const Mesh& mesh,
                              const std::function<Place(const std::string&)>& where,
                              std::vector<Error>& errors);

// Sets the motion of a scene whose contacts and materials are there. Errors name the key.
void add_motion(Scene& scene, const SolveConfig& config, const Mesh& mesh,
                const std::function<Place(const std::string&)>& where, std::vector<Error>& errors);

// Whether gravity and the motion at the beginning are their own images.
bool keeps_motion(const Vec3& signs, const InertiaOptions& motion);

// Names of the fields of nodes and of the histories that belong to a motion.
inline constexpr const char* velocity_field = "velocity";
inline constexpr const char* acceleration_field = "acceleration";
inline constexpr const char* carried_field = "carried";
inline constexpr const char* indenter_velocity = "indenter_velocity";
inline constexpr const char* indenter_acceleration = "indenter_acceleration";
inline constexpr const char* indenter_carried = "indenter_carried";

// of_nodes: a recorded field of the whole body as one of the part that is solved; `shared`: of
// forces, of which a node of the part stands for several.
MotionState recorded_motion(
    const StepRecord& record,
    const std::function<VecX(const std::vector<Vec3>& field, bool shared)>& of_nodes);

}  // namespace langer
