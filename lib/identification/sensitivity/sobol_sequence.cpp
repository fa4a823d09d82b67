#include "identification/sensitivity/sobol_sequence.hpp"

#include <boost/random/sobol.hpp>

namespace langer {

struct SobolSequence::Engine {
  boost::random::sobol_engine<std::uint32_t, 32> sequence;
};

SobolSequence::SobolSequence(Eigen::Index dimensions, Random shift, std::uint32_t from)
    : engine_(new Engine{
          boost::random::sobol_engine<std::uint32_t, 32>(static_cast<std::size_t>(dimensions))}),
      point_(static_cast<std::size_t>(dimensions), 0u),
      begun_(from > 0) {
  if (from > 0)
    engine_->sequence.seed(from - 1);  // the engine leaves out the first point, which is zero
  for (Eigen::Index i = 0; i < dimensions; ++i)
    shift_.push_back(static_cast<std::uint32_t>(shift.bits() >> 32));
}

SobolSequence::~SobolSequence() = default;

// Each coordinate of the point is combined with the random shift bit by bit. Adding a half keeps it
// inside the open interval (0, 1).
VecX SobolSequence::next() {
  if (begun_)
    for (std::uint32_t& x : point_) x = engine_->sequence();
  begun_ = true;
  VecX u(static_cast<Eigen::Index>(point_.size()));
  for (Eigen::Index i = 0; i < u.size(); ++i)
    u[i] = (static_cast<double>(point_[static_cast<std::size_t>(i)] ^
                                shift_[static_cast<std::size_t>(i)]) +
            0.5) *
           0x1p-32;
  return u;
}

}  // namespace langer
