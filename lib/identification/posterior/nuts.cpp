#include "identification/posterior/nuts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/random.hpp"
#include "core/tensor/dense.hpp"

namespace langer {

namespace {

constexpr double minus_infinity = -std::numeric_limits<double>::infinity();
constexpr double energy_error_of_divergence = 1000;
constexpr int most_reflections = 100;  // in one step

double log_sum(double a, double b) {
  const double high = std::max(a, b);
  if (high == minus_infinity) return high;
  return high + std::log(std::exp(a - high) + std::exp(b - high));
}

struct Point {
  VecX x, momentum, gradient;
  double log_density = 0;
};

// A part of a path: its ends as seen in the direction of its growth, and the sum of its momenta.
struct Part {
  VecX momentum_begin, momentum_end, velocity_begin, velocity_end, sum;
  double log_weight = minus_infinity;
};

class Sampler {
 public:
  Sampler(const LogDensity& density, const MatX& scale, const NutsOptions& options)
      : density_(density), options_(options), random_(options.seed, 1 + options.chain) {
    set_scale(scale);
  }

  Point at(const VecX& x) {
    Point point;
    point.x = x;
    point.momentum = VecX::Zero(x.size());
    evaluate(point);
    return point;
  }

  void set_scale(const MatX& scale) {
    scale_ = scale;
    lower_ = Cholesky(scale).L();
  }

  // One path from a point, and a point of it.
  void move(Point& point, double& acceptance) {
    draw_momentum(point);
    energy_ = energy(point);
    accepted_ = 0;
    steps_ = 0;
    diverged_ = false;
    Point left = point;
    Point right = point;
    Part whole;
    whole.momentum_begin = whole.momentum_end = point.momentum;
    whole.velocity_begin = whole.velocity_end = scale_ * point.momentum;
    whole.sum = point.momentum;
    whole.log_weight = 0;
    int depth = 0;
    for (; depth < options_.deepest; ++depth) {
      const bool forward = random_.uniform() < 0.5;
      Part grown;
      Point proposal = point;
      Point& end = forward ? right : left;
      const bool valid = grow(depth, forward ? 1 : -1, end, grown, proposal);
      if (!valid) break;
      if (random_.uniform() < std::exp(grown.log_weight - whole.log_weight)) point = proposal;
      if (!join(whole, grown, forward)) break;
    }
    if (depth == options_.deepest) ++longest;
    if (diverged_) ++divergences;
    acceptance = accepted_ / std::max(1, steps_);
  }

  // A step size at which one step is accepted with a probability near 0.8.
  void find_step(const Point& from) {
    Point point = from;
    draw_momentum(point);
    const double begin = energy(point);
    Point next = point;
    leap(next, 1);
    double change = begin - energy(next);
    if (std::isnan(change)) change = minus_infinity;
    const double direction = change > std::log(0.8) ? 1 : -1;
    for (int i = 0; i < 60; ++i) {
      step *= std::pow(2, direction);
      next = point;
      leap(next, 1);
      change = begin - energy(next);
      if (std::isnan(change)) change = minus_infinity;
      if ((direction > 0) != (change > std::log(0.8))) break;
    }
  }

  double step = 1;
  int divergences = 0, longest = 0;
  long evaluations = 0;

 private:
  void evaluate(Point& point) {
    ++evaluations;
    point.log_density = density_(point.x, point.gradient);
    if (std::isnan(point.log_density) || !point.gradient.allFinite()) {
      point.log_density = minus_infinity;
    }
  }

  void draw_momentum(Point& point) {
    VecX z(point.x.size());
    for (double& one : z) one = random_.normal();
    point.momentum = lower_.transpose().triangularView<Eigen::Upper>().solve(z);
  }

  double energy(const Point& point) const {
    return -point.log_density + 0.5 * point.momentum.dot(scale_ * point.momentum);
  }

  void leap(Point& point, int direction) {
    const double h = direction * step;
    if (point.log_density == minus_infinity) return;
    point.momentum += 0.5 * h * point.gradient;
    if (!drift(point, h)) {
      point.log_density = minus_infinity;
      return;
    }
    evaluate(point);
    if (point.log_density > minus_infinity) point.momentum += 0.5 * h * point.gradient;
  }

  // Moves x for the time h, reflected at walls like light at a mirror in the metric of the momenta.
  // False where one step is so long that it goes from wall to wall.
  bool drift(Point& point, double h) const {
    if (options_.lower.size() == 0) {
      point.x += h * (scale_ * point.momentum);
      return true;
    }
    const double direction = h < 0 ? -1 : 1;
    double left = std::abs(h);
    for (int i = 0; i < most_reflections; ++i) {
      const VecX velocity = direction * (scale_ * point.momentum);
      const auto [hit, time] = next_wall(point.x, velocity);
      if (hit < 0 || time >= left) {
        point.x += left * velocity;
        point.x = point.x.cwiseMax(options_.lower).cwiseMin(options_.upper);
        return point.x.allFinite();
      }
      point.x += time * velocity;
      point.x[hit] = velocity[hit] > 0 ? options_.upper[hit] : options_.lower[hit];
      point.momentum[hit] -= 2 * direction * velocity[hit] / scale_(hit, hit);
      left -= time;
    }
    return false;
  }

  // The wall that x meets first, and when; -1: none.
  std::pair<Eigen::Index, double> next_wall(const VecX& x, const VecX& velocity) const {
    std::pair<Eigen::Index, double> first{-1, std::numeric_limits<double>::infinity()};
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (velocity[i] == 0) continue;
      const double wall = velocity[i] > 0 ? options_.upper[i] : options_.lower[i];
      const double time = (wall - x[i]) / velocity[i];
      if (time < first.second) first = {i, std::max(0., time)};
    }
    return first;
  }

  static bool goes_apart(const VecX& velocity_a, const VecX& velocity_b, const VecX& sum) {
    return velocity_a.dot(sum) > 0 && velocity_b.dot(sum) > 0;
  }

  // 2^depth more steps from an end; false where they turn back or diverge
  bool grow(int depth, int direction, Point& end, Part& part, Point& proposal) {
    if (depth == 0) {
      leap(end, direction);
      ++steps_;
      double now = energy(end);
      if (std::isnan(now)) now = std::numeric_limits<double>::infinity();
      if (now - energy_ > energy_error_of_divergence) diverged_ = true;
      accepted_ += std::min(1., std::exp(energy_ - now));
      part.log_weight = energy_ - now;
      part.momentum_begin = part.momentum_end = end.momentum;
      part.velocity_begin = part.velocity_end = scale_ * end.momentum;
      part.sum = end.momentum;
      proposal = end;
      return !diverged_;
    }
    Part first, second;
    if (!grow(depth - 1, direction, end, first, proposal)) return false;
    Point other = proposal;
    if (!grow(depth - 1, direction, end, second, other)) return false;
    const double weight = log_sum(first.log_weight, second.log_weight);
    if (random_.uniform() < std::exp(second.log_weight - weight)) proposal = other;
    part = first;
    return join(part, second, true);
  }

  // Puts `grown` behind `whole`, or before it; false where the path that results turns back.
  static bool join(Part& whole, const Part& grown, bool behind) {
    const VecX sum = whole.sum + grown.sum;
    const double weight = log_sum(whole.log_weight, grown.log_weight);
    bool apart = true;
    if (behind) {
      apart = goes_apart(whole.velocity_begin, grown.velocity_end, sum);
      apart = apart && goes_apart(whole.velocity_begin, grown.velocity_begin,
                                  whole.sum + grown.momentum_begin);
      apart = apart &&
              goes_apart(whole.velocity_end, grown.velocity_end, grown.sum + whole.momentum_end);
      whole.momentum_end = grown.momentum_end;
      whole.velocity_end = grown.velocity_end;
    } else {
      apart = goes_apart(grown.velocity_end, whole.velocity_end, sum);
      apart = apart && goes_apart(grown.velocity_begin, whole.velocity_end,
                                  whole.sum + grown.momentum_begin);
      apart = apart && goes_apart(grown.velocity_end, whole.velocity_begin,
                                  grown.sum + whole.momentum_begin);
      whole.momentum_begin = grown.momentum_end;
      whole.velocity_begin = grown.velocity_end;
    }
    whole.sum = sum;
    whole.log_weight = weight;
    return apart;
  }

  const LogDensity& density_;
  NutsOptions options_;
  Random random_;
  MatX scale_, lower_;
  double energy_ = 0, accepted_ = 0;
  int steps_ = 0;
  bool diverged_ = false;
};

// Nesterov's dual averaging of ln(step), as in [HG14].
class StepAdaption {
 public:
  explicit StepAdaption(double step, double target)
      : centre_(std::log(10 * step)), target_(target) {}

  double next(double acceptance) {
    ++count_;
    const double share = 1 / (count_ + 10);
    mean_ = (1 - share) * mean_ + share * (target_ - acceptance);
    const double log_step = centre_ - std::sqrt(count_) / 0.05 * mean_;
    const double weight = std::pow(count_, -0.75);
    averaged_ = weight * log_step + (1 - weight) * averaged_;
    return std::exp(log_step);
  }
  double result() const { return std::exp(averaged_); }

 private:
  double centre_, target_, mean_ = 0, averaged_ = 0, count_ = 0;
};

MatX covariance_of(const std::vector<VecX>& draws) {
  const auto n = static_cast<double>(draws.size());
  VecX mean = VecX::Zero(draws.front().size());
  for (const VecX& x : draws) mean += x / n;
  MatX sum = MatX::Zero(mean.size(), mean.size());
  for (const VecX& x : draws) sum += (x - mean) * (x - mean).transpose() / (n - 1);
  return sum;
}

}  // namespace

NutsChain sample_chain(const LogDensity& density, const VecX& start, const MatX& scale,
                       const NutsOptions& options) {
  Sampler sampler(density, scale, options);
  Point point = sampler.at(start);
  NutsChain chain;
  const auto n = start.size();
  chain.draws.resize(options.samples, n);
  chain.log_density.resize(options.samples);
  double acceptance = 0;
  // Two windows: the second has the covariance that the first has seen.
  std::vector<VecX> seen;
  for (const int window : {0, 1}) {
    const int steps = window == 0 ? options.warmup / 2 : options.warmup - options.warmup / 2;
    if (window == 1 && static_cast<Eigen::Index>(seen.size()) > 5 * n) {
      const auto count = static_cast<double>(seen.size());
      const double share = count / (count + 5. * static_cast<double>(n));
      sampler.set_scale(share * covariance_of(seen) + (1 - share) * scale);
    }
    sampler.find_step(point);
    StepAdaption adaption(sampler.step, options.acceptance);
    for (int i = 0; i < steps; ++i) {
      sampler.move(point, acceptance);
      sampler.step = adaption.next(acceptance);
      if (window == 0 && i >= steps / 4) seen.push_back(point.x);
    }
    if (steps > 0) sampler.step = adaption.result();
  }
  sampler.divergences = 0;
  sampler.longest = 0;
  double sum = 0;
  for (int i = 0; i < options.samples; ++i) {
    sampler.move(point, acceptance);
    sum += acceptance;
    chain.draws.row(i) = point.x.transpose();
    chain.log_density[i] = point.log_density;
  }
  chain.divergences = sampler.divergences;
  chain.longest = sampler.longest;
  chain.step = sampler.step;
  chain.acceptance = sum / std::max(1, options.samples);
  chain.evaluations = sampler.evaluations;
  return chain;
}

Convergence convergence(const std::vector<VecX>& chains) {
  // each chain in two halves, so that a drift within one counts as well
  std::vector<VecX> halves;
  for (const VecX& chain : chains) {
    const auto half = chain.size() / 2;
    halves.push_back(chain.head(half));
    halves.push_back(chain.tail(half));
  }
  const auto n = halves.front().size();
  const auto m = static_cast<double>(halves.size());
  const auto count = static_cast<double>(n);
  double mean = 0;
  for (const VecX& half : halves) mean += half.mean() / m;
  double between = 0;
  double within = 0;
  for (const VecX& half : halves) {
    between += count * (half.mean() - mean) * (half.mean() - mean) / (m - 1);
    within += (half.array() - half.mean()).matrix().squaredNorm() / (count - 1) / m;
  }
  const double total = (count - 1) / count * within + between / count;
  Convergence result;
  result.r_hat = std::sqrt(total / within);
  // correlation at a lag from the mean autocovariance of the halves
  const auto correlation = [&](Eigen::Index lag) {
    double sum = 0;
    for (const VecX& half : halves) {
      const VecX d = half.array() - half.mean();
      sum += d.head(n - lag).dot(d.tail(n - lag)) / count / m;
    }
    return 1 - (within - sum) / total;
  };
  double sum = 0;
  double last = std::numeric_limits<double>::infinity();
  for (Eigen::Index lag = 0; lag + 1 < n; lag += 2) {
    double pair = (lag == 0 ? 1 : correlation(lag)) + correlation(lag + 1);
    if (!(pair > 0)) break;
    pair = std::min(pair, last);
    last = pair;
    sum += pair;
  }
  const double time = std::max(-1 + 2 * sum, 1 / std::log10(m * count));
  result.effective = m * count / time;
  return result;
}

}  // namespace langer
