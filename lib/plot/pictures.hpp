// The figures of a stage: their scripts are written beside its output and run; what went wrong is said at the end, each reason
// once. A figure that cannot be drawn stops nothing.
#pragma once

#include <initializer_list>
#include <map>
#include <string>

namespace langer {

struct Drawing;

class Pictures {
 public:
  // now: false leaves the scripts to be run later
  explicit Pictures(std::string folder, bool now = true) : folder_(std::move(folder)), now_(now) {}
  void draw(const std::string& name, const std::string& script);                // <name>.gp, which makes the pictures
  void draw(const std::string& name, const Drawing& drawing);                   // <name>.svg at once, <name>.png by its script
  const std::map<std::string, std::string>& failed() const { return failed_; }  // reason -> names

 private:
  void need_places(const std::string& name, std::initializer_list<const char*> types) const;
  void run(const std::string& name, const std::string& script);
  std::string place(const std::string& file) const;
  std::string folder_;
  bool now_;
  std::map<std::string, std::string> failed_;
};

}  // namespace langer
