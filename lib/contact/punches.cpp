#include "contact/punches.hpp"

#include <Eigen/LU>

namespace langer {

Mat3 Ellipsoid::inverse(const Mat3& A) { return A.inverse(); }

}  // namespace langer
