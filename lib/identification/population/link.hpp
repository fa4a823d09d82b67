// How a parameter of a law becomes a number that varies normally between specimens.
//
// Moduli, exponents and times are positive, and a stiff specimen varies by as many per cent as a
// soft one: their logarithm is normal. Angles and numbers of either sign are taken as they are. A
// number between two limits, such as the dispersion of fibres, is normal on the scale of the
// logit.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace langer {

enum class LinkKind { identity, log, logit };
constexpr auto names(LinkKind) { return std::array{"identity", "log", "logit"}; }

struct Link {
  LinkKind kind = LinkKind::identity;
  double lower = 0, upper = 1;  // of logit

  // phi of a number; numbers on a limit are moved off it by `least` of the range, or of 1
  double forward(double x, double least = 1e-6) const {
    if (kind == LinkKind::log) {
      return std::log(std::max(x, least));
    }
    if (kind == LinkKind::logit) {
      const double share = std::clamp((x - lower) / (upper - lower), least, 1 - least);
      return std::log(share / (1 - share));
    }
    return x;
  }
  // the number of a phi
  double backward(double phi) const {
    if (kind == LinkKind::log) {
      return std::exp(phi);
    }
    if (kind == LinkKind::logit) {
      return lower + (upper - lower) / (1 + std::exp(-phi));
    }
    return phi;
  }
  // d number / d phi
  double slope(double phi) const {
    if (kind == LinkKind::log) {
      return std::exp(phi);
    }
    if (kind == LinkKind::logit) {
      const double share = 1 / (1 + std::exp(-phi));
      return (upper - lower) * share * (1 - share);
    }
    return 1;
  }
};

}  // namespace langer
