// The effects of material parameters on the stress (sensitivity.h5), as charts over the strain.
#include <sstream>

#include "core/hdf5/h5.hpp"
#include "report/sources.hpp"
#include "results/store/provenance.hpp"

namespace langer::report {

// A chart of each index that the file contains, over the strain, with one curve for each parameter.
// The parameters are in the order of the attribute `order`.
void add_sensitivities(ReportPage& page, const std::vector<Source>& sources) {
  struct Matrix {
    const char* name;  // of a dataset, after its group
    const char* title;
    const char* unit;
  };
  static constexpr Matrix matrices[] = {
      {"mu_star_range", "one at a time: effect over the range", "MPa"},
      {"morris/mu_star", "Morris: mean effect over the range", "MPa"},
      {"morris/sigma", "Morris: spread of the effects", "MPa"},
      {"sobol/first", "Sobol: first-order share", "-"},
      {"sobol/total", "Sobol: total share", "-"}};
  for (const Source& source : sources) {
    const h5::File file = h5::File::open(source.path);
    read_identity(file.root(), sensitivity_schema);
    const std::vector<double> strain = file.root().read<double>("strain", {h5::any}).values;
    std::istringstream order(file.root().group("parameters").text_attribute("order"));
    std::vector<std::string> parameters;
    for (std::string name; order >> name;) parameters.push_back(name);
    for (const Matrix& matrix : matrices) {
      const std::string path = matrix.name;
      const auto cut = path.find('/');
      std::string folder;
      if (cut != std::string::npos) folder = path.substr(0, cut);
      const std::string name = path.substr(cut + 1);
      if (!folder.empty() && !file.root().has(folder)) continue;
      h5::Group group = file.root();
      if (!folder.empty()) group = file.root().group(folder);
      if (!group.has(name)) continue;
      const auto values = group.read<double>(name, {parameters.size(), strain.size()}).values;
      std::string title = matrix.title;
      if (sources.size() > 1) title = fmt::format("{}: {}", source.label, matrix.title);
      Chart chart{"sensitivity", title, "strain", "-", matrix.title, matrix.unit, {}, false};
      for (std::size_t p = 0; p < parameters.size(); ++p) {
        const auto row = values.begin() + static_cast<std::ptrdiff_t>(p * strain.size());
        chart.series.push_back({parameters[p],
                                strain,
                                {row, row + static_cast<std::ptrdiff_t>(strain.size())},
                                false});
      }
      page.charts.push_back(std::move(chart));
    }
  }
}

}  // namespace langer::report
