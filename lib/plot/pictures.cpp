#include "plot/pictures.hpp"

#include <filesystem>

#include "hdf5/replace.hpp"
#include "hdf5/seal.hpp"
#include "plot/drawing.hpp"
#include "plot/gnuplot.hpp"

namespace langer {

void Pictures::need_places(const std::string& name, std::initializer_list<const char*> types) const {
  for (const char* type : types) need_replaceable_from(place(name + type), place(name + ".gp"));
}

void Pictures::run(const std::string& name, const std::string& script) {
  write_text_file(place(name + ".gp"), script);
  if (!now_) return;
  const std::string reason = run_gnuplot(folder_, name + ".gp");
  if (!reason.empty()) failed_[reason] += (failed_[reason].empty() ? "" : ", ") + name;
}

void Pictures::draw(const std::string& name, const std::string& script) {
  need_places(name, {".svg", ".png", ".gp.log"});  // which gnuplot writes
  run(name, script);
}

void Pictures::draw(const std::string& name, const Drawing& drawing) {
  need_places(name, {".png", ".gp.log"});
  write_text_file(place(name + ".svg"), svg(drawing));
  run(name, gnuplot_script(drawing, name));
}

std::string Pictures::place(const std::string& file) const { return (std::filesystem::path(folder_) / file).string(); }

}  // namespace langer
