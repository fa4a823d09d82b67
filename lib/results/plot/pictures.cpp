#include "results/plot/pictures.hpp"

#include <algorithm>
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

// A failure is kept for the end.
void Pictures::draw_now(const std::string& name) {
  const std::string reason = run_gnuplot(folder_, name + ".gp");
  if (!reason.empty()) append(failed_[reason], ", ", name);
}

void Pictures::draw(const std::string& name, const Plot& plot) {
  check_replaceable(name, true);
  write_text_file(path_of(name + ".gp"), gnuplot_script(plot, name, style_));
  if (now_) draw_now(name);
}

void Pictures::draw(const std::string& name, const Drawing& drawing) {
  check_replaceable(name, false);
  if (style_.wants(PictureFormat::svg))
    write_text_file(path_of(name + ".svg"), svg(drawing, style_));
  // where SVG is all that is asked for, the script has nothing to draw
  const bool has_more =
      std::any_of(style_.formats.begin(), style_.formats.end(),
                  [](PictureFormat format) { return format != PictureFormat::svg; });
  write_text_file(path_of(name + ".gp"), gnuplot_script(drawing, name, style_));
  if (now_ && has_more) draw_now(name);
}

std::string Pictures::path_of(const std::string& file) const {
  return (std::filesystem::path(folder_) / file).string();
}

}  // namespace langer
