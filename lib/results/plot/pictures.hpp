// The figures of a stage: their scripts are written beside its output and run; what went wrong is
// said at the end, each reason once. A figure that cannot be drawn stops nothing.
#pragma once

#include <map>
#include <string>

#include "results/plot/figure_style.hpp"

namespace langer {

struct Drawing;
struct Plot;

class Pictures {
 public:
  // now: false leaves the scripts to be run later
  Pictures(std::string folder, FigureStyle style, bool now = true)
      : folder_(std::move(folder)), style_(std::move(style)), now_(now) {}
  void draw(const std::string& name, const Plot& plot);  // <name>.gp, which makes the pictures
  void draw(const std::string& name,
            const Drawing& drawing);  // <name>.svg at once, the others by its script
  Look look() const { return style_.look(); }
  const std::map<std::string, std::string>& failed() const { return failed_; }  // reason -> names

 private:
  void need_places(const std::string& name, bool svg_too) const;
  void run(const std::string& name, const std::string& script);
  std::string place(const std::string& file) const;
  std::string folder_;
  FigureStyle style_;
  bool now_;
  std::map<std::string, std::string> failed_;
};

}  // namespace langer
