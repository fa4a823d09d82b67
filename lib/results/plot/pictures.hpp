// The figures of a stage. Their scripts are written into the folder of its output and run. A figure
// that cannot be drawn does not stop the stage: failed() collects the reasons, each once, and the
// stage reports them at its end.
#pragma once

#include <map>
#include <string>

#include "results/plot/figure_style.hpp"

namespace langer {

struct Drawing;
struct Plot;

// Draws figures into one folder in one style.
class Pictures {
 public:
  // now: false writes the scripts without running them
  Pictures(std::string folder, FigureStyle style, bool now = true)
      : folder_(std::move(folder)), style_(std::move(style)), now_(now) {}
  // Writes <name>.gp, which makes all pictures of an x-y figure.
  void draw(const std::string& name, const Plot& plot);
  // Writes <name>.svg at once and <name>.gp, which makes the other pictures.
  void draw(const std::string& name, const Drawing& drawing);
  Look look() const { return style_.look(); }
  // The names of the figures that could not be drawn, by reason.
  const std::map<std::string, std::string>& failed() const { return failed_; }

 private:
  void check_replaceable(const std::string& name, bool script_makes_svg) const;
  void draw_now(const std::string& name);
  std::string path_of(const std::string& file) const;
  std::string folder_;
  FigureStyle style_;
  bool now_;
  std::map<std::string, std::string> failed_;
};

}  // namespace langer
