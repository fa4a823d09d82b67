#include "store/curves_file.hpp"

#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "store/h5.hpp"
#include "store/seal.hpp"

namespace langer {

std::string csv_name(const std::string& name, const std::string& unit) {
  if (unit.empty() || unit == "-") return name;
  return name + "_" + (unit == "1/MPa" ? "per_MPa" : unit);
}

std::string csv(const std::vector<Column>& columns) {
  std::string text;
  const std::size_t rows = columns.empty() ? 0 : columns[0].values.size();
  for (const Column& c : columns) {
    if (c.values.size() != rows)
      throw Failure(Exit::bug, Error{{}, c.name, fmt::format("{} values", c.values.size()), fmt::format("{} rows", rows), ""});
    text += (text.empty() ? "" : ",") + csv_name(c.name, c.unit);
  }
  text += "\n";
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t c = 0; c < columns.size(); ++c)  // shortest digits that read back as the same number
      text += fmt::format("{}{}", columns[c].values[i], c + 1 < columns.size() ? "," : "\n");
  return text;
}

void write_curves(const std::string& path, const Curves& all, const Identity& identity) {
  if (!all.columns.empty()) write_text_file(std::filesystem::path(path).replace_extension(".csv").string(), csv(all.columns));
  h5::File file = h5::File::create(path);
  write_identity(file.root(), curves_schema, identity);
  const h5::Group curves = file.root().make_group("curves"), columns = file.root().make_group("columns");
  for (const NamedCurve& c : all.curves) {
    const h5::Group one = curves.make_group(c.name);
    one.write<double>("x", {c.x.size()}, c.x, c.x_unit);
    one.write<double>("y", {c.y.size()}, c.y, c.y_unit);
    one.annotate("x", "label", c.x_label);
    one.annotate("y", "label", c.y_label);
  }
  std::string order;
  for (const Column& c : all.columns) {
    columns.write<double>(c.name, {c.values.size()}, c.values, c.unit);
    order += (order.empty() ? "" : " ") + c.name;
  }
  columns.attribute("order", order);
  write_summary(file.root(), all.summary);
  file.commit();
}

CurvesFile read_curves(const std::string& path) {
  const h5::File file = h5::File::open(path);
  CurvesFile result;
  result.content_id = content_id(read_identity(file.root(), curves_schema), curves_schema.version);
  const h5::Group curves = file.root().group("curves"), columns = file.root().group("columns");
  for (const std::string& name : curves.groups()) {
    const h5::Group one = curves.group(name);
    NamedCurve c{name, one.annotation("x", "label"), one.unit("x"), one.annotation("y", "label"), one.unit("y"), {}, {}};
    c.x = one.read<double>("x", {h5::any}).values;
    c.y = one.read<double>("y", {c.x.size()}).values;
    result.curves.curves.push_back(std::move(c));
  }
  std::istringstream order(columns.text_attribute("order"));
  std::size_t rows = h5::any;
  for (std::string name; order >> name;) {
    Column c{name, columns.unit(name), columns.read<double>(name, {rows}).values};
    rows = c.values.size();
    result.curves.columns.push_back(std::move(c));
  }
  result.curves.summary = read_summary(file.root());
  return result;
}

}  // namespace langer
