// Writes sweep.h5, the file of langer-gather and langer-tune. Its layout is in the header and in
// docs/schema.md; readers are the report, `langer show` and the package for Python.
#include "pipeline/sweep/sweep_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/hdf5/h5.hpp"
#include "core/hdf5/seal.hpp"

namespace langer {

namespace {

// The words as numbers; empty if one of them is not a number.
std::vector<double> numbers(const std::vector<std::string>& words) {
  std::vector<double> found;
  for (const std::string& w : words) {
    double x = 0;
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), x);
    if (error != std::errc{} || end != w.data() + w.size()) return {};
    found.push_back(x);
  }
  return found;
}

// Writes the values of an axis. Words are stored as their index in the attribute `words`.
void write_axis(const h5::Group& group, const SweepAxis& axis) {
  const std::vector<double> x = numbers(axis.values);
  if (x.size() == axis.values.size())
    return group.write<double>(axis.name, {x.size()}, x, axis.unit);
  std::vector<std::string> words;
  std::vector<std::int64_t> index;
  for (const std::string& value : axis.values) {
    const auto at = std::ranges::find(words, value);
    index.push_back(at - words.begin());
    if (at == words.end()) words.push_back(value);
  }
  group.write<std::int64_t>(axis.name, {index.size()}, index, axis.unit);
  group.annotate(axis.name, "words", fmt::format("{}", fmt::join(words, " ")));
}

// Writes the effects of a design as far as they could be computed.
void write_effects(const h5::Group& root, const Design& design,
                   const std::vector<QuantityEffects>& effects) {
  const h5::Group all = root.make_group("effects");
  std::vector<std::string> order;
  for (const DesignParameter& p : design.parameters) order.push_back(short_name(p));
  all.attribute("order", fmt::format("{}", fmt::join(order, " ")));
  for (const QuantityEffects& e : effects) {
    const h5::Group one = all.make_group(e.name);
    const auto write = [&](const std::string& name, const MatX& column, const std::string& unit) {
      one.write<double>(name, {order.size()}, std::span(column.data(), order.size()), unit);
    };
    const auto write_estimate = [&](const std::string& name, const Estimate& x,
                                    const std::string& unit) {
      write(name, x.value, unit);
      write(name + "_low", x.low, unit);
      write(name + "_high", x.high, unit);
    };
    if (e.one_at_a_time && e.one_at_a_time->complete) {
      write("one_at_a_time", e.one_at_a_time->mu_star, e.unit);
      write("one_at_a_time_spread", e.one_at_a_time->spread, e.unit);
    }
    if (e.morris && e.morris->trajectories >= 2) {
      write_estimate("morris_mu_star", e.morris->mu_star, e.unit);
      write_estimate("morris_sigma", e.morris->sigma, e.unit);
    }
    if (e.sobol && e.sobol->rows >= 2) {
      write_estimate("sobol_first", e.sobol->first, "-");
      write_estimate("sobol_total", e.sobol->total, "-");
    }
  }
}

}  // namespace

// The file appears under its name only when it is complete (h5::File::commit).
void write_sweep(const std::string& path, const std::string& csv_path, const Sweep& sweep,
                 const Design* design, const std::vector<QuantityEffects>& effects,
                 const Identity& identity, const std::vector<Spread>& spreads,
                 const std::vector<Band>& bands) {
  write_text_file(csv_path, csv(sweep));
  h5::File file = h5::File::create(path);
  write_identity(file.root(), sweep_schema, identity);
  file.root().write_text("members", fmt::format("{}", fmt::join(sweep.members, "\n")));
  const h5::Group axes = file.root().make_group("axis");
  const h5::Group values = file.root().make_group("values");
  for (const SweepAxis& axis : sweep.axes) write_axis(axes, axis);
  for (const SweepColumn& c : sweep.columns)
    values.write<double>(c.name, {c.values.size()}, c.values, c.unit);
  if (design) write_effects(file.root(), *design, effects);
  if (!spreads.empty()) write_spread(file.root(), spreads, bands);
  file.commit();
}

}  // namespace langer
