#include "plot/pictures.hpp"

#include <filesystem>

#include "plot/drawing.hpp"
#include "plot/gnuplot.hpp"
#include "store/replace.hpp"
#include "store/seal.hpp"

namespace langer {

void Pictures::draw(const std::string& name, const std::string& script) {
  for (const char* type : {".svg", ".png", ".gp.log"})  // which gnuplot writes
    need_replaceable((std::filesystem::path(folder_) / (name + type)).string());
  write_text_file((std::filesystem::path(folder_) / (name + ".gp")).string(), script);
  const std::string reason = run_gnuplot(folder_, name + ".gp");
  if (!reason.empty()) failed_[reason] += (failed_[reason].empty() ? "" : ", ") + name;
}

void Pictures::draw(const std::string& name, const Drawing& drawing) {
  write_text_file((std::filesystem::path(folder_) / (name + ".svg")).string(), svg(drawing));
  draw(name, gnuplot_script(drawing, name));
}

}  // namespace langer
