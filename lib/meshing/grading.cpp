#include "meshing/grading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace langer {

void refuse(const std::string& key, const std::string& found, const std::string& expected,
            const std::string& hint) {
  throw Failure(Exit::config, Error{{}, key, found, expected, hint});
}

namespace {

// From element to element: beyond it, neighbours differ too much in size for accurate results.
constexpr double largest_growth = 3;

// The length of m elements that grow by q: edge (q + q^2 + ... + q^m). Infinite if it is more than
// `enough`. Computed in quarters, so that the sum cannot overflow before the comparison.
double growing(double edge, double q, int m, double enough) {
  double sum = 0;
  double term = 0.25 * edge;
  enough *= 0.25;
  for (int i = 0; i < m; ++i) {
    if (term > enough / q) return std::numeric_limits<double>::infinity();
    term *= q;
    sum += term;
    if (sum > enough) return std::numeric_limits<double>::infinity();
  }
  return 4 * sum;
}

}  // namespace

// Lines from 0 to `length` over n elements: the first ones of length `edge` as far as `within`, the
// others growing by one factor q, which solves edge (q + ... + q^m) = rest. The left side grows
// with q, so bisection between 1 and the largest growth finds it.
std::vector<double> refined(double length, int n, double edge, double within,
                            const std::string& key) {
  int fine = n;
  if (0.5 * within / n < 0.5 * edge)
    fine = std::clamp(static_cast<int>(std::lround(within / edge)), 1, n);
  const int m = n - fine;
  double rest = length - fine * edge;
  if (m == 0 && std::abs(rest) < 1e-9 * length) rest = 0;
  const double most = rest * (1 + 1e-9);
  const double least = rest * (1 - 1e-9);
  if (growing(edge, 1, m, most) > most)
    refuse(key, fmt::format("{} cells of {} mm are longer than {} mm", n, edge, length),
           "fewer divisions or a smaller edge", "");
  if (growing(edge, largest_growth, m, least) < least)
    refuse(key,
           fmt::format("{} cells that grow from {} mm by up to {} each do not reach {} mm", n, edge,
                       largest_growth, length),
           "more divisions or a larger edge", "");
  double low = 1;
  double high = largest_growth;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (growing(edge, middle, m, rest) > rest)
      high = middle;
    else
      low = middle;
  }
  std::vector<double> lines{0};
  double step = edge;
  for (int i = 0; i < n; ++i) {
    if (i >= fine) step *= low;
    lines.push_back(lines.back() + step);
  }
  lines.back() = length;
  return lines;
}

std::vector<double> even_lines(double low, double high, int n) {
  std::vector<double> lines(static_cast<std::size_t>(n) + 1);
  // measured from the middle: the lines are exact mirror images about it
  for (int i = 0; i <= n; ++i) lines[i] = 0.5 * (low + high) + (high - low) * (i - 0.5 * n) / n;
  lines.front() = low;
  lines.back() = high;
  return lines;
}

std::vector<double> lines_to_centre(double low, double high, int n, double edge, double within,
                                    const std::string& key) {
  const double half = 0.5 * (high - low);
  const double centre = 0.5 * (low + high);
  std::vector<double> away;  // distances from the centre, ascending
  if (n % 2 == 0) {
    away = refined(half, n / 2, edge, within, key);
  } else if (n == 1) {
    away = {half};
  } else {  // the centre is the middle of an element
    away = refined(half - 0.5 * edge, n / 2, edge, within - 0.5 * edge, key);
    for (double& x : away) x += 0.5 * edge;
  }
  std::vector<double> lines;
  for (auto x = away.rbegin(); x != away.rend(); ++x) lines.push_back(centre - *x);
  // of an even number, the line through the centre is there already
  std::size_t first = 0;
  if (n % 2 == 0) first = 1;
  for (std::size_t i = first; i < away.size(); ++i) lines.push_back(centre + away[i]);
  lines.front() = low;
  lines.back() = high;
  return lines;
}

std::vector<double> lines_around(double place, const GradedSide& below, const GradedSide& above,
                                 const std::string& key) {
  const auto away = [&](const GradedSide& side) {
    if (side.n == 0) return std::vector<double>{0};
    return refined(side.length, side.n, side.edge, side.within, key);
  };
  std::vector<double> lines;
  const std::vector<double> low = away(below);
  const std::vector<double> high = away(above);
  for (auto x = low.rbegin(); x != low.rend(); ++x) lines.push_back(place - *x);
  for (std::size_t i = 1; i < high.size(); ++i) lines.push_back(place + high[i]);
  return lines;
}

std::vector<double> lines_to_top(double low, double high, int n, double edge,
                                 const std::string& key) {
  std::vector<double> lines;
  const std::vector<double> below = refined(high - low, n, edge, 0, key);
  for (auto x = below.rbegin(); x != below.rend(); ++x) lines.push_back(high - *x);
  lines.front() = low;
  lines.back() = high;
  return lines;
}

// The lengths of elements as a continuous function of their number, sampled at n + 1 places. Within
// an element this function is exponential, so that lines of one growth factor stay such lines.
std::vector<double> resampled(const std::vector<double>& lines, int n) {
  const int most = static_cast<int>(lines.size()) - 2;  // the last cell
  const auto length = [&](int i) {
    return lines[static_cast<std::size_t>(i) + 1] - lines[static_cast<std::size_t>(i)];
  };
  std::vector<double> found{lines.front()};
  for (int j = 1; j < n; ++j) {
    const double s = (most + 1.0) * j / n;
    const int cell = std::min(static_cast<int>(s), most);
    const int before = std::max(cell - 1, 0);
    const int after = std::min(cell + 1, most);
    double growth = 0;
    if (after != before) growth = std::log(length(after) / length(before)) / (after - before);
    double part = s - cell;
    if (!(std::abs(growth) < 1e-9)) part = std::expm1(growth * (s - cell)) / std::expm1(growth);
    found.push_back(lines[static_cast<std::size_t>(cell)] + part * length(cell));
  }
  found.push_back(lines.back());
  return found;
}

// Moves the nearest line to each demanded place and the lines between in proportion. Demands are
// served in ascending order; each needs a line of its own that no earlier demand has used.
Moved through(const std::vector<double>& lines, std::vector<Demand> demands,
              const std::string& axis, const std::string& key) {
  const int n = static_cast<int>(lines.size()) - 1;
  const double tolerance = 1e-12 * (lines.back() - lines.front());
  std::sort(demands.begin(), demands.end(),
            [](const Demand& a, const Demand& b) { return a.at < b.at; });
  struct Pin {
    int line;
    double at;
    std::string by;
  };
  std::vector<Pin> pins{{0, lines.front(), ""}};
  for (const Demand& d : demands) {
    if (d.at < lines.front() - tolerance || d.at > lines.back() + tolerance)
      refuse(d.by, fmt::format("{} = {} is outside the block", axis, d.at),
             fmt::format("{} to {}", lines.front(), lines.back()), "");
    if (std::abs(d.at - pins.back().at) <= tolerance || std::abs(d.at - lines.back()) <= tolerance)
      continue;
    // the nearest line inside the block; the sides stay where they are
    int nearest = 1;
    for (int i = 1; i < n; ++i)
      if (std::abs(lines[i] - d.at) < std::abs(lines[nearest] - d.at)) nearest = i;
    if (n < 2 || nearest <= pins.back().line) {
      std::string found = fmt::format("no grid line is left for {} = {}", axis, d.at);
      if (!pins.back().by.empty()) found += ", the nearest goes through " + pins.back().by;
      refuse(d.by, found, "more divisions, or points further apart",
             fmt::format("{} divides {} into {} cells", key, axis, n));
    }
    pins.push_back({nearest, d.at, d.by});
  }
  pins.push_back({n, lines.back(), ""});
  Moved moved{lines, 0};
  for (std::size_t p = 1; p < pins.size(); ++p) {
    const Pin &a = pins[p - 1], &b = pins[p];
    for (int i = a.line; i < b.line; ++i)
      moved.lines[i] =
          a.at + (lines[i] - lines[a.line]) * ((b.at - a.at) / (lines[b.line] - lines[a.line]));
  }
  // Lines that are mirror images but for rounding become so to the last digit: the search for
  // symmetry compares positions.
  const double middle = 0.5 * (lines.front() + lines.back());
  for (int i = 0; 2 * i <= n; ++i)
    if (std::abs(moved.lines[i] + moved.lines[n - i] - 2 * middle) <= 10 * tolerance) {
      if (2 * i == n)
        moved.lines[i] = middle;
      else
        moved.lines[i] = 2 * middle - moved.lines[n - i];
    }
  for (const Pin& pin : pins) moved.lines[pin.line] = pin.at;
  for (int i = 0; i <= n; ++i)
    moved.furthest = std::max(moved.furthest, std::abs(moved.lines[i] - lines[i]));
  return moved;
}

namespace {

// Maps places on an axis to the number of elements below them, a real number, and back. Meshes of a
// family divide this number evenly.
class ElementNumbers {
 public:
  explicit ElementNumbers(const std::vector<double>& lines)
      : n_(static_cast<int>(lines.size()) - 1), fine_(resampled(lines, per_cell * n_)) {}
  double number_at(double x) const {
    const auto above = std::upper_bound(fine_.begin() + 1, fine_.end() - 1, x);
    const double low = *(above - 1);
    const auto i = static_cast<double>(above - 1 - fine_.begin());
    return (i + (x - low) / (*above - low)) / per_cell;
  }
  double place_of(double number) const {
    const double at = number * per_cell;
    const auto i = std::min(static_cast<std::size_t>(at), fine_.size() - 2);
    return fine_[i] + (at - static_cast<double>(i)) * (fine_[i + 1] - fine_[i]);
  }

 private:
  static constexpr int per_cell = 32;
  int n_;
  std::vector<double> fine_;
};

}  // namespace

// Between neighbouring breaks the number of elements is a multiple of `parts`, whatever the length:
// so every mesh of the family has lines at the breaks, and the finer one divides the coarser.
std::vector<double> in_family(const std::vector<double>& lines, std::vector<double> breaks,
                              double length, int parts) {
  const double low = lines.front();
  const double high = lines.back();
  const double slack = 1e-9 * (high - low);
  std::erase_if(breaks, [&](double x) { return x < low + slack || x > high - slack; });
  if (lines.size() == 2 && breaks.empty()) return lines;
  breaks.push_back(low);
  breaks.push_back(high);
  std::sort(breaks.begin(), breaks.end());
  const auto near = [slack](double a, double b) {
    return b - a <= slack;
  };
  breaks.erase(std::unique(breaks.begin(), breaks.end(), near), breaks.end());
  const ElementNumbers numbers(lines);
  std::vector<double> found{low};
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double first = numbers.number_at(breaks[i]);
    const double last = numbers.number_at(breaks[i + 1]);
    const auto quads = std::max(1L, std::lround((last - first) / (4 * length)));
    const int n = parts * static_cast<int>(quads);
    for (int k = 1; k < n; ++k) found.push_back(numbers.place_of(first + (last - first) * k / n));
    found.push_back(breaks[i + 1]);
  }
  return found;
}

// Numbers of elements divided by about `wanted`. Whole numbers allow few factors that are the same
// for all directions: the one with the smallest deviation, in logarithms, is chosen.
std::vector<int> divided(const std::vector<int>& n, double wanted) {
  std::vector<int> best = n;
  double least = std::numeric_limits<double>::infinity();
  for (int k : n)
    for (double to : {std::floor(k / wanted), std::ceil(k / wanted)}) {
      if (to < 1) continue;
      const double factor = k / to;
      double off = 0.7 * std::abs(std::log(factor / wanted));
      std::vector<int> counts = n;
      for (int& count : counts) {
        if (count == 0) continue;
        const int fewer = std::max(1, static_cast<int>(std::lround(count / factor)));
        off = std::max(off, std::abs(std::log(count / (fewer * factor))));
        count = fewer;
      }
      if (counts != n && off < least) {
        least = off;
        best = counts;
      }
    }
  return best;
}

}  // namespace langer
