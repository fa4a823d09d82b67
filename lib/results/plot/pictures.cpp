#include "results/plot/pictures.hpp"

#include <filesystem>

#include "core/base/text.hpp"
#include "core/hdf5/replace.hpp"
#include "core/hdf5/seal.hpp"
#include "results/plot/drawing.hpp"
#include "results/plot/gnuplot.hpp"

namespace langer {

// Refuses a picture whose name belongs to a link, a device or a file that this run reads.
void Pictures::check_replaceable(const std::string& name, bool script_makes_svg) const {
  for (PictureFormat format : style_.formats) {
    if (format == PictureFormat::svg && !script_makes_svg) continue;
    require_replaceable_from(path_of(name + "." + word_of(format)), path_of(name + ".gp"));
  }
}

// Writes the script and runs it at once if gnuplot is to draw now. A failure is kept for the end.
void Pictures::run(const std::string& name, const std::string& script) {
  write_text_file(path_of(name + ".gp"), script);
  if (!now_) return;
  const std::string reason = run_gnuplot(folder_, name + ".gp");
  if (!reason.empty()) append(failed_[reason], ", ", name);
}

void Pictures::draw(const std::string& name, const Plot& plot) {
  check_replaceable(name, true);
  run(name, gnuplot_script(plot, name, style_));
}

void Pictures::draw(const std::string& name, const Drawing& drawing) {
  check_replaceable(name, false);
  if (style_.wants(PictureFormat::svg))
    write_text_file(path_of(name + ".svg"), svg(drawing, style_));
  run(name, gnuplot_script(drawing, name, style_));
}

std::string Pictures::path_of(const std::string& file) const {
  return (std::filesystem::path(folder_) / file).string();
}

}  // namespace langer
