#include "identification/sensitivity/sobol.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "core/base/in_order.hpp"
#include "core/base/random.hpp"
#include "identification/sensitivity/sobol_sequence.hpp"

namespace langer {

namespace {

// Blocks of rows: units of work for the threads and of the resampling for intervals.
constexpr int n_blocks = 64;

// Sums over the rows of a block. Curves are taken less the curve at the middle of the box, which
// saves digits.
struct Sums {
  double n = 0;
  VecX A, B, AA, BB, BA;  // (m)
  MatX M, BM, D;          // (k, m) of y_ABi, y_B y_ABi, (y_A - y_ABi)^2
  long missing = 0, curves = 0;

  Sums(Eigen::Index k, Eigen::Index m) {
    A = B = AA = BB = BA = VecX::Zero(m);
    M = BM = D = MatX::Zero(m, k);
  }
  void operator+=(const Sums& s) {
    n += s.n;
    missing += s.missing;
    curves += s.curves;
    A += s.A;
    B += s.B;
    AA += s.AA;
    BB += s.BB;
    BA += s.BA;
    M += s.M;
    BM += s.BM;
    D += s.D;
  }
};

// Sensitivity indices, and mean and variance of the curve.
struct Shares {
  MatX first, total, group_first, group_total;
  VecX mean, variance;
};

// Indices from the sums: numerators by the estimators of the header, divided by the variance.
Shares shares(const Sums& s, const std::vector<std::vector<int>>& groups) {
  Shares r;
  const double n = s.n;
  r.mean = (s.A + s.B) / (2 * n);
  r.variance = ((s.AA + s.BB) / (2 * n) - r.mean.cwiseAbs2()).cwiseMax(0);
  //   mean (y_B - mean)(y_ABi - y_A)
  const MatX part = ((s.BM.colwise() - s.BA) -
                     ((s.M.colwise() - s.A).array().colwise() * r.mean.array()).matrix()) /
                    n;
  const MatX rest = s.D / (2 * n);
  // A point without variance has no index.
  const auto ratio = [](double x, double V) {
    if (V > 0) return x / V;
    return std::numeric_limits<double>::quiet_NaN();
  };
  const auto m = part.rows();
  const auto k = part.cols();
  const auto z = static_cast<Eigen::Index>(groups.size());
  r.first.resize(k, m);
  r.total.resize(k, m);
  r.group_first.resize(k, z);
  r.group_total.resize(k, z);
  for (Eigen::Index i = 0; i < k; ++i) {
    for (Eigen::Index j = 0; j < m; ++j) {
      r.first(i, j) = ratio(part(j, i), r.variance[j]);
      r.total(i, j) = ratio(rest(j, i), r.variance[j]);
    }
    for (Eigen::Index g = 0; g < z; ++g) {
      double first = 0, total = 0, V = 0;
      for (int j : groups[static_cast<std::size_t>(g)]) {
        first += part(j, i);
        total += rest(j, i);
        V += r.variance[j];
      }
      r.group_first(i, g) = ratio(first, V);
      r.group_total(i, g) = ratio(total, V);
    }
  }
  return r;
}

// A row of independent random numbers in [0, 1).
VecX independent(Eigen::Index size, Random random) {
  VecX u(size);
  for (double& x : u) x = random.uniform();
  return u;
}

// Adds one row: the curves at a, at b, and at a with each parameter replaced by that of b. The row
// counts only if all of these curves exist.
void add_row(Sums& sums, const ParametricCurve& phi, const VecX& middle, const VecX& lower,
             const VecX& range, const VecX& u) {
  const auto k = lower.size();
  VecX a = lower + u.head(k).cwiseProduct(range);
  VecX b = lower + u.tail(k).cwiseProduct(range);
  const auto curve = [&](const VecX& p, VecX& y) {
    ++sums.curves;
    if (!phi(p, y) || !y.allFinite()) return false;
    y -= middle;
    return true;
  };
  VecX y_A, y_B, y;
  MatX mixed(middle.size(), k);
  bool exist = curve(a, y_A) && curve(b, y_B);
  for (Eigen::Index i = 0; exist && i < k; ++i) {
    std::swap(a[i], b[i]);
    exist = curve(a, y);
    std::swap(a[i], b[i]);
    if (exist) mixed.col(i) = y;
  }
  if (!exist) {
    ++sums.missing;
    return;
  }
  sums.n += 1;
  sums.A += y_A;
  sums.B += y_B;
  sums.AA += y_A.cwiseAbs2();
  sums.BB += y_B.cwiseAbs2();
  sums.BA += y_B.cwiseProduct(y_A);
  sums.M += mixed;
  sums.BM.array() += mixed.array().colwise() * y_B.array();
  sums.D += (mixed.colwise() - y_A).cwiseAbs2();
}

}  // namespace

Sobol sobol(const CurveMaker& maker, const VecX& lower, const VecX& upper, long n,
            const SamplingOptions& options) {
  Sobol result;
  const auto k = lower.size();
  // Sobol' points need 2 k dimensions. Beyond those of the table independent random numbers are
  // used.
  const bool random_rows =
      options.sequence == Sequence::random || 2 * k > SobolSequence::most_dimensions;
  const int threads = std::max(1, options.threads);
  std::vector<ParametricCurve> phi;
  for (int t = 0; t < threads; ++t) phi.push_back(maker());
  VecX middle;
  const VecX centre = 0.5 * (lower + upper);
  if (!phi[0](centre, middle) || !middle.allFinite()) return result;
  std::vector<Sums> blocks(n_blocks, Sums(k, middle.size()));
  in_order(
      threads, n_blocks,
      [&](int worker, int block) {
        const long from = n * block / n_blocks;
        const long to = n * (block + 1) / n_blocks;
        std::optional<SobolSequence> sequence;
        if (!random_rows)
          sequence.emplace(2 * k, Random(options.seed, 1ull << 41),
                           static_cast<std::uint32_t>(from));
        Sums sums(k, middle.size());  // of its own: neighbours in `blocks` would share cache lines
        for (long row = from; row < to; ++row)
          add_row(sums, phi[static_cast<std::size_t>(worker)], middle, lower, upper - lower,
                  random_rows
                      ? independent(2 * k, Random(options.seed, static_cast<std::uint64_t>(row)))
                      : sequence->next());
        blocks[static_cast<std::size_t>(block)] = std::move(sums);
      },
      [&](int, int block) {
        if (options.progress) options.progress((block + 1.) / n_blocks);
      });
  Sums all(k, middle.size());
  for (const Sums& s : blocks) all += s;
  result.rows = static_cast<long>(all.n);
  result.without_curve = all.missing;
  result.curves = all.curves;
  if (all.n < 2) return result;
  const Shares best = shares(all, options.groups);
  result.mean = best.mean + middle;
  result.deviation = best.variance.cwiseSqrt();
  // Intervals by the bootstrap over blocks.
  Resamples first, total, group_first, group_total;
  for (int r = 0; r < options.resamples; ++r) {
    Random random(options.seed, (1ull << 40) + static_cast<std::uint64_t>(r));
    Sums sums(k, middle.size());
    for (int b = 0; b < n_blocks; ++b) sums += blocks[random.below(n_blocks)];
    if (sums.n < 2) continue;
    const Shares one = shares(sums, options.groups);
    first.add(one.first);
    total.add(one.total);
    group_first.add(one.group_first);
    group_total.add(one.group_total);
  }
  result.first = first.around(best.first);
  result.total = total.around(best.total);
  result.group_first = group_first.around(best.group_first);
  result.group_total = group_total.around(best.group_total);
  return result;
}

}  // namespace langer
