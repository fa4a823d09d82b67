#include "identification/inverse/scene_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/text.hpp"
#include "core/config/writer.hpp"
#include "identification/inverse/refuse.hpp"

namespace langer {

namespace {

// An abscissa that is linear between kinks.
Abscissa sampled(std::string key, const std::vector<double>& kinks,
                 const std::function<double(double)>& s) {
  Abscissa over;
  over.key = std::move(key);
  over.unit = unit_of_column(over.key);
  for (double t : kinks) {
    over.t.push_back(t);
    over.s.push_back(s(t));
  }
  return over;
}

// The points of all histories of the scene: measured curves may have kinks there.
std::vector<double> kinks_of(const SolveConfig& scene) {
  std::set<double> t{0, 1};
  for (const auto& [name, contact] : scene.contacts) {
    for (const WaypointConfig& point : contact.motion) t.insert(place(point, scene.path.seconds));
    for (std::size_t i = 0; contact.control && i < contact.control->force.points.size(); ++i)
      t.insert(place(contact.control->force.points[i], scene.path.seconds));
  }
  for (const LoadConfig& load : scene.loads)
    for (const HistoryConfig& history : load.histories())
      for (const HistoryPointConfig& point : history.points)
        t.insert(place(point, scene.path.seconds));
  return {t.begin(), t.end()};
}

// the indenter that was measured, or the first
const std::pair<const std::string, ContactConfig>* indenter_of(const FitData& data,
                                                               const SolveConfig& scene) {
  if (scene.contacts.empty()) return nullptr;
  const auto named = scene.contacts.find(data.on);
  if (named != scene.contacts.end()) return &*named;
  return &*scene.contacts.begin();
}

// a file of an indenter that is pushed gives its travel over the force
bool gives_travel(const FitData& data, const SolveConfig& scene) {
  const auto* indenter = indenter_of(data, scene);
  return indenter && indenter->second.control && !data.columns->u_ind.empty() &&
         !data.columns->force.empty();
}

// The imposed force of a force-controlled indenter as a function of the path parameter. Offsets of
// the instrument cannot be taken into account here.
std::function<double(double)> pushed_by(const FitData& data, const std::string& at,
                                        const SolveConfig& scene, const FindPlace& where) {
  for (const auto& [key, given] : {std::pair("touch_offset", data.touch_offset),
                                   {"force_offset", data.force_offset},
                                   {"compliance", data.compliance}})
    if (given != 0)
      refuse_scene(where, at + key, "a test of an indenter that is pushed",
                   "none: a file whose offsets are taken off");
  const History history =
      history_of(indenter_of(data, scene)->second.control->force, scene.path.seconds);
  return [history](double t) {
    return history.at(t);
  };
}

// The travel of an indenter as a function of the path parameter.
std::function<double(double)> travel_of(const FitData& data, const SolveConfig& scene,
                                        const std::string& at, const FindPlace& where) {
  const std::string key = at + "columns.u_ind";
  if (scene.contacts.empty())
    refuse_scene(where, key, "a scene without indenters", "displacement, pressure, time or t");
  const ContactConfig& contact = indenter_of(data, scene)->second;
  if (contact.control || contact.motion.empty())
    refuse_scene(where, key, "an indenter that is pushed: its travel is an answer",
                 "force next to it, or t, or time where the path has seconds");
  std::vector<HistoryPoint<Vec3>> motion;
  for (const WaypointConfig& point : contact.motion)
    motion.push_back(
        {place(point, scene.path.seconds), Vec3(point.to[0], point.to[1], point.to[2])});
  return [motion](double t) {
    return value_at(motion, t).norm();
  };
}

// the one history of a set that is moved or pressed
std::function<double(double)> load_of(const FitData& data, const std::string& at,
                                      const SolveConfig& scene, bool pressure,
                                      const FindPlace& where) {
  std::vector<std::string> sets;
  for (const LoadConfig& load : scene.loads) {
    sets.push_back(load.on);
    if (load.on != data.moved) continue;
    std::vector<HistoryConfig> moving;
    if (pressure && load.pressure) moving.push_back(*load.pressure);
    for (int axis = 0; axis < 3 && !pressure; ++axis)
      if (const auto one = load.imposed(axis); one && one->moves()) moving.push_back(*one);
    if (moving.empty()) continue;
    if (moving.size() > 1)
      refuse_scene(where, at + "moved", data.moved + " moves along several axes",
                   "one that moves along one axis");
    const History history = history_of(moving.front(), scene.path.seconds);
    return [history](double t) {
      return history.at(t);
    };
  }
  refuse_scene(
      where, at + "moved",
      fmt::format("no {} on \"{}\"", pressure ? "pressure" : "imposed displacement", data.moved),
      sets.empty() ? "a scene with loads" : "one of " + list_words(sets));
}

// The nodes of the set `on`; refuses a name that the scene does not have.
std::vector<int> set_of(const FitData& data, const std::string& at, const Mesh& mesh,
                        const FindPlace& where) {
  const auto set = mesh.node_sets.find(data.on);
  if (set != mesh.node_sets.end()) return set->second;
  std::vector<std::string> known;
  for (const auto& [name, nodes] : mesh.node_sets) known.push_back(name);
  const std::string near = nearest(data.on, known);
  refuse_scene(where, at + "on", "the scene has no set \"" + data.on + "\"",
               "one of " + list_words(known), did_you_mean(near));
}

// The force on the indenter that the config names, or on the only one.
Observation force_of(const FitData& data, const std::string& at, const SolveConfig& scene,
                     const FindPlace& where) {
  if (scene.contacts.empty())
    refuse_scene(where, at + "columns.force", "a scene without indenters",
                 "reaction_x, reaction_y or reaction_z of a set `on`");
  if (data.on.empty() && scene.contacts.size() == 1) return {};
  std::vector<std::string> known;
  for (const auto& [name, contact] : scene.contacts) known.push_back(name);
  if (data.on.empty())
    refuse_scene(where, at + "columns.force", "a scene with several indenters",
                 "on: one of " + list_words(known));
  if (!scene.contacts.count(data.on))
    refuse_scene(where, at + "on", "the scene has no contact \"" + data.on + "\"",
                 "one of " + list_words(known));
  Observation one;
  if (scene.contacts.size() > 1) one.contact = data.on;
  return one;
}

// Places in the columns x, y and z; NaN for a height that is not given.
std::vector<Vec3> places_in(const SceneData& file) {
  std::vector<Vec3> places;
  const SceneColumn* x = file.find("x");
  const SceneColumn* y = file.find("y");
  const SceneColumn* z = file.find("z");
  if (!x && !y && !z) return places;
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    Vec3 place(0, std::nan(""), 0);
    if (x) place[0] = x->values[i];
    if (y) place[1] = y->values[i];
    if (z) place[2] = z->values[i];
    places.push_back(place);
  }
  return places;
}

// Adds an observation unless there is an equal one. Returns its index.
std::size_t added(std::vector<Observation>& observations, Observation one) {
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Observation& o = observations[i];
    if (o.of == one.of && o.axis == one.axis && o.contact == one.contact && o.nodes == one.nodes &&
        o.weights == one.weights)
      return i;
  }
  observations.push_back(std::move(one));
  return observations.size() - 1;
}

// one observation, or one of each row
std::vector<std::size_t> observed(const FitData& data, const std::string& at,
                                  const SceneColumn& column, const SceneData& file,
                                  const std::vector<Vec3>& places, const ForwardRun& run,
                                  const FindPlace& where, std::vector<Observation>& observations) {
  Observation one;
  if (column.key == "u_ind") {
    one.of = Observation::Of::travel;
    one.contact = indenter_of(data, run.config())->first;
  } else if (column.key == "force") {
    one = force_of(data, at, run.config(), where);
  } else {
    one.of =
        column.key.starts_with("u_") ? Observation::Of::displacement : Observation::Of::reaction;
    one.axis = column.key.back() - 'x';
    if (places.empty()) {
      one.nodes = set_of(data, at, run.mesh(), where);
      one.weights.assign(one.nodes.size(), one.of == Observation::Of::reaction
                                               ? 1.0
                                               : 1.0 / static_cast<double>(one.nodes.size()));
    }
  }
  if (places.empty()) return {added(observations, one)};
  std::vector<std::size_t> of_row;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!find_place(run.mesh(), places[i], one)) {
      const Error error{file.rows[i], "columns.x",
                        fmt::format("no surface of the scene at ({:g}, {:g}, {:g})", places[i][0],
                                    places[i][1], places[i][2]),
                        std::isnan(places[i][1]) ? "a place on its top" : "a place on its surface",
                        "coordinates of the undeformed mesh, in mm"};
      throw Failure(Exit::input, error);
    }
    of_row.push_back(added(observations, one));
  }
  return of_row;
}

// The measured travel less touch offset and compliance, with the values of the config.
double own_travel(const FitData& data, const SceneData& file, std::size_t row, double s) {
  if (!file.find("u_ind")) return s;
  const SceneColumn* force = file.find("force");
  return s - data.touch_offset -
         (force ? data.compliance * (force->values[row] - data.force_offset) : 0);
}

}  // namespace

// Finds the path parameter at which the abscissa has a value, searching from `piece` on. `slack` is
// the part of the range by which a value may be outside the first and the last piece.
std::optional<double> Abscissa::find(double wanted, std::size_t& piece, double slack) const {
  double most = 0;
  for (double one : s) most = std::max(most, std::abs(one));
  for (std::size_t k = piece; k + 1 < t.size(); ++k) {
    const double a = s[k];
    const double b = s[k + 1];
    if (a == b) continue;
    const bool last = k + 2 == t.size();
    const bool first = k == 0;
    double margin = 1e-9 * most;
    if (last || first) margin = slack * most;
    const double low = std::min(a, b) - margin;
    const double high = std::max(a, b) + margin;
    if (wanted < low || wanted > high) continue;
    piece = k;
    return t[k] + (wanted - a) / (b - a) * (t[k + 1] - t[k]);
  }
  return std::nullopt;
}

// The cheapest way through rows and stretches: what goes against a stretch costs its length, what
// is left out at its end half of it.
std::vector<std::size_t> Abscissa::stretches(const std::vector<double>& values,
                                             double slack) const {
  const std::size_t n = values.size();
  const std::size_t pieces = t.size() - 1;
  constexpr double never = std::numeric_limits<double>::infinity();
  const auto has = [&](std::size_t k, double value) {
    std::size_t found = k;
    return find(value, found, slack) && found == k;
  };
  std::vector<std::vector<std::size_t>> from(n, std::vector<std::size_t>(pieces, 0));
  std::vector<double> cost(pieces, never);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> next(pieces, never);
    for (std::size_t k = 0; k < pieces; ++k) {
      if (!has(k, values[i])) continue;
      double left_out = 0;
      for (std::size_t j = k + 1; j-- > 0;) {
        double so_far = 0;
        if (i > 0) {
          so_far = cost[j] + left_out;
        } else if (j == 0) {
          so_far = left_out;
        } else {
          so_far = never;
        }
        if (i == 0 && k > 0 && j == 0) so_far += 0.5 * std::abs(s[1] - s[0]);
        if (i > 0 && j == k)
          so_far += std::max(0.0, (values[i - 1] - values[i]) * (s[k + 1] > s[k] ? 1 : -1));
        if (i > 0 && j < k) so_far += 0.5 * std::abs(s[j + 1] - values[i - 1]);
        if (so_far < next[k]) {
          next[k] = so_far;
          from[i][k] = j;
        }
        if (j < k) left_out += 0.5 * std::abs(s[j + 1] - s[j]);
      }
    }
    cost = std::move(next);
    if (*std::min_element(cost.begin(), cost.end()) == never) {
      std::vector<std::size_t> none(n, 0);
      none[i] = pieces;
      return none;
    }
  }
  std::vector<std::size_t> out(n, 0);
  std::size_t k = 0;
  if (n > 0) {
    k = static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
  }
  for (std::size_t i = n; i-- > 0; k = from[i][k]) out[i] = k;
  return out;
}

Abscissa abscissa_of(const FitData& data, std::size_t item, const SolveConfig& scene,
                     const FindPlace& where) {
  const FitColumns& c = *data.columns;
  const std::string at = fmt::format("data[{}].", item);
  const std::vector<double> kinks = kinks_of(scene);
  if (gives_travel(data, scene)) return sampled("force", kinks, pushed_by(data, at, scene, where));
  if (!c.u_ind.empty()) return sampled("u_ind", kinks, travel_of(data, scene, at, where));
  if (!c.displacement.empty())
    return sampled("displacement", kinks, load_of(data, at, scene, false, where));
  if (!c.pressure.empty()) return sampled("pressure", kinks, load_of(data, at, scene, true, where));
  if (!c.time.empty()) {
    if (!scene.path.seconds)
      refuse_scene(where, at + "columns.time", "a scene whose path has no seconds",
                   "t, u_ind, displacement or pressure");
    return sampled("time", kinks,
                   [seconds = *scene.path.seconds](double t) { return seconds * t; });
  }
  return sampled("t", kinks, [](double t) { return t; });
}

// A measured file of a scene: its abscissa on the path, its curves and their observations.
SceneTest scene_test(const FitData& data, std::size_t item, const SceneData& file,
                     const ForwardRun& run, double noise, double slack, const FindPlace& where,
                     std::vector<Observation>& observations) {
  const std::string at = fmt::format("data[{}].", item);
  SceneTest test;
  test.name = file.name;
  test.data = item;
  test.over = abscissa_of(data, item, run.config(), where);
  test.kinks = kinks_of(run.config());
  const SceneColumn* over = file.find(test.over.key);
  if (over) {
    test.s = over->values;
  } else {
    test.s = std::vector<double>(file.rows.size(), 1);
  }
  std::vector<double> own;
  for (std::size_t i = 0; i < test.s.size(); ++i)
    own.push_back(own_travel(data, file, i, test.s[i]));
  test.stretch = test.over.stretches(own, slack);
  for (std::size_t i = 0; i < test.s.size(); ++i)
    if (test.stretch[i] + 1 == test.over.t.size()) {
      const auto [low, high] = std::minmax_element(test.over.s.begin(), test.over.s.end());
      throw Failure(
          Exit::input,
          Error{file.rows[i], "columns." + test.over.key,
                fmt::format("{} {:g} {}", test.over.key, test.s[i], test.over.unit),
                fmt::format("what the path of the scene reaches, {:g} to {:g} {}, in its order",
                            *low, *high, test.over.unit),
                "a longer path in " + data.solve.path + ", or rows left out"});
    }
  test.places = places_in(file);
  double largest = 0;
  std::vector<double> measured;
  for (const SceneColumn& column : file.columns) {
    if (column.key != "force" && !column.key.starts_with("reaction") &&
        !column.key.starts_with("u_"))
      continue;
    if (column.key == test.over.key) continue;
    SceneCurve curve{column.key, column.unit, static_cast<Eigen::Index>(measured.size()),
                     observed(data, at, column, file, test.places, run, where, observations)};
    if (column.key == "force") test.force = curve.first;
    measured.insert(measured.end(), column.values.begin(), column.values.end());
    for (double value : column.values) largest = std::max(largest, std::abs(value));
    test.curves.push_back(std::move(curve));
  }
  if (!(largest > 0))
    refuse_scene(where, at + "columns", "nothing but zeros in " + file.name, "a test of something");
  test.measured =
      Eigen::Map<const VecX>(measured.data(), static_cast<Eigen::Index>(measured.size()));
  test.deviation = data.standard_deviation.value_or(noise * largest);
  return test;
}

namespace {

// weights of values at `nodes` in the polynomial through them, and in its slope
struct PolynomialWeights {
  VecX value, rate;
};
// Weights of the Lagrange polynomial through the nodes, and of its derivative.
PolynomialWeights polynomial_weights(const std::vector<double>& nodes, double at) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  PolynomialWeights weights{VecX::Ones(n), VecX::Zero(n)};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t m = 0; m < nodes.size(); ++m) {
      if (m == i) continue;
      weights.value[row] *= (at - nodes[m]) / (nodes[i] - nodes[m]);
      double product = 1 / (nodes[i] - nodes[m]);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (k != i && k != m) product *= (at - nodes[k]) / (nodes[i] - nodes[k]);
      }
      weights.rate[row] += product;
    }
  }
  return weights;
}

}  // namespace

// Where a value of the path parameter is among the states of a run: weights of neighbouring states
// that interpolate values and rates between two kinks.
PathPlace place_on(const std::vector<double>& t, const std::vector<double>& kinks, double at) {
  PathPlace found;
  const auto n = static_cast<Eigen::Index>(t.size());
  const auto time = [&](Eigen::Index i) {
    if (i < 0) return 0.0;  // the undeformed state
    return t[static_cast<std::size_t>(i)];
  };
  if (at <= 0) return found;  // at rest
  double begin = 0, end = 1;
  for (double kink : kinks) {
    // behind the end of the path its last piece continues
    if (kink <= at - 1e-9 && kink < 1 - 1e-9) begin = std::max(begin, kink);
    if (kink >= at - 1e-9) end = std::min(end, kink);
  }
  // Only states between those two kinks count, both included.
  Eigen::Index first = -1;
  Eigen::Index last = n - 1;
  while (first + 1 < n && time(first) < begin - 1e-9) ++first;
  while (last > 0 && time(last - 1) >= end - 1e-9) --last;
  double longest = 0;
  if (n > 0) longest = time(last) - time(last - 1);
  // Trial offsets may lead a little beyond the end: the last piece continues for 1.5 increments.
  if (n == 0 || at > time(last) + 1.5 * longest) {
    found.exists = false;
    return found;
  }
  Eigen::Index below = first;
  while (below + 1 < last && time(below + 1) <= at) ++below;
  if (first == last) {
    if (last >= 0) found.value.push_back({last, 1});
    if (last >= 0) found.rate.push_back({last, 0});
    return found;
  }

  // Between two states the polynomials through the five states around each of them, the weight of
  // one growing as that of the other falls. The slope has no jump at a state then: a search for an
  // offset, which moves all readings past the states at once, would end there. Beyond the end the
  // last slope goes on, bent as the last interval is.
  const Eigen::Index count = last - first + 1;
  VecX value = VecX::Zero(count);
  VecX rate = VecX::Zero(count);
  const auto around = [&](Eigen::Index node, Eigen::Index points, double x) {
    points = std::min(points, count);
    const Eigen::Index from = std::clamp(node - points / 2, first, last - points + 1);
    std::vector<double> nodes;
    for (Eigen::Index k = 0; k < points; ++k) nodes.push_back(time(from + k));
    const PolynomialWeights weights = polynomial_weights(nodes, x);
    PolynomialWeights all{VecX::Zero(count), VecX::Zero(count)};
    all.value.segment(from - first, points) = weights.value;
    all.rate.segment(from - first, points) = weights.rate;
    return all;
  };
  const double beyond = at - time(last);
  if (beyond > 0) {
    const PolynomialWeights end = around(last, 5, time(last));
    const PolynomialWeights parabola = around(last, 3, at);
    const PolynomialWeights parabola_end = around(last, 3, time(last));
    const VecX bend = parabola.rate - parabola_end.rate;
    value = end.value + beyond * end.rate + 0.5 * beyond * bend;
    rate = end.rate + bend;
  } else {
    const double h = time(below + 1) - time(below);
    const double x = (at - time(below)) / h;
    const PolynomialWeights left = around(below, 5, at);
    const PolynomialWeights right = around(below + 1, 5, at);
    value = (1 - x) * left.value + x * right.value;
    rate = (1 - x) * left.rate + x * right.rate + (right.value - left.value) / h;
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index state = first + k;
    if (state < 0 || (value[k] == 0 && rate[k] == 0)) continue;
    found.value.push_back({state, value[k]});
    found.rate.push_back({state, rate[k]});
  }
  return found;
}

}  // namespace langer
