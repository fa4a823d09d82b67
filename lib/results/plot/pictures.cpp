#include "results/plot/pictures.hpp"

#include <filesystem>

#include "core/hdf5/replace.hpp"
#include "core/hdf5/seal.hpp"
#include "results/plot/drawing.hpp"
#include "results/plot/gnuplot.hpp"

namespace langer {

void Pictures::need_places(const std::string& name, bool svg_too) const {
  std::vector<std::string> types;
  for (PictureFormat format : style_.formats)
    if (svg_too || format != PictureFormat::svg)
      types.push_back(std::string(".") + names(format)[static_cast<std::size_t>(format)]);
  for (const std::string& type : types)
    require_replaceable_from(place(name + type), place(name + ".gp"));
}

void Pictures::run(const std::string& name, const std::string& script) {
  write_text_file(place(name + ".gp"), script);
  if (!now_) return;
  const std::string reason = run_gnuplot(folder_, name + ".gp");
  if (!reason.empty()) failed_[reason] += (failed_[reason].empty() ? "" : ", ") + name;
}

void Pictures::draw(const std::string& name, const Plot& plot) {
  need_places(name, true);
  run(name, gnuplot_script(plot, name, style_));
}

void Pictures::draw(const std::string& name, const Drawing& drawing) {
  need_places(name, false);
  if (style_.wants(PictureFormat::svg)) write_text_file(place(name + ".svg"), svg(drawing, style_));
  run(name, gnuplot_script(drawing, name, style_));
}

std::string Pictures::place(const std::string& file) const {
  return (std::filesystem::path(folder_) / file).string();
}

}  // namespace langer
